//! Hold: the moment C (d x r), which turns a segment toward its groomed direction on the head.

use crate::scalar::{Scalar, Vector};
use crate::vector::{cross, scale, subtract};

/// C of a segment of this length with this much hair beyond its middle (cm): that of a force of this strength along r
/// on all of it, so that a strand settles along F + H r.
pub fn moment_per_radian(push: f64, hold: f64, beyond: f64, length: f64) -> f64 {
    push * hold * beyond * length
}

#[inline(always)]
pub fn moment<S: Scalar>(hold: f64, rest: Vector<S>, d: Vector<S>) -> Vector<S> {
    d.cross(rest).times(hold)
}

/// The same for one lane, from the difference, which is exactly 0 at rest.
#[inline(always)]
pub fn moment_lane(hold: f32, rest: [f32; 3], d: [f32; 3]) -> [f32; 3] {
    scale(hold, cross(subtract(d, rest), rest))
}
