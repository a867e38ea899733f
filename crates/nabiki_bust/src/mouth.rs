//! The lips.

use glam::Vec3;
use nabiki_groom::face;

use crate::shapes::{chain, join, ridge, swell};

/// Joins the lips to the face and parts them with a line.
pub(crate) fn add(p: Vec3, skin: f32) -> f32 {
    if p.x < 5.0 || p.y > -4.0 || p.y < -11.0 {
        return skin;
    }
    let upper = chain(
        p,
        &[
            (Vec3::new(9.55, -7.0, 0.0), 0.46),
            (Vec3::new(9.56, -6.93, 0.5), 0.5),
            (Vec3::new(9.18, -7.05, 1.4), 0.45),
            (Vec3::new(8.25, -7.25, 2.5), 0.18),
        ],
    );
    let lower = chain(
        p,
        &[
            (Vec3::new(9.35, -8.02, 0.0), 0.58),
            (Vec3::new(9.27, -8.0, 0.6), 0.58),
            (Vec3::new(8.9, -7.78, 1.5), 0.44),
            (Vec3::new(8.2, -7.33, 2.45), 0.2),
        ],
    );
    let mut skin = join(skin, upper, 0.4);
    skin = join(skin, lower, 0.45);
    // The corners are drawn in.
    skin += 0.07 * swell(p, Vec3::new(8.3, -7.22, 2.75), Vec3::new(1.2, 1.1, 1.1));
    // Groove between nose and lip.
    skin += 0.14 * swell(p, Vec3::new(9.5, -6.25, 0.0), Vec3::new(1.0, 0.7, 0.7));
    skin + parting(p) - vermilion(p)
}

/// The line between the lips: a shallow wave that rises to the corners.
fn parting(p: Vec3) -> f32 {
    let t = face::along_lips(p.z);
    if t >= 1.0 {
        return 0.0;
    }
    let dip = ridge(p.z, 0.8);
    let off = p.y - (-7.42 - 0.12 * dip + 0.24 * t * t * t);
    0.13 * ridge(off, 0.24) * ((1.0 - t) * 3.0).min(1.0)
}

/// The red of the lips stands out a little from the skin about it, with the bow of the upper lip.
fn vermilion(p: Vec3) -> f32 {
    let t = face::along_lips(p.z);
    if t >= 1.0 {
        return 0.0;
    }
    let [upper, lower] = face::lip_edges(p.z, t);
    let rise = |depth: f32| {
        let s = (depth / 0.22).clamp(0.0, 1.0);
        s * s * (3.0 - 2.0 * s)
    };
    0.085 * rise(upper - p.y) * rise(p.y - lower) * ((1.0 - t) * 4.0).min(1.0)
}
