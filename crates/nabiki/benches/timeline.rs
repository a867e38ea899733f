//! All frames of a preview at once, against a step at a time: `cargo bench -p nabiki --bench timeline`.
//!
//! 300 strands of 18 segments over the 100 frames of the gust, hair of nearly equal lengths. Three ways, measured in
//! turn: the timeline, which keeps all frames; a stepper that is rewound, its frames copied into the same storage; and
//! the same with a stepper built anew, which is what a command does. The fastest of all rounds, in ms.

use std::hint::black_box;
use std::sync::Arc;
use std::time::Instant;

use glam::Vec3;
use nabiki::dynamics::{Dynamics, FrameInput, Simulation, Stepper, Timeline};
use nabiki::field::{Keyframe, KeyframedField};
use nabiki::{Ellipsoid, Strands};

const STRANDS: usize = 300;
const SEGMENTS: usize = 18;
const FRAMES: u32 = 100;
const ROUNDS: usize = 201;

fn main() {
    println!("threads: {}", rayon::current_num_threads());
    let (hair, field, dynamics) = (hair(), Arc::new(wind()), gust());
    let mut timeline = Timeline::new(&hair, &dynamics, field.clone(), Vec::new(), FRAMES).expect("settings in range");
    let new = || Simulation::new(&hair, &dynamics, &*field).expect("settings in range");
    let mut simulation = new();
    let mut film = vec![Vec3::ZERO; hair.points().len() * (FRAMES as usize + 1)];
    let mut times = [const { Vec::new() }; 3];
    for _ in 0..ROUNDS {
        times[0].push(time(|| {
            timeline.set_field(field.clone()).expect("a stable field");
            black_box(timeline.play());
        }));
        times[1].push(time(|| {
            simulation.rewind();
            step_all(&mut simulation, &field, &mut film);
        }));
        times[2].push(time(|| step_all(&mut new(), &field, &mut film)));
    }
    let [all, stepped, built] = times.map(fastest);
    println!("all frames at once      {all:>8.3} ms");
    println!("a step at a time        {stepped:>8.3} ms, {:.2} times as long", stepped / all);
    println!("the same, built anew    {built:>8.3} ms, {:.2} times as long", built / all);
}

fn step_all(simulation: &mut Simulation, field: &KeyframedField, film: &mut [Vec3]) {
    let points = simulation.strands().points().len();
    for (frame, page) in film.chunks_exact_mut(points).enumerate() {
        if frame > 0 {
            simulation.step_frame(&FrameInput::new(frame as u32, &[], field));
        }
        page.copy_from_slice(simulation.strands().points());
    }
    black_box(film);
}

fn time(mut run: impl FnMut()) -> f64 {
    let start = Instant::now();
    run();
    1e3 * start.elapsed().as_secs_f64()
}

/// What else the machine does only ever adds to a time.
fn fastest(times: Vec<f64>) -> f64 {
    times.into_iter().fold(f64::INFINITY, f64::min)
}

fn wind() -> KeyframedField {
    let key = |through, vector| Keyframe { through, vector };
    let keys = [key(50, Vec3::new(-100.0, 0.0, 0.0)), key(100, Vec3::new(-15.0, -150.0, 0.0))];
    KeyframedField::new(&keys).expect("two keyframes")
}

/// Table 1 of the paper.
fn gust() -> Dynamics {
    Dynamics { ..Dynamics::new(Ellipsoid { center: Vec3::ZERO, half_axes: Vec3::new(9.5, 11.0, 8.0) }) }
}

/// Arcs from an ellipsoid over a spiral of roots.
fn hair() -> Strands {
    let mut hair = Strands::with_capacity(STRANDS, STRANDS * (SEGMENTS + 1));
    for s in 0..STRANDS {
        let y = 1.0 - (s as f32 + 0.5) / STRANDS as f32;
        let azimuth = s as f32 * 2.399_963;
        let out = Vec3::new((1.0 - y * y).sqrt() * azimuth.sin(), y, (1.0 - y * y).sqrt() * azimuth.cos());
        let mut p = out * Vec3::new(9.5, 11.0, 8.0);
        hair.push((0..=SEGMENTS).map(|i| {
            let point = p;
            p += (out + Vec3::NEG_Y * (0.2 * i as f32)).normalize();
            point
        }));
    }
    hair
}
