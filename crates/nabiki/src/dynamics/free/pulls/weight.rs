//! Weight: g - R g', that of now without the one under which hair lies in balance at rest.

use super::at::At;
use crate::dynamics::free::rotate::turned;
use crate::dynamics::gain::SegmentShape;
use crate::dynamics::pull::{Name, Pull};
use crate::scalar::{Scalar, Vector};
use crate::vector::subtract;

/// Of `free.gravity`.
pub struct Gravity(pub f32);

impl Pull for Gravity {
    fn name(&self) -> Name {
        Name { setting: "free.gravity", words: "gravity", term: "2 gravity" }
    }

    fn setting(&self) -> f32 {
        self.0
    }

    /// Both of its weights may turn it the same way.
    fn strongest(&self, _: &SegmentShape, _: Option<&SegmentShape>) -> f64 {
        2.0 * f64::from(self.0)
    }
}

#[inline(always)]
pub fn force<S: Scalar>(at: &At<S>) -> Vector<S> {
    Vector::from(at.head.weight) - at.frame.of_known(at.rest_weight)
}

/// The head's weight now and at rest, in the unit of the force.
#[derive(Clone, Copy, Debug, Default)]
pub struct Weight {
    pub now: [f32; 3],
    pub at_rest: [f32; 3],
}

impl Weight {
    /// The force on one lane.
    #[inline(always)]
    pub fn force_lane(&self, (u, s, over_length): ([f32; 3], f32, f32)) -> [f32; 3] {
        subtract(self.now, turned(u, s, over_length, self.at_rest))
    }
}
