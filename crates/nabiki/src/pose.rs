//! The pose of the head in the world.

use glam::{Affine3A, Quat, Vec3};

use crate::error::SettingError;

/// The pose of the head in one frame: world = `rotation` head + `position_cm`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose {
    /// Origin of head space in the world (cm; y up, right-handed).
    pub position_cm: Vec3,
    /// Rotation from head space to the world.
    pub rotation: Quat,
}

impl Pose {
    /// The pose of a head that does not move: head space is the world.
    pub const STILL: Self = Self { position_cm: Vec3::ZERO, rotation: Quat::IDENTITY };

    /// Whether all numbers are finite and the rotation has length 1, within 1e-3.
    pub fn is_valid(&self) -> bool {
        self.position_cm.is_finite() && self.rotation.is_finite() && (self.rotation.length() - 1.0).abs() < 1e-3
    }

    /// The direction in head space that points up in the world.
    pub fn up_in_head(&self) -> Vec3 {
        self.rotation.inverse() * Vec3::Y
    }

    /// The previous pose if the motion from this pose to `next` is continued backward. If `next` is the same, the pose
    /// itself.
    pub fn continued_back_from(&self, next: &Self) -> Self {
        if self == next {
            return *self;
        }
        let turn = self.rotation * next.rotation.inverse();
        let position_cm = 2.0 * self.position_cm - next.position_cm;
        Self { position_cm, rotation: (turn * self.rotation).normalize() }
    }

    /// Interpolates to `next` (`part` in 0..1), for steps between two known poses. Positions are interpolated linearly,
    /// rotations along the shorter arc at constant speed.
    #[must_use]
    pub fn between(&self, next: &Self, part: f32) -> Self {
        Self {
            position_cm: self.position_cm.lerp(next.position_cm, part),
            rotation: self.rotation.slerp(next.rotation, part).normalize(),
        }
    }

    /// Transforms points from head space to the world (cm).
    #[must_use]
    pub fn world_from_head(&self) -> Affine3A {
        Affine3A::from_rotation_translation(self.rotation, self.position_cm)
    }
}

/// Refuses invalid poses, one per frame; `name` names the list in the error.
pub(crate) fn check_poses(name: &str, poses: &[Pose]) -> Result<(), SettingError> {
    match poses.iter().position(|pose| !pose.is_valid()) {
        None => Ok(()),
        Some(n) => {
            let remedy = "must be a finite position (cm) and a rotation of length 1";
            Err(SettingError::new(format!("{name} frame {n}"), format!("{:?}", poses[n]), remedy))
        }
    }
}

impl Default for Pose {
    fn default() -> Self {
        Self::STILL
    }
}
