//! Does the hair come to the hand? `cargo bench -p nabiki_scene --bench pull`.
//!
//! Over the scenes that come with the project: ten frames each, drawn at random, in each a lock about a node drawn at random, as a
//! hand in the window takes it, pulled by 2, 5 and 8 cm in directions drawn from those that its length allows. The hand takes 0.3 s
//! for its way and rests then; printed is the share of pulls after which the lock is within 0.3 cm of the hand 0.3 s later. What
//! drives it is what drives the window: `nabiki_scene::pull`.
//!
//! A lock counts as in contact where it touches, or is pulled to or through, the head or a body; free of it are the others.
//!
//!     cargo bench -p nabiki_scene --bench pull -- --frames 3 --only gust --seed 7
//!
//! `--frames N` frames a scene, `--only TEXT` scenes whose name has it in, `--seed N` other draws, `--each` a line for every pull,
//! `--wait S` how long one that has not come is waited for in all (3 s). Two clocks are read: that on the wall, which others on the
//! machine slow down, and the time on all processors together, which on a machine of one's own is at least what the wall shows.

use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use glam::Vec3;
use nabiki::Strands;
use nabiki::dynamics::Form;
use nabiki::solve::change;
use nabiki_scene::pull::{Follower, Freedom, Lock, Pull};
use nabiki_scene::{BuiltScene, Scene, Shown};

/// What a window shows at first, and how near a node lies whose strand comes along (cm).
const STRANDS: usize = 300;
const LOCK_CM: f32 = 1.5;
/// The lengths of the pulls (cm), and how near is there (cm).
const PULLS_CM: [f32; 3] = [2.0, 5.0, 8.0];
const THERE_CM: f64 = 0.3;
/// How long the hand takes for its way, how often it moves meanwhile, and how long after it rests the hair should be there (s).
const WAY_S: f64 = 0.3;
const MOVES: u32 = 15;
const SOON_S: f64 = 0.3;
/// Of its length, what a strand can be drawn out to.
const TAUT: f32 = 0.95;
/// Nearer than this to a skin is in contact (cm).
const TOUCHES_CM: f32 = 0.8;

struct Options {
    frames: usize,
    only: Option<String>,
    seed: u64,
    each: bool,
    wait_s: f64,
}

fn main() {
    let options = options();
    println!("threads: {}", rayon::current_num_threads());
    println!("share of pulls that come within {THERE_CM} cm of the hand, {SOON_S} s after it rests: by the wall, by");
    println!(
        "processor time of all threads, and in the end ({} s); medians of what is left (cm); by how much the wind",
        options.wait_s
    );
    println!("of any frame was changed, median and nine in ten");
    let mut all = Vec::new();
    for path in scenes(options.only.as_deref()) {
        let name = name(&path);
        let mut random =
            Random(options.seed ^ name.bytes().fold(7, |h: u64, b| h.wrapping_mul(31).wrapping_add(b.into())));
        let built = match Scene::load(&path, &[]).map_err(|e| e.to_string()) {
            Ok(scene) => scene.build(Shown::First(STRANDS)).map_err(|e| e.to_string()),
            Err(e) => Err(e),
        };
        match built {
            Ok(built) => {
                let tried = pulls(&built, &options, &mut random);
                table(&name, &tried);
                all.extend(tried);
            }
            Err(why) => println!("{name}: left out, {why}"),
        }
    }
    table("all scenes", &all);
}

fn options() -> Options {
    let mut options = Options { frames: 10, only: None, seed: 1, each: false, wait_s: 3.0 };
    let mut args = std::env::args().skip(1);
    while let Some(arg) = args.next() {
        let mut value = || args.next().expect("a value");
        match arg.as_str() {
            "--frames" => options.frames = value().parse().expect("a number"),
            "--seed" => options.seed = value().parse().expect("a number"),
            "--wait" => options.wait_s = value().parse().expect("seconds"),
            "--only" => options.only = Some(value()),
            "--each" => options.each = true,
            _ => {}
        }
    }
    options
}

