//! Meshes and strands of formats of their own that took gigabytes or minutes, made small.

use super::layers::Made;

/// A glTF of one triangle, its buffers and what else is said.
fn gltf(nodes: &str, meshes: &str, buffers: &str) -> String {
    format!(
        r#"{{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0]}}],"nodes":[{nodes}],"meshes":[{meshes}],
        "accessors":[{{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]}}],
        "bufferViews":[{{"buffer":0,"byteLength":36}}],"buffers":[{buffers}]}}"#
    )
}

const MESH: &str = r#"{"primitives":[{"attributes":{"POSITION":0}}]}"#;

fn glb(text: &str, binary: &[u8]) -> Vec<u8> {
    let mut text = text.as_bytes().to_vec();
    text.resize(text.len().next_multiple_of(4), b' ');
    let words = |words: &[u32]| words.iter().flat_map(|word| word.to_le_bytes()).collect::<Vec<u8>>();
    let length = 28 + text.len() + binary.len();
    let head = words(&[0x4654_6C67, 2, length as u32, text.len() as u32, 0x4E4F_534A]);
    [head, text, words(&[binary.len() as u32, 0x004E_4942]), binary.to_vec()].concat()
}

fn triangle() -> Vec<u8> {
    [0.0f32, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0].map(f32::to_le_bytes).concat()
}

