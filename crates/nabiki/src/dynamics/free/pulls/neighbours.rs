//! Neighbours: pressure out of places fuller than at rest, and cohesion toward the mean velocity, from the grid of the carriers.

use glam::{DMat3, DVec3};

use super::at::At;
use crate::dynamics::free::grid::Crowd;
use crate::dynamics::gain::SegmentShape;
use crate::dynamics::pull::{Name, Pull};
use crate::scalar::{Scalar, Vector};
use crate::vector::scale_add;

/// Of `neighbours.cohesion`: the pressure hangs on the place alone.
pub struct Cohesion(pub f32);

impl Pull for Cohesion {
    fn name(&self) -> Name {
        Name { setting: "neighbours.cohesion", words: "cohesion", term: "2 l cohesion" }
    }

    fn setting(&self) -> f32 {
        self.0
    }

    /// What it holds against the segment's own increment, twice.
    fn strongest(&self, segment: &SegmentShape, _: Option<&SegmentShape>) -> f64 {
        2.0 * f64::from(self.0) * segment.length
    }
}

#[inline(always)]
pub fn force<S: Scalar>(at: &At<S>) -> Vector<S> {
    match at.crowd {
        Some(crowd) => push(crowd, at.end, at.velocity),
        None => Vector::zero(),
    }
}

/// The same on one lane: `pull` is the force and the drag there, as [`Crowd::at_row`] gives them.
#[inline(always)]
pub fn force_lane([x, y, z, drag]: [f32; 4], velocity: [f32; 3]) -> [f32; 3] {
    scale_add(-drag, velocity, [x, y, z])
}

/// The force of its neighbours on a point that goes along at `velocity` (cm a frame; head space).
#[inline(never)]
fn push<S: Scalar>(crowd: &Crowd, p: Vector<S>, velocity: Vector<S>) -> Vector<S> {
    /// In a grid of centimetres, read in f32.
    const STEP_CM: f64 = 0.03;
    let (at, along) = (p.value(), velocity.value());
    let by_place = || {
        let slope = |e: DVec3| (crowd.force(at + e, along) - crowd.force(at - e, along)) / (2.0 * STEP_CM);
        DMat3::from_cols(slope(STEP_CM * DVec3::X), slope(STEP_CM * DVec3::Y), slope(STEP_CM * DVec3::Z))
    };
    // The drag is linear in the velocity.
    let by_velocity = || {
        let drag = |e: DVec3| crowd.force(at, e) - crowd.force(at, DVec3::ZERO);
        DMat3::from_cols(drag(DVec3::X), drag(DVec3::Y), drag(DVec3::Z))
    };
    let push = S::known_vector(crowd.force(at, along), p, by_place);
    push + S::known_vector(DVec3::ZERO, velocity, by_velocity)
}
