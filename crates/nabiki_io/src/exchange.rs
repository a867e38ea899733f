//! USD layers and Alembic archives: hair, heads, motion, units and axes. Separate crates read and write these formats.

use std::path::{Path, PathBuf};

use glam::{DAffine3, DVec3, Vec3};
use nabiki::{Hair, Mesh, Strands};
use nabiki_alembic::ArchiveReader;
use nabiki_exchange::{Contents, Export, GroomReader, InPlace, Placed, Prim, PrimKind, Problem, Window};
use nabiki_usd::StageReader;

use crate::axis::Axis;
use crate::error::{Error, Result};
use crate::fbx_file::{is_fbx, outline_of};
use crate::groom_curves::CurvePrim;
use crate::input;
use crate::kind::extension;
use crate::mesh::parts;
use crate::motion::track::{Sample, Track};
use crate::moving::{self, ChainOptions};
use crate::placement::Placement;
use crate::unit::Unit;

pub use crate::declared::DeclaredSpace;

/// Whether the file name ends like a USD layer.
pub fn is_usd(path: &Path) -> bool {
    matches!(extension(path).as_str(), "usd" | "usda" | "usdc")
}

/// Whether the file name ends like an Alembic archive.
pub fn is_alembic(path: &Path) -> bool {
    extension(path) == "abc"
}

/// A layer or archive that is open.
pub(crate) struct Opened {
    path: PathBuf,
    reader: Box<dyn GroomReader>,
}

impl Opened {
    pub fn new(path: &Path) -> Result<Self> {
        let file = Window::new(input::open(path)?).map_err(|e| Error::from(e).in_file(path))?;
        let reader: std::result::Result<Box<dyn GroomReader>, Problem> = if is_alembic(path) {
            ArchiveReader::new(file).map(|reader| Box::new(reader) as _)
        } else {
            StageReader::new(file).map(|reader| Box::new(reader) as _)
        };
        Ok(Self { path: path.to_owned(), reader: reader.map_err(|e| named(path, e))? })
    }

    pub fn ask<T>(
        &mut self,
        question: impl FnOnce(&mut dyn GroomReader) -> std::result::Result<T, Problem>,
    ) -> Result<T> {
        question(&mut *self.reader).map_err(|e| named(&self.path, e))
    }

    pub fn declared_space(&mut self) -> Result<DeclaredSpace> {
        let contents = self.ask(|r| r.contents())?;
        let up = if contents.z_up == Some(true) { Axis::PlusZ } else { Axis::PlusY };
        if is_alembic(&self.path) {
            return Ok(DeclaredSpace { unit: None, up: Some(up) });
        }
        // A layer that says nothing means centimetres and y, by USD's own rule.
        let metres = contents.meters_per_unit.unwrap_or(0.01);
        // From nanometres to a thousand kilometres: beyond, the numbers of a head leave what f32 can hold.
        if !(1e-9..=1e6).contains(&metres) {
            let line = format!("metersPerUnit = {metres:e}: must lie in 1e-9..1e6; 0.01 means centimetres");
            return Err(Error::new(line).in_file(&self.path));
        }
        let cm = (metres * 100.0) as f32;
        Ok(DeclaredSpace { unit: Some(Unit { cm }), up: Some(up) })
    }
}

fn meters_per_unit(declared: DeclaredSpace) -> f64 {
    declared.unit.map_or(0.01, Unit::metres)
}

fn named(path: &Path, problem: Problem) -> Error {
    Error::new(problem.to_string()).in_file(path)
}

/// The space that the file or its format declares. glTF is in metres, +y up. A USD layer declares both. Alembic is +y
/// up by convention and has no unit. An FBX declares both. Other formats declare nothing.
///
/// # Errors
/// A layer that cannot be read, or an invalid unit or axis.
pub fn declared_space(path: &Path) -> Result<DeclaredSpace> {
    match extension(path).as_str() {
        "glb" | "gltf" => Ok(DeclaredSpace::GLTF),
        "fbx" => Ok(outline_of(path)?.space),
        _ if is_alembic(path) => Ok(DeclaredSpace { unit: None, up: Some(Axis::PlusY) }),
        _ if is_usd(path) => Opened::new(path)?.declared_space(),
        _ => Ok(DeclaredSpace::default()),
    }
}

/// Reads the hair of frame `frame` (after the end, the last frame), in the file's unit and axes. `segments` divides
/// every curve into that many; `None` keeps polylines unchanged.
///
/// # Errors
/// If the file is invalid.
pub fn hair(path: &Path, frame: usize, segments: Option<usize>) -> Result<Hair> {
    Opened::new(path)?.ask(|r| r.hair(frame, segments))
}

