//! Sets `shared_data` where the shared reference data lie beside the project: without them, the tests that need them are
//! ignored, and counted so.

use std::path::Path;

fn main() {
    println!("cargo::rustc-check-cfg=cfg(shared_data)");
    println!("cargo::rerun-if-changed=build.rs");
    let data = Path::new("../../../shared/data");
    if data.is_dir() {
        println!("cargo::rustc-cfg=shared_data");
        println!("cargo::rerun-if-changed={}", data.display());
    } else {
        // A path that is not there would make cargo run this at every build; the folder above it is.
        let nearest = data.ancestors().find(|folder| folder.is_dir()).unwrap_or(Path::new("."));
        println!("cargo::rerun-if-changed={}", nearest.display());
    }
}
