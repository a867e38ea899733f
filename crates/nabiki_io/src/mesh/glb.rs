//! glTF 2.0, .glb and .gltf, by way of the crate gltf: triangles of the default scene, node transforms applied.
//!
//! Skins and morphs are left in their rest pose. Accessors are read here rather than by the crate, whose iterators
//! trust the file's offsets and counts.

use std::path::Path;

use glam::{Mat4, Vec2, Vec3};
use gltf::{
    accessor::{DataType, Dimensions},
    mesh::Mode,
};
use nabiki::Mesh;
use nabiki_exchange::Budget;

use super::{
    TRIANGLE_BYTES, VERTEX_BYTES,
    check::{check, check_groups},
};
use crate::{
    error::{Error, Result},
    gltf_file::{Buffer, budget, buffers, open},
};

/// `folder`: where buffers in files of their own are; `None` refuses them.
pub(super) fn from_bytes(bytes: &[u8], folder: Option<&Path>, groups: &[String]) -> Result<Mesh> {
    let (document, blob) = open(bytes)?;
    let buffers = buffers(&document, blob, folder)?;
    let nodes = document.nodes().filter_map(|n| n.name());
    let names: Vec<&str> = nodes.chain(document.meshes().filter_map(|m| m.name())).collect();
    check_groups(groups, &names)?;
    let wanted = |name: Option<&str>| name.is_some_and(|name| groups.iter().any(|g| g == name));

    let budget = budget(bytes, &buffers);
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
                append(&mut mesh, &primitive, &buffers, scene_from_node, &budget)
                    .map_err(|e| Error::new(format!("mesh {}: {}", node_mesh.index(), e.what)))?;
            }
        }
        open.extend(node.children().map(|child| (child, scene_from_node, node_wanted)));
    }
    check(mesh)
}

/// The named nodes that have a mesh, with its triangles.
pub(super) fn groups(bytes: &[u8]) -> Result<Vec<(String, usize)>> {
    let (document, _) = open(bytes)?;
    let corners = |primitive: gltf::Primitive| {
        let counted = primitive.indices().or_else(|| primitive.get(&gltf::Semantic::Positions));
        counted.map_or(0, |accessor| accessor.count())
    };
    let group = |node: gltf::Node| {
        let (name, mesh) = (node.name()?.to_owned(), node.mesh()?);
        Some((name, mesh.primitives().map(corners).sum::<usize>() / 3))
    };
    Ok(document.nodes().filter_map(group).collect())
}

/// Adds one primitive's triangles.
fn append(
    mesh: &mut Mesh,
    primitive: &gltf::Primitive,
    buffers: &[Buffer<'_>],
    scene_from_node: Mat4,
    budget: &Budget,
) -> Result<()> {
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
    let places = items(&positions, buffers, 12)?;
    // A mesh drawn by many nodes is copied for each.
    budget.take(count as u64 * VERTEX_BYTES, "vertices")?;
    for item in places {
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
            let all = items(&indices, buffers, width)?;
            budget.take(indices.count() as u64 / 3 * TRIANGLE_BYTES, "triangles")?;
            all.map(number).collect()
        }
    };
    if let Some(&bad) = indices.iter().find(|&&v| v as usize >= count) {
        return Err(Error::new(format!("index {bad} names a vertex beyond the {count} there are")));
    }
    // A mirroring transform would turn the surface inside out.
    let mirrored = scene_from_node.determinant() < 0.0;
    let uvs = texture_coordinates(primitive, buffers, count)?;
    for &[a, b, c] in indices.as_chunks::<3>().0 {
        let corners = if mirrored { [a, c, b] } else { [a, b, c] };
        mesh.push(corners.map(|v| first + v), uvs.as_ref().map(|uvs| corners.map(|v| uvs[v as usize])));
    }
    Ok(())
}

