//! The bytes of a `.glb` with chains of joints: the JSON, and one buffer.

use std::io::{self, Write};

use glam::{DAffine3, DQuat, Vec3};
use nabiki::Strands;
use serde_json::{Value, json};

use super::Springs;
use super::bind::Influence;
use super::chain::{Bone, Guide};
use crate::gltf_write::{
    Binary, FLOAT, SHORT, TRIANGLES, UNSIGNED_BYTE, UNSIGNED_SHORT, VERTICES, joined, material, ribbons, short,
};

/// Roots of skin that move less than this stay where they are (m).
const STAYS: f64 = 1e-6;

/// What is written. Points are in metres, y up, on the head.
pub(super) struct Scene<'a> {
    pub rest: &'a Strands,
    /// The origin of the head.
    pub center: Vec3,
    /// What leads each of these points.
    pub bound: &'a [Influence],
    pub guides: &'a [Guide],
    /// The head in each frame.
    pub heads: &'a [DAffine3],
    pub frame_rate: f64,
    /// Linear RGB.
    pub colour: [f32; 3],
    /// Half the width of ribbons (m); `None` draws lines.
    pub half_width: Option<f32>,
    /// Vertices and triangles of the head.
    pub head: Option<(Vec<Vec3>, &'a [[u32; 3]])>,
    pub springs: Option<Springs>,
}

/// Writes the file.
pub(super) fn write(scene: &Scene<'_>, to: &mut impl Write) -> io::Result<()> {
    let mut binary = Binary::default();
    let mesh = hair(scene, &mut binary);
    let (mut nodes, joints) = joints(scene);
    let skin = skin(scene, &joints, &mut binary);
    let animation = animation(scene, &joints, &mut binary);
    nodes.push(json!({ "name": "hair", "mesh": 0, "skin": 0 }));
    let roots = json!([0, nodes.len() - 1]);
    let mut meshes = vec![mesh];
    let mut materials = vec![material("hair", scene.colour, scene.half_width.is_some())];
    if let Some((points, triangles)) = &scene.head {
        let position = binary.positions(points);
        let indices = binary.indices(triangles.as_flattened());
        meshes.push(json!({ "name": "head", "primitives": [
            { "attributes": { "POSITION": position }, "indices": indices, "mode": TRIANGLES, "material": 1 }
        ] }));
        materials.push(material("skin", [0.75, 0.5, 0.4], false));
        nodes[0]["mesh"] = 1.into();
    }
    let mut document = json!({
        "scene": 0,
        "scenes": [{ "nodes": roots }],
        "nodes": nodes,
        "meshes": meshes,
        "materials": materials,
        "skins": [skin],
    });
    if let Some(springs) = scene.springs {
        document["extensionsUsed"] = json!(["VRMC_springBone"]);
        document["extensions"] = json!({ "VRMC_springBone": spring_bones(scene.guides, &joints, springs) });
    }
    if scene.heads.len() > 1 {
        document["animations"] = json!([animation]);
    }
    binary.write(document, to)
}

/// The mesh of the hair at rest: lines, or a ribbon for each strand.
fn hair(scene: &Scene<'_>, binary: &mut Binary) -> Value {
    let strands = scene.rest;
    let (points, each) = match scene.half_width {
        None => (strands.points().to_vec(), 1),
        Some(half) => (strands.iter().flat_map(|strand| ribbons::ribbon(strand, half, scene.center)).collect(), 2),
    };
    let (mut joints, mut weights): (Vec<[u16; 4]>, Vec<[u8; 4]>) = (Vec::new(), Vec::new());
    for (of, by) in scene.bound {
        for _ in 0..each {
            joints.push(*of);
            weights.push(*by);
        }
    }
    let (indices, mode) = joined(strands, each == 2);
    let position = binary.positions(&points);
    let view = binary.view(bytemuck::cast_slice(&joints), VERTICES);
    let joints = binary.accessor(view, 0, UNSIGNED_SHORT, "VEC4", points.len());
    let view = binary.view(bytemuck::cast_slice(&weights), VERTICES);
    let weights = binary.accessor(view, 0, UNSIGNED_BYTE, "VEC4", points.len());
    binary.accessors[weights]["normalized"] = true.into();
    let mut attributes = json!({ "POSITION": position, "JOINTS_0": joints, "WEIGHTS_0": weights });
    if each == 2 {
        attributes["TEXCOORD_0"] = binary.ribbon_uvs(strands).into();
        let all = strands.iter().flat_map(|strand| ribbons::normals(strand, scene.center));
        let normals: Vec<Vec3> = all.flat_map(|normal| [normal; 2]).collect();
        attributes["NORMAL"] = binary.vectors(&normals, VERTICES).into();
    }
    let indices = binary.indices(&indices);
    json!({ "name": "hair", "primitives": [
        { "attributes": attributes, "indices": indices, "mode": mode, "material": 0 }
    ] })
}

