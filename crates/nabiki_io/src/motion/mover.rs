//! Finds the node of a glTF or FBX that moves a mesh.

use std::path::Path;

use glam::Vec3;
use gltf::json::{animation::Property, validation::Checked};

use super::clip;
use super::joints::Tree;
use crate::error::{Error, Result};
use crate::fbx_file::{self, is_fbx};
use crate::gltf_file::{self, Buffers, pose};
use crate::input::{self, MOST_BINARY_BYTES};
use crate::mesh::glb;

/// A node that carries a mesh, and its animations.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ClipMover {
    /// The node's name, or its path from the root if other nodes have the same name.
    pub node: String,
    /// The animation to choose; empty if the file has only one.
    pub clip: String,
    /// All animations that move it and can be chosen.
    pub clips: Vec<String>,
}

/// The node of the .glb, .gltf or .fbx that carries most of the vertices for which `counts` is true (the file's unit) among
/// those of `groups`, and that an animation moves. `None` if nothing moves it, or it has no name.
///
/// # Errors
/// If the file is invalid.
pub fn clip_mover(file: &Path, groups: &[String], counts: &dyn Fn(Vec3) -> bool) -> Result<Option<ClipMover>> {
    let found = || {
        let bytes = input::read(file, MOST_BINARY_BYTES)?;
        if is_fbx(file) {
            return fbx_file::mover(&bytes, groups, counts);
        }
        let (document, blob) = gltf_file::open(&bytes)?;
        if document.animations().len() == 0 {
            return Ok(None);
        }
        let buffers = Buffers::new(&document, &bytes, blob, file.parent())?;
        let carried = glb::carried(&document, &buffers, groups, counts)?;
        let nodes: Vec<gltf::Node> = document.nodes().collect();
        let names = nodes.iter().map(|node| node.name()).collect();
        let tree = Tree { kind: "node", names, parents: pose::parents(&document)? };
        let json = document.as_json();
        let names = json.animations.iter().map(|clip| clip.name.as_deref());
        let clips = document.animations().zip(names).map(|(clip, name)| {
            let (targets, morphs) = (targets(&clip, &document).collect(), has_morphs(&clip, &document));
            Animated { name, targets, morphs }
        });
        Ok(mover_of(&tree, &carried, &clips.collect::<Vec<_>>()))
    };
    found().map_err(|e: Error| e.in_file(file))
}

/// Whether the node `name` carries a vertex of the meshes in `groups`.
///
/// # Errors
/// If the file is invalid, or the name belongs to no node or to several.
pub fn clip_carries(file: &Path, name: &str, groups: &[String]) -> Result<bool> {
    let found = || {
        let bytes = input::read(file, MOST_BINARY_BYTES)?;
        if is_fbx(file) {
            return fbx_file::carries(&bytes, name, groups);
        }
        let (document, blob) = gltf_file::open(&bytes)?;
        let buffers = Buffers::new(&document, &bytes, blob, file.parent())?;
        let node = clip::chain(&document, name)?.pop().map(|node| node.index());
        let parents = pose::parents(&document)?;
        let carried = glb::carried(&document, &buffers, groups, &|_| true)?;
        Ok(node.is_some_and(|node| is_carrier(&parents, &carried, node)))
    };
    found().map_err(|e: Error| e.in_file(file))
}

/// An animation of a file, and what it moves.
pub(super) struct Animated<'a> {
    pub name: Option<&'a str>,
    /// The nodes that it places.
    pub targets: Vec<usize>,
    /// Whether it moves morphs.
    pub morphs: bool,
}

/// The node of `tree` that carries the head, where each node carries as many vertices as `carried` says, and that one of `clips`
/// moves.
pub(super) fn mover_of(tree: &Tree<'_>, carried: &[usize], clips: &[Animated<'_>]) -> Option<ClipMover> {
    let carrier = head_of(&tree.names, carried)?;
    let above: Vec<usize> = std::iter::successors(Some(carrier), |&node| tree.parents[node]).collect();
    // A node without a name goes as the one above it does, unless it is moved itself.
    let named = above.iter().position(|&node| tree.names[node].is_some())?;
    if above[..named].iter().any(|node| clips.iter().any(|clip| clip.targets.contains(node))) {
        return None;
    }
    let chain = &above[named..];
    // Skin that bends counts as well: a jaw, or a smile.
    let moves = |clip: &&Animated| {
        clip.targets.iter().any(|target| chain.contains(target) || carried[*target] > 0) || clip.morphs
    };
    let moving: Vec<&Animated> = clips.iter().filter(moves).collect();
    let choosable = |clip: &&Animated| {
        let name = clip.name?;
        let alone = clips.iter().filter(|other| other.name == Some(name)).count() == 1;
        alone.then(|| name.to_owned())
    };
    let names: Vec<String> = moving.iter().filter_map(choosable).collect();
    let clip = match (clips.len() == 1 && !moving.is_empty(), names.first()) {
        (true, _) => String::new(),
        (false, Some(first)) => first.clone(),
        (false, None) => return None,
    };
    let path: String = chain.iter().rev().map(|&node| format!("/{}", tree.names[node].unwrap_or_default())).collect();
    let name = tree.names[chain[0]].unwrap_or_default().to_owned();
    let leads_there =
        |name: &String| tree.chain(name).is_ok_and(|found| found.last().copied() == chain.first().copied());
    [name, path].into_iter().find(leads_there).map(|node| ClipMover { node, clip, clips: names })
}

/// Whether `node` is, or is above, one that carries vertices.
pub(super) fn is_carrier(parents: &[Option<usize>], carried: &[usize], node: usize) -> bool {
    let mut carriers = (0..carried.len()).filter(|&carrier| carried[carrier] > 0);
    carriers.any(|carrier| std::iter::successors(Some(carrier), |&at| parents[at]).any(|at| at == node))
}

/// The node that carries most, or, of those that carry a good part, the one that is called a head.
fn head_of(names: &[Option<&str>], carried: &[usize]) -> Option<usize> {
    const GOOD_PART: f32 = 0.05;
    let all: usize = carried.iter().sum();
    let most = |nodes: &mut dyn Iterator<Item = usize>| nodes.max_by_key(|&node| (carried[node], usize::MAX - node));
    let is_head = |node: usize| names[node].is_some_and(|name| name.to_ascii_lowercase().contains("head"));
    let good = |node: usize| carried[node] as f32 >= GOOD_PART * all as f32;
    let mut heads = (0..names.len()).filter(|&node| is_head(node) && carried[node] > 0 && good(node));
    most(&mut heads).or_else(|| most(&mut (0..carried.len()).filter(|&node| carried[node] > 0)))
}

/// The nodes that an animation places.
fn targets<'a>(clip: &gltf::Animation<'a>, document: &'a gltf::Document) -> impl Iterator<Item = usize> + use<'a> {
    channels(clip, document).filter(|(_, path)| *path != Property::MorphTargetWeights).map(|(node, _)| node)
}

/// Whether an animation moves morphs.
fn has_morphs(clip: &gltf::Animation, document: &gltf::Document) -> bool {
    channels(clip, document).any(|(_, path)| path == Property::MorphTargetWeights)
}

/// The nodes that an animation moves, and what of them.
fn channels<'a>(
    clip: &gltf::Animation<'a>,
    document: &'a gltf::Document,
) -> impl Iterator<Item = (usize, Property)> + use<'a> {
    let channels = document.as_json().animations[clip.index()].channels.iter();
    channels.filter_map(|channel| match channel.target.path {
        Checked::Valid(path) => Some((channel.target.node.value(), path)),
        Checked::Invalid => None,
    })
}
