//! Simulates a scene without pictures.

use std::path::{Path, PathBuf};

use nabiki_file::folder_of;
use nabiki_io::cache::Shard;
use nabiki_io::moving;

use crate::built::Shown;
use crate::cache_file::SceneCache;
use crate::error::{Error, Result};
use crate::exports::{ExportOptions, Exports};
use crate::frames::{FrameSource, Simulated};
use crate::motion_summary::MotionSummary;
use crate::place::{self, Folders};
use crate::scene::Scene;
use crate::told::Told;
use crate::watch::{Watch, each_frame};

/// Options of [`simulate`].
#[derive(Clone, Debug)]
pub struct SimulateOptions {
    /// A motion cache (.nabiki), or moving hair for other tools, by its ending.
    pub output: PathBuf,
    /// Additional files of moving hair for other tools.
    pub exports: ExportOptions,
    /// The stepper.
    pub twin: Twin,
    /// Only one shard of the strands, as a motion cache for [`join`](super::join()).
    pub shard: Option<ShardOptions>,
}

/// The shard to simulate.
#[derive(Clone, Debug)]
pub struct ShardOptions {
    /// The shard.
    pub shard: Shard,
    /// The command line for it, without shard and file, for messages about missing shards.
    pub command: String,
}

/// The two steppers.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Twin {
    /// f32, 16 strands at a time, all cores.
    #[default]
    Fast,
    /// The specification: one segment at a time, in f64.
    Reference,
}

/// Simulates a scene and writes all frames.
///
/// # Errors
/// A scene that cannot be built or simulated, a place that cannot be written, or cancelled by `watch`.
pub fn simulate(scene: Scene, shown: Shown, options: &SimulateOptions, watch: &mut dyn Watch) -> Result<()> {
    let mut exports = options.exports.clone();
    let to_tools = moving::is_moving(&options.output);
    let cache = (!to_tools).then_some(options.output.as_path());
    if let Some(ShardOptions { shard, .. }) = options.shard
        && !(cache.is_some() && exports.files.is_empty())
    {
        return Err(Error::refused(format!(
            "--shard {shard}: a shard can only be written to a motion cache (.nabiki); to export, join all shards with \
             nabiki join and use nabiki convert"
        )));
    }
    let mut folders = Folders::default();
    if let (Some(cache), Some(_)) = (cache, &options.shard) {
        // On a farm, no earlier task creates the folder.
        folders.make(folder_of(cache), "choose another name")?;
    }
    match cache {
        Some(cache) => {
            let others = format!("moving hair for other tools in {}", moving::ENDINGS);
            place::cache(cache, &others, &scene.inputs())?
        }
        None => exports.files.insert(0, options.output.clone()),
    }
    exports.check()?;
    let written = exports.written();
    let files: Vec<&Path> = cache.into_iter().chain(written.iter().map(PathBuf::as_path)).collect();
    place::distinct(&files)?;
    place::not_inputs(&files, &scene.inputs())?;
    let built = match &options.shard {
        Some(ShardOptions { shard, .. }) => super::build_shard(scene, shown, *shard, watch)?,
        None => super::build(scene, shown, watch)?,
    };
    let mut frames: Box<dyn FrameSource + '_> = match options.twin {
        Twin::Fast => Box::new(Simulated::new(&built)?),
        Twin::Reference => Box::new(Simulated::by(&built, built.reference()?)),
    };
    super::introduce(&built, watch);
    let in_source = built.hair_in_source();
    let mut exports = Exports::begin(&exports, &built, &in_source, watch)?;
    let reference = options.twin == Twin::Reference;
    let piece = options.shard.as_ref().map(|ShardOptions { command, .. }| built.piece(reference, command));
    let piece = piece.transpose()?.flatten();
    let mut scene_cache = cache.map(|cache| SceneCache::begin(&built, cache, piece, watch)).transpose()?;
    let mut summary = MotionSummary::default();
    each_frame(watch, "simulating", 0..=built.frames(), |n| {
        let strands = frames.frame(n)?;
        let write = || {
            if let Some(cache) = &mut scene_cache {
                cache.push(n, strands)?;
            }
            exports.frame(n, strands, &built.pose(n))
        };
        // The disk takes one thread, and most of the time.
        let (written, ()) = rayon::join(write, || summary.add(&built, n, strands));
        written
    })?;
    scene_cache.map_or(Ok(()), SceneCache::finish)?;
    watch.told(Told::Motion(summary));
    let written = cache.map(|cache| (cache.to_owned(), None)).into_iter().chain(exports.finish()?);
    super::wrote_with(written, watch);
    Ok(())
}
