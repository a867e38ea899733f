//! The face without its features: cheeks, jaw and chin.

use glam::{Quat, Vec3};

use crate::shapes::{capsule, ellipsoid, join, swell, turned_ellipsoid};

/// Joins the face to the skull.
pub(crate) fn add(p: Vec3, skin: f32) -> f32 {
    if p.x < -6.0 || p.y < -16.0 {
        return skin;
    }
    let egg = turned_ellipsoid(p, Vec3::new(3.3, -3.2, 0.0), Vec3::new(5.7, 7.5, 5.35), Quat::from_rotation_z(0.24));
    let cheek = ellipsoid(p, Vec3::new(4.9, -3.1, 3.9), Vec3::new(2.3, 1.9, 2.15));
    // Up from its angle below the ear the jaw goes to the ear, and forward to the chin.
    let angle = Vec3::new(0.8, -7.1, 3.9);
    let branch = capsule(p, Vec3::new(-0.2, -4.0, 4.7), angle, 1.0, 0.9);
    let body = capsule(p, angle, Vec3::new(6.9, -9.7, 0.8), 0.9, 1.0);
    let jaw = join(branch, body, 2.0);
    let chin = ellipsoid(p, Vec3::new(7.45, -9.45, 0.0), Vec3::new(1.5, 1.2, 1.35));
    let muzzle = ellipsoid(p, Vec3::new(6.0, -7.0, 0.0), Vec3::new(3.3, 3.0, 3.5));
    let mut skin = join(skin, egg, 2.5);
    skin = join(skin, cheek, 2.2);
    skin = join(skin, jaw, 2.2);
    skin = join(skin, muzzle, 2.4);
    skin = join(skin, chin, 1.9);
    // The fullness of the cheek beside the mouth, and the crease above the chin.
    skin -= 0.26 * swell(p, Vec3::new(6.4, -5.0, 4.2), Vec3::new(3.4, 3.4, 3.2));
    skin -= 0.26 * swell(p, Vec3::new(4.8, -6.0, 4.9), Vec3::new(4.0, 3.6, 3.0));
    skin + 0.15 * swell(p, Vec3::new(9.2, -8.75, 0.0), Vec3::new(1.6, 0.95, 2.4))
}
