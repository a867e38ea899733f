//! USD layers and Alembic archives, which their own crates read and write: hair, heads, motion, and the space that the
//! files declare.

use std::path::Path;

use nabiki::export::{Export, FrameSink};
use nabiki::{Hair, Mesh};
use nabiki_alembic::{ArchiveReader, HairArchive};
use nabiki_usd::{Form, HairStage, StageReader};

use crate::axis::Axis;
use crate::error::{Error, Result};
use crate::kind::extension;
use crate::motion::track::{Sample, Track};
use crate::placement::Placement;
use crate::unit::Unit;

pub use crate::declared::DeclaredSpace;

/// Whether a file's ending is that of a USD layer.
pub fn is_usd(path: &Path) -> bool {
    matches!(extension(path).as_str(), "usd" | "usda" | "usdc")
}

/// Whether a file's ending is that of an Alembic archive.
pub fn is_alembic(path: &Path) -> bool {
    extension(path) == "abc"
}

/// The unit and up axis that the file declares. Only USD layers say anything; Alembic is y up by agreement.
///
/// # Errors
/// A layer that cannot be read.
pub fn declared_space(path: &Path) -> Result<DeclaredSpace> {
    if is_alembic(path) {
        return Ok(DeclaredSpace { unit: None, up: Some(Axis::PlusY) });
    }
    if !is_usd(path) {
        return Ok(DeclaredSpace::default());
    }
    let contents = stage(path)?.contents().map_err(|e| Error::new(e.to_string()).in_file(path))?;
    // A layer that says nothing means centimetres and y, by USD's own rule.
    let cm = contents.meters_per_unit.unwrap_or(0.01) * 100.0;
    let up = if contents.z_up == Some(true) { Axis::PlusZ } else { Axis::PlusY };
    Ok(DeclaredSpace { unit: Some(Unit { cm: cm as f32 }), up: Some(up) })
}

pub(crate) fn stage(path: &Path) -> Result<StageReader> {
    StageReader::open(path).map_err(|e| Error::new(e.to_string()).in_file(path))
}

pub(crate) fn archive(path: &Path) -> Result<ArchiveReader> {
    ArchiveReader::open(path).map_err(|e| Error::new(e.to_string()).in_file(path))
}

/// Reads the hair of frame `frame` (the last one after those there are), in the file's own unit and axes.
/// `segments`: walks every curve into as many; `None` keeps polylines as they are.
///
/// # Errors
/// What is wrong with the file.
pub fn hair(path: &Path, frame: usize, segments: Option<usize>) -> Result<Hair> {
    let named = |problem: String| Error::new(problem).in_file(path);
    if is_alembic(path) {
        archive(path)?.hair(frame, segments).map_err(|e| named(e.to_string()))
    } else {
        stage(path)?.hair(frame, segments).map_err(|e| named(e.to_string()))
    }
}

/// Number of frames of the curves in a layer or archive; 1 for hair that stands still.
///
/// # Errors
/// What is wrong with the file.
pub fn frames(path: &Path) -> Result<usize> {
    let named = |problem: String| Error::new(problem).in_file(path);
    let frames = if is_alembic(path) {
        archive(path)?.contents().map_err(|e| named(e.to_string()))?.frames
    } else {
        stage(path)?.contents().map_err(|e| named(e.to_string()))?.times.len()
    };
    Ok(frames.max(1))
}

/// Reads all meshes, in the file's own unit and axes.
///
/// # Errors
/// What is wrong with the file.
pub fn mesh(path: &Path) -> Result<Mesh> {
    let named = |problem: String| Error::new(problem).in_file(path);
    if is_alembic(path) {
        archive(path)?.mesh().map_err(|e| named(e.to_string()))
    } else {
        stage(path)?.mesh().map_err(|e| named(e.to_string()))
    }
}

