//! USD layers and Alembic archives through this crate: heads, motion, units.

use std::path::{Path, PathBuf};

use glam::{Affine3A, Quat, Vec3};
use nabiki::export::Export;
use nabiki::{Hair, Mesh, Strands};
use nabiki_io::exchange::{self, Said};
use nabiki_io::motion::{self, Axis, MotionSource};
use nabiki_io::placement::Unit;
use nabiki_io::{hair, mesh};

const FRAMES: usize = 11;

fn pose(frame: usize) -> Affine3A {
    let turn = Quat::from_rotation_y(0.05 * frame as f32);
    Affine3A::from_rotation_translation(turn, Vec3::new(2.0 * frame as f32, 150.0, 0.0))
}

fn strands() -> Strands {
    let mut strands = Strands::default();
    strands.push([Vec3::ZERO, Vec3::X, 2.0 * Vec3::X]);
    strands.push([Vec3::Y, 2.0 * Vec3::Y]);
    strands
}

fn write(folder: &Path, name: &str) -> PathBuf {
    let hair = Hair::from(strands());
    let skin = Mesh { positions: vec![Vec3::ZERO, Vec3::X, Vec3::Y], triangles: vec![[0, 1, 2]], uvs: None };
    let mut export = Export::new(&hair, 20.0);
    export.head = Some(&skin);
    let path = folder.join(name);
    let mut sink = exchange::sink(&path, export, None).unwrap();
    for frame in 0..FRAMES {
        sink.frame(&hair.strands, &pose(frame)).unwrap();
    }
    sink.finish().unwrap();
    path
}

#[test]
fn the_transforms_of_layers_and_archives_move_a_head() {
    let folder = tempfile::tempdir().unwrap();
    for name in ["head.usda", "head.usdc", "head.abc"] {
        let file = write(folder.path(), name);
        let source = MotionSource {
            file: file.clone(),
            node: "head".into(),
            // Only Alembic must be told the unit.
            unit_cm: name.ends_with("abc").then_some(1.0),
            facing: Some(Axis::PlusX),
            ..MotionSource::default()
        };
        let motion = motion::read(&source, 10.0).unwrap();
        assert_eq!(motion.poses.len(), 6, "{}", motion.report);
        assert!(motion.report.contains("11 samples at 20 Hz (0.500 s) -> 6 frames at 10 Hz"), "{}", motion.report);
        for (n, found) in motion.poses.iter().enumerate() {
            let expected = pose(2 * n);
            assert!(found.position_cm.distance(expected.translation.into()) < 1e-4, "{name}, frame {n}");
            assert!(
                (found.rotation * Vec3::X).distance(expected.transform_vector3(Vec3::X)) < 1e-6,
                "{name}, frame {n}"
            );
        }
        let head = mesh::read(&file, &[]).unwrap();
        assert_eq!(head.triangles.len(), 1);
        assert_eq!(head.positions[0], Vec3::from(pose(0).translation));
    }
}

#[test]
fn unit_and_up_axis_are_what_the_layer_says() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("metres.usdc");
    let said = Said { unit: Some(Unit { cm: 100.0 }), up: Some(Axis::PlusZ) };
    exchange::write(&path, &Hair::from(strands()), said).unwrap();
    assert_eq!(exchange::said(&path).unwrap(), said);
    assert_eq!(hair::read(&path).unwrap().strands, strands());
    let archive = folder.path().join("hair.abc");
    hair::write(&archive, &Hair::from(strands())).unwrap();
    assert_eq!(exchange::said(&archive).unwrap(), Said { unit: None, up: Some(Axis::PlusY) });
}

#[test]
fn a_layer_of_alembic_and_an_unknown_ending_are_refused_by_name() {
    let hair = Hair::from(strands());
    let refused = |name: &str, layer: Option<&str>| {
        let result = exchange::sink(Path::new(name), Export::new(&hair, 24.0), layer);
        result.err().unwrap().to_string()
    };
    assert_eq!(refused("hair.abc", Some("/a")), "hair.abc: Alembic has no layers: write .usda or .usdc");
    assert_eq!(refused("hair.fbx", None), "hair.fbx: moving hair is written as .usda, .usdc or .abc");
}
