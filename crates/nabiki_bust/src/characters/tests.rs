//! What holds for every character: closed skins, whole shares, a first frame as sculpted, and smooth motion.

use std::collections::HashMap;

use glam::{Affine3A, Quat, Vec3};

use super::net::Skin;
use super::rig::{Joint, Move, Shares};
use super::{creature, talker, walker};

/// A torus, as a field.
fn ring(p: Vec3) -> f32 {
    glam::Vec2::new(glam::Vec2::new(p.x, p.y).length() - 4.0, p.z).length() - 1.5
}

fn assert_closed(skin: &Skin) {
    let mut edges: HashMap<[u32; 2], i32> = HashMap::new();
    for &[a, b, c] in &skin.triangles {
        for edge in [[a, b], [b, c], [c, a]] {
            *edges.entry(edge).or_default() += 1;
        }
    }
    for (&[a, b], &count) in &edges {
        assert!(count == 1 && edges.get(&[b, a]) == Some(&1), "the edge from {a} to {b}");
    }
}

/// Surface nets and fewer triangles keep a torus a torus: closed, of Euler number 0, outside outward, on the zero set.
#[test]
fn a_skin_is_closed_and_keeps_its_holes() {
    const AXIS: crate::grid::Axis = &[(-7.0, 0.3), (7.0, 0.0)];
    let skin = super::net::mesh(&ring, [AXIS; 3], 700, &|_| 1.0);
    assert_closed(&skin);
    let (vertices, triangles) = (skin.places.len() as i64, skin.triangles.len() as i64);
    assert_eq!(vertices - triangles * 3 / 2 + triangles, 0);
    assert!((650..=700).contains(&vertices), "{vertices}");
    for (&p, normal) in skin.places.iter().zip(skin.normals()) {
        assert!(ring(p).abs() < 0.01, "{p}");
        assert!(ring(p + 0.2 * normal) > 0.15, "{p}: {normal}");
    }
}

#[test]
fn shares_are_255_in_all() {
    for i in 0..200 {
        let share = |n: i32| (i as f32 * 0.618_034 * n as f32).fract();
        let shares = (1..7).fold(Shares::on(0), |shares, n| shares.over(n as usize, share(n)));
        let (joints, shares) = shares.bytes();
        assert_eq!(shares.iter().map(|&s| u32::from(s)).sum::<u32>(), 255);
        assert!(joints.iter().zip(shares).all(|(&joint, share)| share > 0 || joint == 0));
    }
}

/// Where each joint has the place of its own rest (cm), in one frame.
fn places(joints: &[Joint], moves: &[Move]) -> Vec<Vec3> {
    let mut all: Vec<Affine3A> = Vec::new();
    for (joint, moved) in joints.iter().zip(moves) {
        let (above, from) = match joint.above {
            Some(above) => (all[above], joints[above].place),
            None => (Affine3A::IDENTITY, Vec3::ZERO),
        };
        let below = Affine3A::from_rotation_translation(moved.turn, joint.place - from + moved.way);
        all.push(above * below);
    }
    all.iter().map(|joint| joint.translation.into()).collect()
}

/// Hair is placed on the skin as sculpted and begins there, so that is the first frame. And hair feels accelerations: none is
/// a jump. The largest here are those of the shake.
#[test]
fn motion_begins_as_sculpted_and_is_smooth() {
    for (name, joints, frames) in [walker::moving(), talker::moving(), creature::moving()] {
        for moved in &frames[0] {
            assert_eq!((moved.turn, moved.way), (Quat::IDENTITY, Vec3::ZERO), "{name}");
        }
        let places: Vec<Vec<Vec3>> = frames.iter().map(|frame| places(joints, frame)).collect();
        for (j, joint) in joints.iter().enumerate() {
            let at = |n: usize| places[n][j];
            for n in 1..frames.len() - 1 {
                // cm / frame^2; the earth's gravity is 1.7.
                let acceleration = at(n + 1) - 2.0 * at(n) + at(n - 1);
                assert!(acceleration.length() < 2.0, "{name}, {} in frame {n}: {acceleration}", joint.name);
            }
        }
    }
}
