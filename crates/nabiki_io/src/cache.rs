//! Motion caches, `.nabiki`: every frame of a simulation, bit by bit, in a file that is written and read one frame at a
//! time. `docs/cache.md` describes the layout.

mod attributes;
mod origin;
mod other;
mod piece;

use std::{
    fs::File,
    io::{Seek, SeekFrom, Write},
    path::{Path, PathBuf},
};

use glam::{Quat, Vec3};
use nabiki::{Hair, Pose, Strands, hair::Attributes, strands::not_finite};
use nabiki_file::PartFile;

use crate::{
    bytes::{Bytes, put},
    error::{Error, Result},
    finite,
    identity::SceneId,
    sum::{Sum, Summing},
};

pub use origin::Origin;
pub use piece::{Piece, Shard};

const MAGIC: &[u8; 8] = b"NABIKI\r\n";
const VERSION: u32 = 1;
const HEADER_BYTES: u64 = 64;
const POSE_BYTES: u64 = 28;
/// The block of the box about all frames.
const BOUNDS_TAG: &[u8; 8] = b"bounds  ";
/// The block of the number of frame 0, where that is not 0.
const START_TAG: &[u8; 8] = b"start   ";
/// The block of the sums of header and frames.
const SUMS_TAG: &[u8; 8] = b"sums    ";
/// What is said of bytes that have another sum.
const DAMAGED: &str = "the file is damaged, its checksum does not match; copy it again, or make it again";

/// The part of a cache that is the same for all frames.
#[derive(Clone, Debug, PartialEq)]
pub struct Header {
    /// The identity of the scene that made the motion.
    pub scene: SceneId,
    /// Frames per second for playback.
    pub frame_rate: f64,
    /// Number of frame 0 on the timeline of the shot. Exported files count from it.
    pub first_frame: i32,
    /// Offsets of the strands' points, and the number of points at the end ([`Strands::starts`]).
    pub starts: Vec<u32>,
    /// The attributes of the groom (widths in cm).
    pub attributes: Attributes,
    /// The file that the hair came from; `None` for grown hair.
    pub origin: Option<Origin>,
    /// The piece of a motion that this is; `None` for a complete motion. In a piece, `scene` is not the identity of the
    /// complete motion.
    pub piece: Option<Piece>,
}

impl Header {
    /// A header for a scene's hair. The hair counts as grown unless you set `origin`.
    pub fn new(scene: SceneId, frame_rate: f64, hair: &Hair) -> Self {
        let starts = hair.strands.starts().to_vec();
        let attributes = hair.attributes.clone();
        Self { scene, frame_rate, first_frame: 0, starts, attributes, origin: None, piece: None }
    }

    /// Marks the strands as a piece of a motion.
    pub fn of_piece(self, piece: Piece) -> Self {
        Self { scene: piece.identity(), piece: Some(piece), ..self }
    }

    fn strand_count(&self) -> usize {
        self.starts.len().saturating_sub(1)
    }

    fn point_count(&self) -> usize {
        self.starts.last().map_or(0, |&n| n as usize)
    }

    /// Bytes of a frame.
    fn frame_bytes(&self) -> u64 {
        POSE_BYTES + 12 * self.point_count() as u64
    }

    /// Strands of this topology with all points at the origin, as the buffer for reading frames.
    pub fn strands(&self) -> Strands {
        Strands::from_parts(self.starts.clone(), vec![Vec3::ZERO; self.point_count()])
    }
}

/// Writes a cache frame by frame. If it is dropped before [`finish`](Self::finish), no file remains.
pub struct Writer {
    file: PartFile,
    target: PathBuf,
    points: usize,
    /// How many frames there will be.
    frames: u64,
    /// The pose of a frame of which some points are still to come, and how many there are.
    open: Option<(Pose, usize)>,
    /// Of what there is of that frame.
    sum: Sum,
    /// Those of the frames that are whole.
    sums: Vec<u64>,
    bounds: [Vec3; 2],
    places: Places,
}

