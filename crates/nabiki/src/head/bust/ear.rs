//! The ear.

use glam::{Mat3, Quat, Vec2, Vec3};

use super::shapes::{carve, ellipsoid, join};

/// Joins the ear to the head.
pub(super) fn add(p: Vec3, skin: f32) -> f32 {
    let center = Vec3::new(-1.6, -1.6, 7.3);
    if p.distance_squared(center) > 36.0 {
        return skin;
    }
    // In the ear's own frame x is forward, y up along the ear, z out of its plane: it leans back by 12 degrees and
    // stands off the head by 25.
    let lean = Mat3::from_quat(Quat::from_rotation_y(-0.32) * Quat::from_rotation_z(0.2));
    let q = lean.transpose() * (p - center);
    // Narrower toward the lobe.
    let width = 1.75 + 0.18 * q.y;
    let flat = Vec2::new(q.x / width.max(0.6), q.y / 2.95);
    let edge = (flat.length() - 1.0) * 1.75;
    let plate = join(edge, q.z.abs() - 0.25, 0.1).max(edge).max(q.z.abs() - 0.3);
    let rim = Vec2::new((edge + 0.3) * 1.0, q.z - 0.25).length() - 0.33;
    let rim = rim.max(-(q.x - 1.2)).min(rim);
    let concha = ellipsoid(q, Vec3::new(0.25, -0.3, 0.55), Vec3::new(0.85, 1.3, 0.7));
    let hollow = ellipsoid(q, Vec3::new(-0.2, 1.5, 0.5), Vec3::new(0.9, 0.9, 0.4));
    let mut ear = join(plate, rim, 0.35);
    ear = carve(ear, concha, 0.3);
    ear = carve(ear, hollow, 0.3);
    join(skin, ear, 0.7)
}
