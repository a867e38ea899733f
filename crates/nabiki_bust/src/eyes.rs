//! Brows, sockets and lidded eyes.

use glam::{Quat, Vec3};
use nabiki_groom::face;

use crate::shapes::{capsule, carve, join, ridge, swell, turned_ellipsoid};

/// Middle of the eyeball.
const EYE: Vec3 = Vec3::new(7.0, -0.75, 3.15);

/// Sinks the sockets, sets the lidded eyes into them and raises the brows.
pub(crate) fn add(p: Vec3, skin: f32) -> f32 {
    if p.x < 2.0 || p.y.abs() > 6.0 {
        return skin;
    }
    let mut skin = skin;
    // The socket is deepest between eye and nose; under the outer half of the brow it is full.
    skin += 0.5 * swell(p, Vec3::new(8.7, -0.5, 2.3), Vec3::new(2.2, 2.1, 2.3));
    skin -= 0.2 * swell(p, Vec3::new(7.9, 0.4, 4.2), Vec3::new(2.4, 1.5, 2.4));
    // Below the eye the lid goes over into the cheek without a trough.
    skin -= 0.14 * swell(p, Vec3::new(8.0, -3.1, 3.0), Vec3::new(2.4, 2.2, 2.6));
    // The brow's bone follows the upper rim, and sinks into the temple.
    let highest = Vec3::new(8.1, 1.35, 2.9);
    let inner = capsule(p, Vec3::new(8.5, 0.95, 1.2), highest, 0.2, 0.28);
    let outer = capsule(p, highest, Vec3::new(6.2, 0.9, 4.9), 0.28, -0.15);
    let brow = join(inner, outer, 1.0);
    skin = join(skin, brow, 1.5);
    let ball = |grown: f32| turned_ellipsoid(p, EYE, Vec3::new(1.3, 1.25, 1.62) + grown, Quat::from_rotation_y(-0.3));
    skin = join(skin, ball(0.16), 0.75);
    skin += crease(p);
    // No deeper than a lid is thick, at the corners too, where the eyeball is not behind it.
    skin = carve(skin, between_lids(p).max(-0.26 - skin), 0.07);
    skin = join(skin, ball(0.0), 0.05);
    skin - eyebrow(p)
}

/// Negative between the edges of the lids, seen from before the face.
fn between_lids(p: Vec3) -> f32 {
    let t = face::along_lids(p.z);
    let [upper, lower] = face::lid_edges(t.clamp(-1.0, 1.0));
    let beyond = (t.abs() - 1.0).max(0.0) * 1.53;
    let across = (p.y - upper).max(lower - p.y);
    0.8 * across + beyond
}

/// The fold that the upper lid makes where it is raised.
fn crease(p: Vec3) -> f32 {
    let t = face::along_lids(p.z);
    let bow = 1.0 - t * t / 1.2;
    if bow <= 0.0 {
        return 0.0;
    }
    let [upper, _] = face::lid_edges(t.clamp(-1.0, 1.0));
    let off = p.y - (upper + 0.14 + 0.24 * bow);
    0.065 * ridge(off, 0.3) * (2.0 * bow).min(1.0)
}

/// The eyebrow as a sculptor has it: a low ridge that rises outward and falls at its end.
fn eyebrow(p: Vec3) -> f32 {
    let t = face::along_brow(p.z);
    if !(0.0..=1.0).contains(&t) {
        return 0.0;
    }
    let off = p.y - face::brow_line(t);
    0.07 * ridge(off, 0.62 - 0.25 * t) * (t * 6.0).min(1.0) * ((1.0 - t) * 2.5).min(1.0)
}
