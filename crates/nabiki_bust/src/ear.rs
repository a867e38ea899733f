//! The ear: a plate with a rolled rim, a fold within it, a hollow, the knob before it and a lobe.

use glam::{Mat3, Quat, Vec2, Vec3};

use crate::shapes::{carve, chain, ellipsoid, join};

/// Joins the ear to the head.
pub(crate) fn add(p: Vec3, skin: f32) -> f32 {
    let center = Vec3::new(-1.7, -1.85, 7.6);
    if p.distance_squared(center) > 36.0 {
        return skin;
    }
    // In the ear's own frame x is forward, y up along it, z out of its plane: the ear leans back by 11 degrees, and
    // its back edge stands off the head by 20.
    let turn = Mat3::from_quat(Quat::from_rotation_y(0.35) * Quat::from_rotation_z(0.2));
    let q = turn.transpose() * (p - center);
    // Narrower toward the lobe.
    let half_width = (1.62 + 0.2 * q.y).max(0.6);
    let edge = 1.6 * (Vec2::new(q.x / half_width, q.y / 3.08).length() - 1.0);
    let plate = carve(edge, 0.2 - q.z.abs(), 0.12);
    // From the hollow forward, over the top and down the back, gone at the lobe.
    let rim = chain(
        q,
        &[
            (Vec3::new(0.35, -0.15, -0.3), 0.24),
            (Vec3::new(0.95, 0.25, 0.1), 0.22),
            (Vec3::new(1.4, 1.2, 0.2), 0.24),
            (Vec3::new(0.85, 2.4, 0.24), 0.27),
            (Vec3::new(-0.35, 2.85, 0.26), 0.29),
            (Vec3::new(-1.4, 2.15, 0.28), 0.29),
            (Vec3::new(-1.68, 0.9, 0.28), 0.27),
            (Vec3::new(-1.5, -0.5, 0.22), 0.22),
            (Vec3::new(-1.08, -1.6, 0.14), 0.18),
            (Vec3::new(-0.6, -2.4, 0.06), 0.14),
        ],
    );
    // The fold within the rim, forked above.
    let fold = chain(
        q,
        &[
            (Vec3::new(0.25, -1.75, 0.22), 0.22),
            (Vec3::new(-0.36, -1.35, 0.18), 0.19),
            (Vec3::new(-0.64, -0.4, 0.22), 0.2),
            (Vec3::new(-0.64, 0.6, 0.2), 0.2),
            (Vec3::new(-0.35, 1.7, 0.08), 0.16),
        ],
    );
    let prong = chain(
        q,
        &[(Vec3::new(-0.64, 0.4, 0.18), 0.18), (Vec3::new(0.0, 0.85, 0.14), 0.18), (Vec3::new(0.9, 0.95, 0.06), 0.14)],
    );
    let knob = ellipsoid(q, Vec3::new(1.24, -0.65, 0.14), Vec3::new(0.34, 0.52, 0.3));
    let lobe = ellipsoid(q, Vec3::new(0.15, -2.45, 0.04), Vec3::new(0.85, 0.78, 0.27));
    let shell = ellipsoid(q, Vec3::new(0.28, -0.5, 0.35), Vec3::new(0.8, 1.1, 0.75));
    let mut ear = join(plate, lobe, 0.4);
    ear = join(ear, fold, 0.4);
    ear = join(ear, prong, 0.3);
    ear = carve(ear, shell, 0.25);
    ear = join(ear, rim, 0.25);
    ear = join(ear, knob, 0.5);
    join(skin, ear, 0.7)
}
