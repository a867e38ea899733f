//! The nose.

use glam::Vec3;

use super::shapes::{capsule, carve, ellipsoid, join};

/// Joins the nose to the face.
pub(super) fn add(p: Vec3, skin: f32) -> f32 {
    if p.x < 5.0 || p.y > 4.0 || p.y < -9.0 {
        return skin;
    }
    let bridge = capsule(p, Vec3::new(8.0, 0.6, 0.0), Vec3::new(10.25, -4.3, 0.0), 0.6, 0.7);
    let tip = ellipsoid(p, Vec3::new(10.45, -4.45, 0.0), Vec3::new(0.85, 0.75, 0.85));
    let wing = ellipsoid(p, Vec3::new(9.35, -4.85, 1.1), Vec3::new(0.95, 0.62, 0.6));
    let mut skin = join(skin, bridge, 1.3);
    skin = join(skin, tip, 0.7);
    skin = join(skin, wing, 0.5);
    let nostril = ellipsoid(p, Vec3::new(9.75, -5.45, 0.62), Vec3::new(0.42, 0.3, 0.26));
    carve(skin, nostril, 0.25)
}
