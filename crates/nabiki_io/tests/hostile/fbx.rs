//! FBX files that ask for much, made small.

use super::layers::Made;

const SETTINGS: &str = "; FBX 7.4.0 project file\nFBXHeaderExtension: {\nFBXVersion: 7400\n}\n";

fn list(values: impl Iterator<Item = i64>) -> String {
    let values: Vec<String> = values.map(|value| value.to_string()).collect();
    format!("*{} {{ a: {} }}", values.len(), values.join(","))
}

/// A mesh, number 1, of one polygon, with these coordinates.
fn mesh(coordinates: impl Iterator<Item = i64>, corners: i64) -> String {
    let ends = (0..corners).map(|v| if v + 1 == corners { -v - 1 } else { v });
    let (vertices, polygon) = (list(coordinates), list(ends));
    format!("Geometry: 1, \"Geometry::\", \"Mesh\" {{\nVertices: {vertices}\nPolygonVertexIndex: {polygon}\n}}\n")
}

fn file(objects: &str, connections: &str) -> Vec<u8> {
    format!("{SETTINGS}Objects: {{\n{objects}}}\nConnections: {{\n{connections}}}\n").into()
}

pub fn all() -> Vec<Made> {
    let mut made = Vec::new();
    let node = |n: usize| format!("Model: {n}, \"Model::n{n}\", \"Mesh\" {{\n}}\n");

    // One mesh for very many nodes.
    let nodes: String = (2..5000).map(node).collect();
    let shown: String = (2..5000).map(|n| format!("C: \"OO\",1,{n}\nC: \"OO\",{n},0\n")).collect();
    made.push(("one_mesh_for_many.fbx", file(&(mesh((0..90_000).map(|i| i % 7), 3) + &nodes), &shown)));

    // Nodes below one another, and nothing but nodes.
    let below: String = (2..5000).map(|n| format!("C: \"OO\",{},{n}\n", n + 1)).collect();
    made.push(("deep.fbx", file(&nodes, &below)));
    made.push(("nodes.fbx", file(&(2..60_000).map(node).collect::<String>(), "")));

    // A polygon that is all ears, as large as the file.
    let zigzag = (0..60_000).flat_map(|i| [if i % 2 == 0 { i } else { 60_000 - i }, (i * 7919) % 10_007, i % 3]);
    made.push(("one_polygon.fbx", file(&(mesh(zigzag, 60_000) + &node(2)), "C: \"OO\",1,2\nC: \"OO\",2,0\n")));

    // A chain of nodes in an animation of days.
    let chain: String = (2..900).map(node).collect();
    let below: String = (3..900).map(|n| format!("C: \"OO\",{n},{}\n", n - 1)).collect();
    let days = 46_186_158_000_i64 * 10_000;
    let moved = format!(
        "{chain}Model: 900, \"Model::Head\", \"Null\" {{\n}}\nAnimationStack: 1000, \"AnimStack::a\", \"\" {{\nProperties70: {{\n\
         P: \"LocalStop\", \"KTime\", \"Time\", \"\",{days}\n}}\n}}\nAnimationLayer: 1001, \"AnimLayer::a\", \"\" {{\n}}\n"
    );
    made.push(("days.fbx", file(&moved, &format!("{below}C: \"OO\",2,0\nC: \"OO\",900,899\nC: \"OO\",1001,1000\n"))));

    made.push(("zeros.fbx", zeros(30_000_000)));
    made.push(("open.fbx", [SETTINGS.as_bytes(), &b"a: {\n".repeat(300_000)].concat()));
    made
}

/// A binary file whose mesh has this many coordinates, all 0 and packed.
fn zeros(count: u32) -> Vec<u8> {
    let packed = packed_zeros(8 * u64::from(count));
    let property =
        [&b"d"[..], &count.to_le_bytes(), &1_u32.to_le_bytes(), &(packed.len() as u32).to_le_bytes(), &packed].concat();
    let mut bytes = b"Kaydara FBX Binary  \0\x1a\0".to_vec();
    bytes.extend(7400_u32.to_le_bytes());
    let name = |name: &[u8]| [&b"S"[..], &(name.len() as u32).to_le_bytes(), name].concat();
    let of_mesh = [&b"L"[..], &1_i64.to_le_bytes(), &name(b"\0\x01Geometry"), &name(b"Mesh")].concat();
    let outer = [(&b"Objects"[..], 0_u32, Vec::new()), (b"Geometry", 3, of_mesh), (b"Vertices", 1, property)];
    let mut ends = Vec::new();
    for (name, properties, values) in outer {
        ends.push(bytes.len());
        bytes.extend([0; 4]);
        bytes.extend([properties, values.len() as u32].map(u32::to_le_bytes).concat());
        bytes.push(name.len() as u8);
        bytes.extend([name, &values].concat());
    }
    // Each node but the innermost ends with an empty one, and so does the file.
    for (depth, at) in ends.into_iter().rev().enumerate() {
        bytes.extend(vec![0; if depth == 0 { 0 } else { 13 }]);
        let end = (bytes.len() as u32).to_le_bytes();
        bytes[at..at + 4].copy_from_slice(&end);
    }
    bytes.extend([0; 13]);
    bytes
}

/// So many zeros as zlib has them: one, and copies of 258 of those before.
fn packed_zeros(count: u64) -> Vec<u8> {
    let mut bits = Vec::new();
    let mut put = |code: u32, length: u32| bits.extend((0..length).rev().map(|bit| (code >> bit & 1) as u8));
    // The last block, with the fixed codes.
    put(0b110, 3);
    put(0x30, 8);
    for _ in 0..(count - 1) / 258 {
        put(0b1100_0101, 8);
        put(0, 5);
    }
    for _ in 0..(count - 1) % 258 {
        put(0x30, 8);
    }
    put(0, 7);
    let packed = bits.chunks(8).map(|byte| byte.iter().enumerate().fold(0, |sum, (place, bit)| sum | bit << place));
    let sum = ((count % 65_521) as u32) << 16 | 1;
    [vec![0x78, 0x01], packed.collect(), sum.to_be_bytes().to_vec()].concat()
}
