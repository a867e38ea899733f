//! The lips.

use glam::Vec3;

use super::shapes::{chain, join, ridge, swell};

/// Joins the lips to the face and parts them with a line.
pub(super) fn add(p: Vec3, skin: f32) -> f32 {
    if p.x < 5.0 || p.y > -4.0 || p.y < -11.0 {
        return skin;
    }
    let upper = chain(
        p,
        &[
            (Vec3::new(9.5, -7.0, 0.0), 0.46),
            (Vec3::new(9.48, -6.9, 0.5), 0.5),
            (Vec3::new(9.1, -7.05, 1.4), 0.44),
            (Vec3::new(8.3, -7.35, 2.4), 0.18),
        ],
    );
    let lower = chain(
        p,
        &[
            (Vec3::new(9.35, -8.02, 0.0), 0.58),
            (Vec3::new(9.27, -8.0, 0.6), 0.58),
            (Vec3::new(8.9, -7.78, 1.5), 0.44),
            (Vec3::new(8.25, -7.42, 2.35), 0.2),
        ],
    );
    let mut skin = join(skin, upper, 0.4);
    skin = join(skin, lower, 0.45);
    // The corners are drawn in.
    skin += 0.12 * swell(p, Vec3::new(8.5, -7.35, 2.5), Vec3::new(1.0, 0.8, 0.8));
    // Groove between nose and lip.
    skin += 0.14 * swell(p, Vec3::new(9.5, -6.2, 0.0), Vec3::new(1.0, 0.8, 0.5));
    skin + parting(p)
}

/// The line between the lips: a shallow wave that rises to the corners.
fn parting(p: Vec3) -> f32 {
    let t = p.z / 2.5;
    if t >= 1.0 {
        return 0.0;
    }
    let dip = ridge(p.z, 0.8);
    let off = p.y - (-7.42 - 0.12 * dip + 0.14 * t * t * t);
    0.15 * ridge(off, 0.22) * ((1.0 - t) * 3.0).min(1.0)
}