/// A triangle on a skin whose joints hang one below the other. The first of them moves.
fn deep_joints(count: usize) -> Vec<u8> {
    let nodes: Vec<String> = (1..count).map(|below| format!(r#"{{"children":[{below}]}}"#)).collect();
    let joints: Vec<String> = (0..count).map(|joint| joint.to_string()).collect();
    let view = |at: usize, length: usize| format!(r#"{{"buffer":0,"byteOffset":{at},"byteLength":{length}}}"#);
    let of = |view: usize, kind: u32, count: usize, shape: &str| {
        format!(
            r#"{{"bufferView":{view},"componentType":{kind},"count":{count},"type":"{shape}","min":[0,0,0],"max":[1,1,0]}}"#
        )
    };
    let weights = [1.0f32, 0.0, 0.0, 0.0].repeat(3).iter().flat_map(|x| x.to_le_bytes()).collect::<Vec<u8>>();
    let times = [0.0f32, 1.0].iter().flat_map(|x| x.to_le_bytes()).collect::<Vec<u8>>();
    let ways = [0.0f32, 0.0, 0.0, 0.0, 1.0, 0.0].iter().flat_map(|x| x.to_le_bytes()).collect::<Vec<u8>>();
    let binary = [triangle(), weights, times, ways, vec![0; 12]].concat();
    let text = format!(
        r#"{{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0,{count}]}}],"nodes":[{},{{}},{{"mesh":0,"skin":0}}],
        "skins":[{{"joints":[{}]}}],
        "meshes":[{{"primitives":[{{"attributes":{{"POSITION":0,"WEIGHTS_0":1,"JOINTS_0":4}}}}]}}],
        "animations":[{{"samplers":[{{"input":2,"output":3}}],"channels":[{{"sampler":0,"target":{{"node":0,"path":"translation"}}}}]}}],
        "accessors":[{},{},{},{},{}],"bufferViews":[{},{},{},{},{}],"buffers":[{{"byteLength":{}}}]}}"#,
        nodes.join(","),
        joints.join(","),
        of(0, 5126, 3, "VEC3"),
        of(1, 5126, 3, "VEC4"),
        of(2, 5126, 2, "SCALAR"),
        of(3, 5126, 2, "VEC3"),
        of(4, 5121, 3, "VEC4"),
        view(0, 36),
        view(36, 48),
        view(84, 8),
        view(92, 24),
        view(116, 12),
        binary.len()
    );
    glb(&text, &binary)
}

pub fn all() -> Vec<Made> {
    let mut made = Vec::new();
    let node = r#"{"mesh":0}"#;

    // One file, under several names, and one chunk, for very many buffers.
    made.push(("big.bin", vec![0; 10_000_000]));
    let many: Vec<String> =
        (0..300).map(|n| format!(r#"{{"byteLength":10000000,"uri":"{}big.bin"}}"#, "./".repeat(n % 3))).collect();
    made.push(("one_file_for_many.gltf", gltf(node, MESH, &many.join(",")).into()));
    let chunk = [triangle(), vec![0; 1_000_000 - 36]].concat();
    let many = vec![r#"{"byteLength":1000000}"#; 10_000].join(",");
    made.push(("one_chunk_for_many.glb", glb(&gltf(node, MESH, &many), &chunk)));

    // One mesh for many nodes, and nodes of two bytes.
    let points = triangle().repeat(20_000);
    let large = gltf("", MESH, &format!(r#"{{"byteLength":{}}}"#, points.len()));
    let large = large
        .replace(r#""count":3"#, r#""count":60000"#)
        .replace(r#""byteLength":36"#, &format!(r#""byteLength":{}"#, points.len()));
    let children: Vec<String> = (1..5000).map(|n| n.to_string()).collect();
    let nodes = format!(r#"{{"children":[{}]}}{}"#, children.join(","), format!(",{node}").repeat(4999));
    made.push((
        "one_mesh_for_many.glb",
        glb(&large.replace(r#""nodes":[]"#, &format!(r#""nodes":[{nodes}]"#)), &points),
    ));
    let smallest = format!("{node}{}", ",{}".repeat(2_000_000));
    made.push(("smallest_nodes.gltf", gltf(&smallest, MESH, r#"{"byteLength":36,"uri":"big.bin"}"#).into()));
    let extremes = format!(r#""min":[0,0,0{}]"#, ",0".repeat(2_000_000));
    let text = gltf(node, MESH, r#"{"byteLength":36,"uri":"big.bin"}"#);
    made.push(("long_extremes.gltf", text.replacen(r#""min":[0,0,0]"#, &extremes, 1).into()));
    let nested = "[".repeat(1_000_000);
    made.push(("nested.gltf", text.replacen(r#""min":[0,0,0]"#, &format!(r#""min":{nested}"#), 1).into()));

    // Joints one below the other, each of them of the skin.
    made.push(("deep_joints.glb", deep_joints(30_000)));

    // Elements of nothing, and faces of bytes.
    let header = |elements: &str| format!("ply\nformat binary_little_endian 1.0\n{elements}end_header\n").into_bytes();
    let nothing = "element vertex 1000000\n".repeat(45_000);
    made.push(("vertices_of_nothing.ply", header(&nothing)));
    let vertex = "element vertex 1000000\nproperty list uchar float l\n";
    made.push(("lists_of_nothing.ply", [header(&vertex.repeat(1000)), vec![0; 1_000_000]].concat()));
    let face = "element vertex 1\nproperty char x\nelement face 1\nproperty list uint uchar vertex_index\n";
    let body = [vec![0], 4_000_000u32.to_le_bytes().to_vec(), vec![0; 4_000_000]].concat();
    made.push(("face_of_bytes.ply", [header(face), body].concat()));
    let properties = format!("element vertex 1\n{}", "property char x\n".repeat(200_000));
    made.push(("many_properties.ply", [header(&properties), vec![0; 200_000]].concat()));

    let vertices = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    made.push(("long_face.obj", format!("{vertices}f{}\n", " 1 2 3".repeat(700_000)).into()));
    made.push(("long_strand.obj", format!("{vertices}l{}\n", " 1 2 3".repeat(700_000)).into()));
    made.push(("short_strands.obj", format!("{vertices}{}", "l 1 2\n".repeat(700_000)).into()));
    made.push(("long_group.obj", format!("{vertices}g {}\nf 1 2 3\n", "g".repeat(4_000_000)).into()));
    made.push(("continued.obj", format!("{vertices}{}\nf 1 2 3\n", "\\\n".repeat(2_000_000)).into()));
    let counts = "numOfBones 0\nnumOfVertices 4000000000\n";
    made.push(("claimed.tfxmesh", format!("{counts}0 0 0 0\n").into()));

    // Counts that claim all there can be.
    let hair = [&b"HAIR"[..], &[u32::MAX, u32::MAX, 31, 0].map(u32::to_le_bytes).concat(), &[0; 1000]].concat();
    made.push(("claimed.hair", hair));
    let points = [&b"HAIR"[..], &[80_000, 80_000, 2, 0].map(u32::to_le_bytes).concat(), &[0; 108 + 960_000]].concat();
    made.push(("strands_of_one_point.hair", points));
    let tfx =
        [4f32.to_le_bytes().to_vec(), [65_535u32, 65_535, 160].map(u32::to_le_bytes).concat(), vec![0; 1000]].concat();
    made.push(("claimed.tfx", tfx));
    made
}
