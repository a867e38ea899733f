//! Grooms, simulates and draws a scene.

use std::path::Path;

use nabiki::Strands;

use crate::built::{BuiltScene, Shown};
use crate::error::Result;
use crate::exports::{ExportOptions, Exports};
use crate::film::Film;
use crate::frames::{FrameSource, Simulated};
use crate::outputs::{self, PictureOutputs};
use crate::place::{self, Folders};
use crate::scene::Scene;
use crate::told::Told;
use crate::watch::Watch;

/// Simulates a scene and draws all frames into `folder`: a movie, a contact sheet and the other outputs of the scene.
/// It also writes the requested files of moving hair.
///
/// # Errors
/// A scene that cannot be built or simulated, a place that cannot be written, or cancelled by `watch`.
pub fn run(scene: Scene, shown: Shown, folder: &Path, exports: &ExportOptions, watch: &mut dyn Watch) -> Result<()> {
    exports.check()?;
    let written = exports.written();
    let files: Vec<&Path> = written.iter().map(|file| file.as_path()).collect();
    place::distinct(&files)?;
    place::not_inputs(&files, &scene.inputs())?;
    outputs::check_movie(&scene, &scene.picture)?;
    let built = super::build(scene, shown, watch)?;
    let simulated = Simulated::new(&built)?;
    let scene = &built.scene;
    let mut folders = Folders::default();
    let mut outputs =
        PictureOutputs::begin(&built, &scene.picture, folder, &scene.name(), &scene.inputs(), &mut folders, watch)?;
    outputs.check_apart_from(&files)?;
    super::introduce(&built, watch);
    let in_source = built.hair_in_source();
    let mut exports = Exports::begin(exports, &built, &in_source, watch)?;
    let mut rehearsal = simulated.again();
    let mut frames = Exported { frames: simulated, built: &built, exports: &mut exports };
    let summary = Film::new(&built, &scene.picture, &mut rehearsal, watch)?.shoot(&mut frames, &mut outputs, watch)?;
    watch.told(Told::Motion(summary));
    let pictures = outputs.finish(watch)?.into_iter().map(|file| (file, None));
    super::wrote_with(pictures.chain(exports.finish()?), watch);
    Ok(())
}

/// Frames that are written to files as they are read.
struct Exported<'a, 'b, F> {
    frames: F,
    built: &'a BuiltScene,
    exports: &'b mut Exports<'a>,
}

impl<F: FrameSource> FrameSource for Exported<'_, '_, F> {
    fn frame(&mut self, n: u32) -> Result<&Strands> {
        let strands = self.frames.frame(n)?;
        self.exports.frame(n, strands, &self.built.pose(n))?;
        Ok(strands)
    }
}
