//! What a step of the free form costs beside the paper's: `cargo bench -p nabiki --bench free_form`.
//!
//! Both forms, with the same hair, wind and threads, are measured in turn; so is a loop that only reads and writes the
//! bytes of the free form's step. The figures are the fastest of the rounds, in ns a segment and frame, all points
//! written. Bodies and neighbours are met by hair that the wind blows against and over the built-in head, at the frames that
//! stand in the table.

#[path = "common/bytes.rs"]
mod bytes;

use std::sync::Arc;
use std::time::Instant;

use bytes::Bytes;
use glam::Vec3;
use nabiki::Head;
use nabiki::body::{Body, Contact};
use nabiki::dynamics::{Dynamics, Form, FrameInput, Motion, Simulation, Stepper};
use nabiki::field::{Keyframe, KeyframedField};
use nabiki::free_form::{FreeForm, FreeMotion, NeighbourForces, Neighbours};
use nabiki::groom::{Growth, Style, grow};
use nabiki::pseudo_force::PseudoForce;
use nabiki::roots::Hairline;

const ROUNDS: usize = 15;
const FRAMES: u32 = 60;

fn main() {
    println!("threads: {}", rayon::current_num_threads());
    let (head, strands) = (Head::builtin(), 20_000);
    let (hairline, style) = (Hairline::default(), Style::default());
    let growth = Growth { hairline: &hairline, style: &style, strands, segments: 20, segment_length: 0.9, seed: 1 };
    let hair = grow(&head, &growth, strands).expect("settings in range").strands;
    let form = FreeForm::default();
    let bodies = vec![Body::head(&head, Contact::default())];
    let carriers = Arc::new(hair.select(&(0..256).collect::<Vec<_>>()));
    let neighbours = Some(Neighbours { forces: NeighbourForces::default(), carriers });
    let bare = FreeMotion { form, ..Default::default() };
    let forms = [
        ("the paper's form", Form::Paper),
        ("free", Form::Free(bare.clone())),
        ("free, head", Form::Free(FreeMotion { bodies: bodies.clone(), ..bare.clone() })),
        ("free, head, neighbours", Form::Free(FreeMotion { bodies, neighbours, ..bare })),
    ];
    let wind = KeyframedField::new(&[
        Keyframe { through: 30, vector: Vec3::new(-100.0, 0.0, 0.0) },
        Keyframe { through: FRAMES, vector: Vec3::new(-15.0, -150.0, 0.0) },
    ])
    .expect("two keyframes");
    let mut times = vec![f64::INFINITY; forms.len() + 1];
    let mut bytes = Bytes::<6>::new(strands, 20);
    for _ in 0..ROUNDS {
        for ((_, form), time) in forms.iter().zip(&mut times) {
            let mut simulation =
                Simulation::new(&hair, &dynamics(&head, form.clone()), &wind).expect("settings in range");
            let start = Instant::now();
            for frame in 1..=FRAMES {
                simulation.step_frame(&FrameInput::new(frame, &[], &wind));
            }
            *time = time.min(start.elapsed().as_secs_f64());
        }
        let start = Instant::now();
        (0..FRAMES).for_each(|_| bytes.pass());
        let last = times.len() - 1;
        times[last] = times[last].min(start.elapsed().as_secs_f64());
    }
    let per_segment = 1e9 / (hair.segment_count() as f64 * f64::from(FRAMES));
    println!("{} strands, {} segments, frames 1 to {FRAMES}", hair.len(), hair.segment_count());
    for (name, time) in forms.iter().map(|(name, _)| *name).chain(["bytes of the free form only"]).zip(&times) {
        println!("{name:>28} {:>6.2} ns, {:>5.2} of the paper's form", time * per_segment, time / times[0]);
    }
}

fn dynamics(head: &Head, form: Form) -> Dynamics {
    Dynamics {
        motion: Motion { inertia_length_floor: 18.0, ..Motion::default() },
        segment_length: 1.0,
        pseudo_force: if form == Form::Paper { PseudoForce::default() } else { PseudoForce::off() },
        ellipsoid: head.ellipsoid,
        shell: 1.25,
        polar_axis: Vec3::Y,
        disturbance: None,
        form,
    }
}
