//! A scene's motion as a cache.

use std::path::Path;

use nabiki_io::cache::{Header, Piece, Writer};

use crate::built::BuiltScene;
use crate::error::Result;
use crate::frames::FrameSource;
use crate::place;
use crate::watch::{Watch, each_frame};

/// A cache being written, frame by frame from 0 on.
pub(crate) struct SceneCache<'a> {
    built: &'a BuiltScene,
    writer: Writer,
}

impl<'a> SceneCache<'a> {
    /// Begins the file. `piece`: what it records of the whole, if only a shard is built.
    pub fn begin(built: &'a BuiltScene, path: &Path, piece: Option<Piece>, watch: &mut dyn Watch) -> Result<Self> {
        let points = built.strands().points().len() as u64;
        // A pose of seven numbers and the points, all of four bytes.
        let frames = u64::from(built.frames()) + 1;
        place::room(path, frames * (28 + 12 * points), watch)?;
        let mut header = Header::new(built.identity()?, built.scene.frame_rate(), &built.groom.hair);
        header.first_frame = built.first_frame();
        header.origin = built.hair_origin();
        if let Some(piece) = piece {
            header = header.of_piece(piece);
        }
        Ok(Self { built, writer: Writer::create(path, &header, frames)? })
    }

    /// Writes the next frame, `n`.
    pub fn push(&mut self, n: u32, strands: &nabiki::Strands) -> Result<()> {
        Ok(self.writer.push(&self.built.pose(n), strands.points())?)
    }

    /// Completes the file and names it.
    pub fn finish(self) -> Result<()> {
        self.writer.finish()?;
        Ok(())
    }
}

/// Writes every frame.
pub(crate) fn write_cache(
    built: &BuiltScene,
    path: &Path,
    frames: &mut dyn FrameSource,
    watch: &mut dyn Watch,
) -> Result<()> {
    let mut cache = SceneCache::begin(built, path, None, watch)?;
    each_frame(watch, "simulating", 0..=built.frames(), |n| cache.push(n, frames.frame(n)?))?;
    cache.finish()
}
