//! The head ellipsoid E of the paper (section 3.1) and the ellipsoids similar to it.

use std::f32::consts::{PI, TAU};

use glam::{Vec2, Vec3};
use serde::{Deserialize, Serialize};

use crate::error::{SettingError, check_positive};

/// An ellipsoid whose axes are those of head space: E(p) = |(p - center) / half_axes|^2 - 1.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Ellipsoid {
    /// Centre (head space, cm).
    pub center: Vec3,
    /// Half axes along x, y and z (cm).
    pub half_axes: Vec3,
}

impl Ellipsoid {
    /// Refuses a centre that is no point, and half axes that are not above 0. `name` is what the setting is called.
    pub fn check(&self, name: &str) -> Result<(), SettingError> {
        if !self.center.is_finite() {
            return Err(SettingError::new(format!("{name}.center"), self.center, "must be finite numbers (cm)"));
        }
        let thing = format!("{name}.half_axes");
        self.half_axes.to_array().into_iter().try_for_each(|half_axis| check_positive(&thing, half_axis))
    }

    /// E(p): negative inside, 0 on the surface, positive outside.
    pub fn value(&self, p: Vec3) -> f32 {
        ((p - self.center) / self.half_axes).length_squared() - 1.0
    }

    /// D(p) = grad E(p), the outward normal direction, not of unit length.
    pub fn gradient(&self, p: Vec3) -> Vec3 {
        2.0 * (p - self.center) / (self.half_axes * self.half_axes)
    }

    /// Longitude and latitude as texture coordinates, each in 0..1: (1/2, 1/2) where the face looks (+x), u growing
    /// toward +z with its seam at the back, v from the bottom to the top. For a point off the surface, those of the
    /// similar ellipsoid through it.
    pub fn uv(&self, p: Vec3) -> Vec2 {
        let q = ((p - self.center) / self.half_axes).normalize_or(Vec3::Y);
        Vec2::new(0.5 + q.z.atan2(q.x) / TAU, 0.5 + q.y.clamp(-1.0, 1.0).asin() / PI)
    }

    /// The similar ellipsoid about the same centre: C of the paper, for a `factor` above 1.
    pub fn scaled(&self, factor: f32) -> Self {
        Self { center: self.center, half_axes: self.half_axes * factor }
    }
}
