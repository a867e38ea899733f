//! USD layers and Alembic archives, which their own crates read and write: hair, heads, motion, and what the files say
//! of unit and axes.

use std::fmt;
use std::path::{Path, PathBuf};

use glam::Affine3A;
use nabiki::{Hair, Mesh, Strands};
use nabiki_alembic::{ArchiveReader, HairArchive};
use nabiki_exchange::{Contents, Export, FrameSink, GroomReader, InPlace, Placed, Prim, PrimKind, Problem};
use nabiki_usd::{Form, HairStage, StageReader};
use serde::Serialize;

use crate::error::{Error, Result};
use crate::hair::extension;
use crate::info::{HairInfo, MeshInfo};
use crate::motion::{Axis, Sample, Track};
use crate::placement::{Placement, Unit};

/// Whether a file's ending is that of a USD layer.
pub fn is_usd(path: &Path) -> bool {
    matches!(extension(path).as_str(), "usd" | "usda" | "usdc")
}

/// Whether a file's ending is that of an Alembic archive.
pub fn is_alembic(path: &Path) -> bool {
    extension(path) == "abc"
}

/// What a file itself says of its coordinates; `None` where it says nothing.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Coordinates {
    /// Length unit.
    pub unit: Option<Unit>,
    /// Axis that points up.
    pub up: Option<Axis>,
}

impl Coordinates {
    fn meters_per_unit(self) -> f64 {
        self.unit.map_or(0.01, |unit| f64::from(unit.cm) / 100.0)
    }
}

/// A layer or archive that is open.
struct Opened<'a> {
    path: &'a Path,
    reader: Box<dyn GroomReader>,
}

impl<'a> Opened<'a> {
    fn new(path: &'a Path) -> Result<Self> {
        let reader: std::result::Result<Box<dyn GroomReader>, Problem> = if is_alembic(path) {
            ArchiveReader::open(path).map(|reader| Box::new(reader) as _)
        } else {
            StageReader::open(path).map(|reader| Box::new(reader) as _)
        };
        Ok(Self { path, reader: reader.map_err(|e| named(path, e))? })
    }

    fn ask<T>(&mut self, question: impl FnOnce(&mut dyn GroomReader) -> std::result::Result<T, Problem>) -> Result<T> {
        question(&mut *self.reader).map_err(|e| named(self.path, e))
    }

    fn coordinates(&mut self) -> Result<Coordinates> {
        let contents = self.ask(|r| r.contents())?;
        let up = if contents.z_up == Some(true) { Axis::PlusZ } else { Axis::PlusY };
        if is_alembic(self.path) {
            return Ok(Coordinates { unit: None, up: Some(up) });
        }
        // A layer that says nothing means centimetres and y, by USD's own rule.
        let cm = (contents.meters_per_unit.unwrap_or(0.01) * 100.0) as f32;
        if !(cm.is_finite() && cm > 0.0) {
            let line = format!("metersPerUnit = {}: is too far from any unit", cm / 100.0);
            return Err(Error::new(line).in_file(self.path));
        }
        Ok(Coordinates { unit: Some(Unit { cm }), up: Some(up) })
    }
}

fn named(path: &Path, problem: Problem) -> Error {
    Error::new(problem.to_string()).in_file(path)
}

/// What the file says. Only USD layers name a unit; Alembic is y up by agreement.
///
/// # Errors
/// A layer that cannot be read; a unit or an axis that is none.
pub fn coordinates(path: &Path) -> Result<Coordinates> {
    if is_alembic(path) {
        return Ok(Coordinates { unit: None, up: Some(Axis::PlusY) });
    }
    if is_usd(path) { Opened::new(path)?.coordinates() } else { Ok(Coordinates::default()) }
}

/// Reads the hair of frame `frame` (the last one after those there are), in the file's own unit and axes.
/// `segments`: walks every curve into as many; `None` keeps polylines as they are.
///
/// # Errors
/// What is wrong with the file.
pub fn hair(path: &Path, frame: usize, segments: Option<usize>) -> Result<Hair> {
    Opened::new(path)?.ask(|r| r.hair(frame, segments))
}

/// Number of frames of the curves in a layer or archive; 1 for hair that stands still.
///
/// # Errors
/// What is wrong with the file.
pub fn frames(path: &Path) -> Result<usize> {
    Ok(Opened::new(path)?.ask(|r| r.contents())?.times.len().max(1))
}

/// Reads all meshes, in the file's own unit and axes.
///
/// # Errors
/// What is wrong with the file.
pub fn mesh(path: &Path) -> Result<Mesh> {
    Opened::new(path)?.ask(|r| r.mesh())
}