/// Number of frames of the curves in a layer or archive; 1 for hair that does not move and for other formats.
///
/// # Errors
/// If the file is invalid.
pub fn frames(path: &Path) -> Result<usize> {
    if !(is_usd(path) || is_alembic(path)) {
        return Ok(1);
    }
    Ok(Opened::new(path)?.ask(|r| r.contents())?.times.len().max(1))
}

/// Frames per second of a layer, an archive or an FBX; `None` in other formats.
///
/// # Errors
/// If the file is invalid.
pub fn frame_rate(path: &Path) -> Result<Option<f64>> {
    if is_fbx(path) {
        return Ok(outline_of(path)?.rate);
    }
    if !(is_usd(path) || is_alembic(path)) {
        return Ok(None);
    }
    Ok(Some(Opened::new(path)?.ask(|r| r.contents())?.frame_rate))
}

/// Reads the meshes, in the file's own unit and axes: those that show, or all where none does. `groups`: names or whole
/// paths of meshes, or of what they stand below; all meshes when empty. With what of the meshes is left out or not
/// obeyed, a phrase each.
///
/// # Errors
/// What is wrong with the file; a group that it has not.
pub(crate) fn mesh(path: &Path, groups: &[String]) -> Result<(Mesh, Vec<String>)> {
    let mut file = Opened::new(path)?;
    if !groups.is_empty() {
        let meshes = file.ask(|r| r.contents())?.meshes;
        parts::check(groups, &meshes).map_err(|e| e.in_file(path))?;
    }
    let wanted = |mesh: &str| parts::is_kept(groups, mesh);
    file.ask(|r| {
        let (mesh, lost) = r.meshes_with_losses(&wanted)?;
        Ok((mesh, r.meshes_unread(&wanted)?.into_iter().chain(lost).collect()))
    })
}

/// The paths of the meshes of a layer or archive, each with the number of its faces.
///
/// # Errors
/// If the file is invalid.
pub(crate) fn mesh_sizes(path: &Path) -> Result<Vec<(String, usize)>> {
    let prims = Opened::new(path)?.ask(|r| r.prims())?.into_iter();
    let sizes = prims.filter_map(|prim| match prim.kind {
        PrimKind::Mesh { faces, .. } if faces > 0 => Some((prim.path, faces)),
        _ => None,
    });
    Ok(sizes.collect())
}

/// Whether the object, prim or joint `node` carries one of the meshes that a scene reads.
///
/// # Errors
/// If the file is invalid.
pub fn carries_mesh(path: &Path, node: &str, groups: &[String]) -> Result<bool> {
    let mut file = Opened::new(path)?;
    let all: Vec<String> = file.ask(|r| r.prims())?.into_iter().map(|prim| prim.path).collect();
    let by_name = |path: &&String| path.rsplit('/').next().is_some_and(|name| name.eq_ignore_ascii_case(node));
    let Some(node) = all.iter().find(|path| *path == node).or_else(|| all.iter().find(by_name)) else {
        let joint = file.ask(|r| r.joint_of_meshes(&|mesh| parts::is_kept(groups, mesh)))?;
        return Ok(joint.is_some_and(|joint| joint == node || joint.ends_with(&format!("/{node}"))));
    };
    let meshes = file.ask(|r| r.contents())?.meshes;
    Ok(meshes.iter().any(|mesh| parts::is_kept(groups, mesh) && parts::is_part(node, mesh)))
}

/// What moves a mesh that a scene reads: the skeleton joint that it is bound to, the nearest moving transform above it, or
/// the mesh itself if it only bends. `None` in other formats, and if nothing moves.
///
/// # Errors
/// If the file is invalid.
pub fn mover_of_mesh(path: &Path, groups: &[String]) -> Result<Option<String>> {
    if !(is_usd(path) || is_alembic(path)) {
        return Ok(None);
    }
    let mut file = Opened::new(path)?;
    let bends = file.ask(|r| r.bending_times(&|mesh| parts::is_kept(groups, mesh)))?.len() > 1;
    if let Some(joint) = file.ask(|r| r.joint_of_meshes(&|mesh| parts::is_kept(groups, mesh)))? {
        let way = file.ask(|r| r.motion(&joint))?;
        let stays = |placed: &Placed| Placed { time: way[0].time, ..*placed } == way[0];
        return Ok((bends || !way.iter().all(stays)).then_some(joint));
    }
    let (prims, mut meshes) = (file.ask(|r| r.prims())?, file.ask(|r| r.contents())?.meshes);
    meshes.retain(|mesh| parts::is_kept(groups, mesh));
    let moves = |prim: &Prim| prim.kind == PrimKind::Transform && prim.samples > 1;
    let carries = |prim: &Prim| meshes.iter().any(|mesh| parts::is_part(&prim.path, mesh));
    let movers = prims.into_iter().filter(|prim| moves(prim) && carries(prim));
    let mover = movers.map(|prim| prim.path).max_by_key(|path| path.matches('/').count());
    // Skin that bends on a head that stands still.
    Ok(mover.or_else(|| meshes.into_iter().next().filter(|_| bends)))
}