/// Where what is known in the end is to be written.
struct Places {
    bounds: u64,
    sums: u64,
}

impl Writer {
    /// Starts a cache of `frames` frames at `path`.
    ///
    /// # Errors
    /// No strands or frames, a strand with fewer than two points, an invalid frame rate, or an error of the disk.
    pub fn create(path: &Path, header: &Header, frames: u64) -> Result<Self> {
        let named = |e: Error| e.in_file(path);
        let shape = header.strands();
        if shape.is_empty() {
            return Err(named(Error::new("there are no strands to write")));
        }
        check_starts(&header.starts).map_err(named)?;
        if frames == 0 {
            return Err(named(Error::new("there are no frames to write")));
        }
        if !(header.frame_rate.is_finite() && header.frame_rate > 0.0) {
            return Err(named(Error::new(format!("frame rate is {}: must be above 0", header.frame_rate))));
        }
        let hair = Hair { strands: shape, attributes: header.attributes.clone() };
        hair.check_lengths().map_err(|e| named(Error::new(e.to_string())))?;
        let mut file = PartFile::create(path).map_err(|e| named(e.into()))?;
        let places = write_header(&mut file, header, frames).map_err(named)?;
        let bounds = [Vec3::INFINITY, Vec3::NEG_INFINITY];
        Ok(Self {
            file,
            target: path.to_owned(),
            points: header.point_count(),
            frames,
            open: None,
            sum: Sum::default(),
            sums: Vec::new(),
            bounds,
            places,
        })
    }

    /// Appends one frame: all `points` (head space, cm) and the pose of the head.
    pub fn push(&mut self, head: &Pose, points: &[Vec3]) -> Result<()> {
        if points.len() != self.points {
            let what = format!("frame {}: {} points, but the cache has {}", self.frame(), points.len(), self.points);
            return Err(Error::new(what).in_file(&self.target));
        }
        self.check(points)?;
        self.begin_frame(head)?;
        self.part(points)
    }

    /// Starts a frame whose points are written in parts with [`part`](Self::part). It ends with the last point.
    pub fn begin_frame(&mut self, head: &Pose) -> Result<()> {
        let refuse = |what: String| Err(Error::new(what).in_file(&self.target));
        let frame = self.frame();
        if frame == self.frames {
            return refuse(format!("frame {frame}: the cache has room for {frame} frames"));
        }
        if let Some((_, given)) = self.open {
            return refuse(format!("frame {frame}: {given} points, but the cache has {}", self.points));
        }
        if !head.is_valid() {
            let Pose { position_cm, rotation } = head;
            return refuse(format!("frame {frame}: the head is at {position_cm}, turned {rotation}: not a pose"));
        }
        self.sum = Sum::default();
        let mut out = Summing { out: &mut self.file, sum: &mut self.sum };
        put(&mut out, &[head.position_cm])
            .and_then(|()| put(&mut out, &[head.rotation.to_array()]))
            .map_err(|e| e.in_file(&self.target))?;
        self.open = Some((*head, 0));
        Ok(())
    }

    /// Writes the next points of the current frame (head space, cm).
    pub fn part(&mut self, points: &[Vec3]) -> Result<()> {
        let Some((head, given)) = self.open.map(|(head, given)| (head, given + points.len())) else {
            return Err(Error::new("points were given before a frame").in_file(&self.target));
        };
        if given > self.points {
            let what = format!("frame {}: {given} points, but the cache has {}", self.frame(), self.points);
            return Err(Error::new(what).in_file(&self.target));
        }
        self.check(points)?;
        put(&mut Summing { out: &mut self.file, sum: &mut self.sum }, points).map_err(|e| e.in_file(&self.target))?;
        let [low, high] = turned_bounds(points, head.rotation);
        self.bounds = [self.bounds[0].min(low), self.bounds[1].max(high)];
        self.open = (given < self.points).then_some((head, given));
        if given == self.points {
            self.sums.push(self.sum.value());
        }
        Ok(())
    }

    /// The number of the frame that is begun, or will be next.
    fn frame(&self) -> u64 {
        self.sums.len() as u64
    }

