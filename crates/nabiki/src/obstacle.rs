//! Shapes that hair does not enter, as contact, the solver, summaries and pictures see them.

mod capsule;

use std::fmt::Debug;

use glam::{Mat3, Vec3};

pub use capsule::Capsule;

/// A shape in its own space (cm), closed or without end, as a half space is: a rigid mesh
/// ([`SkinDistance`](crate::distance::SkinDistance)), a [`Capsule`], or any other, which may bend from frame to frame. Where that space
/// is, a [`BodyWay`](crate::body::BodyWay) says.
///
/// Contact asks in every frame for many points at once, from many threads: answers depend on the point and the frame alone.
pub trait Obstacle: Debug + Send + Sync {
    /// The corners of the box that [`read`](Self::read) knows, in all frames: from the shape to the margin of contact at least, which is
    /// up to 5 cm. They may be infinite.
    fn reach(&self) -> [Vec3; 2];

    /// Signed distance at a point in a frame, and how that changes; `None` beyond [`reach`](Self::reach), and only there. A distance
    /// may be too small anywhere, and too large by a twentieth where it is above 4 cm.
    fn read(&self, p: Vec3, frame: u32) -> Option<Reading>;

    /// How far what is at a point in a frame has come since the frame before (cm). Rigid shapes stay where they are in their space.
    fn moved(&self, _p: Vec3, _frame: u32) -> Vec3 {
        Vec3::ZERO
    }

    /// The farthest that any of it has come since the frame before (cm).
    fn farthest_moved(&self, _frame: u32) -> f32 {
        0.0
    }

    /// Hands on numbers that tell it from other shapes: caches and saved states know it by them.
    fn identify(&self, hand_on: &mut dyn FnMut(&[f32]));
}

/// What an [`Obstacle`] is like at a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reading {
    /// Signed distance (cm), negative inside.
    pub distance: f32,
    /// Its gradient, outward; of about unit length.
    pub gradient: Vec3,
    /// How the gradient changes (1 / cm). Exact derivatives need it, a step does not.
    pub hessian: Mat3,
}

/// How far a point lies beyond a box (cm); 0 within.
pub(crate) fn beyond([low, high]: [Vec3; 2], p: Vec3) -> f32 {
    (low - p).max(p - high).max(Vec3::ZERO).length()
}
