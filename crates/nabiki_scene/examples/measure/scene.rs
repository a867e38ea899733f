//! How the hair of a scene moves.

use glam::{DVec3, Vec3};
use nabiki::Strands;
use nabiki::dynamics::{Dynamics, Form, Played};
use nabiki::field::UniformField;
use nabiki_scene::{BuiltScene, Scene, Shown};

use crate::numbers::{correlation, mean, share_above, share_of_three};
use crate::reference::{Chain, Properties};

/// Where along a strand its rise is measured.
const ALONG: [f64; 3] = [0.15, 0.55, 0.97];
/// Strands that come nearer to the head than this, but for their first third, are not compared with a chain that knows no head (cm).
const FREE_CM: f32 = 0.8;
/// Chains at the most: each takes a few hundred steps a frame.
const CHAINS: usize = 40;

/// Prints the table of a scene.
pub fn measure(scene: Scene, strands: usize) -> Result<(), Box<dyn std::error::Error>> {
    let built = scene.clone().build(Shown::AtMost(strands))?;
    let mut timeline = built.timeline()?;
    let film = timeline.play();
    let rest = &built.groom.hair.strands;
    println!("{} strands, {} frames at {} a second", rest.len(), film.frames(), built.dynamics.motion.frame_rate);

    if let Some((from, through)) = first_wind(&scene) {
        // The reference knows no locks and no regions.
        let mut alike = scene.clone();
        alike.free.variation = None;
        alike.free.regions.clear();
        let built = alike.build(Shown::AtMost(strands))?;
        rises(&built, &built.timeline()?.play(), from, through);
    }
    let tips: Vec<Vec<DVec3>> = (0..rest.len()).map(|s| tip_of(&film, s)).collect();
    alike(rest, &tips);
    alike_in_locks(&built, &tips);
    let velocities: Vec<Vec<DVec3>> = tips.iter().map(|tip| tip.windows(2).map(|w| w[1] - w[0]).collect()).collect();
    println!("three components of all tips' velocities  {:.3}", share_of_three(&velocities));
    let rate = built.dynamics.motion.frame_rate;
    println!("energy of tips' velocities above 1 Hz     {:.1} %", 100.0 * share_above(&velocities, 1.0 / rate));
    shapes(&built, &film);
    rest_and_return(&built, scene, strands)
}

fn tip_of(film: &Played, s: usize) -> Vec<DVec3> {
    (0..=film.frames()).map(|n| film.strand(n, s).last().expect("a strand has points").as_dvec3()).collect()
}

/// The first interval with wind: the frame before it, and its last.
fn first_wind(scene: &Scene) -> Option<(u32, u32)> {
    let keys = &scene.field.force;
    let first = keys.iter().position(|key| key.vector != Vec3::ZERO)?;
    Some((if first == 0 { 0 } else { keys[first - 1].through }, keys[first].through))
}

/// Half-rise and the way of the tip, beside chains where hair touches nothing and nothing else pulls.
fn rises(built: &BuiltScene, film: &Played, from: u32, through: u32) {
    let through = through.min(film.frames());
    let all: Vec<[f64; 3]> = (0..built.groom.hair.strands.len())
        .map(|s| {
            let frames: Vec<Vec<DVec3>> = (0..=through).map(|n| wide(film.strand(n, s))).collect();
            ALONG.map(|along| half_rise(&frames, along))
        })
        .collect();
    print_rises("half-rise from frame 0, all strands", &all);
    if built.head_moves() {
        return;
    }
    let Form::Free(free) = &built.dynamics.form else { return };
    let touches = |s: usize| {
        (0..=through).any(|n| {
            let points = film.strand(n, s);
            points[points.len() / 3..].iter().any(|&p| built.model.head.distance(p) < FREE_CM)
        })
    };
    let clear: Vec<usize> = (0..built.groom.hair.strands.len()).filter(|&s| !touches(s)).take(CHAINS).collect();
    if clear.is_empty() || free.form.tie.is_some() {
        return;
    }
    let (mut ours, mut chains, mut apart) = (Vec::new(), Vec::new(), Vec::new());
    for &s in &clear {
        let frames: Vec<Vec<DVec3>> = (0..=through).map(|n| wide(film.strand(n, s))).collect();
        let chain = Chain::new(&frames[0], properties(&built.dynamics, &frames[0]));
        let truth = chain.run(through, |p, n| built.forces.field.at(p.as_vec3(), n).as_dvec3(), |_| DVec3::ZERO);
        ours.push(ALONG.map(|along| half_rise(&frames, along)));
        chains.push(ALONG.map(|along| half_rise(&truth, along)));
        let tips = frames.iter().zip(&truth).map(|(a, b)| a[a.len() - 1].distance(b[b.len() - 1]));
        apart.push(mean(tips.skip(from as usize)));
    }
    print_rises(&format!("the same of {} that touch nothing", clear.len()), &ours);
    print_rises("as the reference chain", &chains);
    println!("tip from the reference's, mean            {:.2} cm", mean(apart.into_iter()));
}