    /// Refuses points that are not finite.
    fn check(&self, points: &[Vec3]) -> Result<()> {
        let Some(p) = not_finite(points) else { return Ok(()) };
        let what = format!("frame {}: point {p} is {}: it must be finite", self.frame(), points[p]);
        Err(Error::new(what).in_file(&self.target))
    }

    /// Gives the file its name and returns the number of frames.
    pub fn finish(mut self) -> Result<u64> {
        let named = |e: Error| e.in_file(&self.target);
        if let Some((_, given)) = self.open {
            let what = format!("frame {}: {given} points, but the cache has {}", self.frame(), self.points);
            return Err(named(Error::new(what)));
        }
        if self.frame() != self.frames {
            return Err(named(Error::new(format!("{} frames, but the cache has {}", self.frame(), self.frames))));
        }
        let Places { bounds, sums } = self.places;
        let out = &mut self.file;
        let complete = |out: &mut PartFile| -> Result<()> {
            out.seek(SeekFrom::Start(bounds))?;
            put(out, &self.bounds)?;
            out.seek(SeekFrom::Start(0))?;
            let header = Sum::of(out, sums)?;
            out.seek(SeekFrom::Start(sums))?;
            put(out, &[header])?;
            put(out, &self.sums)
        };
        complete(out).map_err(named)?;
        self.file.finish().map_err(|e| Error::from(e).in_file(&self.target))?;
        Ok(self.frames)
    }
}

/// The box about points that are turned.
fn turned_bounds(points: &[Vec3], turn: Quat) -> [Vec3; 2] {
    if turn == Quat::IDENTITY {
        return nabiki::strands::bounds(points);
    }
    points.iter().fold([Vec3::INFINITY, Vec3::NEG_INFINITY], |[low, high], &p| {
        let p = turn * p;
        [low.min(p), high.max(p)]
    })
}

fn write_header(out: &mut dyn Write, header: &Header, frames: u64) -> Result<Places> {
    let mut blocks = Vec::new();
    put(&mut blocks, &header.starts)?;
    blocks.resize(blocks.len().next_multiple_of(8), 0);
    attributes::write(&mut blocks, &header.attributes)?;
    if let Some(origin) = &header.origin {
        attributes::block(&mut blocks, origin::TAG, Some(&origin.bytes()))?;
        let in_world = origin.in_world.then_some([1_u8]);
        attributes::block(&mut blocks, origin::WORLD_TAG, in_world.as_ref().map(|one| &one[..]))?;
        attributes::block(&mut blocks, origin::GROOM_TAG, Some(&origin::groom_bytes(&origin.groom)?))?;
    }
    let piece = header.piece.as_ref().map(Piece::bytes).transpose()?;
    attributes::block(&mut blocks, piece::TAG, piece.as_deref())?;
    let start = (header.first_frame != 0).then_some([header.first_frame]);
    attributes::block(&mut blocks, START_TAG, start.as_ref().map(|start| &start[..]))?;
    let none = [Vec3::INFINITY, Vec3::NEG_INFINITY];
    attributes::block(&mut blocks, BOUNDS_TAG, Some(&none))?;
    let bounds = HEADER_BYTES + (blocks.len() - size_of_val(&none)) as u64;
    let room = usize::try_from(frames).ok().and_then(|n| n.checked_add(1)).filter(|&n| n < isize::MAX as usize / 8);
    let room = vec![0_u64; room.ok_or_else(|| Error::new(format!("{frames} frames do not fit in memory")))?];
    attributes::block(&mut blocks, SUMS_TAG, Some(&room))?;
    let sums = HEADER_BYTES + (blocks.len() - size_of_val(&room[..])) as u64;
    out.write_all(MAGIC)?;
    put(out, &[VERSION, header.strand_count() as u32, header.point_count() as u32, 0])?;
    put(out, &[frames, HEADER_BYTES + blocks.len() as u64])?;
    put(out, &[header.frame_rate])?;
    out.write_all(&header.scene.0.to_le_bytes())?;
    out.write_all(&blocks)?;
    Ok(Places { bounds, sums })
}