/// The scene files of the project.
fn scenes(only: Option<&str>) -> Vec<PathBuf> {
    let folders = ["../../scenes", "../../scenes/paper"].map(|of| Path::new(env!("CARGO_MANIFEST_DIR")).join(of));
    let within = |folder| std::fs::read_dir(folder).expect("scenes").map(|entry| entry.expect("a file").path());
    let mut paths: Vec<PathBuf> = folders.into_iter().flat_map(within).collect();
    let named = |path: &PathBuf| {
        let name = name(path);
        path.extension().is_some_and(|end| end == "toml") && only.is_none_or(|only| name.contains(only))
    };
    paths.retain(named);
    paths.sort();
    paths
}

/// A scene's name, with the folder of the paper's.
fn name(path: &Path) -> String {
    let stem = path.file_stem().unwrap_or_default().to_string_lossy();
    let is_papers = path.parent().is_some_and(|folder| folder.ends_with("paper"));
    if is_papers { format!("paper/{stem}") } else { stem.into_owned() }
}

struct Tried {
    cm: f32,
    contact: bool,
    /// Left by the clock on the wall, by that of the processors, in the end (cm).
    left: [f64; 3],
    /// By how much the wind of any frame is another than before, at the most, in the end.
    change: f32,
}

fn pulls(built: &BuiltScene, options: &Options, random: &mut Random) -> Vec<Tried> {
    let mut timeline = built.timeline().expect("a scene that moves");
    let film = timeline.play();
    let strands = built.strands();
    let mut tried = Vec::new();
    for _ in 0..options.frames {
        let mut drawn = || {
            let frame = 10.min(built.frames()) + random.below(built.frames().saturating_sub(9) as usize) as u32;
            let strand = random.below(strands.len());
            let count = strands.range(strand).len();
            // The outer half: what lies on the head from its root on is not what a hand takes.
            let node = (count / 2 + random.below(count - count / 2)).max(1);
            Lock::about(frame, film.points(frame), strands, strands.len(), (strand, node), LOCK_CM)
        };
        let mut lock = drawn();
        while !moves(built, &lock) {
            lock = drawn();
        }
        let points = film.points(lock.frame);
        for cm in PULLS_CM {
            let Some(way) = way(strands, points, &lock, cm, random) else { continue };
            let contact = is_in_contact(built, points, &lock, way);
            let (left, change) = pulled(built, &lock, lock.middle(points, strands), way, options.wait_s);
            if options.each {
                let ([x, y, z], [wall, busy, end]) = (way.to_array(), left);
                let touch = if contact { "contact" } else { "free" };
                println!(
                    "  frame {:3}, {:2} strands, by [{x:5.1}, {y:5.1}, {z:5.1}], {touch:7}: left {wall:.2} {busy:.2} {end:.2}, wind by {change:.0}",
                    lock.frame,
                    lock.nodes.len()
                );
            }
            tried.push(Tried { cm, contact, left, change });
        }
    }
    tried
}

/// Whether a lock is hair that a wind moves: not all of it lies before the band.
fn moves(built: &BuiltScene, lock: &Lock) -> bool {
    let Form::Free(free) = &built.dynamics.form else { return true };
    let tied = |strand: usize| free.form.tie.map_or(0, |tie| tie.held(built.strands().strand(strand)));
    lock.nodes.iter().all(|&(strand, node)| node > tied(strand) + 1)
}

/// A direction in which the length of all strands allows it.
fn way(strands: &Strands, points: &[Vec3], lock: &Lock, cm: f32, random: &mut Random) -> Option<Vec3> {
    (0..200).map(|_| cm * random.direction()).find(|&way| {
        lock.nodes.iter().all(|&(strand, node)| {
            let of = &points[strands.range(strand)];
            let length: f32 = of[..=node].windows(2).map(|pair| pair[0].distance(pair[1])).sum();
            of[0].distance(of[node] + way) <= TAUT * length
        })
    })
}

fn is_in_contact(built: &BuiltScene, points: &[Vec3], lock: &Lock, way: Vec3) -> bool {
    let pose = built.pose(lock.frame);
    let strands = built.strands();
    let bodies = match &built.dynamics.form {
        Form::Free(free) => &free.bodies[..],
        Form::Paper => return false,
    };
    lock.nodes.iter().any(|&(strand, node)| {
        let of = &points[strands.range(strand)];
        let (root, place) = (of[0], of[node]);
        bodies.iter().any(|body| {
            let to_body = body.head_from_body(lock.frame, &pose).inverse();
            let distance = |p: Vec3| {
                let reading = body.shape.obstacle().read(to_body.transform_point3(p), lock.frame);
                reading.map_or(f32::INFINITY, |reading| reading.distance)
            };
            let on_way = (0..=4).any(|i| distance(place + way * (i as f32 / 4.0)) < TOUCHES_CM);
            // Drawn straight from its root it would go through.
            let through = (2..8).any(|i| distance(root.lerp(place + way, i as f32 / 8.0)) < -0.5);
            on_way || through
        })
    })
}

