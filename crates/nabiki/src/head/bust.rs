//! The builtin bust: blended shapes, meshed.

mod mesher;
mod shapes;

use glam::Vec3;

use crate::{Ellipsoid, Mesh};

/// E of the builtin bust: the half axes that make the paper's unit of length a centimetre.
pub(super) const ELLIPSOID: Ellipsoid = Ellipsoid { center: Vec3::ZERO, half_axes: Vec3::new(9.5, 11.0, 7.8) };

/// The bust's surface.
pub(super) fn mesh() -> Mesh {
    mesher::mesh(&field)
}

/// The bust as one function of the place: negative inside, zero on the skin, and near it about the distance (cm).
fn field(p: Vec3) -> f32 {
    use shapes::{capsule, ellipsoid, smooth_union};
    let p = Vec3::new(p.x, p.y, (p.z * p.z + 0.01).sqrt());
    let skull = ellipsoid(p, Vec3::ZERO, ELLIPSOID.half_axes);
    let face = ellipsoid(p, Vec3::new(2.2, -4.0, 0.0), Vec3::new(6.6, 7.6, 5.8));
    let neck = capsule(p, Vec3::new(-1.5, -8.0, 0.0), Vec3::new(-4.5, -24.0, 0.0), 5.2, 5.8);
    let shoulders = capsule(p, Vec3::new(-4.0, -25.5, 0.0), Vec3::new(-4.5, -26.5, 14.5), 6.0, 4.5);
    let head = smooth_union(skull, face, 2.0);
    let nose = capsule(p, Vec3::new(8.6, 0.0, 0.0), Vec3::new(10.0, -4.6, 0.0), 0.6, 0.9);
    let ear = ellipsoid(p, Vec3::new(-1.6, -1.7, 7.6), Vec3::new(1.6, 3.1, 0.8));
    let head = smooth_union(smooth_union(head, nose, 0.8), ear, 0.4);
    let body = smooth_union(smooth_union(head, neck, 2.5), shoulders, 4.0);
    body.max(-31.0 - p.y)
}
