//! The nose.

use glam::Vec3;
use nabiki_groom::face;

use crate::shapes::{capsule, carve, ellipsoid, join, swell};

/// Joins the nose to the face.
pub(crate) fn add(p: Vec3, skin: f32) -> f32 {
    if p.x < 5.0 || p.y > 4.0 || p.y < -9.0 {
        return skin;
    }
    let bridge = capsule(p, Vec3::new(8.0, 0.6, 0.0), Vec3::new(10.1, -4.1, 0.0), 0.6, 0.72);
    let tip = ellipsoid(p, Vec3::new(10.35, -4.35, 0.0), Vec3::new(0.9, 0.82, 0.95));
    let wing = ellipsoid(p, Vec3::new(9.35, -4.8, 1.0), Vec3::new(0.95, 0.62, 0.62));
    let mut skin = join(skin, bridge, 1.3);
    skin = join(skin, tip, 0.7);
    let base = ellipsoid(p, Vec3::new(9.85, -5.1, 0.0), Vec3::new(0.8, 0.4, 0.4));
    skin = join(skin, base, 0.6);
    skin = join(skin, wing, 0.6);
    let nostril = ellipsoid(p, face::NOSTRIL, Vec3::new(0.45, 0.26, 0.24));
    skin = carve(skin, nostril, 0.4);
    // The bridge is a little hollow in profile.
    skin + 0.13 * swell(p, Vec3::new(9.7, -2.0, 0.0), Vec3::new(1.2, 1.9, 1.2))
}