fn print_rises(what: &str, all: &[[f64; 3]]) {
    let [a, b, c] = [0, 1, 2].map(|i| mean(all.iter().map(|rises| rises[i])));
    println!("{what:41} {a:.1} / {b:.1} / {c:.1} frames at {:?} of the length", ALONG);
}

fn wide(points: &[Vec3]) -> Vec<DVec3> {
    points.iter().map(|p| p.as_dvec3()).collect()
}

/// The frame in which a place of a strand has come half as far from rest as it comes at the most.
fn half_rise(frames: &[Vec<DVec3>], along: f64) -> f64 {
    let n = ((along * (frames[0].len() - 1) as f64).round() as usize).max(1);
    let way = |points: &Vec<DVec3>| (points[n] - points[n - 1]).normalize();
    let ways: Vec<f64> = frames.iter().map(|points| way(points).angle_between(way(&frames[0]))).collect();
    let half = 0.5 * ways.iter().copied().fold(0.0, f64::max);
    let after = ways.iter().position(|&way| way >= half).unwrap_or(0);
    if after == 0 {
        return 0.0;
    }
    let before = after - 1;
    before as f64 + (half - ways[before]) / (ways[after] - ways[before])
}

/// A strand of a scene as a chain.
pub fn properties(dynamics: &Dynamics, points: &[DVec3]) -> Properties {
    let Form::Free(free) = &dynamics.form else { unreachable!("asked of the free form alone") };
    let lengths: Vec<f64> = points.windows(2).map(|w| w[0].distance(w[1])).collect();
    let length: f64 = lengths.iter().sum();
    let motion = &dynamics.motion;
    let d = f64::from(dynamics.segment_length);
    let floored = length.max(f64::from(motion.inertia_length_floor));
    let of_force = d * f64::from(motion.time_step).powi(2) / (f64::from(motion.linear_density) * floored.powi(2));
    let ends: Vec<f64> = lengths
        .iter()
        .scan(0.0, |end, l| {
            *end += l;
            Some(*end / length)
        })
        .collect();
    let begin = |i: usize| if i == 0 { 0.0 } else { ends[i - 1] };
    let each = || 0..lengths.len();
    Properties {
        of_force,
        weight: DVec3::NEG_Y * of_force * f64::from(free.form.gravity),
        bending: each().map(|i| 0.375 * of_force * length * free.form.stiffness.at(begin(i)) * d * d).collect(),
        hold: each().map(|i| of_force * free.form.hold.at(0.5 * (begin(i) + ends[i]))).collect(),
        drag: each()
            .map(|i| {
                let settle = free.form.settle.at(ends[i]);
                if settle > 0.0 { 2.0 / settle } else { 0.0 }
            })
            .collect(),
    }
}