/// Reads the way of the object or prim `node`.
pub(crate) fn track(path: &Path, node: &str) -> Result<Track> {
    let named = |problem: String| Error::new(problem).in_file(path);
    let motion = if is_alembic(path) {
        archive(path)?.motion(node).map_err(|e| named(e.to_string()))?
    } else {
        stage(path)?.motion(node).map_err(|e| named(e.to_string()))?
    };
    let declared = declared_space(path)?;
    let (times, samples) =
        motion.into_iter().map(|(time, position, rotation)| (time, Sample { position, rotation })).unzip();
    let unit_cm = declared.unit.map(|unit| f64::from(unit.cm));
    Ok(Track { times, samples, what: format!("object {node}"), unit_cm, up: declared.up })
}

/// What is told to a file of moving hair: imported hair goes back into its own file's space, at its `placement`, hair
/// grown here is in centimetres, y up.
pub fn export<'a>(hair: &'a Hair, frame_rate: f64, placement: Option<&Placement>) -> Export<'a> {
    let mut export = Export::new(hair, frame_rate);
    if let Some(placement) = placement {
        export.file_from_head = placement.file_from_head();
        export.meters_per_unit = f64::from(placement.unit.cm) / 100.0;
        export.z_up = placement.up == Axis::PlusZ;
    }
    export
}

/// Refuses to lay a layer over a groom of `in_file` points (`None` for one grown here) whose import kept `used`.
///
/// # Errors
/// One line that says how to import it whole.
pub fn check_layer(in_file: Option<u64>, used: usize) -> Result<()> {
    let refuse = |why: String| Err(Error::new(format!("a layer would not fit the groom: {why}")));
    match in_file {
        None => refuse("its hair is grown here; leave out --export-layer for a complete stage".to_owned()),
        Some(points) if points != used as u64 => refuse(format!(
            "{used} of its {points} points are used; set hair.join_within = 0 and hair.drop_shorter_than = 0, leave \
             out hair.strands and hair.segments, and take strands without extent out of the file"
        )),
        Some(_) => Ok(()),
    }
}

/// Begins a file that takes moving hair frame by frame: .usda, .usdc or .abc. `layer`: the prim path of a groom over
/// which samples alone are to be laid.
///
/// # Errors
/// Another ending; a layer of Alembic, which has none; what the disk says.
pub fn sink<'a>(path: &Path, export: Export<'a>, layer: Option<&str>) -> Result<Box<dyn FrameSink + 'a>> {
    let named = |e: std::io::Error| Error::from(e).in_file(path);
    match (is_usd(path), is_alembic(path), layer) {
        (true, _, None) => Ok(Box::new(HairStage::create(path, export, Form::Stage).map_err(named)?)),
        (true, _, Some(prim)) => {
            Ok(Box::new(HairStage::create(path, export, Form::Layer(prim.to_owned())).map_err(named)?))
        }
        (_, true, None) => Ok(Box::new(HairArchive::create(path, export).map_err(named)?)),
        (_, true, Some(_)) => Err(Error::new("Alembic has no layers: write .usda or .usdc").in_file(path)),
        _ => Err(Error::new("moving hair is written as .usda, .usdc or .abc").in_file(path)),
    }
}

/// Writes hair that stands still, in the unit and axes it has.
///
/// # Errors
/// What the disk says.
pub fn write(path: &Path, hair: &Hair, declared: DeclaredSpace) -> Result<()> {
    let mut export = Export::new(hair, 24.0);
    export.meters_per_unit = declared.unit.map_or(0.01, |unit| f64::from(unit.cm) / 100.0);
    export.z_up = declared.up == Some(Axis::PlusZ);
    let mut sink = sink(path, export, None)?;
    let named = |e: std::io::Error| Error::from(e).in_file(path);
    sink.frame(&hair.strands, &glam::Affine3A::IDENTITY).map_err(named)?;
    sink.finish().map_err(named)
}

/// What a layer or archive cannot hold of `hair`, a phrase each.
pub fn losses(hair: &Hair) -> Vec<String> {
    let groups = hair.attributes.group.as_deref().unwrap_or_default();
    let names = &hair.attributes.group_names;
    if names.keys().any(|number| !groups.contains(number)) {
        vec!["names of groups without strands".to_owned()]
    } else {
        Vec::new()
    }
}
