//! glTF 2.0, .glb and .gltf, by way of the crate gltf: triangles of the default scene, node transforms applied.
//!
//! Skins and morphs are left in their rest pose. Accessors are read here rather than by the crate, whose iterators
//! trust the file's offsets and counts.

use std::path::Path;

use glam::{Mat4, Vec3};
use gltf::{
    accessor::{DataType, Dimensions},
    mesh::Mode,
};
use nabiki::Mesh;

use super::check::{check, check_groups};
use crate::{
    error::{Error, Result},
    gltf_file::{buffers, open},
};

/// A mesh drawn by many nodes is copied for each; beyond this many times the file's size it is a trick, not a head.
const MOST_COPIES: usize = 64;

/// `folder`: where buffers in files of their own are; `None` refuses them.
pub(super) fn from_bytes(bytes: &[u8], folder: Option<&Path>, groups: &[String]) -> Result<Mesh> {
    let (document, blob) = open(bytes)?;
    let buffers = buffers(&document, blob.as_deref(), folder)?;
    let nodes = document.nodes().filter_map(|n| n.name());
    let names: Vec<&str> = nodes.chain(document.meshes().filter_map(|m| m.name())).collect();
    check_groups(groups, &names)?;
    let wanted = |name: Option<&str>| name.is_some_and(|name| groups.iter().any(|g| g == name));

    let room = MOST_COPIES * (bytes.len() + buffers.iter().map(Vec::len).sum::<usize>()) / size_of::<Vec3>();
    let mut seen = vec![false; document.nodes().len()];
    let mut mesh = Mesh::default();
    let scene = document.default_scene().or_else(|| document.scenes().next());
    let roots: Vec<_> = match scene {
        Some(scene) => scene.nodes().collect(),
        None => document.nodes().collect(),
    };
    let mut open: Vec<_> = roots.into_iter().map(|node| (node, Mat4::IDENTITY, groups.is_empty())).collect();
    open.reverse();
    while let Some((node, scene_from_parent, parent_wanted)) = open.pop() {
        if std::mem::replace(&mut seen[node.index()], true) {
            return Err(Error::new(format!("node {} has two parents or is its own ancestor", node.index())));
        }
        let scene_from_node = scene_from_parent * Mat4::from_cols_array_2d(&node.transform().matrix());
        let node_wanted = parent_wanted || wanted(node.name());
        if let Some(node_mesh) = node.mesh().filter(|m| node_wanted || wanted(m.name())) {
            for primitive in node_mesh.primitives() {
                append(&mut mesh, &primitive, &buffers, scene_from_node)
                    .map_err(|e| Error::new(format!("mesh {}: {}", node_mesh.index(), e.what)))?;
                if mesh.positions.len() > room || mesh.triangles.len() > room {
                    return Err(Error::new(format!(
                        "its nodes repeat meshes to more than {MOST_COPIES} times the file"
                    )));
                }
            }
        }
        open.extend(node.children().map(|child| (child, scene_from_node, node_wanted)));
    }
    check(mesh)
}

/// Adds one primitive's triangles.
fn append(mesh: &mut Mesh, primitive: &gltf::Primitive, buffers: &[Vec<u8>], scene_from_node: Mat4) -> Result<()> {
    if primitive.mode() != Mode::Triangles {
        return Err(Error::new(format!("primitives of mode {:?} are not read: export triangles", primitive.mode())));
    }
    let positions =
        primitive.get(&gltf::Semantic::Positions).ok_or_else(|| Error::new("a primitive has no positions"))?;
    if (positions.data_type(), positions.dimensions()) != (DataType::F32, Dimensions::Vec3) {
        return Err(Error::new("positions are not triples of f32: export without quantisation"));
    }
    let first = u32::try_from(mesh.positions.len()).map_err(|_| Error::new("more than 2^32 vertices"))?;
    let count = positions.count();
    for item in items(&positions, buffers, 12)? {
        let f = |i: usize| f32::from_le_bytes([item[i], item[i + 1], item[i + 2], item[i + 3]]);
        mesh.positions.push(scene_from_node.transform_point3(Vec3::new(f(0), f(4), f(8))));
    }
    let indices: Vec<u32> = match primitive.indices() {
        None => (0..count as u32).collect(),
        Some(indices) => {
            if indices.dimensions() != Dimensions::Scalar {
                return Err(Error::new("indices are not single numbers"));
            }
            let width = match indices.data_type() {
                DataType::U8 => 1,
                DataType::U16 => 2,
                DataType::U32 => 4,
                other => return Err(Error::new(format!("indices of type {other:?} are not read"))),
            };
            let number = |item: &[u8]| item.iter().rev().fold(0u32, |n, &byte| n << 8 | u32::from(byte));
            items(&indices, buffers, width)?.map(number).collect()
        }
    };
    if let Some(&bad) = indices.iter().find(|&&v| v as usize >= count) {
        return Err(Error::new(format!("index {bad} names a vertex beyond the {count} there are")));
    }
    // A mirroring transform would turn the surface inside out.
    let mirrored = scene_from_node.determinant() < 0.0;
    mesh.triangles.extend(indices.chunks_exact(3).map(|t| {
        let [a, b, c] = [first + t[0], first + t[1], first + t[2]];
        if mirrored { [a, c, b] } else { [a, b, c] }
    }));
    Ok(())
}

/// The items of an accessor, each of `size` bytes, all within their buffer.
fn items<'a>(
    accessor: &gltf::Accessor,
    buffers: &'a [Vec<u8>],
    size: usize,
) -> Result<impl Iterator<Item = &'a [u8]> + use<'a>> {
    let index = accessor.index();
    if accessor.sparse().is_some() {
        return Err(Error::new(format!("accessor {index} is sparse: export without sparse accessors")));
    }
    let view = accessor.view().ok_or_else(|| Error::new(format!("accessor {index} has no data")))?;
    let (count, stride) = (accessor.count(), view.stride().unwrap_or(size));
    let slice = || {
        let bytes = buffers.get(view.buffer().index())?;
        let view_bytes = bytes.get(view.offset()..view.offset().checked_add(view.length())?)?;
        let length = count.checked_sub(1)?.checked_mul(stride)?.checked_add(size)?;
        view_bytes.get(accessor.offset()..accessor.offset().checked_add(length)?)
    };
    if stride < size {
        return Err(Error::new(format!("accessor {index}: stride {stride} is less than its items' {size} bytes")));
    }
    let slice =
        slice().ok_or_else(|| Error::new(format!("accessor {index}: {count} items reach beyond their buffer")))?;
    Ok(slice.chunks(stride).map(move |chunk| &chunk[..size]))
}
