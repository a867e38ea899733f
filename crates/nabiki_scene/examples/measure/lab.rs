//! One strand of 18 cm that hangs from a clamp, under the earth's gravity: how it swings, and how it answers a head that shakes.

use std::f64::consts::{PI, TAU};
use std::sync::Arc;

use glam::{DVec3, Quat, Vec3};
use nabiki::dynamics::{Dynamics, Form, Timeline, earth_gravity, substeps};
use nabiki::field::{Keyframe, KeyframedField};
use nabiki::free_form::{EARTH_CM_PER_S2, FreeForm, FreeMotion};
use nabiki::{Ellipsoid, Pose, Profile, SettingError, Strands};

use crate::numbers::power;
use crate::reference::{Chain, frequencies};
use crate::scene::properties;

const SEGMENTS: usize = 18;
const LENGTH_CM: f64 = 18.0;
/// Stiffnesses, by gamma = w L^3 / EI; that of real hair of this length is about 64.
const GAMMAS: [f64; 3] = [5.0, 50.0, 500.0];
/// In which a swing dies to 1/e (s).
const SETTLES_S: f64 = 0.6;
/// How far a head shakes to either side (cm), and how often (Hz).
const SHAKE_CM: f64 = 3.0;
const SHAKES_HZ: [f64; 6] = [1.0, 1.41, 1.6, 2.0, 3.24, 4.0];
/// Frames a second for a head that moves.
const RATE: f64 = 120.0;
/// Frames a second of a film.
const FILM_RATE: f64 = 24.0;
/// So many steps a frame that more change little.
const FINE: u32 = 32;
/// How far a head bobs (cm), and how often (Hz).
const BOB_CM: f64 = 2.0;
const BOBS_HZ: [f64; 8] = [1.6, 2.0, 2.4, 2.8, 3.0, 3.2, 3.6, 4.0];

/// Prints the tables.
pub fn measure() {
    println!("omega 1, 2 over sqrt(g / L) at 24 frames a second; what a rod has");
    for gamma in GAMMAS {
        let [first, second, _] = frequencies(gamma);
        // Frames show no more than half their rate.
        let shown = second * unit() / TAU < 0.5 * FILM_RATE;
        let found = swings(gamma).map_or_else(
            |e| format!("refused: {} = {}", e.thing, e.value),
            |[a, b]| if shown { format!("{a:.3}, {b:.3}") } else { format!("{a:.3}, too fast for frames") },
        );
        println!("  gamma {gamma:>3}: {found}; {first:.3}, {second:.3}");
    }
    println!(
        "a head shaken by {SHAKE_CM} cm, gamma 50, 120 frames a second: the tip's way over the head's; in {FINE} steps a \
         frame; the reference's"
    );
    for hz in SHAKES_HZ {
        let way = |time: f64| DVec3::Z * SHAKE_CM * (TAU * hz * time).sin();
        let found = |steps| moved(way, 12.0, DVec3::ZERO, steps).map(|ways| ways.map(|way| swing(&way, hz) / SHAKE_CM));
        print_ways(&format!("{hz} Hz"), [found(None), found(Some(FINE))]);
    }
    println!("a head that bobs by {BOB_CM} cm, gamma 50: how far the tip sways 20 s later (cm); the reference's");
    for hz in BOBS_HZ {
        let way = |time: f64| DVec3::Y * BOB_CM * (TAU * hz * time).sin();
        let found = moved(way, 20.0, DVec3::Z * 0.2, None).map(|ways| ways.map(|way| span(&way)));
        print_ways(&format!("{hz} Hz"), [found]);
    }
}

/// Ours of each run, and the reference's.
fn print_ways<const N: usize>(what: &str, found: [Result<[f64; 2], SettingError>; N]) {
    let mut line = String::new();
    let mut reference = String::new();
    for run in found {
        match run {
            Ok([ours, truth]) => {
                line += &format!("{ours:.2}; ");
                reference = format!("{truth:.2}");
            }
            Err(refused) => line += &format!("refused: {refused}; "),
        }
    }
    println!("  {what}: {line}{reference}");
}

fn hanging() -> Strands {
    let points: Vec<Vec3> =
        (0..=SEGMENTS).map(|i| Vec3::NEG_Y * (i as f64 * LENGTH_CM / SEGMENTS as f64) as f32).collect();
    let mut strands = Strands::default();
    strands.push(points);
    strands
}

fn dynamics(gamma: f64, rate: f64, settle: f64) -> Dynamics {
    let mut dynamics = Dynamics::new(Ellipsoid { center: Vec3::Y * 100.0, half_axes: Vec3::ONE });
    dynamics.motion.frame_rate = rate;
    let gravity = earth_gravity(&dynamics, LENGTH_CM);
    // EI / lambda = 3/8 A L K d^2, and gamma = A gravity L^3 over that.
    let stiffness = f64::from(gravity) * LENGTH_CM.powi(2) / (0.375 * gamma);
    let mut form = FreeForm {
        stiffness: Profile::Even(stiffness as f32),
        hold: Profile::Even(0.0),
        settle: Profile::Even(settle as f32),
        gravity,
        drag: nabiki::Profile::Even(1.0),
        ..FreeForm::default()
    };
    // As many as a scene with such hair takes.
    form.substeps = Some(substeps(&dynamics, &form, gravity, [LENGTH_CM, LENGTH_CM / SEGMENTS as f64]));
    dynamics.form = Form::Free(FreeMotion { form, ..FreeMotion::default() });
    dynamics
}

