//! Strands and triangles out of the same .obj.
#![no_main]

use libfuzzer_sys::fuzz_target;
use nabiki_fuzz::within_budget;
use nabiki_io::{Placement, mesh, obj_lines};

fuzz_target!(|bytes: &[u8]| {
    within_budget(bytes.len(), || {
        let _ = obj_lines::from_bytes(bytes);
        if let Ok(mesh) = mesh::from_bytes(bytes, "obj", &[]) {
            let _ = mesh::place_and_weld(mesh, &Placement::default());
        }
    });
});
