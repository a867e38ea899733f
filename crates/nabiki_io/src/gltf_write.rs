//! Writing `.glb`: the JSON, one buffer, and hair in glTF's space.

pub(crate) mod ribbons;

use std::io::{self, Write};

use glam::{DAffine3, DMat3, DVec3, Vec3};
use nabiki::Strands;
use nabiki_exchange::Export;
use serde_json::{Value, json};

// Names of the specification.
pub(crate) const FLOAT: u32 = 5126;
pub(crate) const SHORT: u32 = 5122;
pub(crate) const UNSIGNED_BYTE: u32 = 5121;
pub(crate) const UNSIGNED_SHORT: u32 = 5123;
const UNSIGNED_INT: u32 = 5125;
const LINES: u32 = 1;
pub(crate) const TRIANGLES: u32 = 4;
pub(crate) const VERTICES: Option<u32> = Some(34962);

/// The buffer, and what describes it.
#[derive(Default)]
pub(crate) struct Binary {
    bytes: Vec<u8>,
    views: Vec<Value>,
    pub accessors: Vec<Value>,
}

impl Binary {
    /// A view of some bytes. `target`: what a graphics card takes them for.
    pub fn view(&mut self, bytes: &[u8], target: Option<u32>) -> usize {
        let mut view = json!({ "buffer": 0, "byteOffset": self.bytes.len(), "byteLength": bytes.len() });
        if let Some(target) = target {
            view["target"] = target.into();
        }
        self.bytes.extend_from_slice(bytes);
        self.bytes.resize(self.bytes.len().next_multiple_of(4), 0);
        self.views.push(view);
        self.views.len() - 1
    }

    pub fn accessor(&mut self, view: usize, offset: usize, component: u32, kind: &str, count: usize) -> usize {
        let accessor = json!({
            "bufferView": view, "byteOffset": offset, "componentType": component, "type": kind, "count": count
        });
        self.accessors.push(accessor);
        self.accessors.len() - 1
    }

    /// Attributes of vertices or of the animation.
    pub fn vectors(&mut self, vectors: &[Vec3], target: Option<u32>) -> usize {
        let view = self.view(bytemuck::cast_slice(vectors), target);
        self.accessor(view, 0, FLOAT, "VEC3", vectors.len())
    }

    /// Positions, with the bounds that are required of these.
    pub fn positions(&mut self, points: &[Vec3]) -> usize {
        let accessor = self.vectors(points, VERTICES);
        let [low, high] = nabiki::strands::bounds(points).map(|p| p.to_array());
        self.accessors[accessor]["min"] = short(&low);
        self.accessors[accessor]["max"] = short(&high);
        accessor
    }

    /// Texture coordinates of ribbons: across and along each strand.
    pub fn ribbon_uvs(&mut self, strands: &Strands) -> usize {
        let uvs = ribbons::uvs(strands);
        let view = self.view(bytemuck::cast_slice(&uvs), VERTICES);
        let accessor = self.accessor(view, 0, UNSIGNED_SHORT, "VEC2", uvs.len());
        self.accessors[accessor]["normalized"] = true.into();
        accessor
    }

    /// Indices of vertices, in 16 bits where they fit: the largest number of these is not an index.
    pub fn indices(&mut self, indices: &[u32]) -> usize {
        let narrow: Option<Vec<u16>> =
            indices.iter().map(|&index| u16::try_from(index).ok().filter(|&index| index < u16::MAX)).collect();
        let (bytes, component) = match &narrow {
            Some(narrow) => (bytemuck::cast_slice(narrow), UNSIGNED_SHORT),
            None => (bytemuck::cast_slice(indices), UNSIGNED_INT),
        };
        let view = self.view(bytes, Some(34963));
        self.accessor(view, 0, component, "SCALAR", indices.len())
    }