/// Reads the way of the object, prim or joint `node`.
pub(crate) fn track(path: &Path, node: &str) -> Result<Track> {
    let mut file = Opened::new(path)?;
    let motion = file.ask(|r| r.motion(node))?;
    let Coordinates { unit, up } = file.coordinates()?;
    let sample = |placed: Placed| (placed.time, Sample { position: placed.position, rotation: placed.rotation });
    let (times, samples) = motion.into_iter().map(sample).unzip();
    Ok(Track { times, samples, what: format!("object {node}"), unit_cm: unit.map(|unit| f64::from(unit.cm)), up })
}

/// Moving hair of a layer or archive, read one frame after another.
pub struct MovingHair {
    path: PathBuf,
    reader: Box<dyn GroomReader>,
    segments: Option<usize>,
    contents: Contents,
    coordinates: Coordinates,
    hair: Hair,
}

impl MovingHair {
    /// Opens the file at `path` and reads its first frame. `segments`: as in [`hair`].
    ///
    /// # Errors
    /// What is wrong with the file.
    pub fn open(path: &Path, segments: Option<usize>) -> Result<Self> {
        let mut file = Opened::new(path)?;
        let coordinates = file.coordinates()?;
        let contents = file.ask(|r| r.contents())?;
        let hair = file.ask(|r| r.hair_in_place(0, segments, true))?.hair;
        Ok(Self { path: path.to_owned(), reader: file.reader, segments, contents, coordinates, hair })
    }

    /// Number of frames; 1 for hair that stands still.
    pub fn frames(&self) -> usize {
        self.contents.times.len().max(1)
    }

    /// Frames a second.
    pub fn frame_rate(&self) -> f64 {
        self.contents.frame_rate
    }

    /// The first frame with its attributes, in the space of the file's moving transform, its unit and axes.
    pub fn hair(&self) -> &Hair {
        &self.hair
    }

    /// Unit and up axis, as far as the file says them.
    pub fn coordinates(&self) -> Coordinates {
        self.coordinates
    }

    /// The points of a frame, and the transform above them. Nothing of other frames is kept.
    ///
    /// # Errors
    /// What is wrong with the file.
    pub fn frame(&mut self, frame: usize) -> Result<(Strands, Affine3A)> {
        let found = self.reader.hair_in_place(frame, self.segments, false);
        let InPlace { hair, world_from_hair } = found.map_err(|e| named(&self.path, e))?;
        Ok((hair.strands, world_from_hair))
    }

    /// What is told to a file that takes these frames as they are: same numbers, frame rate, unit and axes. `hair`: a
    /// copy of [`hair`](Self::hair), so that frames can be read while the file is written.
    pub fn export<'h>(&self, hair: &'h Hair) -> Export<'h> {
        let mut export = Export::new(hair, self.contents.frame_rate);
        export.first_frame = self.contents.first_frame();
        export.meters_per_unit = self.coordinates.meters_per_unit();
        export.z_up = self.coordinates.up == Some(Axis::PlusZ);
        export.velocities = self.frames() > 1;
        export
    }
}

/// What is told to a file of moving hair: imported hair goes back into its own file's space, at its `placement`, hair
/// grown here is in centimetres, y up.
pub fn export<'a>(hair: &'a Hair, frame_rate: f64, placement: Option<&Placement>) -> Export<'a> {
    let mut export = Export::new(hair, frame_rate);
    export.rest = true;
    export.velocities = true;
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

