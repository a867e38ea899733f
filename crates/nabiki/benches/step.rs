//! What a step costs, against what the machine can do: `cargo bench -p nabiki --bench step`.
//!
//! Each size is measured in turn with two loops on the same machine and in the same run: one that only reads and writes
//! the bytes of the step (states read and written, lengths and gains read, points written), and one that takes eight
//! sines and cosines a segment, as many as the equations name for two frames; the last column is the step as a part of
//! that. All three use the same threads and blocks. The figures are the fastest of the rounds, in ns a segment and
//! frame. The last size has strands of 10 to 20 segments of all lengths, side by side: blocks that are filled up.

#[path = "common/bytes.rs"]
mod bytes;

use std::hint::black_box;
use std::time::Instant;

use bytes::Bytes;
use glam::Vec3;
use nabiki::dynamics::{Dynamics, FrameInput, Simulation, Stepper};
use nabiki::field::{Keyframe, KeyframedField};
use nabiki::{Ellipsoid, Strands};
use rayon::prelude::*;

const ROUNDS: usize = 41;

fn main() {
    println!("threads: {}", rayon::current_num_threads());
    println!(
        "{:>10} {:>9} {:>12} {:>12} {:>12} {:>7}",
        "strands", "segments", "step", "bytes only", "sines only", "of sines"
    );
    for (strands, segments, frames, mixed) in
        [(300, 20, 1000, false), (20_000, 20, 20, false), (200_000, 20, 4, false), (20_000, 20, 20, true)]
    {
        let hair = hair(strands, segments, mixed);
        let field = wind();
        let mut simulation = Simulation::new(&hair, &gust(), &field).expect("settings in range");
        let input = FrameInput::new(1, &[], &field);
        let mut bytes = Bytes::<3>::new(strands, segments);
        let per_segment = 1e9 / (hair.segment_count() * frames) as f64;
        let mut times = [const { Vec::new() }; 3];
        for _ in 0..ROUNDS {
            times[0].push(time(frames, || simulation.step_frame(&input)));
            times[1].push(time(frames, || bytes.pass()));
            times[2].push(time(frames, || sines(&mut bytes)));
        }
        let [step, bytes, sines] = times.map(|t| fastest(t) * per_segment);
        let ratio = step / sines;
        let segments = if mixed { "10 to 20".to_owned() } else { segments.to_string() };
        println!("{strands:>10} {segments:>9} {step:>9.2} ns {bytes:>9.2} ns {sines:>9.2} ns {ratio:>7.2}");
    }
}

fn time(frames: usize, mut frame: impl FnMut()) -> f64 {
    let start = Instant::now();
    for _ in 0..frames {
        frame();
    }
    start.elapsed().as_secs_f64()
}

/// What else the machine does only ever adds to a time.
fn fastest(times: Vec<f64>) -> f64 {
    times.into_iter().fold(f64::INFINITY, f64::min)
}

fn wind() -> KeyframedField {
    KeyframedField::new(&[Keyframe { through: 100, vector: Vec3::new(-100.0, 0.0, 0.0) }]).expect("one keyframe")
}

/// Table 1 of the paper.
fn gust() -> Dynamics {
    Dynamics { ..Dynamics::new(Ellipsoid { center: Vec3::ZERO, half_axes: Vec3::new(9.5, 11.0, 8.0) }) }
}

/// Arcs from an ellipsoid over a spiral of roots; `mixed`: of half to all of the segments.
fn hair(strands: usize, segments: usize, mixed: bool) -> Strands {
    let mut hair = Strands::with_capacity(strands, strands * (segments + 1));
    for s in 0..strands {
        let y = 1.0 - (s as f32 + 0.5) / strands as f32;
        let azimuth = s as f32 * 2.399_963;
        let out = Vec3::new((1.0 - y * y).sqrt() * azimuth.sin(), y, (1.0 - y * y).sqrt() * azimuth.cos());
        let mut p = out * Vec3::new(9.5, 11.0, 8.0);
        let cut = if mixed { s * 7 % (segments / 2 + 1) } else { 0 };
        let points = (0..=segments - cut).map(|i| {
            let point = p;
            p += (out + Vec3::NEG_Y * (0.2 * i as f32)).normalize();
            point
        });
        hair.push(points);
    }
    hair
}

/// Eight sines and cosines a segment, of data that stays in the nearest cache.
fn sines(bytes: &mut Bytes<3>) {
    bytes.states.par_chunks_mut(8 * bytes.segments).for_each(|states| {
        let [a, b, c, d, ..] = states[0];
        pulp::Arch::new().dispatch(Sines { angles: [a, b, c, d], times: states.len() });
    });
}

struct Sines {
    angles: [[f32; 16]; 4],
    times: usize,
}

impl pulp::NullaryFnOnce for Sines {
    type Output = ();

    #[inline(always)]
    fn call(mut self) {
        for _ in 0..self.times {
            for quantity in &mut self.angles {
                for v in quantity {
                    let (sin, cos) = sin_cos(*v);
                    *v = sin + cos;
                }
            }
        }
        black_box(self.angles);
    }
}

/// The polynomials of the step, without the care for quadrants.
#[inline(always)]
fn sin_cos(x: f32) -> (f32, f32) {
    let turns = x.mul_add(std::f32::consts::FRAC_2_PI, 12_582_912.0) - 12_582_912.0;
    let r = turns.mul_add(-std::f32::consts::FRAC_PI_2, x);
    let r2 = r * r;
    let sin = (r * r2).mul_add(r2.mul_add(-0.000_195, 0.008_33).mul_add(r2, -0.166_7), r);
    let cos = (r2 * r2).mul_add(r2.mul_add(2.44e-5, -0.001_39).mul_add(r2, 0.041_7), r2.mul_add(-0.5, 1.0));
    (sin, cos)
}
