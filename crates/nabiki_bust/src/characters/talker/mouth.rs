//! A mouth that can open: lips a little apart with a hollow behind them, what of the face goes with the jaw, and how lips
//! smile and round.

use glam::Vec3;
use nabiki_groom::face;

use super::smooth;
use crate::field;
use crate::shapes::{carve, ellipsoid, join, swell};

/// Where the jaw turns, before the ear.
pub(super) const HINGE: Vec3 = Vec3::new(0.3, -3.0, 0.0);

pub(super) fn skin(p: Vec3) -> f32 {
    let skin = field(p);
    if p.x < 2.0 || p.y > -4.0 || p.y < -11.0 || p.z.abs() > 5.0 {
        return skin;
    }
    let parting = parting(p.z);
    let slit = ellipsoid(p, Vec3::new(7.4, parting, 0.0), Vec3::new(2.7, 0.17, 2.45));
    let hollow = ellipsoid(p, Vec3::new(6.0, -7.25, 0.0), Vec3::new(2.0, 1.0, 2.0));
    carve(skin, join(slit, hollow, 0.3), 0.16)
}

fn parting(z: f32) -> f32 {
    face::lip_parting(z.abs(), face::along_lips(z.abs()).min(1.0))
}

/// How much of a place goes with the jaw: what lies below a line from the hinge to between the lips. The border is sharp at
/// the lips and softer the farther from them.
pub(super) fn of_jaw(p: Vec3) -> f32 {
    let z = p.z.abs();
    let along = ((p.x - HINGE.x) / (7.6 - HINGE.x)).clamp(0.0, 1.0);
    let line = HINGE.y + (parting(p.z) - HINGE.y) * along;
    let away = (z - 2.2).max(7.0 - p.x).max(0.0);
    let half = 0.1 + 0.5 * away;
    let below = smooth(line - p.y, -half, half);
    let above_neck = smooth(p.y - 0.25 * (p.x - 6.0), -14.5, -10.5);
    let before_ear = smooth(p.x, -1.5, 3.0);
    below * above_neck * before_ear
}

/// Corners up and out, cheeks fuller.
pub(super) fn smile(p: Vec3) -> Vec3 {
    let (side, right) = (p.z.signum(), p.with_z(p.z.abs()));
    let corner = swell(right, Vec3::new(7.6, -7.1, 3.0), Vec3::new(3.0, 2.2, 2.6));
    let cheek = swell(right, Vec3::new(7.4, -4.6, 4.4), Vec3::new(3.0, 2.4, 2.6));
    let way = corner * Vec3::new(-0.5, 0.55, 0.55) + cheek * Vec3::new(0.2, 0.28, 0.12);
    way * Vec3::new(1.0, 1.0, side)
}

/// Lips forward and together.
pub(super) fn round(p: Vec3) -> Vec3 {
    let lips = swell(p, Vec3::new(8.4, -7.15, 0.0), Vec3::new(2.6, 2.4, 3.9));
    Vec3::new(0.45, 0.0, -0.22 * p.z) * lips
}
