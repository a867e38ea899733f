//! What Git LFS leaves in the place of a file that it has not fetched is called so, whatever the file should be.

use std::path::Path;

use nabiki_io::motion::{self, Axis, MotionSource};
use nabiki_io::{cache, hair, info, input, kind, mesh};

const POINTER: &str = "version https://git-lfs.github.com/spec/v1\n\
    oid sha256:4d7a214614ab2935c943f9e0ff69d22eadbb8f32b1258daaa5e2ca24d17e2393\nsize 12345\n";

/// Everything that reads a file of some ending.
fn refused(path: &Path) -> Vec<String> {
    let source = MotionSource {
        file: path.to_owned(),
        unit_cm: Some(1.0),
        up: Some(Axis::PlusY),
        facing: Some(Axis::PlusX),
        ..MotionSource::default()
    };
    let skeleton = MotionSource { file: "a.amc".into(), skeleton: Some(path.to_owned()), ..source.clone() };
    match path.extension().and_then(|ending| ending.to_str()).unwrap() {
        "toml" => vec![kind::check_scene(path).map_err(|e| e.to_string()).unwrap_err()],
        "nabiki" => vec![cache::Reader::open(path).map(|_| ()).unwrap_err().to_string()],
        "hair" | "tfx" => vec![hair::read(path).unwrap_err().to_string()],
        "obj" => vec![hair::read(path).unwrap_err().to_string(), mesh::read(path, &[]).unwrap_err().to_string()],
        "ply" | "tfxmesh" => vec![mesh::read(path, &[]).unwrap_err().to_string()],
        "glb" | "gltf" | "fbx" => {
            vec![mesh::read(path, &[]).unwrap_err().to_string(), motion::read(&source, 24.0).unwrap_err().to_string()]
        }
        "bvh" | "csv" | "tof" => vec![motion::read(&source, 24.0).unwrap_err().to_string()],
        "amc" => {
            std::fs::write(path.with_file_name("a.asf"), POINTER).unwrap();
            let skeleton = Some(path.with_file_name("a.asf"));
            vec![motion::read(&MotionSource { skeleton, ..source }, 24.0).unwrap_err().to_string()]
        }
        "asf" => vec![motion::read(&skeleton, 24.0).unwrap_err().to_string()],
        _ => vec![
            hair::read(path).unwrap_err().to_string(),
            mesh::read(path, &[]).unwrap_err().to_string(),
            motion::read(&source, 24.0).unwrap_err().to_string(),
        ],
    }
}

#[test]
fn a_pointer_is_named_for_every_format() {
    let folder = tempfile::tempdir().unwrap();
    let endings = [
        "toml", "nabiki", "hair", "tfx", "obj", "glb", "gltf", "fbx", "ply", "tfxmesh", "usd", "usda", "usdc", "abc",
        "bvh", "csv", "tof", "amc",
    ];
    for ending in endings {
        let path = folder.path().join(format!("file.{ending}"));
        std::fs::write(&path, POINTER).unwrap();
        let said = format!("{}: is a Git LFS pointer: fetch the file with git lfs pull", path.display());
        assert!(refused(&path).iter().all(|line| *line == said), "{ending}: {:?}", refused(&path));
        if ending != "toml" {
            assert_eq!(info::info(&path).unwrap_err().to_string(), said, "info");
        }
    }
}

#[test]
fn a_pointer_of_what_is_not_read_is_named_too() {
    let folder = tempfile::tempdir().unwrap();
    for ending in ["png", "exr", "usdz", "blend", "json", ""] {
        let path = folder.path().join(format!("file.{ending}"));
        std::fs::write(&path, POINTER).unwrap();
        let said = info::info(&path).unwrap_err().to_string();
        assert!(said.ends_with("is a Git LFS pointer: fetch the file with git lfs pull"), "{said}");
        std::fs::write(&path, "something else").unwrap();
        assert!(info::info(&path).unwrap_err().to_string().contains("is not one of .hair, "), "{ending}");
    }
}

#[test]
fn what_only_looks_like_a_pointer_is_read() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("notes.txt");
    for text in ["version 1\n".to_owned(), format!("# {POINTER}"), POINTER.repeat(9)] {
        std::fs::write(&path, &text).unwrap();
        assert_eq!(input::read_text(&path, 1 << 20).unwrap(), text);
    }
}
