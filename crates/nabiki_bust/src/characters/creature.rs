//! The creature: a calm animal with long fur, a mane and a bushy tail, that looks about and shakes itself.

mod body;
mod fur;
mod motion;

use glam::Vec3;

use super::glb::{Character, Mesh};
use super::rig::{Joint, Shares, smooth};
use super::{glb, hair, net};
use crate::grid::Axis;

// Places in the list of joints.
const LOIN: usize = 1;
const CHEST: usize = 2;
const NECK: usize = 3;
const NAPE: usize = 4;
const HEAD: usize = 5;
const EAR: [usize; 2] = [6, 7];
const TAIL: [usize; 4] = [8, 9, 10, 11];
/// Upper and lower legs: fore right and left, hind right and left.
const LEG: [[usize; 2]; 4] = [[12, 13], [14, 15], [16, 17], [18, 19]];

const fn leg(name: &'static str, above: usize, place: Vec3, side: f32) -> Joint {
    Joint { name, above: Some(above), place: Vec3::new(place.x, place.y, side * place.z) }
}

#[rustfmt::skip]
static JOINTS: [Joint; 20] = [
    Joint { name: "pelvis", above: None, place: Vec3::new(-22.0, 3.0, 0.0) },
    Joint { name: "loin", above: Some(0), place: Vec3::new(-10.0, 4.0, 0.0) },
    Joint { name: "chest", above: Some(LOIN), place: Vec3::new(4.0, 4.0, 0.0) },
    Joint { name: "neck", above: Some(CHEST), place: Vec3::new(21.0, 6.0, 0.0) },
    Joint { name: "nape", above: Some(NECK), place: Vec3::new(29.0, 13.5, 0.0) },
    Joint { name: "head", above: Some(NAPE), place: Vec3::new(36.0, 20.0, 0.0) },
    Joint { name: "right ear", above: Some(HEAD), place: Vec3::new(37.0, 26.0, 4.2) },
    Joint { name: "left ear", above: Some(HEAD), place: Vec3::new(37.0, 26.0, -4.2) },
    Joint { name: "tail 1", above: Some(0), place: body::TAIL[0].0 },
    Joint { name: "tail 2", above: Some(TAIL[0]), place: body::TAIL[1].0 },
    Joint { name: "tail 3", above: Some(TAIL[1]), place: body::TAIL[2].0 },
    Joint { name: "tail 4", above: Some(TAIL[2]), place: body::TAIL[3].0 },
    leg("right arm", CHEST, body::FORE[0].0, 1.0),
    leg("right forearm", LEG[0][0], body::FORE[1].0, 1.0),
    leg("left arm", CHEST, body::FORE[0].0, -1.0),
    leg("left forearm", LEG[1][0], body::FORE[1].0, -1.0),
    leg("right thigh", 0, body::HIND[0].0, 1.0),
    leg("right shank", LEG[2][0], body::HIND[1].0, 1.0),
    leg("left thigh", 0, body::HIND[0].0, -1.0),
    leg("left shank", LEG[3][0], body::HIND[1].0, -1.0),
];

/// Its origin above the ground (cm).
const HEIGHT: Vec3 = Vec3::new(0.0, 36.5, 0.0);
const VERTICES: usize = 4300;

const ALONG_X: Axis = &[(-76.0, 0.8), (33.0, 0.45), (58.0, 0.0)];
const ALONG_Y: Axis = &[(-39.0, 0.7), (14.0, 0.45), (37.0, 0.0)];
const ALONG_Z: Axis = &[(-16.0, 0.7), (-8.0, 0.5), (8.0, 0.7), (16.0, 0.0)];

const ALONG_Z_OF_EYES: Axis = &[(-6.0, 0.2), (6.0, 0.0)];

fn skin() -> net::Skin {
    net::mesh(&body::skin, [ALONG_X, ALONG_Y, ALONG_Z], VERTICES, &|p| 0.5 + 4.0 * smooth(p.x, 32.0, 42.0))
}

/// The file of the body.
pub(super) fn glb() -> Vec<u8> {
    let skin = skin();
    let shares = skin.places.iter().map(|&p| shares(p)).collect();
    let dark = net::mesh(
        &body::dark,
        [&[(43.0, 0.2), (57.0, 0.0)], &[(15.0, 0.2), (24.0, 0.0)], ALONG_Z_OF_EYES],
        420,
        &|_| 1.0,
    );
    let on_head = dark.places.iter().map(|_| Shares::on(HEAD)).collect();
    glb::write(&Character {
        clip: "shake",
        joints: &JOINTS,
        meshes: vec![
            Mesh { name: "body", skin: &skin, shares, morphs: vec![] },
            Mesh { name: "eyes and nose", skin: &dark, shares: on_head, morphs: vec![] },
        ],
        frames: motion::frames(),
        at: HEIGHT,
    })
}

/// The file of the fur.
pub(super) fn fur() -> Vec<u8> {
    hair::write(&fur::strands(&skin()), HEIGHT)
}

/// How the skin hangs on the joints.
fn shares(p: Vec3) -> Shares {
    let side = usize::from(p.z < 0.0);
    let right = p.with_z(p.z.abs());
    let mut shares = Shares::on(0).over(LOIN, smooth(p.x, -19.0, -5.0)).over(CHEST, smooth(p.x, -5.0, 10.0));
    // Planes across the neck, which rises at 45 degrees.
    let up = 0.7 * (p.x - 21.0) + 0.7 * (p.y - 6.0);
    shares =
        shares.over(NECK, smooth(up, -3.5, 5.0)).over(NAPE, smooth(up, 6.0, 15.0)).over(HEAD, smooth(up, 16.0, 23.0));
    let ear = smooth(p.y, 26.0, 29.0) * smooth(right.z, 1.5, 3.0);
    shares = shares.over(EAR[side], ear);
    for (n, &joint) in TAIL.iter().enumerate() {
        let at = body::TAIL[n].0.x;
        let half = if n == 0 { 3.0 } else { 5.0 };
        let off_rump = smooth(p.y, -8.0, -2.0);
        shares = shares.over(joint, smooth(-p.x, -at - half, -at + half) * off_rump);
    }
    for (legs, points) in [(0, &body::FORE), (2, &body::HIND)] {
        let [upper, lower] = LEG[legs + side];
        let upper_share = smooth(body::trunk(right) - body::leg(right, points), -3.0, 5.0) * smooth(-p.y, 2.0, 11.0);
        let (knee, half) = (points[1].0.y, 4.0);
        shares = shares.over(upper, upper_share).over(lower, upper_share * smooth(-p.y, -knee - half, -knee + half));
    }
    shares
}

/// Its name, its joints and what they do.
#[cfg(test)]
pub(super) fn moving() -> (&'static str, &'static [Joint], Vec<Vec<super::rig::Move>>) {
    ("creature", &JOINTS, motion::frames())
}