/// Whether the meshes that a scene reads bend.
///
/// # Errors
/// If the file is invalid.
pub(crate) fn bends(path: &Path, groups: &[String]) -> Result<bool> {
    let times = Opened::new(path)?.ask(|r| r.bending_times(&|mesh| parts::is_kept(groups, mesh)))?;
    Ok(times.len() > 1)
}

/// Takes the vertices of those meshes at some times (s), in the order in which [`mesh`] reads them.
pub(crate) fn each_bent(
    path: &Path,
    groups: &[String],
    times: &[f64],
    frame: &mut dyn FnMut(usize, Vec<Vec3>) -> Result<()>,
) -> Result<()> {
    let mut file = Opened::new(path)?;
    for (n, &time) in times.iter().enumerate() {
        frame(n, file.ask(|r| r.bent_meshes(&|mesh| parts::is_kept(groups, mesh), time))?)?;
    }
    Ok(())
}

/// Reads the way of the object, prim or joint `node`.
pub(crate) fn track(path: &Path, node: &str) -> Result<Track> {
    let mut file = Opened::new(path)?;
    let motion = file.ask(|r| r.motion(node))?;
    let sample = |placed: Placed| Sample { position: placed.position, rotation: placed.rotation };
    let bound = file.ask(|r| r.bound(node))?;
    let DeclaredSpace { unit, up } = file.declared_space()?;
    let left_out = left_out_of(&motion, bound.as_ref());
    let bound = bound.map(sample);
    let (times, samples) = motion.into_iter().map(|placed| (placed.time, sample(placed))).unzip();
    let unit_cm = unit.map(|unit| 100.0 * unit.metres());
    Ok(Track { times, samples, what: format!("object {node}"), left_out, unlike: None, bound, unit_cm, up })
}

/// What a head or body, which is rigid, does not take from what moves it.
fn left_out_of(motion: &[Placed], bound: Option<&Placed>) -> Option<&'static str> {
    const SAME: f64 = 1e-3;
    // That with which the mesh was read.
    let first = bound.or(motion.first())?.scale;
    let scaled = motion.iter().any(|placed| !(placed.scale / first).abs_diff_eq(DVec3::ONE, SAME));
    let sheared = motion.iter().any(|placed| placed.sheared);
    match (scaled, sheared) {
        (false, false) => None,
        (true, false) => Some("its scale, which changes"),
        (false, true) => Some("its shear, from uneven scale above a rotation"),
        (true, true) => Some("its scale, which changes, and its shear"),
    }
}

/// Moving hair of a layer or archive, read frame by frame.
pub struct MovingHair {
    file: Opened,
    segments: Option<usize>,
    contents: Contents,
    declared: DeclaredSpace,
    hair: Hair,
}

impl MovingHair {
    /// Opens the file at `path` and reads its first frame. `segments` is as in [`hair`].
    ///
    /// # Errors
    /// If the file is invalid.
    pub fn open(path: &Path, segments: Option<usize>) -> Result<Self> {
        Self::of(Opened::new(path)?, segments)
    }

    pub(crate) fn of(mut file: Opened, segments: Option<usize>) -> Result<Self> {
        let declared = file.declared_space()?;
        let contents = file.ask(|r| r.contents())?;
        let hair = file.ask(|r| r.hair_in_place(0, segments, true))?.hair;
        Ok(Self { file, segments, contents, declared, hair })
    }

    /// Number of frames; 1 for hair that does not move.
    pub fn frames(&self) -> usize {
        self.contents.times.len().max(1)
    }

    /// Frames per second.
    pub fn frame_rate(&self) -> f64 {
        self.contents.frame_rate
    }

    /// The first frame with its attributes, in the space below the file's moving transform, in the file's unit and
    /// axes.
    pub fn hair(&self) -> &Hair {
        &self.hair
    }

    /// Unit and up axis, as far as the file declares them.
    pub fn declared_space(&self) -> DeclaredSpace {
        self.declared
    }

    /// The points of a frame and the transform above them. Other frames are not kept in memory.
    ///
    /// # Errors
    /// If the file is invalid.
    pub fn frame(&mut self, frame: usize) -> Result<(Strands, DAffine3)> {
        let segments = self.segments;
        let InPlace { hair, world_from_hair } = self.file.ask(|r| r.hair_in_place(frame, segments, false))?;
        Ok((hair.strands, world_from_hair))
    }

