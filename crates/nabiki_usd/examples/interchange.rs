//! The half of `tests/interchange/check.py` that is Rust.
//!
//! `interchange write DIR` writes a small moving groom in every form, and beside the files what they must hold, as
//! bare numbers. `interchange motion LAYER NODE` prints where a prim or joint is: time (s), position, quaternion (x, y,
//! z, w), a line each.

use std::fs;
use std::path::Path;

use glam::{DAffine3, Quat, Vec3};
use nabiki::hair::Attributes;
use nabiki::{Hair, Mesh, Strands};
use nabiki_alembic::HairArchive;
use nabiki_exchange::{Export, FrameSink, GroomReader, Placed};
use nabiki_usd::{HairStage, LayerKind, StageReader};

const FRAMES: usize = 10;
const STRANDS: usize = 50;

fn strands(frame: usize) -> Strands {
    let mut strands = Strands::default();
    for s in 0..STRANDS {
        let swing = (0.3 * frame as f32 + s as f32).sin();
        let angle = s as f32 * 0.7;
        let root = Vec3::new(9.0 * angle.cos(), 10.0 + 0.05 * s as f32, 9.0 * angle.sin());
        strands.push((0..2 + s % 5).map(|p| root + Vec3::new(0.1 * swing * p as f32, -(p as f32), swing * swing)));
    }
    strands
}

fn groom() -> Hair {
    let mut hair = Hair::from(strands(0));
    let points = hair.strands.points().len();
    hair.attributes = Attributes {
        id: Some((0..STRANDS as i64).map(|s| 100 + 3 * s).collect()),
        root_uv: Some((0..STRANDS).map(|s| [s as f32 / STRANDS as f32, 0.25]).collect()),
        group: Some((0..STRANDS as i32).map(|s| 4 * (s % 2)).collect()),
        group_names: [(0, "fringe".to_owned()), (4, "back \"of\" head".to_owned())].into(),
        guide: Some((0..STRANDS).map(|s| s % 7 == 2).collect()),
        width: Some((0..points).map(|p| 0.008 + 0.0001 * p as f32).collect()),
        colour: Some((0..points).map(|p| [0.1, 0.05 + 0.001 * p as f32, 0.02]).collect()),
        ..Attributes::default()
    };
    hair
}

fn pose(frame: usize) -> DAffine3 {
    let turn = Quat::from_rotation_y(0.1 * frame as f32);
    DAffine3::from_rotation_translation(turn.as_dquat(), Vec3::new(0.0, frame as f32, 0.0).as_dvec3())
}

fn skin() -> Mesh {
    Mesh {
        positions: vec![Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z].into_iter().map(|p| 8.0 * p).collect(),
        triangles: vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]],
        ..Mesh::default()
    }
}

fn fill(mut sink: Box<dyn FrameSink + '_>, moving: bool) -> std::io::Result<()> {
    for frame in 0..FRAMES {
        sink.frame(&strands(frame), &if moving { pose(frame) } else { DAffine3::IDENTITY })?;
    }
    sink.finish().map(|_| ())
}

fn write(folder: &Path) -> std::io::Result<()> {
    fs::create_dir_all(folder)?;
    let (hair, mesh) = (groom(), skin());
    let still = Export::new(&hair, 24.0);
    let mut with_head = still.clone();
    with_head.head = Some(&mesh);
    (with_head.rest, with_head.velocities) = (true, true);
    for name in ["still.usda", "still.usdc"] {
        fill(Box::new(HairStage::create(&folder.join(name), still.clone(), LayerKind::Stage)?), false)?;
    }
    fill(Box::new(HairArchive::create(&folder.join("still.abc"), still.clone())?), false)?;
    for name in ["moving.usda", "moving.usdc"] {
        fill(Box::new(HairStage::create(&folder.join(name), with_head.clone(), LayerKind::Stage)?), true)?;
    }
    fill(Box::new(HairArchive::create(&folder.join("moving.abc"), with_head)?), true)?;
    for name in ["layer.usda", "layer.usdc"] {
        let form = LayerKind::Layer("/head/hair".to_owned());
        fill(Box::new(HairStage::create(&folder.join(name), still.clone(), form)?), false)?;
    }
    let mut rest = Box::new(HairStage::create(&folder.join("rest.usda"), still, LayerKind::Stage)?);
    rest.frame(&hair.strands, &DAffine3::IDENTITY)?;
    rest.finish()?;
    // Strands of one number of points, which every format holds.
    let mut even = Strands::default();
    for s in 0..STRANDS {
        even.push((0..5).map(|p| Vec3::new((s as f32).sin(), 0.1 * p as f32, (s as f32).cos()) * 9.7));
    }
    let even = Hair::from(even);
    let mut sink = Box::new(HairStage::create(&folder.join("even.usda"), Export::new(&even, 24.0), LayerKind::Stage)?);
    sink.frame(&even.strands, &DAffine3::IDENTITY)?;
    sink.finish()?;

    let (mut frames, mut poses) = (Vec::new(), Vec::new());
    for frame in 0..FRAMES {
        frames.extend_from_slice(strands(frame).points());
        poses.extend(glam::DMat4::from(pose(frame)).as_mat4().to_cols_array());
    }
    fs::write(folder.join("poses.f32"), bytemuck::cast_slice(&poses))?;
    fs::write(folder.join("points.f32"), bytemuck::cast_slice(&frames))?;
    let counts: Vec<u32> = hair.strands.iter().map(|s| s.len() as u32).collect();
    fs::write(folder.join("counts.u32"), bytemuck::cast_slice(&counts))
}

fn motion(layer: &Path, node: &str) -> std::io::Result<()> {
    let read = StageReader::open(layer).and_then(|mut stage| stage.motion(node));
    for Placed { time, position: p, rotation: q, .. } in read.map_err(std::io::Error::other)? {
        println!("{time} {} {} {} {} {} {} {}", p.x, p.y, p.z, q.x, q.y, q.z, q.w);
    }
    Ok(())
}

fn main() -> std::io::Result<()> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    match &arguments.iter().map(String::as_str).collect::<Vec<_>>()[..] {
        ["write", folder] => write(Path::new(folder)),
        ["motion", layer, node] => motion(Path::new(layer), node),
        _ => {
            eprintln!("usage: interchange write DIR | motion LAYER NODE");
            std::process::exit(2)
        }
    }
}
