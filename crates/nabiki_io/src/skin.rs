//! Skin that bends: the vertices of a head's mesh in every frame, from the file that holds both mesh and motion, or from a point cache.

use std::io::Read;
use std::path::Path;

use glam::{Affine3A, Vec3, Vec3A};
use nabiki::Pose;
use nabiki::strands::bounds;
use nabiki_exchange::{BOUND_SHAPE, FIRST_SHAPE};

use crate::error::{Error, Result};
use crate::exchange;
use crate::fbx_file::{self, is_fbx};
use crate::input::{self, MOST_BINARY_BYTES};
use crate::mesh::glb::{self, STILL_SHAPE};
use crate::mesh::{self, Welded};
use crate::placement::Placement;
use crate::point_cache::{PointFrames, is_point_cache};

/// Whether meshes of a file bend: their points, joints or morphs move. `groups` chooses meshes as in [`mesh::read`], `clip` an
/// animation of a glTF or FBX. Meshes that only go as a whole do not.
///
/// # Errors
/// If the file is invalid.
pub fn bends(path: &Path, groups: &[String], clip: &str) -> Result<bool> {
    if exchange::is_usd(path) || exchange::is_alembic(path) {
        return exchange::bends(path, groups);
    }
    if mesh::is_gltf(path) {
        let bytes = input::read(path, MOST_BINARY_BYTES)?;
        return glb::bends(&bytes, path.parent(), groups, clip).map_err(|e| e.in_file(path));
    }
    if is_fbx(path) {
        let bytes = input::read(path, MOST_BINARY_BYTES)?;
        return fbx_file::bends(&bytes, groups, clip).map_err(|e| e.in_file(path));
    }
    if is_point_cache(path) {
        return points_bend(path).map_err(|e| e.in_file(path));
    }
    Ok(false)
}

/// Whether the joints of a skin move against each other. `movers`: for each joint the nearest node that moves it. Joints with the same
/// one go as a whole.
pub(crate) fn move_apart(mut movers: impl Iterator<Item = Option<usize>>) -> bool {
    let first = movers.next();
    movers.any(|mover| first != Some(mover))
}

/// The nearest node that moves each node: itself, or one above it. `parents`: the nodes above.
pub(crate) fn movers(parents: &[Option<usize>], moves: impl Fn(usize) -> bool) -> Vec<Option<usize>> {
    let mut movers = vec![None; parents.len()];
    let mut known = vec![false; parents.len()];
    let mut way = Vec::new();
    for node in 0..parents.len() {
        // Up to a node whose mover is known; a ring of nodes ends where it began.
        let mut at = Some(node);
        while let Some(node) = at.filter(|&node| !std::mem::replace(&mut known[node], true)) {
            way.push(node);
            at = parents[node];
        }
        let mut mover = at.and_then(|node| movers[node]);
        while let Some(node) = way.pop() {
            mover = if moves(node) { Some(node) } else { mover };
            movers[node] = mover;
        }
    }
    movers
}

/// Whether the distances between points of a cache change, by more than their rounding. Some of them tell.
fn points_bend(path: &Path) -> Result<bool> {
    const SOME: usize = 500;
    let mut cache = PointFrames::open(path)?;
    let first = cache.frame(0)?;
    let farthest = |of: &[Vec3]| {
        let [low, high] = bounds(of);
        (low.abs().max(high.abs()).max_element(), low.distance(high))
    };
    let (away, size) = farthest(&first);
    let step = first.len().div_ceil(SOME);
    for n in 1..cache.frames() {
        let now = cache.frame(n)?;
        // A few roundings of the places, and less than can be seen.
        let most = 4.0 * f32::EPSILON * away.max(farthest(&now).0) + 1e-5 * size;
        let apart = |of: &[Vec3], v: usize| [0, of.len() / 3, of.len() / 2].map(|other| of[v].distance(of[other]));
        let differs = |v: usize| apart(&first, v).into_iter().zip(apart(&now, v)).any(|(a, b)| (a - b).abs() > most);
        if (0..first.len()).step_by(step).any(differs) {
            return Ok(true);
        }
    }
    Ok(false)
}

