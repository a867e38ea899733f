//! The least that moves: hair of one's own about a ball, in a wind. docs/engine.md shows it.
//!
//!     cargo run --release -p nabiki --example ball

use std::sync::Arc;

use nabiki::body::{Body, BodyWay, Contact, Shape};
use nabiki::dynamics::{Dynamics, Form, FrameInput, Simulation, Stepper};
use nabiki::field::UniformField;
use nabiki::free_form::FreeMotion;
use nabiki::glam::Vec3;
use nabiki::obstacle::Capsule;
use nabiki::{Ellipsoid, SettingError, Strands};

fn main() -> Result<(), SettingError> {
    let head = Ellipsoid { center: Vec3::ZERO, half_axes: Vec3::splat(9.0) };
    let mut hair = Strands::default();
    for around in [0.0_f32, 0.5, 1.0] {
        let out = Vec3::new(around.cos(), 0.5, around.sin()).normalize();
        hair.push((0..=16).map(|i| 9.0 * out + i as f32 * (0.8 * out - Vec3::Y).normalize()));
    }
    // Hair does not collide with the ellipsoid, so add a body: a capsule whose two ends coincide is a ball.
    let ball = Shape::Other(Arc::new(Capsule::new([Vec3::ZERO; 2], 9.0, "head")?));
    let bodies = vec![Body::new("head", ball, BodyWay::WithHead, Contact::default())];
    let dynamics = Dynamics { form: Form::Free(FreeMotion { bodies, ..FreeMotion::default() }), ..Dynamics::new(head) };
    let wind = UniformField(Vec3::new(-80.0, 20.0, 0.0));
    let mut simulation = Simulation::new(&hair, &dynamics, &wind)?;
    for frame in 1..=50 {
        // Without poses the head does not move.
        simulation.step_frame(&FrameInput::new(frame, &[], &wind));
    }
    println!("from {} to {}", hair.strand(0)[16], simulation.strands().strand(0)[16]);
    Ok(())
}
