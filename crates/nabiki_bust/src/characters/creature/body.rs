//! The creature's shape.

use glam::{Quat, Vec3};

use crate::one_side;
use crate::shapes::{capsule, carve, ellipsoid, join, limb, turned_ellipsoid};

/// From the rump to the tip, with the radius there.
#[rustfmt::skip]
pub(super) const TAIL: [(Vec3, f32); 5] = [
    (Vec3::new(-33.0, 6.5, 0.0), 3.8), (Vec3::new(-43.0, 6.0, 0.0), 3.4), (Vec3::new(-53.0, 2.0, 0.0), 3.2),
    (Vec3::new(-62.0, -3.5, 0.0), 2.7), (Vec3::new(-71.0, -7.0, 0.0), 1.6),
];

/// From the shoulder, and from the hip, down to the paw.
#[rustfmt::skip]
pub(super) const FORE: [(Vec3, f32); 5] = [
    (Vec3::new(16.5, -2.0, 6.4), 6.2), (Vec3::new(13.0, -15.0, 7.0), 4.4), (Vec3::new(15.0, -25.0, 6.9), 3.0),
    (Vec3::new(15.8, -31.0, 6.8), 2.7), (Vec3::new(17.6, -33.8, 6.8), 2.7),
];
#[rustfmt::skip]
pub(super) const HIND: [(Vec3, f32); 5] = [
    (Vec3::new(-22.0, 0.0, 6.2), 7.4), (Vec3::new(-17.5, -13.5, 7.2), 5.2), (Vec3::new(-23.5, -23.0, 7.0), 3.0),
    (Vec3::new(-22.8, -31.0, 6.9), 2.6), (Vec3::new(-20.6, -33.8, 6.9), 2.7),
];

pub(super) fn skin(p: Vec3) -> f32 {
    let p = one_side(p);
    let mut skin = trunk(p);
    skin = join(skin, leg(p, &FORE), 4.0);
    skin = join(skin, leg(p, &HIND), 4.5);
    skin = join(skin, limb(p, &TAIL, 1.0), 4.0);
    skin = join(skin, neck(p), 5.0);
    let skin = head(p, skin);
    // Flat soles.
    carve(skin, p.y + 36.0, 0.8)
}

pub(super) fn trunk(p: Vec3) -> f32 {
    // Deeper than broad.
    let p = Vec3::new(p.x, p.y, 1.18 * p.z);
    limb(
        p,
        &[
            (Vec3::new(-26.0, 1.0, 0.0), 10.0),
            (Vec3::new(-9.0, -0.5, 0.0), 11.0),
            (Vec3::new(8.0, -1.0, 0.0), 12.0),
            (Vec3::new(18.0, 1.5, 0.0), 11.0),
        ],
        2.0,
    )
}

pub(super) fn leg(p: Vec3, points: &[(Vec3, f32); 5]) -> f32 {
    if p.distance_squared(points[2].0) > 1600.0 {
        return p.distance(points[2].0) - 25.0;
    }
    limb(p, points, 1.0)
}

fn neck(p: Vec3) -> f32 {
    limb(
        p,
        &[(Vec3::new(17.0, 3.5, 0.0), 9.6), (Vec3::new(27.5, 11.5, 0.0), 7.4), (Vec3::new(36.5, 20.0, 0.0), 6.0)],
        1.5,
    )
}

fn head(p: Vec3, skin: f32) -> f32 {
    let away = p.distance(Vec3::new(42.0, 22.0, 0.0));
    if away > 24.0 {
        return skin;
    }
    let skull = ellipsoid(p, Vec3::new(40.0, 21.3, 0.0), Vec3::new(7.6, 6.3, 6.3));
    let cheek = ellipsoid(p, Vec3::new(41.0, 18.6, 3.4), Vec3::new(4.6, 3.6, 3.0));
    let muzzle = capsule(p, Vec3::new(44.5, 19.0, 0.0), Vec3::new(52.6, 16.9, 0.0), 3.5, 2.2);
    let jaw = capsule(p, Vec3::new(43.0, 16.6, 0.0), Vec3::new(51.0, 15.4, 0.0), 2.3, 1.5);
    let brow = capsule(p, Vec3::new(46.2, 23.4, 1.6), Vec3::new(43.6, 23.8, 4.6), 0.9, 0.8);
    let mut skin = join(skin, join(skull, cheek, 2.5), 4.0);
    skin = join(skin, join(muzzle, jaw, 1.2), 2.6);
    skin = join(skin, brow, 1.6);
    skin = join(skin, nose(p), 0.6);
    let socket = ellipsoid(p, Vec3::new(46.6, 22.0, 3.9), Vec3::new(1.5, 1.1, 1.2));
    skin = carve(skin, socket, 0.8);
    skin = join(skin, eye(p), 0.15);
    ear(p, skin)
}

fn nose(p: Vec3) -> f32 {
    ellipsoid(p, Vec3::new(54.6, 17.6, 0.0), Vec3::new(1.1, 1.0, 1.4))
}

fn eye(p: Vec3) -> f32 {
    ellipsoid(p, Vec3::new(45.35, 21.9, 3.3), Vec3::splat(1.25))
}

/// Eyes and nose a little larger: what is drawn dark.
pub(super) fn dark(p: Vec3) -> f32 {
    let p = one_side(p);
    nose(p).min(eye(p)) - 0.06
}

fn ear(p: Vec3, skin: f32) -> f32 {
    // A leaf that opens forward and outward.
    let turn = Quat::from_rotation_y(-0.55) * Quat::from_rotation_x(0.3) * Quat::from_rotation_z(0.12);
    let center = Vec3::new(36.8, 28.6, 5.0);
    let leaf = turned_ellipsoid(p, center, Vec3::new(1.3, 5.2, 2.9), turn);
    let hollow = turned_ellipsoid(p, center + turn * Vec3::new(1.5, 0.3, 0.0), Vec3::new(1.5, 4.2, 2.0), turn);
    join(skin, carve(leaf, hollow, 0.4), 1.4)
}