/// Reads any frame of a cache.
pub struct Reader<R = File> {
    source: Bytes<R>,
    path: PathBuf,
    header: Header,
    bounds: [Vec3; 2],
    /// Those of the frames.
    sums: Vec<u64>,
    frames: u64,
    first_frame_at: u64,
}

impl Reader {
    /// Opens a cache, and checks its header against its checksum and the length of the file.
    pub fn open(path: &Path) -> Result<Self> {
        Self::from_source(Bytes::open(path)?, path)
    }
}

impl<'a> Reader<std::io::Cursor<&'a [u8]>> {
    /// Opens a cache in memory.
    pub fn from_bytes(bytes: &'a [u8]) -> Result<Self> {
        Self::from_source(Bytes::from_slice(bytes), Path::new("cache"))
    }
}

impl<R: std::io::Read + Seek> Reader<R> {
    fn from_source(mut source: Bytes<R>, path: &Path) -> Result<Self> {
        let start = read_header(&mut source).map_err(|e| e.in_file(path))?;
        let Start { header, bounds, sums, frames, first_frame_at } = start;
        Ok(Self { source, path: path.to_owned(), header, bounds, sums, frames, first_frame_at })
    }

    /// The path of the file.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// The header.
    pub fn header(&self) -> &Header {
        &self.header
    }

    /// The corners of the bounding box of all points in all frames, relative to the head's origin and along the world's
    /// axes (cm). `None` if a corner is not finite.
    pub fn bounds(&self) -> Option<[Vec3; 2]> {
        Some(self.bounds).filter(|[low, high]| low.is_finite() && high.is_finite())
    }

    /// Number of frames, numbered from 0; frame 0 is the hair at rest.
    pub fn frame_count(&self) -> u64 {
        self.frames
    }

    /// Reads one frame into `strands`, made by [`Header::strands`], and returns the pose of the head.
    ///
    /// # Errors
    /// A frame that is not in the cache or fails its checksum, or `strands` with another number of points.
    pub fn read(&mut self, frame: u64, strands: &mut Strands) -> Result<Pose> {
        let path = self.path.clone();
        self.read_frame(frame, strands).map_err(|e| e.in_file(&path))
    }

    fn read_frame(&mut self, frame: u64, strands: &mut Strands) -> Result<Pose> {
        if frame >= self.frames {
            let last = self.frames - 1;
            return Err(Error::new(format!("frame {frame} is not in the cache: it holds frames 0 to {last}")));
        }
        if strands.points().len() != self.header.point_count() {
            let (given, own) = (strands.points().len(), self.header.point_count());
            return Err(Error::new(format!("frame {frame}: room for {given} points, but the cache has {own}")));
        }
        self.source.seek(self.first_frame_at + frame * self.header.frame_bytes())?;
        self.source.begin_sum();
        let position_cm: Vec3 = self.source.value("head position")?;
        let rotation = Quat::from_array(self.source.value("head rotation")?);
        let pose = Pose { position_cm, rotation };
        self.source.fill(strands.points_mut(), "points")?;
        if self.source.end_sum() != Some(self.sums[frame as usize]) {
            return Err(Error::new(format!("frame {frame}: {DAMAGED}")));
        }
        if !pose.is_valid() {
            let line = format!("the head is at {position_cm}, turned {rotation}: the file is damaged");
            return Err(Error::new(format!("frame {frame}: {line}")));
        }
        finite::points(strands).map_err(|e| Error::new(format!("frame {frame}: {}", e.what)))?;
        Ok(pose)
    }

    /// One frame as hair, with the attributes of the cache.
    pub fn hair(&mut self, frame: u64) -> Result<Hair> {
        let mut strands = self.header.strands();
        self.read(frame, &mut strands)?;
        Ok(Hair { strands, attributes: self.header.attributes.clone() })
    }
}