/// omega 1 and 2 of a strand that was pushed for a frame, in sqrt(g / L).
fn swings(gamma: f64) -> Result<[f64; 2], SettingError> {
    const FRAMES: u32 = 480;
    let dynamics = dynamics(gamma, FILM_RATE, 0.0);
    let Form::Free(free) = &dynamics.form else { unreachable!() };
    let push = Vec3::X * 0.05 * free.form.gravity;
    let keys = [Keyframe { through: 1, vector: push }, Keyframe { through: 2, vector: Vec3::ZERO }];
    let field = Arc::new(KeyframedField::new(&keys)?);
    let mut timeline = Timeline::new(&hanging(), &dynamics, field, Vec::new(), FRAMES)?;
    let film = timeline.play();
    let tip: Vec<DVec3> = (2..=FRAMES).map(|n| film.strand(n, 0)[SEGMENTS].as_dvec3()).collect();
    let middle = tip.iter().sum::<DVec3>() / tip.len() as f64;
    let window = |n: usize| (PI * (n as f64 + 0.5) / tip.len() as f64).sin().powi(2);
    // Sideways alone: a tip rises twice in a swing.
    let tip: Vec<DVec3> = tip.iter().enumerate().map(|(n, p)| DVec3::X * window(n) * (p.x - middle.x)).collect();
    let powers: Vec<f64> = (0..2500).map(|i| power(&tip, 2e-4 * f64::from(i))).collect();
    let peaks = || (50..powers.len() - 1).filter(|&i| powers[i] > powers[i - 1] && powers[i] >= powers[i + 1]);
    let highest = peaks().map(|i| powers[i]).fold(0.0, f64::max);
    // The lowest that is not lost beside the others, and the strongest of those well above it.
    let first = peaks().find(|&i| powers[i] > 0.01 * highest).unwrap_or(0);
    let above = peaks().filter(|&i| 2 * i > 3 * first);
    let second = above.max_by(|&i, &j| powers[i].total_cmp(&powers[j])).unwrap_or(0);
    let [first, second] = [first, second].map(|i| 2e-4 * i as f64);
    Ok([first, second].map(|frequency| TAU * frequency * FILM_RATE / unit()))
}

/// sqrt(g / L) (rad/s).
fn unit() -> f64 {
    (EARTH_CM_PER_S2 / LENGTH_CM).sqrt()
}

/// The tip's way in the world (cm, from where it hangs) in the last third of so many seconds, of ours and of the reference, while the
/// root goes `way` (s); `aside`: how far both are pushed in the first frame, as a share of the weight; `steps`: ours in a frame, or as
/// many as a scene takes.
fn moved(
    way: impl Fn(f64) -> DVec3,
    seconds: f64,
    aside: DVec3,
    steps: Option<u32>,
) -> Result<[Vec<DVec3>; 2], SettingError> {
    let frames = (seconds * RATE) as u32;
    let mut dynamics = dynamics(50.0, RATE, SETTLES_S * RATE);
    let Form::Free(free) = &mut dynamics.form else { unreachable!() };
    free.form.substeps = steps.or(free.form.substeps);
    let push = aside.as_vec3() * free.form.gravity;
    let keys = [Keyframe { through: 1, vector: push }, Keyframe { through: 2, vector: Vec3::ZERO }];
    let field = Arc::new(KeyframedField::new(&keys)?);
    let pose = |n: u32| Pose { rotation: Quat::IDENTITY, position_cm: way(f64::from(n) / RATE).as_vec3() };
    let poses: Vec<Pose> = (0..=frames).map(pose).collect();
    let strands = hanging();
    let mut timeline = Timeline::new(&strands, &dynamics, field, poses.clone(), frames)?;
    let film = timeline.play();
    let rest = strands.strand(0)[SEGMENTS].as_dvec3();
    let last_third = 2 * frames / 3..=frames;
    let ours = last_third.clone().map(|n| film.strand(n, 0)[SEGMENTS].as_dvec3() - rest).collect();
    let points: Vec<DVec3> = strands.strand(0).iter().map(|p| p.as_dvec3()).collect();
    let chain = Chain::new(&points, properties(&dynamics, &points));
    let pushed = |_: DVec3, n: u32| if n == 1 { push.as_dvec3() } else { DVec3::ZERO };
    let truth = chain.run(frames, pushed, |time| way(time / RATE));
    let reference = last_third.map(|n| truth[n as usize][SEGMENTS] - truth[n as usize][0] - rest).collect();
    Ok([ours, reference])
}

/// How far a way swings sideways at a frequency (cm), in the frames of [`RATE`].
fn swing(way: &[DVec3], hz: f64) -> f64 {
    let sideways: Vec<DVec3> = way.iter().map(|p| DVec3::Z * p.z).collect();
    2.0 * power(&sideways, hz / RATE).sqrt() / way.len() as f64
}

/// Half of what a way spans sideways (cm).
fn span(way: &[DVec3]) -> f64 {
    let (low, high) =
        way.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), p| (low.min(p.z), high.max(p.z)));
    0.5 * (high - low)
}
