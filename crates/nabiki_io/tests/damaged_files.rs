//! Damaged files are errors: never a panic, never room for more than a small multiple of the file.
//!
//! One test on its own in this program: it watches the memory of the whole process.

#[allow(dead_code, reason = "shared by several test programs, each of which uses a part")]
mod samples;

use nabiki_io::{cache, hair_file, mesh, obj_lines, tfx};
use peak_alloc::PeakAlloc;

#[global_allocator]
static MEMORY: PeakAlloc = PeakAlloc;

const OBJ: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\ng a\nf 1 2/2 3/-2/1 4\n\
    g b\nf -1/2/3 -2//4 1\nl 1 2 3\nl 3/1 4\n";

const TFXMESH: &str = "numOfBones 1\n# bone index, bone name\n0 root\nnumOfVertices 3\n0 0 0 0 0 0 1 0 0 0 0 1 0 0 0\n\
    1 1 0 0 0 0 1 0 0 0 0 1 0 0 0\n2 0 1 0 0 0 1 0 0 0 0 1 0 0 0\nnumOfTriangles 1\n0 0 1 2\n";

const FBX: &str = "; FBX 7.4.0 project file\nFBXHeaderExtension: {\nFBXVersion: 7400\n}\nObjects: {\n\
    Geometry: 1, \"Geometry::\", \"Mesh\" {\nVertices: *12 { a: 0,0,0,1,0,0,1,1,0,0,1,0 }\n\
    PolygonVertexIndex: *7 { a: 0,1,2,-4,0,1,-3 }\n}\n\
    Model: 2, \"Model::a\", \"Mesh\" {\nProperties70: {\nP: \"Lcl Scaling\", \"Lcl Scaling\", \"\", \"A\",-1,1,1\n}\n}\n}\n\
    Connections: {\nC: \"OO\",1,2\nC: \"OO\",2,0\n}\n";

/// A .glb of one triangle under a turned, mirrored node.
fn glb() -> Vec<u8> {
    let json = r#"{"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],
        "nodes":[{"children":[1],"scale":[-1,1,1]},{"mesh":0,"translation":[1,2,3]}],
        "meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1}]}],
        "accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]},
        {"bufferView":1,"componentType":5123,"count":3,"type":"SCALAR"}],
        "bufferViews":[{"buffer":0,"byteLength":36},{"buffer":0,"byteOffset":36,"byteLength":6}],
        "buffers":[{"byteLength":44}]}"#;
    let mut json = json.as_bytes().to_vec();
    json.resize(json.len().next_multiple_of(4), b' ');
    let mut binary = [0.0f32, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0].map(f32::to_le_bytes).concat();
    binary.extend([0, 0, 1, 0, 2, 0, 0, 0]);
    let mut glb = b"glTF".to_vec();
    let words = |words: &[u32]| words.iter().flat_map(|w| w.to_le_bytes()).collect::<Vec<u8>>();
    glb.extend(words(&[2, (28 + json.len() + binary.len()) as u32, json.len() as u32, 0x4E4F_534A]));
    glb.extend(json);
    glb.extend(words(&[binary.len() as u32, 0x004E_4942]));
    glb.extend(binary);
    glb
}

/// Reads all that a file offers; true if it was accepted.
type Read = fn(&[u8]) -> bool;

fn formats() -> [(&'static str, Vec<u8>, Read); 9] {
    let read_cache: Read = |bytes| {
        let Ok(mut reader) = cache::Reader::from_bytes(bytes) else { return false };
        (0..reader.frame_count()).all(|frame| reader.hair(frame).is_ok())
    };
    [
        (".hair", samples::hair_bytes(), |bytes| hair_file::from_bytes(bytes).is_ok()),
        (".tfx 4", samples::tfx_bytes(), |bytes| tfx::from_bytes(bytes).is_ok()),
        (".tfx 3", samples::tfx_3_bytes(), |bytes| tfx::from_bytes(bytes).is_ok()),
        (".obj lines", OBJ.into(), |bytes| obj_lines::from_bytes(bytes).is_ok()),
        (".obj", OBJ.into(), |bytes| mesh::from_bytes(bytes, "obj", &[]).is_ok()),
        (".tfxmesh", TFXMESH.into(), |bytes| mesh::from_bytes(bytes, "tfxmesh", &[]).is_ok()),
        (".glb", glb(), |bytes| mesh::from_bytes(bytes, "glb", &[]).is_ok()),
        (".fbx", FBX.into(), |bytes| mesh::from_bytes(bytes, "fbx", &[]).is_ok()),
        ("cache", samples::cache_bytes(), read_cache),
    ]
}

/// Room allowed for a file: a small multiple of its length; the parsers of text and JSON take more, and some at once.
fn allowance(name: &str, bytes: &[u8]) -> usize {
    match name {
        ".obj" | ".obj lines" | ".tfxmesh" | ".glb" => 64 * bytes.len() + (1 << 18),
        // ufbx makes its tables of names and properties for any file.
        ".fbx" => 64 * bytes.len() + (1 << 22),
        _ => 4 * bytes.len() + (1 << 12),
    }
}

fn survives(name: &str, bytes: &[u8], read: Read) -> bool {
    let before = MEMORY.current_usage();
    MEMORY.reset_peak_usage();
    let accepted = read(bytes);
    let used = MEMORY.peak_usage() - before;
    assert!(used <= allowance(name, bytes), "{name}: {} bytes of file took {used} bytes of memory", bytes.len());
    accepted
}

#[test]
fn no_damage_panics_or_takes_more_memory_than_a_small_multiple_of_the_file() {
    for (name, bytes, read) in formats() {
        assert!(survives(name, &bytes, read), "{name}: the sound file is read");
        let binary = !matches!(name, ".obj" | ".obj lines" | ".tfxmesh" | ".fbx");
        for length in 0..bytes.len() {
            let accepted = survives(name, &bytes[..length], read);
            assert!(!(accepted && binary), "{name}: cut to {length} of {} bytes, it is refused", bytes.len());
        }
        let mut damaged = bytes.clone();
        for at in 0..bytes.len() {
            for bit in 0..8 {
                damaged[at] ^= 1 << bit;
                survives(name, &damaged, read);
                damaged[at] = bytes[at];
            }
        }
        for at in (0..bytes.len().saturating_sub(8)).step_by(2) {
            for value in [0, 1, 0x7FFF_FFFF, 0x8000_0000, u32::MAX - 1, u32::MAX, f32::NAN.to_bits()] {
                damaged[at..at + 4].copy_from_slice(&u32::to_le_bytes(value));
                survives(name, &damaged, read);
                damaged[at + 4..at + 8].copy_from_slice(&u32::to_le_bytes(value));
                survives(name, &damaged, read);
                damaged.copy_from_slice(&bytes);
            }
        }
    }
}