/// The nodes, of which the first is the head, and the numbers of those that are joints, guide by guide.
fn joints(scene: &Scene<'_>) -> (Vec<Value>, Vec<usize>) {
    let mut nodes = vec![Value::Null];
    let (mut joints, mut roots) = (Vec::new(), Vec::new());
    for (g, guide) in scene.guides.iter().enumerate() {
        let count = guide.rest.len() - 1;
        roots.push(nodes.len());
        for k in 0..count {
            let from = if k == 0 { guide.rest[0] } else { guide.rest[k] - guide.rest[k - 1] };
            let mut node = json!({ "name": format!("hair_{g}_{k}"), "translation": short(&from.to_array()) });
            if k + 1 < count || scene.springs.is_some() {
                node["children"] = json!([nodes.len() + 1]);
            }
            joints.push(nodes.len());
            nodes.push(node);
        }
        if scene.springs.is_some() {
            // Where the last bone ends: no joint of the skin, but the last of the spring.
            let bone = guide.rest[count] - guide.rest[count - 1];
            nodes.push(json!({ "name": format!("hair_{g}_end"), "translation": short(&bone.to_array()) }));
        }
    }
    nodes[0] = json!({ "name": "head", "children": roots });
    if let Some(head) = scene.heads.first() {
        let (turn, place) = placed(head);
        nodes[0]["translation"] = short(&place);
        nodes[0]["rotation"] = short(&turn);
    }
    (nodes, joints)
}

/// Rotation and translation of a rigid transform.
fn placed(transform: &DAffine3) -> ([f32; 4], [f32; 3]) {
    let (_, turn, place) = transform.to_scale_rotation_translation();
    (turn.as_quat().to_array(), place.as_vec3().to_array())
}

/// The chains as spring bones, after VRM's extension `VRMC_springBone` 1.0.
fn spring_bones(guides: &[Guide], joints: &[usize], Springs { stiffness, drag }: Springs) -> Value {
    let mut first = 0;
    let mut springs = Vec::new();
    for (g, guide) in guides.iter().enumerate() {
        let own = &joints[first..first + guide.rest.len() - 1];
        first += own.len();
        let bone = |&node: &usize| {
            json!({
                "node": node, "hitRadius": 0.0, "stiffness": stiffness, "dragForce": drag,
                "gravityPower": 0.0, "gravityDir": [0.0, -1.0, 0.0]
            })
        };
        let mut bones: Vec<Value> = own.iter().map(bone).collect();
        bones.extend(own.last().map(|last| json!({ "node": last + 1 })));
        springs.push(json!({ "name": format!("hair_{g}"), "joints": bones }));
    }
    json!({ "specVersion": "1.0", "springs": springs })
}

