//! Finds the node of a glTF that moves a mesh.

use std::path::Path;

use glam::Vec3;
use gltf::json::{animation::Property, validation::Checked};

use super::clip;
use crate::error::{Error, Result};
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

/// The node of the .glb or .gltf that carries most of the vertices for which `counts` is true (the file's unit) among
/// those of `groups`, and that an animation moves. `None` if nothing moves it, or it has no name.
///
/// # Errors
/// If the file is invalid.
pub fn clip_mover(file: &Path, groups: &[String], counts: &dyn Fn(Vec3) -> bool) -> Result<Option<ClipMover>> {
    let found = || {
        let bytes = input::read(file, MOST_BINARY_BYTES)?;
        let (document, blob) = gltf_file::open(&bytes)?;
        if document.animations().len() == 0 {
            return Ok(None);
        }
        let buffers = Buffers::new(&document, &bytes, blob, file.parent())?;
        let carried = glb::carried(&document, &buffers, groups, counts)?;
        let Some(carrier) = head_of(&document, &carried) else { return Ok(None) };
        let parents = pose::parents(&document)?;
        let above: Vec<usize> = std::iter::successors(Some(carrier), |&node| parents[node]).collect();
        // A node without a name goes as the one above it does, unless it is moved itself.
        let nodes: Vec<gltf::Node> = document.nodes().collect();
        let moved: Vec<usize> = document.animations().flat_map(|clip| targets(&clip, &document)).collect();
        let Some(named) = above.iter().position(|&node| nodes[node].name().is_some()) else { return Ok(None) };
        if above[..named].iter().any(|node| moved.contains(node)) {
            return Ok(None);
        }
        let chain = &above[named..];
        // Skin that bends counts as well: a jaw, or a smile.
        let bends = |target: usize| carried[target] > 0;
        let moves = |clip: &gltf::Animation| {
            targets(clip, &document).any(|target| chain.contains(&target) || bends(target))
                || has_morphs(clip, &document)
        };
        let clips: Vec<gltf::Animation> = document.animations().filter(moves).collect();
        let only = document.animations().len() == 1;
        let choosable = |clip: &gltf::Animation| {
            let name = clip.name()?;
            let alone = document.animations().filter(|other| other.name() == Some(name)).count() == 1;
            alone.then(|| name.to_owned())
        };
        let names: Vec<String> = clips.iter().filter_map(choosable).collect();
        let clip = match (only && !clips.is_empty(), names.first()) {
            (true, _) => String::new(),
            (false, Some(first)) => first.clone(),
            (false, None) => return Ok(None),
        };
        let path: String =
            chain.iter().rev().map(|&node| format!("/{}", nodes[node].name().unwrap_or_default())).collect();
        let name = nodes[chain[0]].name().unwrap_or_default().to_owned();
        let leads_there = |name: &String| {
            clip::chain(&document, name)
                .is_ok_and(|found| found.last().map(gltf::Node::index) == chain.first().copied())
        };
        Ok([name, path].into_iter().find(leads_there).map(|node| ClipMover { node, clip, clips: names }))
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
        let (document, blob) = gltf_file::open(&bytes)?;
        let buffers = Buffers::new(&document, &bytes, blob, file.parent())?;
        let node = clip::chain(&document, name)?.pop().map(|node| node.index());
        let parents = pose::parents(&document)?;
        let carried = glb::carried(&document, &buffers, groups, &|_| true)?;
        let mut carriers = (0..carried.len()).filter(|&carrier| carried[carrier] > 0);
        Ok(carriers.any(|carrier| std::iter::successors(Some(carrier), |&at| parents[at]).any(|at| Some(at) == node)))
    };
    found().map_err(|e: Error| e.in_file(file))
}

/// The node that carries most, or, of those that carry a good part, the one that is called a head.
fn head_of(document: &gltf::Document, carried: &[usize]) -> Option<usize> {
    const GOOD_PART: f32 = 0.05;
    let all: usize = carried.iter().sum();
    let most = |nodes: &mut dyn Iterator<Item = usize>| nodes.max_by_key(|&node| (carried[node], usize::MAX - node));
    let is_head = |node: &gltf::Node| node.name().is_some_and(|name| name.to_ascii_lowercase().contains("head"));
    let good = |node: usize| carried[node] as f32 >= GOOD_PART * all as f32;
    let mut heads =
        document.nodes().filter(is_head).map(|node| node.index()).filter(|&node| carried[node] > 0 && good(node));
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
