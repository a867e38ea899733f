//! Where the head is in the world.

use glam::{Affine3A, Quat, Vec3};

use crate::error::SettingError;

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

    /// Whether all its numbers are finite and its rotation is one: of length 1, to 1e-3.
    pub fn is_valid(&self) -> bool {
        self.position_cm.is_finite() && self.rotation.is_finite() && (self.rotation.length() - 1.0).abs() < 1e-3
    }

    /// The direction in head space that points up in the world.
    pub fn up_in_head(&self) -> Vec3 {
        self.rotation.inverse() * Vec3::Y
    }

    /// Where the head was before this pose, if it came here as it goes on to `next`. The pose itself where it stands still.
    pub fn continued_back_from(&self, next: &Self) -> Self {
        if self == next {
            return *self;
        }
        let turn = self.rotation * next.rotation.inverse();
        let position_cm = 2.0 * self.position_cm - next.position_cm;
        Self { position_cm, rotation: (turn * self.rotation).normalize() }
    }

    /// The pose at a part of the way to `next`, 0..1: for steps that lie between two known poses. Places go straight, rotations by
    /// the smaller turn at an even rate.
    #[must_use]
    pub fn between(&self, next: &Self, part: f32) -> Self {
        Self {
            position_cm: self.position_cm.lerp(next.position_cm, part),
            rotation: self.rotation.slerp(next.rotation, part).normalize(),
        }
    }

    /// Takes points of head space into the world (cm).
    #[must_use]
    pub fn world_from_head(&self) -> Affine3A {
        Affine3A::from_rotation_translation(self.rotation, self.position_cm)
    }
}

/// Refuses poses that are none, one a frame; `name` is what the way through them is called.
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
