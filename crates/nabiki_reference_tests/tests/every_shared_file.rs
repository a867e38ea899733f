//! Every file of the shared data in hair, heads and motion goes through: hair into every format and back, heads get their
//! ellipsoid, motion gives poses, and what holds none of them says so in one line. A file that is not known here fails: it
//! must be said how it goes through.

use std::path::{Path, PathBuf};

use glam::Vec3;
use nabiki::{Ellipsoid, Hair, Head, Mesh, hair::Constants};
use nabiki_io::{
    hair,
    info::{Info, info},
    mesh,
    motion::{self, Axis, MotionSource},
    placement::Placement,
};
use nabiki_reference_tests::shared;

/// The files of a folder of the shared data, by name.
fn files(folder: &str) -> Vec<(String, PathBuf)> {
    let folder = shared(folder);
    let entries = std::fs::read_dir(&folder).unwrap();
    let paths = entries.map(|entry| entry.unwrap().path()).filter(|path| path.is_file());
    let mut files: Vec<_> =
        paths.map(|path| (path.file_name().unwrap().to_string_lossy().into_owned(), path)).collect();
    files.sort();
    assert!(!files.is_empty(), "{} is empty", folder.display());
    files
}

/// Refused with one line that names the file and says `why`.
fn is_refused(path: &Path, why: &str) {
    let said = info(path).unwrap_err().to_string();
    assert!(said.starts_with(&path.display().to_string()) && said.contains(why), "{said}");
    assert!(!said.contains('\n'), "{said}");
}

/// Reads a mesh into head space.
fn import(path: &Path, unit: &str, groups: &[&str]) -> Mesh {
    let placement = Placement { unit: unit.parse().unwrap(), facing: Axis::PlusZ, ..Placement::default() };
    let groups: Vec<String> = groups.iter().map(|&group| group.to_owned()).collect();
    let Info::Mesh(_) = info(path).unwrap() else { panic!("{} is a mesh", path.display()) };
    mesh::import(path, &placement, &groups).unwrap().0
}

/// A person's head: its ellipsoid is fitted.
fn fits(path: &Path, unit: &str, groups: &[&str]) {
    let ellipsoid = Head::from_mesh(import(path, unit, groups), None).unwrap().ellipsoid;
    // Skulls are 14 to 24 cm broad, long and high.
    let axes = ellipsoid.half_axes;
    assert!(axes.min_element() > 7.0 && axes.max_element() < 12.0, "{}: {ellipsoid:?}", path.display());
}

/// No person's head: the fit asks for an ellipsoid, and with one the mesh is a head.
fn asks_for_an_ellipsoid(path: &Path, unit: &str) {
    let mesh = import(path, unit, &[]);
    let refused = Head::from_mesh(mesh.clone(), None).unwrap_err().to_string();
    assert!(refused.starts_with("head.mesh = no skull, "), "{}: {refused}", path.display());
    assert!(refused.contains("or give head.ellipsoid"), "{}: {refused}", path.display());
    let low = mesh.positions.iter().copied().reduce(Vec3::min).unwrap();
    let high = mesh.positions.iter().copied().reduce(Vec3::max).unwrap();
    let ellipsoid = Ellipsoid { center: 0.5 * (low + high), half_axes: 0.5 * (high - low) };
    Head::from_mesh(mesh, Some(ellipsoid)).unwrap();
}

/// Written into every format, the strands come back to the bit, and so does all else where nothing is lost and no
/// value for all strands has to become one for each or the other way round.
fn goes_into_every_format(path: &Path) {
    let original = hair::read(path).unwrap();
    let Info::Hair(_) = info(path).unwrap() else { panic!("{} is hair", path.display()) };
    let own = path.extension().unwrap().to_str().unwrap();
    let even = original.strands.iter().all(|strand| strand.len() == original.strands.strand(0).len());
    let folder = tempfile::tempdir().unwrap();
    for ending in ["hair", "tfx", "usda", "usdc", "abc"] {
        let copy = folder.path().join("copy").with_extension(ending);
        let what = format!("{} as .{ending}", path.display());
        let written = hair::write(&copy, &original);
        if ending == "tfx" && !even {
            let said = written.unwrap_err().to_string();
            assert!(said.contains("all must have the same number; resample them"), "{said}");
            continue;
        }
        let lost = written.unwrap();
        let read = hair::read(&copy).unwrap();
        assert!(bits(&read) == bits(&original), "{what}: the strands");
        let plain = original.attributes.constant == Constants::default() && ending != "hair";
        if ending == own || plain && lost.is_empty() {
            assert!(read == original, "{what}: what lies beside the strands");
        }
    }
}

/// Comparing floats would let -0 pass for 0.
fn bits(hair: &Hair) -> (&[u32], Vec<[u32; 3]>) {
    (hair.strands.starts(), hair.strands.points().iter().map(|p| p.to_array().map(f32::to_bits)).collect())
}

