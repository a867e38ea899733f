//! Where the head is in the world.

use glam::{Affine3A, Quat, Vec3};

/// Where the head is in one frame: world = `rotation` head + `position_cm`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose {
    /// Origin of head space in the world (cm; y up, right-handed).
    pub position_cm: Vec3,
    /// Turns head space into the world.
    pub rotation: Quat,
}

impl Pose {
    /// The pose of a head that stands still: head space is the world.
    pub const STILL: Self = Self { position_cm: Vec3::ZERO, rotation: Quat::IDENTITY };

    /// Takes points of head space into the world (cm).
    pub fn world_from_head(&self) -> Affine3A {
        Affine3A::from_rotation_translation(self.rotation, self.position_cm)
    }
}

impl Default for Pose {
    fn default() -> Self {
        Self::STILL
    }
}
