//! Shoulders and upper chest, and where the bust is cut off.

use glam::Vec3;

use crate::shapes::{capsule, ellipsoid, join, swell};

/// Joins the shoulders to the neck.
pub(crate) fn add(p: Vec3, skin: f32) -> f32 {
    if p.y > -8.0 {
        return skin;
    }
    let chest = ellipsoid(p, Vec3::new(-4.4, -31.5, 0.0), Vec3::new(8.8, 12.0, 15.5));
    // With what lies between the two, lest they leave a furrow.
    let beside = p.with_z((p.z - 1.6).max(0.0));
    let trapezius = capsule(beside, Vec3::new(-6.6, -17.5, 0.0), Vec3::new(-5.4, -22.6, 10.4), 2.2, 2.2);
    let shoulder = ellipsoid(p, Vec3::new(-4.8, -26.8, 14.6), Vec3::new(4.6, 5.4, 4.6));
    let clavicle = capsule(p, Vec3::new(0.0, -21.7, 1.8), Vec3::new(-3.2, -21.8, 13.5), 0.5, 0.6);
    let body = join(join(chest, shoulder, 4.0), trapezius, 4.0);
    let mut skin = join(skin, body, 3.5);
    skin = join(skin, clavicle, 1.4);
    // The pit of the neck.
    skin + 0.35 * swell(p, Vec3::new(1.0, -20.6, 0.0), Vec3::new(2.4, 2.2, 1.8))
}

/// Cuts the bust off below along a bowl, rim rounded.
pub(crate) fn cut_off(p: Vec3, skin: f32) -> f32 {
    if p.y > -16.0 {
        return skin;
    }
    let bowl = ellipsoid(p, Vec3::new(-4.5, -17.0, 0.0), Vec3::new(20.0, 15.5, 26.0));
    -join(-skin, -bowl.max(-31.0 - p.y), 1.2)
}
