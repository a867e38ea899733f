//! Meshes out of .fbx; every index names a vertex.
#![no_main]

use libfuzzer_sys::fuzz_target;
use nabiki_fuzz::within_budget;
use nabiki_io::mesh;

fuzz_target!(|bytes: &[u8]| {
    within_budget(bytes.len(), || {
        if let Ok(mesh) = mesh::from_bytes(bytes, "fbx", &[]) {
            assert!(mesh.triangles.iter().flatten().all(|&v| (v as usize) < mesh.positions.len()));
        }
    });
});