/// The vertices of a mesh as [`mesh::import`] has them (head space, cm), in the frames 0 to `last`. The motion is in `path`, the
/// mesh's own file or a point cache: the head's poses, and the file's times of frame 0 and between two frames (s). `frame` takes
/// one frame after another. `rate`: frames per second of a cache that counts frames.
///
/// # Errors
/// If the file is invalid, or its vertices change their number.
pub fn each_frame(
    path: &Path,
    mesh: &Path,
    (groups, clip): (&[String], &str),
    placement: &Placement,
    (poses, [first, step], rate): (&[Pose], [f64; 2], f64),
    last: usize,
    frame: &mut dyn FnMut(Vec<Vec3>) -> Result<()>,
) -> Result<()> {
    let named = |e: Error| e.in_file(path);
    let welded = mesh::welded_from(&mesh::read(mesh, groups)?.positions);
    let head_from_file = placement.head_from_file();
    let placed = |n: usize, all: &[Vec3]| -> Result<Vec<Vec3>> {
        let Welded { vertices, kept } = &welded;
        if all.len() != *vertices {
            let line = format!(
                "frame {n} of the motion: its meshes have {} vertices, and {vertices} in the shape at rest: skin that carries hair \
                 keeps its vertices in every frame",
                all.len()
            );
            return Err(Error::new(line));
        }
        let pose = poses.get(n).or(poses.last()).copied().unwrap_or_default();
        // Of the scene's world, where the file's own origin stays.
        let world_from_file = Affine3A { translation: Vec3A::ZERO, ..head_from_file };
        let head_from_world = pose.world_from_head().inverse();
        let there =
            kept.iter().map(|&v| head_from_world.transform_point3(world_from_file.transform_point3(all[v as usize])));
        let there: Vec<Vec3> = there.collect();
        match there.iter().position(|p| !p.is_finite()) {
            Some(v) => Err(Error::new(format!("frame {n} of the motion: vertex {v} of the skin is not finite"))),
            None => Ok(there),
        }
    };
    let times: Vec<f64> = (0..=last).map(|n| first + n as f64 * step).collect();
    let take = &mut |n: usize, all: Vec<Vec3>| frame(placed(n, &all)?);
    if is_point_cache(path) {
        let mut cache = PointFrames::open(path)?;
        let of_cache = cache.times(rate);
        let mut frames = times.iter().enumerate();
        return frames.try_for_each(|(n, &time)| take(n, cache.at(&of_cache, time)?)).map_err(named);
    }
    if mesh::is_gltf(path) {
        let bytes = input::read(path, MOST_BINARY_BYTES)?;
        return glb::each_bent(&bytes, path.parent(), groups, clip, &times, take).map_err(named);
    }
    if is_fbx(path) {
        let bytes = input::read(path, MOST_BINARY_BYTES)?;
        return fbx_file::each_bent(&bytes, groups, clip, &times, take).map_err(named);
    }
    exchange::each_bent(path, groups, &times, take).map_err(named)
}

/// Whether a phrase about unused data says that a mesh keeps one shape. It does not, if its skin is read.
#[must_use]
pub fn says_rigid(unread: &str) -> bool {
    [FIRST_SHAPE, BOUND_SHAPE, STILL_SHAPE].iter().any(|shape| unread.ends_with(shape))
}

/// Hands on the bytes of a file, part by part: what identifies a skin that is read from it.
///
/// # Errors
/// If the file cannot be read.
pub fn each_part(path: &Path, take: &mut dyn FnMut(&[u8])) -> Result<()> {
    let mut file = input::open(path)?;
    let mut part = vec![0; 1 << 20];
    loop {
        match file.read(&mut part).map_err(|e| Error::from(e).in_file(path))? {
            0 => return Ok(()),
            length => take(&part[..length]),
        }
    }
}
