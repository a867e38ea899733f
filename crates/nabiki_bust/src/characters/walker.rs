//! The walker: the bust with a torso and upper arms, in a top, who walks, looks over her shoulder and nods.

mod body;
mod motion;

use glam::Vec3;

use super::glb::{Character, Mesh, write};
use super::net;
use super::rig::{Joint, Shares, smooth};
use crate::grid::Axis;

// Places in the list of joints.
const SPINE: usize = 1;
const CHEST: usize = 2;
const NECK: usize = 3;
const HEAD: usize = 4;
const COLLAR: [usize; 2] = [5, 7];
const ARM: [usize; 2] = [6, 8];

#[rustfmt::skip]
static JOINTS: [Joint; 9] = [
    Joint { name: "pelvis", above: None, place: Vec3::new(-4.2, -64.0, 0.0) },
    Joint { name: "spine", above: Some(0), place: Vec3::new(-4.2, -54.0, 0.0) },
    Joint { name: "chest", above: Some(SPINE), place: Vec3::new(-4.6, -40.0, 0.0) },
    Joint { name: "neck", above: Some(CHEST), place: Vec3::new(-5.2, -19.5, 0.0) },
    Joint { name: "head", above: Some(NECK), place: Vec3::new(-2.6, -9.0, 0.0) },
    Joint { name: "right collar", above: Some(CHEST), place: Vec3::new(-2.4, -22.5, 2.5) },
    Joint { name: "right arm", above: Some(COLLAR[0]), place: body::SHOULDER },
    Joint { name: "left collar", above: Some(CHEST), place: Vec3::new(-2.4, -22.5, -2.5) },
    Joint { name: "left arm", above: Some(COLLAR[1]), place: Vec3::new(body::SHOULDER.x, body::SHOULDER.y, -body::SHOULDER.z) },
];

/// Her head's origin above the ground (cm).
const HEIGHT: f32 = 158.0;
const VERTICES: usize = 8000;
const VERTICES_OF_TOP: usize = 2200;

const ALONG_X: Axis = &[(-18.0, 0.6), (-5.0, 0.3), (0.4, 0.4), (4.5, 0.3), (6.7, 0.16), (11.0, 0.3), (13.0, 0.0)];
const ALONG_Y: Axis = &[
    (-61.0, 0.7),
    (-20.0, 0.5),
    (-11.0, 0.25),
    (-8.8, 0.17),
    (-4.8, 0.2),
    (-1.9, 0.11),
    (0.6, 0.18),
    (3.0, 0.5),
    (12.6, 0.0),
];
const ALONG_Z: Axis = &[
    (-28.0, 0.7),
    (-10.0, 0.5),
    (-9.4, 0.2),
    (-6.8, 0.3),
    (-5.2, 0.2),
    (5.2, 0.3),
    (6.8, 0.2),
    (9.4, 0.5),
    (10.0, 0.7),
    (28.0, 0.0),
];

/// The top's, fine where its hems are.
const TOP: [Axis; 3] = [
    &[(-18.0, 0.45), (8.0, 0.0)],
    &[(-61.0, 0.8), (-40.0, 0.3), (-13.0, 0.0)],
    &[(-20.0, 0.6), (-17.0, 0.35), (17.0, 0.6), (20.0, 0.0)],
];

/// The file.
pub(super) fn glb() -> Vec<u8> {
    let skin = net::mesh(&body::skin, [ALONG_X, ALONG_Y, ALONG_Z], VERTICES, &care);
    let top = net::mesh(&body::top, TOP, VERTICES_OF_TOP, &body::by_the_hem);
    let of = |skin: &net::Skin| skin.places.iter().map(|&p| shares(p)).collect();
    write(&Character {
        clip: "walk",
        joints: &JOINTS,
        meshes: vec![
            Mesh { name: "body", skin: &skin, shares: of(&skin), morphs: vec![] },
            Mesh { name: "top", skin: &top, shares: of(&top), morphs: vec![] },
        ],
        frames: motion::frames(),
        at: HEIGHT * Vec3::Y,
    })
}

/// The face is looked at; the scalp is under hair.
fn care(p: Vec3) -> f32 {
    let face = smooth(p.x, 3.0, 6.0) * smooth(p.y, -14.0, -10.0) * smooth(-p.y, -5.0, -2.5);
    let features = smooth(p.x, 6.3, 7.2) * smooth(p.y, -9.6, -8.4) * smooth(-p.y, -1.8, -1.0);
    let torso = smooth(-p.y, 12.0, 20.0);
    0.4 + 5.0 * face + 14.0 * features + 0.6 * torso
}

/// How the skin hangs on the joints.
fn shares(p: Vec3) -> Shares {
    let side = usize::from(p.z < 0.0);
    let right = p.with_z(p.z.abs());
    // Planes that rise toward the back, so that the chin goes with the head and the nape with the neck.
    let head = smooth(p.y + 0.6 * (p.x + 2.0), -17.0, -9.5);
    let neck = smooth(p.y + 0.25 * (p.x + 4.0), -23.5, -15.5);
    let chest = smooth(p.y, -52.0, -38.0);
    let spine = smooth(p.y, -63.0, -52.0);
    let collar = smooth(right.z, 2.5, 12.0) * smooth(p.y, -34.0, -25.0) * smooth(-p.y, 13.0, 19.0);
    let arm = body::of_arm(right) * smooth(right.z, 9.0, 14.0);
    Shares::on(0)
        .over(SPINE, spine)
        .over(CHEST, chest)
        .over(NECK, neck)
        .over(HEAD, head)
        .over(COLLAR[side], collar)
        .over(ARM[side], arm)
}

/// Its name, its joints and what they do.
#[cfg(test)]
pub(super) fn moving() -> (&'static str, &'static [Joint], Vec<Vec<super::rig::Move>>) {
    ("walker", &JOINTS, motion::frames())
}