/// Correlation of the ways of tips whose roots lie so far apart.
fn alike(rest: &Strands, tips: &[Vec<DVec3>]) {
    let roots: Vec<Vec3> = (0..rest.len()).map(|s| rest.strand(s)[0]).collect();
    let of = |apart: f32| {
        let pairs = (0..roots.len()).flat_map(|i| (0..i).map(move |j| (i, j)));
        let near = pairs.filter(|&(i, j)| (roots[i].distance(roots[j]) / apart - 1.0).abs() < 0.15);
        let found: Vec<f64> = near.map(|(i, j)| correlation(&tips[i], &tips[j])).collect();
        if found.is_empty() { f64::NAN } else { mean(found.into_iter()) }
    };
    let [one, three, six] = [1.0, 3.0, 6.0].map(of);
    println!("correlation of tips 1, 3, 6 cm apart       {one:.3} / {three:.3} / {six:.3}");
}

/// The same of strands of one lock whose lengths differ by less than a tenth.
fn alike_in_locks(built: &BuiltScene, tips: &[Vec<DVec3>]) {
    let Form::Free(free) = &built.dynamics.form else { return };
    let rest = &built.groom.hair.strands;
    let locks: Vec<Vec3> = (0..rest.len()).map(|s| free.lock(rest.strand(s)).middle).collect();
    let lengths: Vec<f32> = rest.lengths().collect();
    let pairs = (0..locks.len()).flat_map(|i| (0..i).map(move |j| (i, j))).filter(|&(i, j)| locks[i] == locks[j]);
    let pairs = pairs.filter(|&(i, j)| (lengths[i] / lengths[j] - 1.0).abs() < 0.1);
    let found: Vec<f64> = pairs.map(|(i, j)| correlation(&tips[i], &tips[j])).collect();
    if !found.is_empty() {
        let all = mean(found.iter().copied());
        println!("correlation of tips within a lock          {all:.3}, of {} pairs", found.len());
    }
}

/// Nodes in the head, sharp bends and lengths.
fn shapes(built: &BuiltScene, film: &Played) {
    let rest = &built.groom.hair.strands;
    let (mut inside, mut kinks, mut joints, mut off) = (0, 0, 0, 0.0_f64);
    for n in 0..=film.frames() {
        inside += film.points(n).iter().filter(|&&p| built.model.head.depth(p) > 0.05).count();
        for s in 0..rest.len() {
            let ways: Vec<Vec3> = film.strand(n, s).windows(2).map(|w| w[1] - w[0]).collect();
            for (way, was) in ways.iter().zip(rest.strand(s).windows(2)) {
                off = off.max(f64::from((way.length() / was[0].distance(was[1]) - 1.0).abs()));
            }
            joints += ways.len() - 1;
            kinks += ways.windows(2).filter(|w| w[0].dot(w[1]) < 0.5 * w[0].length() * w[1].length()).count();
        }
    }
    println!("nodes deeper in the head than 0.05 cm     {inside}, all frames together");
    println!("joints of more than 60 degrees            {:.3} %", 100.0 * kinks as f64 / joints as f64);
    println!("lengths off by                            {off:.1e} of themselves at the most");
}

/// Whether hair rests to the bit without wind, and how far it is from rest ten seconds after.
fn rest_and_return(built: &BuiltScene, mut scene: Scene, strands: usize) -> Result<(), Box<dyn std::error::Error>> {
    if built.head_moves() {
        return Ok(());
    }
    let mut timeline = built.timeline()?;
    timeline.set_field(std::sync::Arc::new(UniformField(Vec3::ZERO)))?;
    let film = timeline.play();
    let rests = (1..=film.frames()).all(|n| film.points(n) == film.points(0));
    println!("without wind                              {}", if rests { "rests to the bit" } else { "does not rest" });
    let Some(last) = built.forces.intervals().last().filter(|key| key.vector == Vec3::ZERO) else { return Ok(()) };
    scene.motion.frames = last.through + (10.0 * built.dynamics.motion.frame_rate) as u32;
    let built = scene.build(Shown::AtMost(strands))?;
    let mut timeline = built.timeline()?;
    let film = timeline.play();
    let (last, rest) = (film.frames(), &built.groom.hair.strands);
    let far = (0..rest.len()).map(|s| {
        let tip = |n| *film.strand(n, s).last().expect("a strand has points");
        f64::from(tip(last).distance(tip(0)))
    });
    println!("tips from rest, ten seconds after         {:.2} cm in the mean", mean(far));
    Ok(())
}
