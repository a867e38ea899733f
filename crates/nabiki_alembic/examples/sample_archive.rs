//! Writes a small moving groom with every attribute, for other programs to read: `sample_archive OUT.abc [--head]`.

use std::path::Path;

use glam::{Affine3A, Quat, Vec3};
use nabiki::export::{Export, FrameSink};
use nabiki::hair::Attributes;
use nabiki::{Hair, Mesh, Strands};
use nabiki_alembic::HairArchive;

fn main() -> std::io::Result<()> {
    let mut arguments = std::env::args().skip(1);
    let path = arguments.next().expect("the file to write");
    let with_head = arguments.next().is_some();
    let at = |frame: usize, s: usize, p: usize| {
        let swing = (0.3 * frame as f32 + s as f32).sin() * 0.1 * p as f32;
        Vec3::new(s as f32 * 0.5 + swing, 10.0 - p as f32, swing * swing)
    };
    let strands = |frame: usize| {
        let mut strands = Strands::default();
        for s in 0..7 {
            strands.push((0..3 + s % 3).map(|p| at(frame, s, p)));
        }
        strands
    };
    let mut hair = Hair::from(strands(0));
    let points = hair.strands.points().len();
    hair.attributes = Attributes {
        id: Some((0..7).map(|s| 100 + 3 * s).collect()),
        root_uv: Some((0..7).map(|s| [s as f32 / 7.0, 0.25]).collect()),
        group: Some(vec![0, 0, 0, 4, 4, 4, 4]),
        group_names: [(0, "fringe".to_owned()), (4, "back".to_owned())].into(),
        guide: Some((0..7).map(|s| s == 2).collect()),
        width: Some((0..points).map(|p| 0.008 + 0.0001 * p as f32).collect()),
        color: Some((0..points).map(|p| [0.1, 0.05 + 0.01 * p as f32, 0.02]).collect()),
        ..Attributes::default()
    };
    let mesh = Mesh {
        positions: vec![Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z],
        triangles: vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]],
    };
    let mut export = Export::new(&hair, 24.0);
    export.head = with_head.then_some(&mesh);
    let mut sink = Box::new(HairArchive::create(Path::new(&path), export)?);
    for frame in 0..10 {
        let turn = Quat::from_rotation_y(0.1 * frame as f32);
        let world_from_head = Affine3A::from_rotation_translation(turn, Vec3::new(0.0, frame as f32, 0.0));
        sink.frame(&strands(frame), &world_from_head)?;
    }
    sink.finish()
}
