//! The nose.

use glam::{Quat, Vec3};
use nabiki_groom::face;

use crate::shapes::{capsule, carve, chain, ellipsoid, join, swell, turned_ellipsoid};

/// Joins the nose to the face.
pub(crate) fn add(p: Vec3, skin: f32) -> f32 {
    if p.x < 5.0 || p.y > 4.0 || p.y < -9.0 {
        return skin;
    }
    let bridge = chain(
        p,
        &[
            (Vec3::new(7.9, 1.3, 0.0), 0.5),
            (Vec3::new(8.2, -0.6, 0.0), 0.5),
            (Vec3::new(9.2, -2.4, 0.0), 0.62),
            (Vec3::new(10.35, -4.0, 0.0), 0.6),
        ],
    );
    let tip = ellipsoid(p, Vec3::new(10.4, -4.33, 0.0), Vec3::new(0.78, 0.66, 0.76));
    let wing =
        turned_ellipsoid(p, Vec3::new(9.45, -4.7, 0.98), Vec3::new(0.85, 0.54, 0.43), Quat::from_rotation_y(0.35));
    let mut skin = join(skin, bridge, 1.3);
    skin = join(skin, tip, 0.9);
    let base = capsule(p, Vec3::new(10.5, -4.86, 0.0), Vec3::new(9.3, -4.84, 0.0), 0.3, 0.28);
    skin = join(skin, wing, 0.55);
    skin = join(skin, base, 0.4);
    let nostril = turned_ellipsoid(p, face::NOSTRIL, Vec3::new(0.46, 0.22, 0.19), Quat::from_rotation_y(0.4));
    skin = carve(skin, nostril, 0.32);
    // The upper lip begins in a corner below.
    skin += 0.12 * swell(p, Vec3::new(9.5, -5.3, 0.0), Vec3::new(0.9, 0.6, 1.3));
    skin + 0.05 * swell(p, Vec3::new(9.7, -2.2, 0.0), Vec3::new(1.2, 1.6, 1.2))
}
