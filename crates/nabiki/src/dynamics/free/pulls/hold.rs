//! Hold: H (r - d), which turns a segment toward its groomed direction in head space.

use super::at::At;
use crate::dynamics::gain::SegmentShape;
use crate::dynamics::pull::{Name, Pull};
use crate::profile::Profile;
use crate::scalar::{Scalar, Vector};
use crate::vector::{scale, subtract};

/// Of `free.hold`.
pub struct Hold<'a>(pub &'a Profile);

impl Pull for Hold<'_> {
    fn name(&self) -> Name {
        Name { setting: "free.hold", words: "the largest hold", term: "H" }
    }

    fn setting(&self) -> f32 {
        self.0.largest()
    }

    fn has_others(&self) -> bool {
        self.0.values().len() > 1
    }

    fn strongest(&self, segment: &SegmentShape, _: Option<&SegmentShape>) -> f64 {
        self.0.at(segment.middle)
    }
}

#[inline(always)]
pub fn force<S: Scalar>(at: &At<S>) -> Vector<S> {
    (Vector::from(at.segment.rest) - at.direction).times(at.segment.hold)
}

#[inline(always)]
pub fn force_lane(hold: f32, rest: [f32; 3], d: [f32; 3]) -> [f32; 3] {
    scale(hold, subtract(rest, d))
}