#[test]
#[cfg_attr(not(shared_data), ignore = "needs the shared reference data beside the project")]
fn every_hair_file_goes_through() {
    for (name, path) in files("hair") {
        match name.as_str() {
            "curly_swatch_frame00.hair"
            | "curly_swatch_frame00.obj"
            | "curly_swatch_frame70.obj"
            | "ratboy_mohawk.tfx"
            | "ratboy_mohawk_varseg.hair"
            | "sintel_hair_16pts.hair"
            | "sintel_hair_16pts.tfx" => {
                goes_into_every_format(&path);
            }
            "ratboy_body.tfxmesh" => asks_for_an_ellipsoid(&path, "m"),
            "ratboy_mohawk.tfxbone" => is_refused(&path, "holds no strands"),
            "curly_swatch_scalp_points.obj" => is_refused(&path, "holds 3176 vertices but no faces: not a head"),
            _ => panic!("how does {name} go through?"),
        }
    }
}

#[test]
#[cfg_attr(not(shared_data), ignore = "needs the shared reference data beside the project")]
fn every_head_goes_through() {
    for (name, path) in files("heads") {
        match name.as_str() {
            "sintel_bust.obj" | "sintel_collider.obj" => fits(&path, "m", &[]),
            "sintel_eyes.obj" => asks_for_an_ellipsoid(&path, "m"),
            // A head is about 4.5 of its units tall.
            "lps_head.obj" => fits(&path, "5.0", &[]),
            "makehuman_base.obj" => fits(&path, "dm", &["body"]),
            "suzanne.glb" => asks_for_an_ellipsoid(&path, "dm"),
            "sintel_collider_sdf64.bin" => is_refused(&path, "ending \"bin\" is not one of"),
            _ => panic!("how does {name} go through?"),
        }
    }
}

#[test]
#[cfg_attr(not(shared_data), ignore = "needs the shared reference data beside the project")]
fn every_motion_goes_through() {
    for (name, path) in files("motion").into_iter().chain(files("motion/head_tracks")) {
        let asked = MotionSource {
            file: path.clone(),
            up: Some(Axis::PlusY),
            facing: Some(Axis::PlusZ),
            ..MotionSource::default()
        };
        let beside = |name: &str| Some(path.with_file_name(name));
        let joint =
            |node: &str, unit_cm: f64| MotionSource { node: node.to_owned(), unit_cm: Some(unit_cm), ..asked.clone() };
        let jolt = MotionSource { skeleton: beside("jolt_human.tof"), ..joint("C_Head_sjnt_0", 100.0) };
        // At 24 frames a second, with the first and those that fit behind it.
        match name.as_str() {
            "cmu_12_01_walk.bvh" => gives_poses(&joint("Head", 2.54 / 0.45), 105),
            "makehuman_walk1.bvh" => {
                gives_poses(
                    &MotionSource { up: Some(Axis::PlusZ), facing: Some(Axis::MinusY), ..joint("Head", 10.0) },
                    14,
                );
            }
            "cmu_02_03_run.amc" => {
                let source = MotionSource { skeleton: beside("cmu_02.asf"), frames_per_second: Some(120.0), ..asked };
                gives_poses(&source, 35);
            }
            "jolt_walk.tof" => gives_poses(&jolt, 68),
            "jolt_sprint.tof" => gives_poses(&jolt, 39),
            "cmu_02.asf" => is_a_skeleton_of(&path, 31),
            "jolt_human.tof" => is_a_skeleton_of(&path, 23),
            "kaykit_rogue.glb" => every_clip_moves(&path, "head", 76),
            "fox.glb" => every_clip_moves(&path, "b_Head_05", 3),
            "cmu_02_03_run.csv" => gives_poses(&asked, 35),
            "cmu_12_01_walk.csv" => gives_poses(&asked, 105),
            "jolt_sprint.csv" => gives_poses(&asked, 39),
            "jolt_walk.csv" => gives_poses(&asked, 68),
            _ => panic!("how does {name} go through?"),
        }
    }
}

fn gives_poses(source: &MotionSource, frames: usize) {
    let motion = motion::read(source, 24.0).unwrap();
    let said = &motion.report;
    assert_eq!(motion.poses.len(), frames, "{said}");
    assert!(said.starts_with(&source.file.display().to_string()), "{said}");
    assert!(said.contains(&format!("-> {frames} frames at 24 Hz")) && said.contains("unit "), "{said}");
    assert!(motion.poses.iter().all(|pose| (pose.rotation.length() - 1.0).abs() < 1e-6), "{said}");
    match info(&source.file).unwrap() {
        Info::Motion(info) => assert!(info.samples > 1 && info.asked.contains(&"facing"), "{info:?}"),
        Info::Mesh(_) => assert!(source.file.extension().is_some_and(|e| e == "glb"), "{said}"),
        other => panic!("{}: {other:?}", source.file.display()),
    }
}

fn is_a_skeleton_of(path: &Path, joints: usize) {
    let Info::Motion(info) = info(path).unwrap() else { panic!("{} is a skeleton", path.display()) };
    assert_eq!((info.samples, info.joints.len()), (0, joints), "{}", path.display());
}

fn every_clip_moves(path: &Path, node: &str, clips: usize) {
    let Info::Mesh(info) = info(path).unwrap() else { panic!("{} has a body", path.display()) };
    assert_eq!(info.clips.len(), clips);
    assert!(info.nodes.iter().any(|name| name == node), "{:?}", info.nodes);
    for clip in info.clips {
        let source =
            MotionSource { file: path.to_owned(), node: node.to_owned(), clip: clip.name, ..MotionSource::default() };
        // Clips of these files begin at 0.
        let frames = (clip.end.unwrap() * 24.0 + 1e-4).floor() as usize + 1;
        gives_poses(&source, frames);
    }
}
