//! Joints: the moment B (d x R r), which turns a segment toward where the one before carries its rest direction, with the reaction on that
//! one.

use crate::dynamics::Dynamics;
use crate::scalar::{Scalar, Vector};
use crate::vector::{cross, scale, subtract};

/// GJ over EI, for round hair of constant volume.
pub const TORSION: f64 = 2.0 / 3.0;

/// EI of a hair of this stiffness K whose weight is 1 per cm (cm^4 per frame^2): 3/8 A L K d^2. A small force then
/// bends it as far at its tip as a load at the tip alone would bend a beam of K d^2.
pub fn bending(dynamics: &Dynamics, push: f64, length: f64, stiffness: f64) -> f64 {
    0.375 * push * length * stiffness * f64::from(dynamics.segment_length).powi(2)
}

/// The moment of a joint. `carried`: R_(i-1) r_i.
#[inline(always)]
pub fn moment<S: Scalar>(bending: S, carried: Vector<S>, d: Vector<S>) -> Vector<S> {
    d.cross(carried) * bending
}

/// The same for one lane, from the difference, which is exactly 0 at rest.
#[inline(always)]
pub fn moment_lane(bending: f32, carried: [f32; 3], d: [f32; 3]) -> [f32; 3] {
    scale(bending, cross(subtract(d, carried), carried))
}
