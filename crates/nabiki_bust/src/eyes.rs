//! Brows, sockets and closed eyes.

use glam::{Quat, Vec3};
use nabiki_groom::face;

use crate::shapes::{chain, join, ridge, swell, turned_ellipsoid};

/// Middle of the eyeball.
const EYE: Vec3 = Vec3::new(7.25, -0.85, 3.15);

/// Sinks the sockets, sets the lidded eyes into them and raises the brows.
pub(crate) fn add(p: Vec3, skin: f32) -> f32 {
    if p.x < 2.0 || p.y.abs() > 6.0 {
        return skin;
    }
    let mut skin = skin;
    // The socket is deepest between eye and nose; under the outer half of the brow it is full.
    skin += 0.6 * swell(p, Vec3::new(8.9, -0.7, 2.2), Vec3::new(2.2, 2.2, 2.2));
    skin -= 0.25 * swell(p, Vec3::new(7.9, 0.6, 4.1), Vec3::new(2.4, 1.5, 2.4));
    // The brow's bone follows the upper rim, and sinks into the temple.
    let brow = chain(
        p,
        &[
            (Vec3::new(8.55, 1.3, 1.4), 0.2),
            (Vec3::new(8.2, 1.75, 2.8), 0.28),
            (Vec3::new(7.1, 1.7, 4.4), 0.1),
            (Vec3::new(5.2, 0.8, 5.3), -0.6),
        ],
    );
    skin = join(skin, brow, 1.5);
    let ball = turned_ellipsoid(p, EYE, Vec3::new(1.3, 1.22, 1.6), Quat::from_rotation_y(-0.3));
    skin = join(skin, ball, 0.55);
    skin + lids(p) - eyebrow(p)
}

/// The line on which the closed lids meet hangs like a bow; a crease runs above it.
fn lids(p: Vec3) -> f32 {
    let t = face::along_lids(p.z);
    let bow = 1.0 - t * t;
    if bow <= -0.2 {
        return 0.0;
    }
    let open = bow.max(0.0).sqrt();
    let line = p.y - face::lid_line(t);
    let crease = p.y - (-0.6 + 0.1 * t + 0.62 * bow);
    // The lower lid lies a little behind the upper one.
    let below = (-line / 0.25).clamp(0.0, 1.0) * ridge(line, 1.2);
    open * (0.19 * ridge(line, 0.2) + 0.05 * below + 0.1 * ridge(crease, 0.3))
}

/// The eyebrow as a sculptor has it: a low ridge that rises outward and falls at its end.
fn eyebrow(p: Vec3) -> f32 {
    let t = face::along_brow(p.z);
    if !(0.0..=1.0).contains(&t) {
        return 0.0;
    }
    let off = p.y - face::brow_line(t);
    0.1 * ridge(off, 0.62 - 0.25 * t) * (t * 6.0).min(1.0) * ((1.0 - t) * 2.5).min(1.0)
}
