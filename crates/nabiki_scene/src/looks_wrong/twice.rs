//! Heads and bodies that are where their file has them in the first frame, and whose motion, from the same file, moves
//! them as if they were at its origin or faced another way.

use std::path::Path;

use glam::Quat;
use nabiki::Pose;
use nabiki::body::BodyWay;
use nabiki_io::exchange::carries_mesh;
use nabiki_io::motion::{MotionSource, clip_carries};
use nabiki_io::{Placement, mesh};

use super::{Advice, Fix};
use crate::built::{BuiltScene, holds_scenes};
use crate::scene::HeadSource;

/// A mesh nearer than this (cm) and turned by less than this (rad) is in its place.
const NEAR: f32 = 0.1;
const TURNED: f32 = 0.01;

/// A mesh and its motion.
struct Moved<'a> {
    /// The table of its settings, and the key that fixes it, if one does.
    table: String,
    key: Option<&'static str>,
    mesh: &'a Path,
    groups: &'a [String],
    motion: &'a MotionSource,
    /// The placement of its file, and its pose in frame 0.
    placement: Placement,
    first: Pose,
}

/// What is moved twice, the head first.
pub(super) fn carried_twice(built: &BuiltScene) -> impl Iterator<Item = Advice> {
    let scene = &built.scene;
    let head = match (&scene.head.source, &scene.head.motion) {
        (HeadSource::Imported(head), Some(motion)) => Some(Moved {
            table: "head".to_owned(),
            key: Some("head.motion.bind_at_start"),
            mesh: &head.mesh,
            groups: &head.groups,
            motion,
            placement: built.model.placement,
            first: built.pose(0),
        }),
        _ => None,
    };
    let bodies = built.bodies.iter().zip(&scene.bodies).enumerate().filter_map(|(i, (body, settings))| {
        let (BodyWay::InWorld(poses), Some(motion)) = (&body.way, &settings.motion) else { return None };
        Some(Moved {
            table: format!("body[{i}]"),
            key: None,
            mesh: &settings.mesh,
            groups: &settings.groups,
            motion,
            placement: body.placement,
            first: *poses.first()?,
        })
    });
    head.into_iter().chain(bodies).filter_map(|moved| twice(built, &moved).or_else(|| askew(built, &moved)))
}

/// A mesh that is bound where its file has it, and moved as if the world of that file faced another way.
fn askew(built: &BuiltScene, moved: &Moved<'_>) -> Option<Advice> {
    let Moved { table, mesh, motion, placement, .. } = moved;
    let facing = motion.facing.filter(|&facing| facing != placement.facing)?;
    if !motion.bind_at_start || built.scene.resolve(mesh) != built.scene.resolve(&motion.file) {
        return None;
    }
    let (file, faces) = (mesh.display(), placement.facing);
    let seen = format!(
        "{table}.motion.facing = \"{facing}\" and {table}.facing = \"{faces}\", both for {file}: it moves and turns in other \
         directions than in the file; give both the same value, or leave out {table}.motion.facing"
    );
    Some(Advice::new(seen))
}

fn twice(built: &BuiltScene, moved: &Moved<'_>) -> Option<Advice> {
    let Moved { table, key, mesh, groups, motion, placement, first } = moved;
    let file = built.scene.resolve(mesh);
    let corrected = motion.start_at_origin || motion.bind_at_start;
    if !holds_scenes(&file) || corrected || file != built.scene.resolve(&motion.file) {
        return None;
    }
    // Another facing turns it on purpose.
    if motion.facing.is_some_and(|facing| facing != placement.facing) {
        return None;
    }
    let off = first.position_cm.distance(placement.origin_in_world().as_vec3());
    let turned = first.rotation.angle_between(Quat::IDENTITY);
    let carries = if mesh::is_gltf(&file) || mesh::is_fbx(&file) { clip_carries } else { carries_mesh };
    if off < NEAR && turned < TURNED || !carries(&file, &motion.node, groups).unwrap_or(false) {
        return None;
    }
    let (file, node) = (mesh.display(), &motion.node);
    let seen = format!(
        "{table}.mesh is already placed in {file} as {node} is in the first frame, and {table}.motion moves it there a \
         second time"
    );
    match *key {
        Some(key) => Some(Advice { seen, fixes: vec![Fix { key, value: "true".to_owned() }] }),
        None => Some(Advice::new(format!("{seen}: give {table}.motion.bind_at_start = true"))),
    }
}
