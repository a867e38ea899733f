//! The head ellipsoid E of the paper (section 3.1) and the ellipsoids similar to it.

use std::f32::consts::{PI, TAU};

use glam::{Vec2, Vec3};

use crate::settings;

settings! {
    /// An ellipsoid with axes along x, y and z of head space: E(p) = |(p - center) / half_axes|^2 - 1.
    #[derive(Copy)]
    pub struct Ellipsoid {
        /// Centre in head space.
        pub center: Vec3 = Vec3::ZERO => "Centre", must "[x, y, z]", unit "cm";
        /// Half axes along x, y and z.
        pub half_axes: Vec3 = Vec3::new(9.0, 11.0, 8.0) => "Half axes", must "[x, y, z]", unit "cm", above 0.0;
    }
}

impl Ellipsoid {
    /// E(p): negative inside, 0 on the surface, positive outside.
    pub fn value(&self, p: Vec3) -> f32 {
        ((p - self.center) / self.half_axes).length_squared() - 1.0
    }

    /// D(p) = grad E(p), the outward normal direction, not of unit length.
    pub fn gradient(&self, p: Vec3) -> Vec3 {
        2.0 * (p - self.center) / (self.half_axes * self.half_axes)
    }

    /// Longitude and latitude as texture coordinates, each in 0..1. The point where the face looks (+x) is (1/2, 1/2).
    /// u grows toward +z with its seam at the back; v grows from bottom to top. A point off the surface gets the
    /// coordinates of the similar ellipsoid through it.
    pub fn uv(&self, p: Vec3) -> Vec2 {
        let q = ((p - self.center) / self.half_axes).normalize_or(Vec3::Y);
        Vec2::new(0.5 + q.z.atan2(q.x) / TAU, 0.5 + q.y.clamp(-1.0, 1.0).asin() / PI)
    }

    /// The ellipsoid scaled about its centre. With a `factor` above 1 this is C of the paper.
    pub fn scaled(&self, factor: f32) -> Self {
        Self { center: self.center, half_axes: self.half_axes * factor }
    }
}
