//! The face without its features: cheeks, jaw and chin.

use glam::{Quat, Vec3};

use crate::shapes::{capsule, ellipsoid, join, swell, turned_ellipsoid};

/// Joins the face to the skull.
pub(crate) fn add(p: Vec3, skin: f32) -> f32 {
    if p.x < -6.0 || p.y < -16.0 {
        return skin;
    }
    let egg = turned_ellipsoid(p, Vec3::new(3.3, -3.6, 0.0), Vec3::new(5.7, 8.3, 5.6), Quat::from_rotation_z(0.27));
    let cheek = ellipsoid(p, Vec3::new(5.0, -3.1, 3.9), Vec3::new(2.3, 1.9, 2.1));
    let jaw = capsule(p, Vec3::new(1.0, -7.2, 3.9), Vec3::new(6.8, -10.2, 0.9), 1.0, 1.1);
    let chin = ellipsoid(p, Vec3::new(7.2, -10.1, 0.0), Vec3::new(1.75, 1.45, 1.7));
    let muzzle = ellipsoid(p, Vec3::new(6.2, -7.3, 0.0), Vec3::new(3.2, 2.9, 3.2));
    let mut skin = join(skin, egg, 2.5);
    skin = join(skin, cheek, 2.0);
    skin = join(skin, jaw, 2.4);
    skin = join(skin, muzzle, 2.2);
    skin = join(skin, chin, 1.6);
    // The fullness of the cheek beside the mouth, and the crease above the chin.
    skin -= 0.32 * swell(p, Vec3::new(6.8, -5.5, 3.7), Vec3::new(2.8, 2.6, 2.6));
    skin + 0.26 * swell(p, Vec3::new(9.3, -9.1, 0.0), Vec3::new(1.6, 1.2, 2.6))
}
