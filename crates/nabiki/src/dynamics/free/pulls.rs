//! What pulls on hair in the free form besides the field: a file for each force, with its text in f64 over any [`Scalar`], its
//! fast text over lanes, and its part in the check of stability.
//!
//! A new force is such a file, its name in [`pulls`], and its term in the sums: [`sum`] here for f64; for the fast step
//! [`sum_of_shape`] if it comes from the segment's own shape, or `Among::outer_forces` in `passes.rs` if from its place, which
//! `Packed::plan` must then let be asked.

pub(super) mod acceleration;
mod at;
mod hold;
pub(super) mod joints;
pub(super) mod neighbours;
pub(super) mod weight;

pub(super) use self::at::At;
use self::hold::Hold;
use self::joints::Stiffness;
use self::neighbours::Cohesion;
use self::weight::{Gravity, Weight};
use crate::dynamics::pull::Pull;
use crate::free_form::{FreeForm, FreeMotion};
use crate::scalar::{Scalar, Vector};
use crate::vector::add;

/// All that the check of stability asks.
pub(in crate::dynamics) fn pulls(free: &FreeMotion) -> Vec<Box<dyn Pull + '_>> {
    let FreeForm { stiffness, hold, .. } = &free.form;
    let mut pulls: Vec<Box<dyn Pull + '_>> =
        vec![Box::new(Stiffness(stiffness)), Box::new(Hold(hold)), Box::new(Gravity(free.form.weight()))];
    let neighbours = free.neighbours.as_ref().map(|neighbours| &neighbours.forces);
    if let Some(forces) = neighbours.filter(|forces| forces.cohesion > 0.0) {
        pulls.push(Box::new(Cohesion(forces.cohesion)));
    }
    pulls
}

/// f, all that pulls on a segment but the moments of its joints. `field`: the force of the field.
#[inline(always)]
pub(super) fn sum<S: Scalar>(field: Vector<S>, at: &At<S>) -> Vector<S> {
    let of_place = field + acceleration::force(at) + neighbours::force(at);
    of_place + weight::force(at) + hold::force(at)
}

/// What comes of a segment's own shape, for one lane of the fast step: `frame` turns as R_(i-1) does, see
/// [`turned`](super::rotate::turned).
#[inline(always)]
pub(super) fn sum_of_shape(
    weight: &Weight,
    frame: ([f32; 3], f32, f32),
    hold: f32,
    rest: [f32; 3],
    d: [f32; 3],
) -> [f32; 3] {
    add(weight.force_lane(frame), hold::force_lane(hold, rest, d))
}
