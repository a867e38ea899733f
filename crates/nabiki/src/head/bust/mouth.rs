//! The lips.

use glam::Vec3;

use super::shapes::{carve, chain, join, swell};

/// Joins the lips to the face and parts them with a line.
pub(super) fn add(p: Vec3, skin: f32) -> f32 {
    if p.x < 5.0 || p.y > -4.0 || p.y < -11.0 {
        return skin;
    }
    let upper = chain(
        p,
        &[
            (Vec3::new(9.5, -7.0, 0.0), 0.42),
            (Vec3::new(9.48, -6.9, 0.55), 0.46),
            (Vec3::new(9.05, -7.05, 1.5), 0.38),
            (Vec3::new(8.3, -7.35, 2.4), 0.16),
        ],
    );
    let lower = chain(
        p,
        &[
            (Vec3::new(9.35, -8.0, 0.0), 0.56),
            (Vec3::new(9.25, -7.97, 0.7), 0.56),
            (Vec3::new(8.85, -7.75, 1.6), 0.42),
            (Vec3::new(8.25, -7.45, 2.3), 0.16),
        ],
    );
    let mut skin = join(skin, upper, 0.45);
    skin = join(skin, lower, 0.5);
    let line = chain(
        p,
        &[
            (Vec3::new(10.0, -7.5, 0.0), 0.1),
            (Vec3::new(9.85, -7.44, 0.7), 0.1),
            (Vec3::new(9.3, -7.45, 1.6), 0.1),
            (Vec3::new(8.4, -7.3, 2.6), 0.08),
        ],
    );
    skin = carve(skin, line, 0.35);
    // Groove between nose and lip.
    skin + 0.14 * swell(p, Vec3::new(9.5, -6.2, 0.0), Vec3::new(1.0, 0.8, 0.5))
}
