//! What a step of the free form costs beside the paper's: `cargo bench -p nabiki --bench free_form`.
//!
//! Both forms, with the same hair, wind and threads, are measured in turn; so is a loop that only reads and writes the
//! bytes of the free form's step. The figures are the sum over frames of the fastest that each took in any round, in ns a
//! segment and frame, all points written: a frame is short enough to be left alone by other programs now and then. Bodies
//! and neighbours are met by hair that the wind blows against and over the built-in head. Cases named behind `--`
//! (`-- "free, head"`) are measured alone, beside the paper's form.

#[path = "common/bytes.rs"]
mod bytes;
#[path = "common/dynamics.rs"]
mod dynamics;

use std::sync::Arc;
use std::time::Instant;

use bytes::Bytes;
use dynamics::{dynamics, free};
use glam::Vec3;
use nabiki::dynamics::{Form, FrameInput, Simulation, Stepper};
use nabiki::field::{Field, FieldSum, Keyframe, KeyframedField, Turbulence, TurbulenceField};
use nabiki::free_form::{FreeMotion, NeighbourForces, Neighbours};
use nabiki_groom::{Growth, Hairline, Style, bust, grow};

const ROUNDS: usize = 15;
const FRAMES: u32 = 60;

fn main() {
    println!("threads: {}", rayon::current_num_threads());
    let (head, strands) = (bust(), 20_000);
    let (hairline, style) = (Hairline::default(), Style::default());
    let growth = Growth { hairline: &hairline, style: &style, strands, segments: 20, segment_length: 0.9, seed: 1 };
    let hair = grow(&head, &growth, strands).expect("settings in range").strands;
    let carriers = Arc::new(hair.select(&(0..256).collect::<Vec<_>>()));
    let neighbours = Some(Neighbours::new(NeighbourForces::default(), carriers));
    let with_head = free(&head);
    let with_all = FreeMotion { neighbours, ..with_head.clone() };
    let wind = || {
        KeyframedField::new(&[
            Keyframe { through: 30, vector: Vec3::new(-100.0, 0.0, 0.0) },
            Keyframe { through: FRAMES, vector: Vec3::new(-15.0, -150.0, 0.0) },
        ])
        .expect("two keyframes")
    };
    let swirls = TurbulenceField::new(&Turbulence::default(), head.ellipsoid, &[], &[Vec3::X]).expect("in range");
    let turbulent = FieldSum::new(vec![Arc::new(wind()), Arc::new(swirls)]);
    let wind = wind();
    let cases: [(&str, Form, &dyn Field); 5] = [
        ("the paper's form", Form::Paper, &wind),
        ("free", Form::Free(FreeMotion::default()), &wind),
        ("free, head", Form::Free(with_head), &wind),
        ("free, head, neighbours", Form::Free(with_all.clone()), &wind),
        ("the same, turbulence", Form::Free(with_all), &turbulent),
    ];
    let named: Vec<String> = std::env::args().skip(1).filter(|name| !name.starts_with("--")).collect();
    let mut times = [[f64::INFINITY; FRAMES as usize]; 6];
    let mut bytes = Bytes::<6>::new(strands, 20);
    for _ in 0..ROUNDS {
        for ((name, form, field), times) in cases.iter().zip(&mut times) {
            if !named.is_empty() && !named.iter().any(|case| case == name) && *form != Form::Paper {
                continue;
            }
            let mut simulation =
                Simulation::new(&hair, &dynamics(&head, form.clone()), *field).expect("settings in range");
            for (frame, time) in (1..).zip(times) {
                *time = time.min(seconds(|| simulation.step_frame(&FrameInput::new(frame, &[], *field))));
            }
        }
        for time in times.last_mut().expect("six") {
            *time = time.min(seconds(|| bytes.pass()));
        }
    }
    let per_segment = 1e9 / (hair.segment_count() as f64 * f64::from(FRAMES));
    println!("{} strands, {} segments, frames 1 to {FRAMES}", hair.len(), hair.segment_count());
    let times = times.map(|frames| frames.iter().sum::<f64>());
    for (name, time) in cases.iter().map(|(name, ..)| *name).chain(["bytes of the free form only"]).zip(times) {
        println!("{name:>28} {:>6.2} ns, {:>5.2} of the paper's form", time * per_segment, time / times[0]);
    }
}

fn seconds(act: impl FnOnce()) -> f64 {
    let start = Instant::now();
    act();
    start.elapsed().as_secs_f64()
}
