//! The mesh that the texture moves: a `.glb` with the hair of the first frame.

use std::io::{self, Write};

use glam::Vec3;
use nabiki::Strands;
use serde_json::json;

use super::layout::Layout;
use crate::gltf_write::{Binary, FLOAT, VERTICES, joined, material};

/// What is written. Points are in metres, y up, in the world.
pub(super) struct Mesh<'a> {
    pub strands: &'a Strands,
    /// The vertices of the first frame.
    pub vertices: &'a [Vec3],
    /// Normals of ribbons by point; `None` draws lines.
    pub normals: Option<Vec<Vec3>>,
    pub layout: &'a Layout,
    /// Linear RGB.
    pub colour: [f32; 3],
}

/// Writes the file.
pub(super) fn write(mesh: &Mesh<'_>, to: &mut impl Write) -> io::Result<()> {
    let mut binary = Binary::default();
    let mut attributes = json!({ "POSITION": binary.positions(mesh.vertices) });
    if let Some(normals) = &mesh.normals {
        attributes["TEXCOORD_0"] = binary.ribbon_uvs(mesh.strands).into();
        let normals: Vec<Vec3> = normals.iter().flat_map(|&normal| [normal; 2]).collect();
        attributes["NORMAL"] = binary.vectors(&normals, VERTICES).into();
    }
    let texels: Vec<[f32; 2]> = (0..mesh.vertices.len()).map(|vertex| mesh.layout.uv(vertex)).collect();
    let view = binary.view(bytemuck::cast_slice(&texels), VERTICES);
    attributes["TEXCOORD_1"] = binary.accessor(view, 0, FLOAT, "VEC2", texels.len()).into();
    let (indices, mode) = joined(mesh.strands, mesh.normals.is_some());
    let indices = binary.indices(&indices);
    let document = json!({
        "scene": 0,
        "scenes": [{ "nodes": [0] }],
        "nodes": [{ "name": "hair", "mesh": 0 }],
        "meshes": [{ "name": "hair", "primitives": [
            { "attributes": attributes, "indices": indices, "mode": mode, "material": 0 }
        ] }],
        "materials": [material("hair", mesh.colour, mesh.normals.is_some())],
    });
    binary.write(document, to)
}