/// What stands before the frames.
struct Start {
    header: Header,
    bounds: [Vec3; 2],
    sums: Vec<u64>,
    frames: u64,
    first_frame_at: u64,
}

/// Refuses strands of fewer than two points, which have no segment.
fn check_starts(starts: &[u32]) -> Result<()> {
    let too_short = |pair: &[u32]| pair[1].checked_sub(pair[0]).is_none_or(|points| points < 2);
    match starts.windows(2).position(too_short) {
        None => Ok(()),
        Some(s) => Err(Error::new(format!(
            "strand {s}: starts at point {} and the next at {}: a strand needs at least 2 points",
            starts[s],
            starts[s + 1]
        ))),
    }
}

fn read_header<R: std::io::Read + Seek>(source: &mut Bytes<R>) -> Result<Start> {
    source.expect(HEADER_BYTES, "header")?;
    if source.array::<u8>(8, "magic")? != MAGIC {
        return Err(Error::new("does not start with NABIKI: not a motion cache"));
    }
    let [version, strand_count, point_count, _]: [u32; 4] = source.value("counts")?;
    if version != VERSION {
        return Err(Error::new(format!("version is {version}, but only version {VERSION} is read")));
    }
    let (frames, first_frame_at): (u64, u64) = (source.value("frame count")?, source.value("first frame")?);
    let frame_rate: f64 = source.value("frame rate")?;
    let scene = SceneId(u128::from_le_bytes(source.value::<[u8; 16]>("scene identity")?));
    if strand_count == 0 || frames == 0 {
        return Err(Error::new(format!("{strand_count} strands, {frames} frames: the cache is empty")));
    }
    if !(frame_rate.is_finite() && frame_rate > 0.0) {
        return Err(Error::new(format!("frame rate is {frame_rate}: must be above 0")));
    }
    let frame_bytes = POSE_BYTES + 12 * u64::from(point_count);
    let expected = frames.checked_mul(frame_bytes).and_then(|all| all.checked_add(first_frame_at));
    if expected != Some(source.len()) {
        let whole = source.len().saturating_sub(first_frame_at) / frame_bytes;
        let found = source.len();
        return Err(Error::new(format!(
            "{frames} frames of {frame_bytes} bytes from offset {first_frame_at} on expected, {found} bytes found \
             ({whole} frames): the file is cut short or its counts are wrong"
        )));
    }
    let starts: Vec<u32> = source.array(strand_count as usize + 1, "starts")?;
    if starts[0] != 0 || starts.last() != Some(&point_count) {
        return Err(Error::new(format!("strand starts do not rise from 0 to {point_count}: the file is damaged")));
    }
    check_starts(&starts).map_err(|e| Error::new(format!("{}: the file is damaged", e.what)))?;
    let blocks_at = HEADER_BYTES + (starts.len() as u64 * 4).next_multiple_of(8);
    source.seek(blocks_at)?;
    let counts = attributes::Counts { strands: strand_count as usize, points: point_count as usize, frames };
    let attributes::Blocks { attributes, origin, piece, bounds, first_frame, sums } =
        attributes::read(source, first_frame_at, counts)?;
    let lost = |block: &str| Error::new(format!("has no block {block}: {DAMAGED}"));
    let sums = sums.ok_or_else(|| lost("sums"))?;
    source.seek(0)?;
    if source.sum_of(sums.at, "header")? != sums.header {
        return Err(Error::new(format!("header: {DAMAGED}")));
    }
    let bounds = bounds.ok_or_else(|| lost("bounds"))?;
    if let Some(piece) = &piece {
        let expected = piece.shard.range(usize::try_from(piece.strands).unwrap_or(usize::MAX)).len();
        if expected != strand_count as usize {
            let shard = piece.shard;
            let what = format!("shard {shard}: {strand_count} strands instead of {expected}: the file is damaged");
            return Err(Error::new(what));
        }
    }
    let header = Header { scene, frame_rate, first_frame, starts, attributes, origin, piece };
    Ok(Start { header, bounds, sums: sums.frames, frames, first_frame_at })
}
