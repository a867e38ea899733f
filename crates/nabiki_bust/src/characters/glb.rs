//! The .glb of a character: meshes, one skin, morphs and one clip with a key a frame. Written by the book of glTF 2.0.
//!
//! The file is in metres, y up, the face along +z; here all is in centimetres with the face along +x and her right along +z.

use glam::{Quat, Vec3};
use serde_json::{Value, json};

use super::net::Skin;
use super::rig::{Joint, Move, Shares};

/// Frames a second of the clip.
pub(super) const RATE: f64 = 24.0;

const FLOAT: u32 = 5126;
const BYTE: u32 = 5121;
const SHORT: u32 = 5123;

/// A character, ready to be written.
pub(super) struct Character<'a> {
    pub clip: &'a str,
    pub joints: &'a [Joint],
    pub meshes: Vec<Mesh<'a>>,
    /// What each joint does in each frame.
    pub frames: Vec<Vec<Move>>,
    /// Where the origin of the sculpture stands in the file (cm).
    pub at: Vec3,
}

/// A mesh that hangs on the joints.
pub(super) struct Mesh<'a> {
    pub name: &'a str,
    pub skin: &'a Skin,
    pub shares: Vec<Shares>,
    /// By how much the vertices move under each morph (cm), and its weight in each frame.
    pub morphs: Vec<(&'a str, Vec<Vec3>, Vec<f32>)>,
}

/// A place (cm) in the file's axes and unit.
pub(super) fn place(p: Vec3) -> Vec3 {
    Vec3::new(-p.z, p.y, p.x) / 100.0
}

fn turn(q: Quat) -> Quat {
    Quat::from_xyzw(-q.z, q.y, q.x, q.w)
}

/// The binary chunk and what the text says of it.
#[derive(Default)]
struct Pool {
    binary: Vec<u8>,
    views: Vec<Value>,
    accessors: Vec<Value>,
}

impl Pool {
    fn put(&mut self, bytes: &[u8], count: usize, shape: &str, component: u32) -> usize {
        self.views.push(json!({ "buffer": 0, "byteOffset": self.binary.len(), "byteLength": bytes.len() }));
        self.binary.extend(bytes);
        self.binary.resize(self.binary.len().next_multiple_of(4), 0);
        let view = self.views.len() - 1;
        self.accessors.push(json!({ "bufferView": view, "componentType": component, "count": count, "type": shape }));
        self.accessors.len() - 1
    }

    fn floats<const N: usize>(&mut self, all: &[[f32; N]], shape: &str) -> usize {
        let bytes: Vec<u8> = all.iter().flatten().flat_map(|x| x.to_le_bytes()).collect();
        self.put(&bytes, all.len(), shape, FLOAT)
    }

    /// Floats whose least and greatest the text must name.
    fn bounded<const N: usize>(&mut self, all: &[[f32; N]], shape: &str) -> usize {
        let accessor = self.floats(all, shape);
        let bound = |pick: fn(f32, f32) -> f32| -> Vec<f32> {
            (0..N).map(|axis| all.iter().map(|p| p[axis]).reduce(pick).unwrap_or_default()).collect()
        };
        self.accessors[accessor]["min"] = json!(bound(f32::min));
        self.accessors[accessor]["max"] = json!(bound(f32::max));
        accessor
    }

    fn shares(&mut self, all: &[[u8; 4]], normalised: bool) -> usize {
        let accessor = self.put(all.as_flattened(), all.len(), "VEC4", BYTE);
        if normalised {
            self.accessors[accessor]["normalized"] = json!(true);
        }
        accessor
    }
}

/// The bytes of the file.
pub(super) fn write(character: &Character<'_>) -> Vec<u8> {
    let Character { clip, joints, meshes, frames, at } = character;
    let mut pool = Pool::default();
    let first = &frames[0];
    // Joints are the first nodes, in their order; the meshes follow.
    let mut nodes: Vec<Value> = (joints.iter().zip(first).enumerate())
        .map(|(j, (joint, moved))| {
            let below: Vec<usize> = (0..joints.len()).filter(|&other| joints[other].above == Some(j)).collect();
            let mut node = json!({
                "name": joint.name,
                "translation": offset(joints, j, moved, *at).to_array(),
                "rotation": turn(moved.turn).to_array(),
            });
            if !below.is_empty() {
                node["children"] = json!(below);
            }
            node
        })
        .collect();
    let binds: Vec<[f32; 16]> =
        joints.iter().map(|joint| glam::Mat4::from_translation(-place(joint.place + *at)).to_cols_array()).collect();
    let binds = pool.floats(&binds, "MAT4");

    let mut of_meshes = Vec::new();
    for mesh in meshes {
        of_meshes.push(mesh_of(mesh, *at, &mut pool));
        let mut node = json!({ "name": mesh.name, "mesh": of_meshes.len() - 1, "skin": 0 });
        if !mesh.morphs.is_empty() {
            node["weights"] = json!(mesh.morphs.iter().map(|(_, _, weights)| weights[0]).collect::<Vec<_>>());
        }
        nodes.push(node);
    }

    let times: Vec<[f32; 1]> = (0..frames.len()).map(|n| [(n as f64 / RATE) as f32]).collect();
    let times = pool.bounded(&times, "SCALAR");
    let (mut samplers, mut channels) = (Vec::new(), Vec::new());
    let mut channel = |node: usize, path: &str, output: usize| {
        channels.push(json!({ "sampler": samplers.len(), "target": { "node": node, "path": path } }));
        samplers.push(json!({ "input": times, "output": output, "interpolation": "LINEAR" }));
    };
    for j in 0..joints.len() {
        let of_joint = || frames.iter().map(move |frame| &frame[j]);
        if of_joint().any(|moved| moved.turn != first[j].turn) {
            let turns: Vec<[f32; 4]> = of_joint().map(|moved| turn(moved.turn).to_array()).collect();
            channel(j, "rotation", pool.floats(&turns, "VEC4"));
        }
        if of_joint().any(|moved| moved.way != first[j].way) {
            let ways: Vec<[f32; 3]> = of_joint().map(|moved| offset(joints, j, moved, *at).to_array()).collect();
            channel(j, "translation", pool.floats(&ways, "VEC3"));
        }
    }
    for (m, mesh) in meshes.iter().enumerate().filter(|(_, mesh)| !mesh.morphs.is_empty()) {
        let weights: Vec<[f32; 1]> =
            (0..frames.len()).flat_map(|n| mesh.morphs.iter().map(move |(_, _, weights)| [weights[n]])).collect();
        channel(joints.len() + m, "weights", pool.floats(&weights, "SCALAR"));
    }

    let roots: Vec<usize> =
        (0..nodes.len()).filter(|&n| joints.get(n).is_none_or(|joint| joint.above.is_none())).collect();
    let skin = json!({ "joints": (0..joints.len()).collect::<Vec<_>>(), "inverseBindMatrices": binds, "skeleton": 0 });
    let document = json!({
        "asset": { "version": "2.0", "generator": "nabiki_bust" },
        "scene": 0,
        "scenes": [{ "nodes": roots }],
        "nodes": nodes,
        "skins": [skin],
        "meshes": of_meshes,
        "animations": [{ "name": clip, "samplers": samplers, "channels": channels }],
        "accessors": pool.accessors,
        "bufferViews": pool.views,
        "buffers": [{ "byteLength": pool.binary.len() }],
    });
    chunks(document.to_string().into_bytes(), &pool.binary)
}

