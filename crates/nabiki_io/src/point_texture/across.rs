//! Ribbons that move: how they lie in each frame.

use glam::{Quat, Vec3};
use nabiki::Strands;

use crate::gltf_write::ribbons;

/// The ribbons of the first frame, on the head (m).
pub(super) struct Across {
    tangents: Vec<Vec3>,
    /// From each point to its right vertex.
    sides: Vec<Vec3>,
    pub normals: Vec<Vec3>,
}

impl Across {
    /// Of strands on the head, whose middle is at `center`.
    pub fn new(strands: &Strands, half_width: f32, center: Vec3) -> Self {
        Self {
            tangents: strands.iter().flat_map(ribbons::tangents).collect(),
            sides: strands.iter().flat_map(|strand| ribbons::sides(strand, half_width, center)).collect(),
            normals: strands.iter().flat_map(|strand| ribbons::normals(strand, center)).collect(),
        }
    }

    /// From each point to its right vertex in another frame.
    ///
    /// Each turns as little as the strand lets it, from the first frame on. Laid on the skin anew, the ribbons would flip
    /// at roots that stand upright.
    pub fn sides(&self, now: &Strands) -> impl Iterator<Item = Vec3> {
        let turns = now.iter().flat_map(ribbons::tangents).zip(&self.tangents);
        turns.zip(&self.sides).map(|((now, &first), &side)| Quat::from_rotation_arc(first, now) * side)
    }
}
