//! Torso, arms and clothes of the walker, blended onto the bust.

use glam::Vec3;

use crate::shapes::{carve, ellipsoid, join, limb, swell};
use crate::{one_side, uncut};

/// Where the right arm turns, and its elbow.
pub(super) const SHOULDER: Vec3 = Vec3::new(-4.9, -26.4, 16.6);
const ELBOW: Vec3 = Vec3::new(-6.2, -56.0, 21.8);

/// Where arms and torso are cut off.
const WAIST: f32 = -58.5;

/// The cloth's thickness (cm).
const CLOTH: f32 = 0.35;

pub(super) fn skin(p: Vec3) -> f32 {
    let p = one_side(p);
    let body = join(join(uncut(p), torso(p), 4.0), arm(p), 2.6);
    carve(body, p.y - WAIST, 1.0)
}

/// The top: the torso a little larger, without arms, below the neckline.
pub(super) fn top(p: Vec3) -> f32 {
    let p = one_side(p);
    let body = join(if p.y < -14.0 { uncut(p) } else { 20.0 }, torso(p), 4.0) - CLOTH;
    let cut = openings(p).into_iter().fold(body, |cut, opening| carve(cut, opening, 0.3));
    carve(carve(cut, -14.0 - p.y, 0.3), p.y - WAIST + 0.5, 0.3)
}

/// Neckline and armhole, negative within. The neckline is a bow, lower before than behind; straps go over the shoulders beside
/// the neck.
fn openings(p: Vec3) -> [f32; 2] {
    let before = super::smooth(p.x, -10.0, 0.0);
    let neckline = ellipsoid(p, Vec3::new(p.x, -17.5, 0.0), Vec3::new(10.0, 8.5 + 5.0 * before, 8.6));
    [neckline, ellipsoid(p, Vec3::new(-4.6, -26.5, 18.2), Vec3::new(12.0, 10.8, 5.6))]
}

/// The hems are seen as lines, so the mesh follows them most.
pub(super) fn by_the_hem(p: Vec3) -> f32 {
    let [neckline, armhole] = openings(one_side(p));
    0.5 + 6.0 * super::smooth(-neckline.abs().min(armhole.abs()), -1.2, -0.5)
}

fn torso(p: Vec3) -> f32 {
    if p.y > -10.0 {
        return p.y + 20.0;
    }
    // Broader than deep.
    let narrow = Vec3::new(p.x, p.y, 0.7 * p.z);
    let trunk = limb(
        narrow,
        &[
            (Vec3::new(-4.8, -30.0, 0.0), 8.9),
            (Vec3::new(-4.4, -40.0, 0.0), 8.8),
            (Vec3::new(-4.0, -50.0, 0.0), 7.9),
            (Vec3::new(-4.2, -64.0, 0.0), 9.6),
        ],
        1.2,
    );
    let breast = ellipsoid(p, Vec3::new(1.4, -37.0, 6.6), Vec3::new(4.4, 5.0, 5.2));
    let skin = join(trunk, breast, 4.5);
    // Shoulder blades, and the furrow of the spine between them.
    let skin = skin - 0.5 * swell(p, Vec3::new(-12.5, -31.0, 7.0), Vec3::new(4.0, 7.0, 4.5));
    skin + 0.45 * swell(p, Vec3::new(-13.0, -42.0, 0.0), Vec3::new(4.0, 18.0, 2.6))
}

fn arm(p: Vec3) -> f32 {
    limb(p, &[(SHOULDER, 3.9), (SHOULDER.lerp(ELBOW, 0.35), 3.8), (SHOULDER.lerp(ELBOW, 0.7), 3.4), (ELBOW, 3.1)], 1.0)
}

/// How much of a place of the right half goes with the arm.
pub(super) fn of_arm(p: Vec3) -> f32 {
    super::smooth(torso(p).min(4.0) - arm(p), -2.0, 3.2)
}
