//! One node's world motion out of an FBX animation, evaluated at the scene's frames themselves. The rotation given is that from the
//! node's rest pose, in which the file's meshes stand.

use glam::{DMat4, DQuat, DVec3, Vec3};

use super::clip::{SAME_SCALE, world};
use super::joints::{Tree, check_poses};
use super::mover::{Animated, ClipMover, is_carrier, mover_of};
use super::source::MotionSource;
use super::track::Sample;
use super::world::{HeadMotion, WorldFromFile, frame_count, pose_of, poses};
use crate::error::Result;
use crate::fbx_file::Document;
use crate::fbx_file::document::{Moved, Placed, clip_name, number};
use crate::mesh::fbx;

/// Reads the poses of `source.node` in `source.clip` out of the file's bytes.
pub(crate) fn head_motion(source: &MotionSource, bytes: &[u8], frame_rate: f64) -> Result<HeadMotion> {
    let document = Document::open(bytes)?;
    let chain = tree(&document).chain(&source.node)?;
    let stack = document.stack(&source.clip)?;
    let [start, end] = Moved::by(&document, stack).range;
    let space = document.space()?;
    let unit_cm = source.unit_cm.or(space.unit.map(|unit| 100.0 * unit.metres()));
    let world_from_file = WorldFromFile::new(unit_cm, source.up.or(space.up), source.facing)?;
    let frames = frame_count(end - start, frame_rate / source.speed)?;
    check_poses(chain.len(), frames)?;
    let rest = document.rest_pose()[chain[chain.len() - 1]];
    let (rest, _) = world([DMat4::from(rest)].into_iter(), &source.node)?;
    let mut samples = Vec::with_capacity(frames.min(1 << 16));
    let (mut first_scale, mut grows) = (None, false);
    for n in 0..frames {
        let time = start + n as f64 / (frame_rate / source.speed);
        let placed = placed(&document, &chain, stack, time);
        let (pose, scale) = world([DMat4::from(placed.scene_from_node)].into_iter(), &source.node)?;
        grows |= !(scale / *first_scale.get_or_insert(scale)).abs_diff_eq(DVec3::ONE, SAME_SCALE);
        let rotation = (pose.rotation * rest.rotation.inverse()).normalize();
        samples.push(Sample { position: pose.position, rotation });
    }
    let first_frame = (source.speed == 1.0).then(|| (start * frame_rate).round() as i32);
    let shot = first_frame.filter(|&first| first != 0);
    let report = format!(
        "{}: clip {}, node {}, {:.3} s -> {frames} frames at {frame_rate} Hz{}{} (evaluated at the frames; unit {} cm, up {}, \
         face {}){}",
        source.file.display(),
        &*stack.element.name,
        source.node,
        end - start,
        shot.map_or_else(String::new, |first| format!(" from frame {first} of the shot on")),
        source.changes(),
        crate::short::Short(world_from_file.unit_cm as f32),
        world_from_file.up,
        world_from_file.facing,
        if grows { "; ignored: its scale, which changes" } else { "" },
    );
    let poses = poses(&world_from_file, samples.into_iter(), source)?;
    let bound = Some(pose_of(world_from_file.pose(Sample { rotation: DQuat::IDENTITY, ..rest })));
    let times = [start, source.speed / frame_rate];
    Ok(HeadMotion { frame_rate, poses, bound, times, first_frame, report })
}

/// The last node of a chain from the scene's root down, at a time of an animation.
fn placed(document: &Document, chain: &[usize], stack: &ufbx::AnimStack, time: f64) -> Placed {
    let mut all: Vec<Placed> = Vec::with_capacity(chain.len() + 1);
    all.push(Placed::root(&document.scene.root_node));
    for &n in chain {
        let node = &document.scene.nodes[n];
        let of_scale = node.inherit_scale_node.as_ref().map(|other| number(other));
        let inherited = of_scale.and_then(|other| chain.iter().position(|&above| above == other));
        let inherited = inherited.and_then(|at| all.get(at + 1)).map(Placed::scale);
        all.push(Placed::below(&all[all.len() - 1], inherited, &stack.anim, node, time));
    }
    all[all.len() - 1]
}

fn tree(document: &Document) -> Tree<'_> {
    let (names, parents) = document.tree();
    Tree { kind: "node", names, parents }
}

/// The node that carries most of the vertices for which `counts` is true, and that an animation moves.
pub(crate) fn mover(bytes: &[u8], groups: &[String], counts: &dyn Fn(Vec3) -> bool) -> Result<Option<ClipMover>> {
    let document = Document::open(bytes)?;
    let stacks = document.scene.anim_stacks.as_ref();
    if stacks.is_empty() {
        return Ok(None);
    }
    let carried = fbx::carried(&document, groups, counts)?;
    let clips = stacks.iter().map(|stack| {
        let moved = Moved::by(&document, stack);
        let targets = moved.nodes.iter().enumerate().filter(|(_, moved)| **moved).map(|(n, _)| n).collect();
        Animated { name: clip_name(stack), targets, morphs: moved.shapes.contains(&true) }
    });
    let clips: Vec<Animated> = clips.collect();
    Ok(mover_of(&tree(&document), &carried, &clips))
}

/// Whether the node `name` carries a vertex of the meshes in `groups`.
pub(crate) fn carries(bytes: &[u8], name: &str, groups: &[String]) -> Result<bool> {
    let document = Document::open(bytes)?;
    let tree = tree(&document);
    let node = tree.chain(name)?.pop();
    let carried = fbx::carried(&document, groups, &|_| true)?;
    Ok(node.is_some_and(|node| is_carrier(&tree.parents, &carried, node)))
}

/// How far at most a number of the poses of chains is from that of the poses that ufbx has. For tests.
#[cfg(test)]
pub(crate) fn worst_of_chains(bytes: &[u8], time: f64) -> Result<f64> {
    let document = Document::open(bytes)?;
    let stack = document.stack("")?;
    let scene = document.at(&stack.anim, time)?;
    let tree = tree(&document);
    let mut worst = 0.0_f64;
    for (n, name) in tree.names.iter().enumerate() {
        let Some(name) = name else { continue };
        let found = placed(&document, &tree.chain(name)?, stack, time).scene_from_node;
        let expected = crate::fbx_file::affine(&scene.nodes[n].node_to_world);
        let off = (DMat4::from(found) - DMat4::from(expected)).to_cols_array();
        worst = off.iter().fold(worst, |worst, x| worst.max(x.abs()));
    }
    Ok(worst)
}
