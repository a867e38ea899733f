//! The tasks of front ends. Each task checks its input before it starts, reports to its watcher, and leaves only
//! complete files.

mod convert;
mod farm;
mod groom;
mod join;
mod movie;
mod new;
mod preview;
mod render;
mod run;
mod simulate;
mod solve;

pub use convert::{ConvertOptions, convert};
pub use farm::{FarmOptions, farm};
pub use groom::groom;
pub use join::join;
pub use movie::{MovieOptions, movie};
pub use new::{NewOptions, new};
pub use preview::{PREVIEW_STRANDS, preview};
pub use render::{Pictures, RenderOptions, draw, render};
pub use run::run;
pub use simulate::{ShardOptions, SimulateOptions, Twin, simulate};
pub use solve::{SolveOptions, find, solve};

use std::path::{Path, PathBuf};

use nabiki_io::cache::Shard;

use crate::advice::Advice;
use crate::built::{BuiltScene, Shown};
use crate::error::Result;
use crate::scene::{HairSource, Scene};
use crate::told::{SceneSummary, SwingTable, Told};
use crate::watch::Watch;
use nabiki_io::shell;

/// Builds a scene. Reports before that which files are read, and after it what of the hair's file is not used.
fn build(scene: Scene, shown: Shown, watch: &mut dyn Watch) -> Result<BuiltScene> {
    reading(scene.inputs().split_off(1), watch);
    let built = scene.build(shown)?;
    unread_hair(&built, watch);
    Ok(built)
}

/// The same for one shard of its strands.
fn build_shard(scene: Scene, shown: Shown, shard: Shard, watch: &mut dyn Watch) -> Result<BuiltScene> {
    reading(scene.inputs().split_off(1), watch);
    let built = scene.build_shard(shown, shard)?;
    unread_hair(&built, watch);
    Ok(built)
}

fn unread_hair(built: &BuiltScene, watch: &mut dyn Watch) {
    if let HairSource::Imported(hair) = &built.scene.hair.source {
        unread(&built.scene.resolve(&hair.file), &built.groom.hair.attributes.unread, watch);
    }
}

/// Reports which files are about to be read, if any.
fn reading(files: Vec<PathBuf>, watch: &mut dyn Watch) {
    if !files.is_empty() {
        watch.told(Told::Reading(files));
    }
}

/// Reports the scene's summary, and what looks wrong about it.
fn present(built: &BuiltScene, watch: &mut dyn Watch) {
    watch.told(Told::Scene(SceneSummary::of(built)));
    advise(built.advice(), watch);
}

/// Reports what looks wrong.
fn advise(advice: impl IntoIterator<Item = Advice>, watch: &mut dyn Watch) {
    advice.into_iter().for_each(|advice| watch.told(Told::Advice(advice)));
}

/// The same, and the periods of its swings.
fn introduce(built: &BuiltScene, watch: &mut dyn Watch) {
    present(built, watch);
    watch.told(Told::Swing(SwingTable::of(built)));
}

/// Reports unused data of a hair file, as much as fits part of a screen.
fn unread(file: &Path, all: &[String], watch: &mut dyn Watch) {
    const MOST_SAID: usize = 12;
    let said = if all.len() > MOST_SAID { &all[..MOST_SAID - 1] } else { all };
    let named = shell::quoted(&shell::operand(&file.to_string_lossy()));
    let more = (said.len() < all.len())
        .then(|| format!("and {} more, which nabiki info {} lists", all.len() - said.len(), named));
    said.iter().cloned().chain(more).for_each(|what| watch.told(Told::Unread { file: file.to_owned(), what }));
}

/// Reports what a file cannot store of the hair.
pub(crate) fn lost(file: &Path, losses: Vec<String>, watch: &mut dyn Watch) {
    losses.into_iter().for_each(|what| watch.told(Told::Lost { file: file.to_owned(), what }));
}

/// Reports which files now exist.
fn wrote(files: Vec<PathBuf>, watch: &mut dyn Watch) {
    wrote_with(files.into_iter().map(|file| (file, None)), watch);
}

/// The same, with what each file holds.
fn wrote_with(files: impl Iterator<Item = (PathBuf, Option<String>)>, watch: &mut dyn Watch) {
    files.for_each(|(file, holds)| watch.told(Told::Wrote { file, holds }));
}
