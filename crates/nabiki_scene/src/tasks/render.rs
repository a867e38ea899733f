//! A scene's pictures, moved by its own simulation or by a motion cache.

use std::path::{Path, PathBuf};

use crate::built::{BuiltScene, Shown};
use crate::error::{Error, Result};
use crate::film::Film;
use crate::frames::{Cached, FrameSource, Simulated};
use crate::outputs::{self, PictureOutputs};
use crate::place::{self, Folders};
use crate::scene::Scene;
use crate::told::Told;
use crate::watch::Watch;

/// What [`render`] draws, and whence.
#[derive(Clone, Debug, Default)]
pub struct RenderOptions {
    /// The motion cache, written from the same scene; without it the scene is simulated.
    pub motion: Option<PathBuf>,
    /// This frame only, as a PNG.
    pub frame: Option<u32>,
}

/// Draws all frames of a scene, or one, into `folder`.
///
/// # Errors
/// As [`run`](super::run()); a cache of another motion, a frame that the scene does not reach.
pub fn render(scene: Scene, shown: Shown, options: &RenderOptions, folder: &Path, watch: &mut dyn Watch) -> Result<()> {
    let last = scene.motion.frames;
    if let Some(frame) = options.frame.filter(|&frame| frame > last) {
        return Err(Error::refused(format!("--frame {frame}: the last frame is motion.frames = {last}")));
    }
    let built = super::build(scene, shown, watch)?;
    let scene = &built.scene;
    let mut folders = Folders::default();
    let mut inputs = scene.inputs();
    inputs.extend(options.motion.clone());
    let written = match options.frame {
        None => {
            let mut outputs =
                PictureOutputs::begin(&built, &scene.picture, folder, &scene.name(), &inputs, &mut folders, watch)?;
            let mut film = Film::new(&built, &scene.picture, source(&built, options)?.as_mut(), watch)?;
            let summary = film.shoot(source(&built, options)?.as_mut(), &mut outputs, watch)?;
            watch.told(Told::Motion(summary));
            outputs.finish(watch)?
        }
        Some(frame) => {
            let path = folder.join(format!("{}_{frame:04}.png", scene.name()));
            folders.make(folder, outputs::WAY_OUT)?;
            place::free(&path, outputs::WAY_OUT)?;
            place::not_inputs(&[&path], &inputs)?;
            let mut film = Film::new(&built, &scene.picture, source(&built, options)?.as_mut(), watch)?;
            film.still(frame, source(&built, options)?.as_mut(), &path)?;
            vec![path]
        }
    };
    super::wrote(written, watch);
    Ok(())
}

fn source<'a>(built: &'a BuiltScene, options: &RenderOptions) -> Result<Box<dyn FrameSource + 'a>> {
    match &options.motion {
        Some(cache) => Ok(Box::new(Cached::of(built, cache)?)),
        None => Ok(Box::new(Simulated::new(built)?)),
    }
}
