//! Vectors turned by quaternions, for the loops over lanes.

use crate::vector::{cross, scale_add};

/// `v` rotated by the quaternion (u, s), 2 / whose squared length is `over_length`. Without a turn, u = 0, it keeps its
/// bits.
#[inline(always)]
pub(super) fn turned(u: [f32; 3], s: f32, over_length: f32, v: [f32; 3]) -> [f32; 3] {
    let once = cross(u, v);
    let twice = cross(u, once);
    scale_add(over_length, scale_add(s, once, twice), v)
}
