//! Files that are small and ask for much: each is read, or refused in one line, in memory that its length bounds.
//!
//! One test on its own in this program: it watches the memory of the whole process.

mod hostile {
    pub mod crate_file;
    pub mod fbx;
    pub mod layers;
    pub mod meshes;
    pub mod motions;
    pub mod ogawa;
}

use std::path::Path;

use hostile::{fbx, layers, meshes, motions};
use nabiki_exchange::Budget;
use nabiki_io::motion::{self, Axis, MotionSource};
use nabiki_io::{Error, GroomFile, Placement, exchange, info, mesh, skin};
use peak_alloc::PeakAlloc;

#[global_allocator]
static MEMORY: PeakAlloc = PeakAlloc;

/// Bytes that no file of these may take, whatever its budget.
const MOST: usize = 256 << 20;

/// All that is done with a file of its kind; every refusal is one line that names it.
fn read(path: &Path) {
    let refused = |error: Error| {
        let line = error.to_string();
        let name = path.file_name().unwrap().to_string_lossy().into_owned();
        assert!(!line.contains('\n') && line.contains(&name) && line.len() < 2000, "{line}");
    };
    let ending = path.extension().unwrap().to_string_lossy().into_owned();
    if let Err(error) = info::info(path) {
        refused(error);
    }
    if matches!(&*ending, "usda" | "usdc" | "abc" | "hair" | "tfx" | "obj") {
        if let Err(error) = GroomFile::open(path).and_then(|mut file| file.hair(0, None)) {
            refused(error);
        }
        if let Err(error) = exchange::frames(path) {
            refused(error);
        }
    }
    if matches!(&*ending, "usda" | "usdc" | "abc" | "obj" | "ply" | "glb" | "gltf" | "fbx" | "tfxmesh") {
        if let Err(error) = mesh::import(path, &Placement::default(), &[]) {
            refused(error);
        }
        if let Err(error) = skin::bends(path, &[], "") {
            refused(error);
        }
        let missing = ["no such group".to_owned()];
        refused(mesh::import(path, &Placement::default(), &missing).unwrap_err());
    }
    if matches!(&*ending, "usda" | "usdc" | "abc" | "glb" | "gltf" | "fbx" | "bvh" | "csv" | "amc" | "tof") {
        let skeleton = ["asf", "tof"].map(|ending| path.with_extension(format!("skeleton.{ending}")));
        let source = MotionSource {
            file: path.to_owned(),
            skeleton: skeleton.into_iter().find(|file| file.exists()),
            unit_cm: Some(1.0),
            up: Some(Axis::PlusY),
            facing: Some(Axis::PlusZ),
            frames_per_second: (ending == "amc").then_some(60.0),
            ..MotionSource::default()
        };
        let source = match &*ending {
            "usda" | "usdc" => MotionSource { unit_cm: None, up: None, ..source },
            _ => source,
        };
        if let Err(error) = motion::read(&source, 24.0) {
            refused(error);
        }
    }
}

#[test]
fn small_files_that_ask_for_much_take_what_their_length_allows() {
    let folder = tempfile::tempdir().unwrap();
    let made = [layers::crate_files, layers::texts, layers::archives, meshes::all, motions::all, fbx::all];
    let mut files = 0;
    for (name, bytes) in made.into_iter().flat_map(|make| make()) {
        let path = folder.path().join(name);
        std::fs::write(&path, &bytes).unwrap();
        let length = bytes.len();
        drop(bytes);
        // What a made file needs beside it is made with it, and is not read by itself.
        if name.contains(".skeleton.") || name.ends_with(".bin") {
            continue;
        }
        let before = MEMORY.current_usage();
        MEMORY.reset_peak_usage();
        read(&path);
        let used = MEMORY.peak_usage() - before;
        let most = 3 * Budget::of(length as u64).most() as usize;
        assert!(used <= most.min(MOST), "{name}: {length} bytes of file took {used} bytes of memory");
        files += 1;
    }
    assert!(files > 40, "{files} files");
}