    /// Export settings for writing these frames unchanged: same frame numbers, frame rate, unit and axes. `hair` is a
    /// copy of [`hair`](Self::hair), so that frames can be read while the file is written.
    pub fn export<'h>(&self, hair: &'h Hair) -> Export<'h> {
        let mut export = Export::new(hair, self.contents.frame_rate);
        export.first_frame = self.contents.first_frame();
        export.meters_per_unit = meters_per_unit(self.declared);
        export.z_up = self.declared.up == Some(Axis::PlusZ);
        export.velocities = self.frames() > 1;
        export
    }
}

/// Export settings for moving hair. Imported hair goes back to its file's space, at its `placement`. Grown hair is in
/// centimetres, y up.
pub fn export<'a>(hair: &'a Hair, frame_rate: f64, placement: Option<&Placement>) -> Export<'a> {
    let mut export = Export::new(hair, frame_rate);
    export.rest = true;
    export.velocities = true;
    export.faces_x = placement.is_none();
    if let Some(placement) = placement {
        export.file_from_head = placement.file_from_head_in_doubles();
        export.meters_per_unit = placement.unit.metres();
        export.z_up = placement.up == Axis::PlusZ;
    }
    export
}

/// Changes `export` to write samples for a layer over `groom`: in the space below the transforms above its curves, with
/// control points for its basis. For curves bound to a skeleton, the layer sets the position.
///
/// The transforms are those of the first frame, in which the hair was read.
pub fn under_groom(export: &mut Export<'_>, groom: &CurvePrim) {
    export.bound = groom.bound;
    if !groom.bound {
        export.file_from_head = groom.world_from_curves.inverse() * export.file_from_head;
    }
    export.course = groom.course;
}

/// Phrases about what samples over a groom cannot express. `head_moves` is whether the head of the motion moves. A
/// groom that is bound to a skeleton is detached from it, and moves with the head nevertheless.
pub fn layer_losses(groom: &CurvePrim, head_moves: bool) -> Vec<String> {
    let head_moves = head_moves && !groom.bound;
    let moves =
        head_moves.then_some("the motion of the head: its stage must move the groom, or leave out --export-layer");
    moves.into_iter().map(str::to_owned).collect()
}

/// Refuses a layer over a groom with `in_file` points (`None` for grown hair) if the import kept another number,
/// `used`.
///
/// # Errors
/// One line that explains how to import all points.
pub fn check_layer(in_file: Option<u64>, used: usize) -> Result<()> {
    let refuse = |why: String| Err(Error::new(format!("a layer would not fit the groom: {why}")));
    match in_file {
        None => refuse("its hair is grown here; leave out --export-layer for a complete stage".to_owned()),
        Some(points) if points != used as u64 => refuse(format!(
            "{used} of its {points} points are used; set hair.join_within = 0 and hair.drop_shorter_than = 0, leave \
             out hair.strands and hair.segments, and remove duplicate points and strands without length from the file"
        )),
        Some(_) => Ok(()),
    }
}

/// The least size (bytes) of a file with this many frames. `layer` is whether it has only samples.
pub fn least_bytes(path: &Path, export: &Export<'_>, frames: u64, layer: bool) -> u64 {
    let points = export.hair.strands.points().len() as u64;
    // A point of text is as long as it is at rest, a velocity at least a row of noughts.
    let (point, velocity) = match extension(path).as_str() {
        "usda" => (nabiki_usd::text_bytes(&export.rest_points()), 11 * points),
        _ => (12 * points, 12 * points),
    };
    let velocity = if export.velocities && frames > 1 && !layer { velocity } else { 0 };
    let rest = if export.rest && !layer { point } else { 0 };
    frames.saturating_mul(point + velocity).saturating_add(rest)
}

/// Export settings for hair that does not move, in its unit and axes.
pub fn still(hair: &Hair, declared: DeclaredSpace) -> Export<'_> {
    let mut export = Export::new(hair, 24.0);
    export.meters_per_unit = meters_per_unit(declared);
    export.z_up = declared.up == Some(Axis::PlusZ);
    export
}

/// Writes hair that does not move, in its unit and axes.
///
/// # Errors
/// Errors of the disk.
pub fn write(path: &Path, hair: &Hair, declared: DeclaredSpace) -> Result<()> {
    moving::write_still(path, still(hair, declared), &DAffine3::IDENTITY, ChainOptions::default())
}

/// Phrases about the data of `hair` that the layer or archive `path` cannot store.
pub fn losses(path: &Path, hair: &Hair) -> Vec<String> {
    let at = &hair.attributes;
    let groups = at.group.as_deref().unwrap_or_default();
    let mut lost = Vec::new();
    if at.group_names.keys().any(|number| !groups.contains(number)) {
        lost.push("names of groups without strands".to_owned());
    }
    let changes = if is_usd(path) { nabiki_usd::changes } else { nabiki_alembic::changes };
    lost.extend(changes(&at.other));
    lost
}