fn mesh_of(mesh: &Mesh<'_>, at: Vec3, pool: &mut Pool) -> Value {
    let places: Vec<[f32; 3]> = mesh.skin.places.iter().map(|&p| place(p + at).to_array()).collect();
    let (joints, shares): (Vec<[u8; 4]>, Vec<[u8; 4]>) = mesh.shares.iter().cloned().map(Shares::bytes).unzip();
    let corners: Vec<u8> = mesh.skin.triangles.iter().flatten().flat_map(|&v| (v as u16).to_le_bytes()).collect();
    assert!(mesh.skin.places.len() < usize::from(u16::MAX), "{} has too many vertices for 16 bits", mesh.name);
    let mut primitive = json!({
        "attributes": {
            "POSITION": pool.bounded(&places, "VEC3"),
            "JOINTS_0": pool.shares(&joints, false),
            "WEIGHTS_0": pool.shares(&shares, true),
        },
        "indices": pool.put(&corners, 3 * mesh.skin.triangles.len(), "SCALAR", SHORT),
    });
    let mut all = json!({ "name": mesh.name });
    if !mesh.morphs.is_empty() {
        let targets: Vec<Value> =
            (mesh.morphs.iter()).map(|(_, ways, _)| json!({ "POSITION": sparse(ways, pool) })).collect();
        primitive["targets"] = json!(targets);
        all["extras"] = json!({ "targetNames": mesh.morphs.iter().map(|(name, ..)| name).collect::<Vec<_>>() });
    }
    all["primitives"] = json!([primitive]);
    all
}

/// The ways of a morph, of which most are 0: only the others are stored.
fn sparse(ways: &[Vec3], pool: &mut Pool) -> usize {
    let moved: Vec<usize> = (0..ways.len()).filter(|&v| ways[v].length() > 1e-3).collect();
    let by: Vec<[f32; 3]> = moved.iter().map(|&v| place(ways[v]).to_array()).collect();
    let corner = |pick: fn(Vec3, Vec3) -> Vec3| by.iter().map(|&way| Vec3::from(way)).fold(Vec3::ZERO, pick).to_array();
    let indices: Vec<u8> = moved.iter().flat_map(|&v| (v as u16).to_le_bytes()).collect();
    let of_indices = pool.put(&indices, moved.len(), "SCALAR", SHORT);
    let of_values = pool.floats(&by, "VEC3");
    // Both are views of the accessor that is made next, not accessors of their own.
    let [indices, values] = [of_indices, of_values].map(|a| pool.accessors[a]["bufferView"].clone());
    pool.accessors.truncate(of_indices);
    pool.accessors.push(json!({
        "componentType": FLOAT, "count": ways.len(), "type": "VEC3", "min": corner(Vec3::min), "max": corner(Vec3::max),
        "sparse": {
            "count": moved.len(),
            "indices": { "bufferView": indices, "componentType": SHORT },
            "values": { "bufferView": values },
        },
    }));
    pool.accessors.len() - 1
}

/// Where a joint is below the one above it.
fn offset(joints: &[Joint], j: usize, moved: &Move, at: Vec3) -> Vec3 {
    let above = joints[j].above.map_or(-at, |above| joints[above].place);
    place(joints[j].place + moved.way - above)
}

fn chunks(mut text: Vec<u8>, binary: &[u8]) -> Vec<u8> {
    text.resize(text.len().next_multiple_of(4), b' ');
    let mut glb = b"glTF".to_vec();
    let mut words = |words: [u32; 2], bytes: &[u8]| {
        glb.extend(words.iter().flat_map(|word| word.to_le_bytes()));
        glb.extend(bytes);
    };
    words([2, (28 + text.len() + binary.len()) as u32], &[]);
    words([text.len() as u32, 0x4E4F_534A], &text);
    words([binary.len() as u32, 0x004E_4942], binary);
    glb
}
