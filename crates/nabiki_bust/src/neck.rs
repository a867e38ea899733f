//! The neck: a leaning column with its two long muscles, and the nape.

use glam::Vec3;

use crate::shapes::{capsule, join, swell};

/// Joins the neck to the head.
pub(crate) fn add(p: Vec3, skin: f32) -> f32 {
    if p.y > 3.0 {
        return skin;
    }
    let column = capsule(p, Vec3::new(-1.4, -7.0, 0.0), Vec3::new(-4.2, -23.0, 0.0), 4.4, 4.9);
    // From behind the ear to the pit of the neck.
    let muscle = capsule(p, Vec3::new(-2.6, -4.0, 3.9), Vec3::new(0.0, -20.6, 1.5), 1.0, 0.75);
    // A capsule on either side with what lies between, lest they leave a furrow.
    let beside = p.with_z((p.z - 1.0).max(0.0));
    let nape = capsule(beside, Vec3::new(-3.7, -6.0, 0.0), Vec3::new(-6.6, -18.5, 0.0), 2.3, 2.4);
    let mut skin = join(skin, column, 2.4);
    skin = join(skin, nape, 3.2);
    skin = join(skin, muscle, 1.2);
    skin - 0.15 * swell(p, Vec3::new(2.7, -14.2, 0.0), Vec3::new(1.6, 3.0, 1.8))
}
