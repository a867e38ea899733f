//! The ear: a plate with a rolled rim, a fold within it, a hollow, the knob before it and a lobe.

use glam::{Mat3, Quat, Vec2, Vec3};

use crate::shapes::{carve, chain, ellipsoid, join};

/// Joins the ear to the head.
pub(crate) fn add(p: Vec3, skin: f32) -> f32 {
    let center = Vec3::new(-1.7, -1.6, 7.7);
    if p.distance_squared(center) > 36.0 {
        return skin;
    }
    // In the ear's own frame x is forward, y up along it, z out of its plane: the ear leans back by 11 degrees, and
    // its back edge stands off the head by 15: hair lies on it, which would press a looser ear flat.
    let turn = Mat3::from_quat(Quat::from_rotation_y(0.27) * Quat::from_rotation_z(0.2));
    let q = turn.transpose() * (p - center);
    // Narrower toward the lobe.
    let half_width = (1.75 + 0.18 * q.y).max(0.6);
    let edge = 1.75 * (Vec2::new(q.x / half_width, q.y / 2.95).length() - 1.0);
    let plate = carve(edge, 0.24 - q.z.abs(), 0.15);
    // The rim begins above the hollow, goes over the top and down the back, and is gone at the lobe.
    let along = ((q.y + 2.2 + 0.9 * q.x) / 1.9).clamp(0.0, 1.0);
    let rolled = 0.29 * (0.35 + 0.65 * along * along * (3.0 - 2.0 * along));
    let rim = Vec2::new(edge + 0.28, q.z - 0.17).length() - rolled;
    let fold = chain(
        q,
        &[
            (Vec3::new(0.0, 1.75, 0.05), 0.16),
            (Vec3::new(-0.5, 0.8, 0.12), 0.24),
            (Vec3::new(-0.62, -0.3, 0.14), 0.24),
            (Vec3::new(-0.3, -1.3, 0.1), 0.22),
        ],
    );
    let knob = ellipsoid(q, Vec3::new(1.02, -0.5, 0.14), Vec3::new(0.28, 0.46, 0.26));
    let lobe = ellipsoid(q, Vec3::new(0.2, -2.3, 0.06), Vec3::new(0.6, 0.65, 0.27));
    let shell = ellipsoid(q, Vec3::new(0.32, -0.35, 0.5), Vec3::new(0.72, 1.15, 0.75));
    let groove = ellipsoid(q, Vec3::new(-0.15, 1.75, 0.42), Vec3::new(0.95, 0.75, 0.4));
    let mut ear = join(plate, rim, 0.3);
    ear = carve(ear, groove, 0.3);
    ear = join(ear, fold, 0.3);
    ear = carve(ear, shell, 0.3);
    ear = join(ear, knob, 0.5);
    ear = join(ear, lobe, 0.4);
    join(skin, ear, 0.8)
}
