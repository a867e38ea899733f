//! Joints: the moment K (R r) x d, which turns two segments toward their rest shape, each as much as the other.

use crate::dynamics::gain::SegmentShape;
use crate::dynamics::pull::{Name, Pull};
use crate::profile::Profile;
use crate::scalar::{Scalar, Vector};
use crate::vector::{cross, scale, subtract};

/// Of `free.stiffness`.
pub struct Stiffness<'a>(pub &'a Profile);

impl Stiffness<'_> {
    /// K of the joint at a segment's beginning, for its length.
    pub fn of(&self, segment: &SegmentShape) -> f64 {
        segment.cut * self.0.at(segment.begin)
    }
}

impl Pull for Stiffness<'_> {
    fn name(&self) -> Name {
        Name { setting: "free.stiffness", words: "the largest stiffness", term: "4 K" }
    }

    fn setting(&self) -> f32 {
        self.0.largest()
    }

    fn has_others(&self) -> bool {
        self.0.values().len() > 1
    }

    /// Twice the stiffness of both of its joints.
    fn strongest(&self, segment: &SegmentShape, next: Option<&SegmentShape>) -> f64 {
        2.0 * (self.of(segment) + next.map_or(0.0, |next| self.of(next)))
    }
}

/// The moment of a joint of stiffness K. `carried`: R_(i-1) r_i, where the segment before it carries its rest direction.
#[inline(always)]
pub fn moment<S: Scalar>(stiffness: S, carried: Vector<S>, d: Vector<S>) -> Vector<S> {
    carried.cross(d) * stiffness
}

/// The same for one lane. Of the difference, which is exactly 0 at rest.
#[inline(always)]
pub fn moment_lane(stiffness: f32, carried: [f32; 3], d: [f32; 3]) -> [f32; 3] {
    scale(stiffness, cross(carried, subtract(d, carried)))
}