/// What is left of a pull, and by how much it has changed the wind.
fn pulled(built: &BuiltScene, lock: &Lock, from: Vec3, way: Vec3, wait_s: f64) -> ([f64; 3], f32) {
    let field = &built.scene.field;
    let mut by = 0.0;
    let pull = Pull::new(Follower::new(built, lock, from, &[], Freedom::default()), || {});
    for i in 1..=MOVES {
        pull.to(if i == MOVES { from + way } else { from + way * (i as f32 / MOVES as f32) });
        std::thread::sleep(Duration::from_secs_f64(WAY_S / f64::from(MOVES)));
    }
    let (clock, busy) = (Instant::now(), processor_s());
    let mut left = [f64::from(way.length()); 3];
    let mut ended = false;
    loop {
        let (wall, busy) = (clock.elapsed().as_secs_f64(), processor_s() - busy);
        if let Some(pulled) = pull.take() {
            let Ok(pulled) = pulled else { return (left, by) };
            // What was found for where the hand was on its way says nothing.
            if pulled.goal != from + way {
                continue;
            }
            let cm = pulled.left_cm;
            ended = pulled.ended;
            left[2] = cm;
            by = change(built.forces.intervals(), &pulled.answer.keyframes, field.wind.ease, 1..=lock.frame);
            for (left, passed) in left.iter_mut().zip([wall, busy]) {
                if passed <= SOON_S {
                    *left = cm;
                }
            }
        }
        if wall > wait_s || ended {
            return (left, by);
        }
        std::thread::sleep(Duration::from_millis(2));
    }
}

fn table(name: &str, tried: &[Tried]) {
    println!("{name}");
    for cm in PULLS_CM {
        for contact in [false, true] {
            let of: Vec<&Tried> = tried.iter().filter(|tried| tried.cm == cm && tried.contact == contact).collect();
            if of.is_empty() {
                continue;
            }
            let share = |clock: usize| {
                let there = of.iter().filter(|tried| tried.left[clock] < THERE_CM).count();
                let mut left: Vec<f64> = of.iter().map(|tried| tried.left[clock]).collect();
                left.sort_by(f64::total_cmp);
                format!("{:4.0} % ({:.2})", 100.0 * there as f64 / of.len() as f64, left[left.len() / 2])
            };
            let kind = if contact { "in contact" } else { "free" };
            let mut change: Vec<f32> = of.iter().map(|tried| tried.change).collect();
            change.sort_by(f32::total_cmp);
            let [half, most] = [change[change.len() / 2], change[change.len() * 9 / 10]];
            let shares = [0, 1, 2].map(share).join(", ");
            println!("  {cm} cm, {kind:10}: {:3} pulls, {shares}, wind by {half:.0}, {most:.0}", of.len());
        }
    }
}

/// The time that this process has had on all processors (s), as Linux counts it, by hundredths of a second; 0 elsewhere.
fn processor_s() -> f64 {
    let read = || {
        let stat = std::fs::read_to_string("/proc/self/stat").ok()?;
        // After the name in brackets, which may hold spaces: the 14th and 15th numbers of all.
        let mut numbers = stat.rsplit_once(')')?.1.split_whitespace().skip(11);
        let ticks: f64 = numbers.next()?.parse::<f64>().ok()? + numbers.next()?.parse::<f64>().ok()?;
        Some(0.01 * ticks)
    };
    read().unwrap_or(0.0)
}

/// Knuth's linear congruential generator, its upper bits.
struct Random(u64);

impl Random {
    fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn below(&mut self, n: usize) -> usize {
        (self.unit() * n as f64) as usize
    }

    fn direction(&mut self) -> Vec3 {
        loop {
            let v = Vec3::from([(); 3].map(|()| 2.0 * self.unit() as f32 - 1.0));
            if (0.01..=1.0).contains(&v.length_squared()) {
                return v.normalize();
            }
        }
    }
}