/// The joints that lead the hair, and where they are when it is at rest.
fn skin(scene: &Scene<'_>, joints: &[usize], binary: &mut Binary) -> Value {
    let rest = scene.guides.iter().flat_map(|guide| &guide.rest[..guide.rest.len() - 1]);
    let inverse: Vec<[f32; 16]> = rest.map(|&p| glam::Mat4::from_translation(-p).to_cols_array()).collect();
    let view = binary.view(bytemuck::cast_slice(&inverse), None);
    let inverse = binary.accessor(view, 0, FLOAT, "MAT4", joints.len());
    json!({ "joints": joints, "inverseBindMatrices": inverse, "skeleton": 0 })
}

/// The animation of head and joints.
fn animation(scene: &Scene<'_>, joints: &[usize], binary: &mut Binary) -> Value {
    let frames = scene.heads.len();
    let times: Vec<f32> = (0..frames).map(|n| (n as f64 / scene.frame_rate) as f32).collect();
    let view = binary.view(bytemuck::cast_slice(&times), None);
    let input = binary.accessor(view, 0, FLOAT, "SCALAR", frames);
    binary.accessors[input]["min"] = short(&times[..1]);
    binary.accessors[input]["max"] = short(&times[frames - 1..]);
    let (mut samplers, mut channels) = (Vec::new(), Vec::new());
    let mut channel = |output: usize, node: usize, path: &str| {
        channels.push(json!({ "sampler": samplers.len(), "target": { "node": node, "path": path } }));
        samplers.push(json!({ "input": input, "output": output }));
    };
    if scene.heads.iter().any(|head| *head != scene.heads[0]) {
        let (turns, places): (Vec<DQuat>, Vec<Vec3>) =
            scene.heads.iter().map(placed).map(|(q, p)| (DQuat::from_array(q.map(f64::from)), Vec3::from(p))).unzip();
        let turns: Vec<[f32; 4]> = continuous(&turns).iter().map(|q| q.as_quat().to_array()).collect();
        let view = binary.view(bytemuck::cast_slice(&turns), None);
        channel(binary.accessor(view, 0, FLOAT, "VEC4", frames), 0, "rotation");
        channel(binary.vectors(&places, None), 0, "translation");
    }
    // All turns in one view, in 16 bits: 3e-5 rad, which no eye sees.
    let mut turns: Vec<[i16; 4]> = Vec::new();
    let mut offsets = Vec::new();
    let mut moving: Vec<(usize, Vec<Vec3>)> = Vec::new();
    let mut first = 0;
    for guide in scene.guides {
        let bones: Vec<Vec<Bone>> = (0..frames).map(|n| guide.bones(n)).collect();
        for k in 0..guide.rest.len() - 1 {
            let local = |bones: &Vec<Bone>| {
                let before = if k > 0 { bones[k - 1].turn } else { DQuat::IDENTITY };
                (before.inverse() * bones[k].turn).normalize()
            };
            offsets.push(8 * turns.len());
            let of_joint: Vec<DQuat> = bones.iter().map(local).collect();
            turns.extend(continuous(&of_joint).iter().map(|q| q.to_array().map(|x| (32767.0 * x).round() as i16)));
        }
        if bones.iter().any(|bones| bones[0].joint.distance(bones[0].rest) > STAYS) {
            moving.push((joints[first], bones.iter().map(|bones| bones[0].joint.as_vec3()).collect()));
        }
        first += guide.rest.len() - 1;
    }
    let view = binary.view(bytemuck::cast_slice(&turns), None);
    for (&node, offset) in joints.iter().zip(offsets) {
        let output = binary.accessor(view, offset, SHORT, "VEC4", frames);
        binary.accessors[output]["normalized"] = true.into();
        channel(output, node, "rotation");
    }
    for (node, places) in moving {
        channel(binary.vectors(&places, None), node, "translation");
    }
    json!({ "name": "hair", "channels": channels, "samplers": samplers })
}

/// The same turns, each with the sign that is nearer to the one before it.
fn continuous(turns: &[DQuat]) -> Vec<DQuat> {
    let mut before = DQuat::IDENTITY;
    let nearer = |&turn: &DQuat| {
        before = if turn.dot(before) < 0.0 { -turn } else { turn };
        before
    };
    turns.iter().map(nearer).collect()
}
