//! Shapes that hair collides with, as used by contact, solver, summaries and pictures.

mod capsule;

use std::fmt::Debug;

use glam::{Mat3, Vec3};

pub use capsule::Capsule;

/// A shape in its own space (cm), closed or unbounded like a half space: a rigid mesh
/// ([`SkinDistance`](crate::distance::SkinDistance)), a [`Capsule`], or your own, which may deform from frame to frame.
/// A [`BodyWay`](crate::body::BodyWay) places that space.
///
/// Contact calls this for many points in every frame, from many threads. Results must depend only on the point and the
/// frame.
pub trait Obstacle: Debug + Send + Sync {
    /// The corners of the box in which [`read`](Self::read) returns values, for all frames. It must contain the shape
    /// and the contact margin, which is at most 5 cm. Corners may be infinite.
    fn reach(&self) -> [Vec3; 2];

    /// Signed distance at a point in a frame, and its derivatives. `None` outside [`reach`](Self::reach), and only
    /// there. A distance may be too small anywhere, and up to 5 % too large above 4 cm.
    fn read(&self, p: Vec3, frame: u32) -> Option<Reading>;

    /// The distance up to which readings are not too small. Contact asks at least as often as hair may come this near.
    fn exact_within(&self) -> f32 {
        f32::INFINITY
    }

    /// The same when only a part of the frame is over, 0..1: for shapes that bend, if a frame has several steps.
    #[inline]
    fn read_during(&self, p: Vec3, frame: u32, _part: f32) -> Option<Reading> {
        self.read(p, frame)
    }

    /// The same at rest, where groomed hair is: by default, in frame 0.
    fn read_at_rest(&self, p: Vec3) -> Option<Reading> {
        self.read(p, 0)
    }

    /// The displacement of the material at a point since the previous frame (cm), in the shape's space. 0 for rigid
    /// shapes.
    fn moved(&self, _p: Vec3, _frame: u32) -> Vec3 {
        Vec3::ZERO
    }

    /// The largest displacement of any part since the previous frame (cm).
    fn farthest_moved(&self, _frame: u32) -> f32 {
        0.0
    }

    /// Passes numbers that distinguish this shape from others to `hand_on`. Caches and saved states use them.
    fn identify(&self, hand_on: &mut dyn FnMut(&[f32]));
}

/// The distance to an [`Obstacle`] at a point, with its derivatives.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reading {
    /// Signed distance (cm), negative inside.
    pub distance: f32,
    /// Its gradient, pointing outward, of about unit length.
    pub gradient: Vec3,
    /// Its second derivatives (1/cm). Exact derivatives of the motion need them; a step does not.
    pub hessian: Mat3,
}

/// How far a point lies beyond a box (cm); 0 within.
pub(crate) fn beyond([low, high]: [Vec3; 2], p: Vec3) -> f32 {
    (low - p).max(p - high).max(Vec3::ZERO).length()
}
