//! The braincase and the forehead.

use glam::Vec3;

use crate::shapes::{ellipsoid, join, swell};

/// The skull: it keeps to the head ellipsoid where hair grows.
pub(crate) fn add(p: Vec3) -> f32 {
    let braincase = ellipsoid(p, Vec3::new(-0.4, 0.6, 0.0), Vec3::new(9.1, 10.5, 7.7));
    let forehead = ellipsoid(p, Vec3::new(2.0, 2.6, 0.0), Vec3::new(7.2, 7.4, 6.5));
    let skin = join(braincase, forehead, 2.0);
    // The temples are flat.
    skin + 0.15 * swell(p, Vec3::new(5.6, 1.6, 6.6), Vec3::new(3.5, 4.0, 2.5))
}