    /// Writes the file: `document`, to which what describes the buffer is added, and the buffer.
    pub fn write(self, mut document: Value, to: &mut impl Write) -> io::Result<()> {
        let generator = concat!("Nabiki ", env!("CARGO_PKG_VERSION"));
        document["asset"] = json!({ "version": "2.0", "generator": generator });
        document["buffers"] = json!([{ "byteLength": self.bytes.len() }]);
        document["accessors"] = self.accessors.into();
        document["bufferViews"] = self.views.into();
        let mut text = serde_json::to_vec(&document).map_err(io::Error::other)?;
        text.resize(text.len().next_multiple_of(4), b' ');
        let whole = |length: usize| {
            u32::try_from(length).map_err(|_| {
                let problem = format!("it would have {length} bytes: a .glb holds less than 4 GiB; show fewer strands");
                io::Error::new(io::ErrorKind::InvalidInput, problem)
            })
        };
        let all = whole(12 + 8 + text.len() + 8 + self.bytes.len())?;
        to.write_all(b"glTF")?;
        for word in [2, all, whole(text.len())?, 0x4E4F_534A] {
            to.write_all(&word.to_le_bytes())?;
        }
        to.write_all(&text)?;
        for word in [whole(self.bytes.len())?, 0x004E_4942] {
            to.write_all(&word.to_le_bytes())?;
        }
        to.write_all(&self.bytes)
    }
}

/// Takes points of the export's file to glTF: metres, y up, facing +z where the hair has no file of its own.
pub(crate) fn gltf_from_file(export: &Export<'_>) -> DAffine3 {
    let matrix3 = match (export.faces_x, export.z_up) {
        // +x to +z, y stays.
        (true, _) => DMat3::from_cols(DVec3::Z, DVec3::Y, DVec3::NEG_X),
        (false, true) => DMat3::from_cols(DVec3::X, DVec3::NEG_Z, DVec3::Y),
        (false, false) => DMat3::IDENTITY,
    };
    DAffine3 { matrix3: matrix3 * export.meters_per_unit, translation: DVec3::ZERO }
}

/// The strands in glTF's axes and unit, on the head.
pub(crate) fn on_head(gltf_from_head: &DAffine3, strands: &Strands) -> Strands {
    let mut placed = strands.clone();
    placed.points_mut().iter_mut().for_each(|p| *p = gltf_from_head.transform_point3(p.as_dvec3()).as_vec3());
    placed
}

/// The colour of all hair (linear RGB).
pub(crate) fn colour(export: &Export<'_>) -> [f32; 3] {
    export.hair.attributes.constant.colour.or(export.default_colour).unwrap_or([0.2, 0.1, 0.05])
}

pub(crate) fn material(name: &str, [r, g, b]: [f32; 3], two_sided: bool) -> Value {
    json!({ "name": name, "doubleSided": two_sided, "pbrMetallicRoughness": {
        "baseColorFactor": [r.min(1.0), g.min(1.0), b.min(1.0), 1.0], "metallicFactor": 0.0, "roughnessFactor": 0.6
    } })
}

/// The vertices that lines or ribbons join, and what they are in glTF. Ribbons have two vertices at each point.
pub(crate) fn joined(strands: &Strands, as_ribbons: bool) -> (Vec<u32>, u32) {
    let segments = |s: usize| {
        let range = strands.range(s);
        (range.start..range.end - 1).map(|at| at as u32)
    };
    let all = (0..strands.len()).flat_map(segments);
    if as_ribbons {
        // Left, right.
        let quad = |at: u32| [2 * at, 2 * at + 1, 2 * at + 2, 2 * at + 2, 2 * at + 1, 2 * at + 3];
        (all.flat_map(quad).collect(), TRIANGLES)
    } else {
        (all.flat_map(|at| [at, at + 1]).collect(), LINES)
    }
}

/// Numbers of 32 bits, with no more digits than these need.
pub(crate) fn short(numbers: &[f32]) -> Value {
    numbers.iter().map(|number| number.to_string().parse::<f64>().unwrap_or_default()).collect::<Vec<_>>().into()
}
