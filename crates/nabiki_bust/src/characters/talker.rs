//! The talker: the bust with lips that part, who speaks, smiles and nods, and has a beard.

mod beard;
mod motion;
mod mouth;

use glam::Vec3;

use super::glb::{Character, Mesh};
use super::rig::{Joint, Shares, smooth};
use super::{glb, hair, net};
use crate::grid::Axis;

// Places in the list of joints.
const NECK: usize = 1;
const HEAD: usize = 2;
const JAW: usize = 3;

static JOINTS: [Joint; 4] = [
    Joint { name: "chest", above: None, place: Vec3::new(-4.6, -30.0, 0.0) },
    Joint { name: "neck", above: Some(0), place: Vec3::new(-5.2, -19.5, 0.0) },
    Joint { name: "head", above: Some(NECK), place: Vec3::new(-2.6, -9.0, 0.0) },
    Joint { name: "jaw", above: Some(HEAD), place: mouth::HINGE },
];

/// His head's origin above the ground (cm).
const HEIGHT: Vec3 = Vec3::new(0.0, 165.0, 0.0);
const VERTICES: usize = 6600;

const ALONG_X: Axis = &[(-14.0, 0.6), (-4.6, 0.24), (0.4, 0.4), (4.5, 0.25), (6.7, 0.14), (10.9, 0.3), (13.0, 0.0)];
const ALONG_Y: Axis = &[
    (-33.0, 0.7),
    (-20.0, 0.5),
    (-11.0, 0.25),
    (-8.8, 0.12),
    (-7.7, 0.06),
    (-6.5, 0.12),
    (-4.6, 0.2),
    (-1.9, 0.1),
    (0.6, 0.18),
    (3.0, 0.5),
    (12.6, 0.0),
];
const ALONG_Z: Axis =
    &[(-21.0, 0.7), (-9.4, 0.2), (-6.8, 0.3), (-5.2, 0.17), (5.2, 0.3), (6.8, 0.2), (9.4, 0.7), (21.0, 0.0)];

fn skin() -> net::Skin {
    net::mesh(&mouth::skin, [ALONG_X, ALONG_Y, ALONG_Z], VERTICES, &care)
}

/// The file of the head.
pub(super) fn glb() -> Vec<u8> {
    let skin = skin();
    let shares = skin.places.iter().map(|&p| shares(p)).collect();
    let (frames, [smile, round]) = motion::frames();
    let morph = |of: fn(Vec3) -> Vec3| skin.places.iter().map(|&p| of(p)).collect();
    let morphs = vec![("smile", morph(mouth::smile), smile), ("round", morph(mouth::round), round)];
    glb::write(&Character {
        clip: "talk",
        joints: &JOINTS,
        meshes: vec![Mesh { name: "head and shoulders", skin: &skin, shares, morphs }],
        frames,
        at: HEIGHT,
    })
}

/// The file of beard and brows.
pub(super) fn beard() -> Vec<u8> {
    hair::write(&beard::strands(&skin()), HEIGHT)
}

/// The face is looked at most.
fn care(p: Vec3) -> f32 {
    let face = smooth(p.x, 2.0, 5.0) * smooth(p.y, -14.0, -10.0) * smooth(-p.y, -5.0, -2.5);
    let features = smooth(p.x, 6.0, 7.0) * smooth(p.y, -9.6, -8.4) * smooth(-p.y, -1.8, -1.0);
    0.5 + 4.0 * face + 12.0 * features
}

fn shares(p: Vec3) -> Shares {
    let head = smooth(p.y + 0.6 * (p.x + 2.0), -17.0, -9.5);
    let neck = smooth(p.y + 0.25 * (p.x + 4.0), -24.5, -15.5);
    Shares::on(0).over(NECK, neck).over(HEAD, head).over(JAW, mouth::of_jaw(p))
}

/// Its name, its joints and what they do.
#[cfg(test)]
pub(super) fn moving() -> (&'static str, &'static [Joint], Vec<Vec<super::rig::Move>>) {
    ("talker", &JOINTS, motion::frames().0)
}
