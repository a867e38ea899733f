//! The ear: a plate with a rolled rim and two hollows.

use glam::{Mat3, Quat, Vec2, Vec3};

use crate::shapes::{carve, ellipsoid, join};

/// Joins the ear to the head.
pub(crate) fn add(p: Vec3, skin: f32) -> f32 {
    let center = Vec3::new(-1.7, -1.6, 7.75);
    if p.distance_squared(center) > 36.0 {
        return skin;
    }
    // In the ear's own frame x is forward, y up along it, z out of its plane: the ear leans back by 11 degrees, and
    // its back edge stands off the head by 24.
    let turn = Mat3::from_quat(Quat::from_rotation_y(0.42) * Quat::from_rotation_z(0.2));
    let q = turn.transpose() * (p - center);
    // Narrower toward the lobe.
    let half_width = (1.75 + 0.18 * q.y).max(0.6);
    let edge = 1.75 * (Vec2::new(q.x / half_width, q.y / 2.95).length() - 1.0);
    let plate = carve(edge, 0.28 - q.z.abs(), 0.15);
    let rim = Vec2::new(edge + 0.3, q.z - 0.25).length() - 0.33;
    let shell = ellipsoid(q, Vec3::new(0.25, -0.3, 0.55), Vec3::new(0.85, 1.3, 0.7));
    let hollow = ellipsoid(q, Vec3::new(-0.2, 1.5, 0.5), Vec3::new(0.9, 0.9, 0.4));
    let mut ear = join(plate, rim, 0.35);
    ear = carve(ear, shell, 0.3);
    ear = carve(ear, hollow, 0.3);
    join(skin, ear, 0.7)
}