/// The first texture coordinates of each of `count` vertices, v upward: that of glTF runs down.
fn texture_coordinates(primitive: &gltf::Primitive, buffers: &[Buffer<'_>], count: usize) -> Result<Option<Vec<Vec2>>> {
    let Some(accessor) = primitive.get(&gltf::Semantic::TexCoords(0)) else { return Ok(None) };
    let (kind, found) = (accessor.data_type(), accessor.count());
    if found != count {
        return Err(Error::new(format!("{found} texture coordinates for {count} vertices")));
    }
    // Whole numbers stand for shares of their type's largest, as glTF 2.0 has it (section 3.7.2.1).
    let (width, number): (usize, fn(&[u8]) -> f32) = match (kind, accessor.dimensions()) {
        (DataType::F32, Dimensions::Vec2) => (4, |b| f32::from_le_bytes([b[0], b[1], b[2], b[3]])),
        (DataType::U8, Dimensions::Vec2) => (1, |b| f32::from(b[0]) / 255.0),
        (DataType::U16, Dimensions::Vec2) => (2, |b| f32::from(u16::from_le_bytes([b[0], b[1]])) / 65535.0),
        (kind, _) => return Err(Error::new(format!("texture coordinates of type {kind:?} are not read"))),
    };
    let uvs = items(&accessor, buffers, 2 * width)?;
    Ok(Some(uvs.map(|item| Vec2::new(number(item), 1.0 - number(&item[width..]))).collect()))
}

/// The items of an accessor, each of `size` bytes, all within their buffer.
fn items<'a>(
    accessor: &gltf::Accessor,
    buffers: &'a [Buffer<'_>],
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

#[cfg(test)]
mod tests {
    use super::*;

