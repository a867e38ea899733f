//! Summary of a motion cache.

use std::fmt;

use serde::Serialize;

use super::hair::HairInfo;
use crate::{
    cache::{Piece, Reader},
    error::Result,
    identity::SceneId,
    short::Short,
};

/// Frames, and the hair of the first frame.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct CacheInfo {
    /// Number of frames, including the rest frame 0.
    pub frames: u64,
    /// Frames per second.
    pub frame_rate: f64,
    /// The identity of the scene that made it.
    pub scene: SceneId,
    /// The shard of a motion, such as `2/7 of 700 strands`; `None` for a complete motion.
    pub shard: Option<String>,
    /// Largest distance of a point between the first and the last frame (head space, cm).
    pub farthest_move: f32,
    /// Whether the head moves between the first and the last frame.
    pub head_moves: bool,
    /// The hair of frame 0 (cm).
    pub rest: HairInfo,
}

impl CacheInfo {
    /// Reads the first and the last frame.
    pub fn of(mut cache: Reader) -> Result<Self> {
        let frames = cache.frame_count();
        let rest = cache.hair(0)?;
        let mut last = rest.strands.clone();
        let first_pose = cache.read(0, &mut last)?;
        let last_pose = cache.read(frames - 1, &mut last)?;
        let moves = last.points().iter().zip(rest.strands.points()).map(|(a, b)| a.distance(*b));
        Ok(Self {
            frames,
            frame_rate: cache.header().frame_rate,
            scene: cache.header().scene,
            shard: cache
                .header()
                .piece
                .as_ref()
                .map(|Piece { shard, strands, .. }| format!("{shard} of {strands} strands")),
            farthest_move: moves.fold(0.0, f32::max),
            head_moves: first_pose != last_pose,
            rest: HairInfo { guess: None, ..HairInfo::of(&rest) },
        })
    }
}

impl fmt::Display for CacheInfo {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "motion cache: {} frames at {} a second, of scene {}", self.frames, self.frame_rate, self.scene)?;
        if let Some(shard) = &self.shard {
            writeln!(f, "shard {shard}; nabiki join combines all of them")?;
        }
        let head = if self.head_moves { "moves" } else { "stands still" };
        writeln!(
            f,
            "from first to last frame a point moves at most {} cm; the head {head}",
            Short(self.farthest_move)
        )?;
        write!(f, "{}\nunit: cm; up: +y; facing: +x (head space)", self.rest)
    }
}
