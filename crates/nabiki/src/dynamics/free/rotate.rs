//! Vectors turned by quaternions, for the loops over lanes.

use glam::Vec3;

use crate::dynamics::trigonometry::sin_cos;
use crate::vector::{cross, dot, scale, scale_add};

/// `v` turned by the quaternion (u, s), 2 / whose squared length is `over_length`. Without a turn, u = 0, it keeps its
/// bits.
#[inline(always)]
pub(super) fn turned(u: [f32; 3], s: f32, over_length: f32, v: [f32; 3]) -> [f32; 3] {
    let once = cross(u, v);
    let twice = cross(u, once);
    scale_add(over_length, scale_add(s, once, twice), v)
}

/// A vector turned about an axis of length 1 (rad).
#[inline(always)]
pub(super) fn turned_about(axis: [f32; 3], angle: f32, v: Vec3) -> Vec3 {
    let (sin, cos) = sin_cos(0.5 * angle);
    let u = scale(sin, axis);
    Vec3::from(turned(u, cos, 2.0 / cos.mul_add(cos, dot(u, u)), v.to_array()))
}