/// Refuses to lay a layer over the prim `path` of the file `groom` where it is not the one that holds its curves.
///
/// # Errors
/// One line with the paths that are; a file that cannot be read.
pub fn check_layer_prim(groom: &Path, path: &str) -> Result<()> {
    let prims = Opened::new(groom)?.ask(|r| r.prims())?;
    let curves = prims.into_iter().filter_map(|prim| match prim.kind {
        PrimKind::Curves { points, .. } => Some((prim.path, points)),
        _ => None,
    });
    let curves: Vec<(String, usize)> = curves.collect();
    let refuse = |why: String| Err(Error::new(why).in_file(groom));
    let list: Vec<String> = curves.iter().take(8).map(|(path, points)| format!("{path} ({points} points)")).collect();
    let list = list.join(", ");
    match &curves[..] {
        [(only, _)] if only == path => Ok(()),
        [] => refuse(format!("--export-layer {path}: it has no curves over which a layer could lie")),
        [_] => refuse(format!("--export-layer {path}: its curves are at {list}")),
        several => {
            let n = several.len();
            refuse(format!("--export-layer {path}: its curves are in {n} prims ({list}), and a layer lies over one"))
        }
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
pub fn write(path: &Path, hair: &Hair, coordinates: Coordinates) -> Result<()> {
    let mut export = Export::new(hair, 24.0);
    export.meters_per_unit = coordinates.meters_per_unit();
    export.z_up = coordinates.up == Some(Axis::PlusZ);
    let mut sink = sink(path, export, None)?;
    let named = |e: std::io::Error| Error::from(e).in_file(path);
    sink.frame(&hair.strands, &Affine3A::IDENTITY).map_err(named)?;
    sink.finish().map_err(named)
}

/// What the layer or archive `path` cannot hold of `hair`, and what was not read of the file it came from, a phrase each.
pub fn losses(path: &Path, hair: &Hair) -> Vec<String> {
    let at = &hair.attributes;
    let groups = at.group.as_deref().unwrap_or_default();
    let mut lost = at.unread.clone();
    if at.group_names.keys().any(|number| !groups.contains(number)) {
        lost.push("names of groups without strands".to_owned());
    }
    for other in at.other.iter().filter(|_| is_usd(path)) {
        if !nabiki_usd::has_type(other) {
            lost.push(format!("{}: USD has no type for its values", other.name));
        } else if nabiki_usd::valid_name(&other.name) != other.name {
            lost.push(format!("the name {}: it is {} there", other.name, nabiki_usd::valid_name(&other.name)));
        }
    }
    lost
}

/// What is in a layer or archive.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ExchangeInfo {
    /// The curves of the first frame, transforms applied.
    pub hair: Option<HairInfo>,
    /// The meshes, transforms applied.
    pub mesh: Option<MeshInfo>,
    /// Frames of the curves; 1 for a groom that stands still.
    pub frames: usize,
    /// Frames a second, where anything moves.
    pub frame_rate: Option<f64>,
    /// Centimetres in the file's unit, where it says so.
    pub unit_cm: Option<f32>,
    /// Axis that points up, where it says so.
    pub up: Option<String>,
    /// What stands in the file.
    pub prims: Vec<PrimSummary>,
}

/// One object of a layer or archive.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PrimSummary {
    /// Where it stands.
    pub path: String,
    /// What it is, and how much of it.
    pub what: String,
    /// Samples over time; `None` for what does not move.
    pub samples: Option<usize>,
}

impl From<Prim> for PrimSummary {
    fn from(prim: Prim) -> Self {
        let what = match prim.kind {
            PrimKind::Curves { curves, points } => format!("{curves} curves, {points} points"),
            PrimKind::Mesh { faces, points } => format!("mesh, {faces} faces, {points} points"),
            PrimKind::Transform => "transform".to_owned(),
            PrimKind::Skeleton { joints } => format!("skeleton, {} joints", joints.len()),
            PrimKind::Other(name) if name.is_empty() => "no type".to_owned(),
            PrimKind::Other(name) => name,
        };
        Self { path: prim.path, what, samples: (prim.samples > 1).then_some(prim.samples) }
    }
}

impl ExchangeInfo {
    /// Looks into the file.
    ///
    /// # Errors
    /// What is wrong with it.
    pub fn of(path: &Path) -> Result<Self> {
        let mut file = Opened::new(path)?;
        let contents = file.ask(|r| r.contents())?;
        let coordinates = file.coordinates()?;
        let prims: Vec<PrimSummary> = file.ask(|r| r.prims())?.into_iter().map(PrimSummary::from).collect();
        let has = |paths: &[String]| !paths.is_empty();
        let hair = has(&contents.curves).then(|| file.ask(|r| r.hair(0, None))).transpose()?;
        let mesh = has(&contents.meshes).then(|| file.ask(|r| r.mesh())).transpose()?;
        let moves = prims.iter().any(|prim| prim.samples.is_some());
        Ok(Self {
            hair: hair.map(|hair| HairInfo::of(&hair)),
            mesh: mesh.map(|mesh| MeshInfo::of(&mesh)),
            frames: contents.times.len().max(1),
            frame_rate: moves.then_some(contents.frame_rate),
            unit_cm: coordinates.unit.map(|unit| unit.cm),
            up: coordinates.up.map(|axis| axis.to_string()),
            prims,
        })
    }
}

impl fmt::Display for ExchangeInfo {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(hair) = &self.hair {
            writeln!(f, "{hair}")?;
        }
        if let Some(mesh) = &self.mesh {
            writeln!(f, "{mesh}")?;
        }
        match self.frame_rate {
            Some(rate) => writeln!(f, "frames: {} at {rate} a second", self.frames)?,
            None => writeln!(f, "frames: {}", self.frames)?,
        }
        const MOST_LISTED: usize = 40;
        for prim in self.prims.iter().take(MOST_LISTED) {
            match prim.samples {
                Some(samples) => writeln!(f, "{}: {}, {samples} samples", prim.path, prim.what)?,
                None => writeln!(f, "{}: {}", prim.path, prim.what)?,
            }
        }
        if self.prims.len() > MOST_LISTED {
            writeln!(f, "and {} more", self.prims.len() - MOST_LISTED)?;
        }
        match self.unit_cm {
            Some(cm) => write!(f, "the file says: unit {cm} cm")?,
            None => write!(f, "the file says: no unit")?,
        }
        match &self.up {
            Some(up) => write!(f, ", up {up}; facing: unknown"),
            None => write!(f, "; up, facing: unknown"),
        }
    }
}