    /// A .glb of one triangle with texture coordinates of a component type, and, if so wanted, once more without any.
    fn glb(component: u32, normalised: bool, uvs: &[u8], without: bool) -> Vec<u8> {
        let bare = if without { r#",{"attributes":{"POSITION":0}}"# } else { "" };
        let (count, bytes, whole) = (3, uvs.len(), 36 + uvs.len());
        let json = format!(
            r#"{{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0]}}],"nodes":[{{"mesh":0}}],
            "meshes":[{{"primitives":[{{"attributes":{{"POSITION":0,"TEXCOORD_0":1}}}}{bare}]}}],
            "accessors":[{{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]}},
            {{"bufferView":1,"componentType":{component},"normalized":{normalised},"count":{count},"type":"VEC2"}}],
            "bufferViews":[{{"buffer":0,"byteLength":36}},{{"buffer":0,"byteOffset":36,"byteLength":{bytes}}}],
            "buffers":[{{"byteLength":{whole}}}]}}"#
        );
        let mut binary = [0.0f32, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0].map(f32::to_le_bytes).concat();
        binary.extend(uvs);
        crate::gltf_file::tests::glb(&json, &binary)
    }

    #[test]
    fn nodes_are_carried_by_those_above_them_and_vertices_may_be_interleaved() {
        // Three vertices of a place and of texture coordinates each, behind four bytes of something else.
        let vertices = [[1.0f32, 0.0, 0.0, 0.25, 1.0], [0.0, 1.0, 0.0, 0.5, 0.75], [0.0, 0.0, 1.0, 0.75, 0.5]].concat();
        let numbers: Vec<u8> = std::iter::once(&9.0).chain(&vertices).flat_map(|x| x.to_le_bytes()).collect();
        // The arm is turned by a quarter about z and lies at (0, 0, 5), the hand lies at (10, 0, 0) of it.
        let half = std::f32::consts::FRAC_1_SQRT_2;
        let json = format!(
            r#"{{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0]}}],
            "nodes":[{{"children":[1],"rotation":[0,0,{half},{half}],"translation":[0,0,5]}},
            {{"mesh":0,"translation":[10,0,0]}}],
            "meshes":[{{"primitives":[{{"attributes":{{"POSITION":0,"TEXCOORD_0":1}}}}]}}],
            "accessors":[{{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,1]}},
            {{"bufferView":0,"byteOffset":12,"componentType":5126,"count":3,"type":"VEC2"}}],
            "bufferViews":[{{"buffer":0,"byteOffset":4,"byteLength":60,"byteStride":20}}],
            "buffers":[{{"byteLength":64}}]}}"#
        );
        let mesh = from_bytes(&crate::gltf_file::tests::glb(&json, &numbers), None, &[]).unwrap();
        let places = [[0.0, 11.0, 5.0], [-1.0, 10.0, 5.0], [0.0, 10.0, 6.0]].map(Vec3::from);
        for (found, place) in mesh.positions.iter().zip(places) {
            assert!(found.distance(place) < 1e-5, "{found} {place}");
        }
        let uvs = [[0.25, 0.0], [0.5, 0.25], [0.75, 0.5]].map(Vec2::from);
        assert_eq!((mesh.triangles, mesh.corner_uvs), (vec![[0, 1, 2]], Some(vec![uvs])));
    }

    #[test]
    fn the_default_scene_is_read_part_by_part_and_a_node_is_chosen_with_what_is_below_it() {
        let triangle = |x: f32| [x, 0.0, 0.0, x + 1.0, 0.0, 0.0, x, 1.0, 0.0];
        let numbers: Vec<u8> = [triangle(0.0), triangle(10.0)].concat().iter().flat_map(|x| x.to_le_bytes()).collect();
        let json = r#"{"asset":{"version":"2.0"},"scene":1,"scenes":[{"nodes":[3]},{"nodes":[0,2]}],
            "nodes":[{"name":"body","children":[1]},{"name":"head","mesh":0},{"name":"floor","mesh":1},{"mesh":1}],
            "meshes":[{"primitives":[{"attributes":{"POSITION":0}},{"attributes":{"POSITION":1}}]},
            {"primitives":[{"attributes":{"POSITION":1}}]}],
            "accessors":[
            {"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]},
            {"bufferView":0,"byteOffset":36,"componentType":5126,"count":3,"type":"VEC3","min":[10,0,0],"max":[11,1,0]}],
            "bufferViews":[{"buffer":0,"byteLength":72}],"buffers":[{"byteLength":72}]}"#;
        let glb = crate::gltf_file::tests::glb(json, &numbers);
        let corners = |groups: &[&str]| {
            let groups: Vec<String> = groups.iter().map(|&group| group.to_owned()).collect();
            let mesh = from_bytes(&glb, None, &groups).unwrap();
            mesh.triangles.iter().map(|t| t.map(|v| mesh.positions[v as usize].x)).collect::<Vec<_>>()
        };
        let (near, far) = ([0.0, 1.0, 0.0], [10.0, 11.0, 10.0]);
        assert_eq!(corners(&[]), [near, far, far]);
        assert_eq!(corners(&["body"]), [near, far]);
        assert_eq!(corners(&["floor"]), [far]);
    }

    #[test]
    fn texture_coordinates_of_every_component_type_are_shares_with_v_upward() {
        let bytes = [0u8, 255, 51, 0, 255, 102];
        let shorts: Vec<u8> = bytes.iter().flat_map(|&b| (u16::from(b) * 257).to_le_bytes()).collect();
        let floats: Vec<u8> = bytes.iter().flat_map(|&b| (f32::from(b) / 255.0).to_le_bytes()).collect();
        // 51 / 255 and 102 / 255 are a fifth and two fifths.
        let expected = [Vec2::new(0.0, 0.0), Vec2::new(0.2, 1.0), Vec2::new(1.0, 1.0 - 0.4)];
        for (component, uvs) in [(5121, &bytes[..]), (5123, &shorts), (5126, &floats)] {
            let mesh = from_bytes(&glb(component, component != 5126, uvs, false), None, &[]).unwrap();
            assert_eq!(mesh.corner_uvs, Some(vec![expected]), "{component}");
        }
        let bare = from_bytes(&glb(5121, true, &bytes, true), None, &[]).unwrap();
        assert_eq!((bare.triangles.len(), bare.corner_uvs), (2, None));
        let signed = from_bytes(&glb(5122, true, &shorts, false), None, &[]).unwrap_err().to_string();
        assert_eq!(signed, "mesh 0: texture coordinates of type I16 are not read");
        let short = from_bytes(&glb(5126, false, &floats[..20], false), None, &[]).unwrap_err().to_string();
        assert!(short.starts_with("mesh 0: accessor 1: 3 items reach beyond"), "{short}");
    }
}
