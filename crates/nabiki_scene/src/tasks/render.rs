//! Draws a scene's pictures, from a simulation or a motion cache.

use std::path::{Path, PathBuf};

use nabiki_file::Hold;
use nabiki_render::output::{exr, png};
use nabiki_render::{Frame, Movie, ToneMapping};

use crate::advice::Advice;
use crate::built::{BuiltScene, Shown};
use crate::error::{Error, Result};
use crate::film::Film;
use crate::frames::{Cached, FrameSource, Simulated};
use crate::looks_wrong::{of_pictures, within_the_head};
use crate::outputs::{self, PictureOutputs, Stills};
use crate::place::{self, Folders};
use crate::scene::Scene;
use crate::told::Told;
use crate::watch::{Watch, each_frame};

/// Options of [`render`].
#[derive(Clone, Debug, Default)]
pub struct RenderOptions {
    /// The motion cache of the same scene. Without it, the scene is simulated.
    pub motion: Option<PathBuf>,
    /// Which pictures to draw.
    pub pictures: Pictures,
}

/// Which pictures of a scene to draw.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Pictures {
    /// All, as the scene asks: a movie, a contact sheet, stills.
    #[default]
    All,
    /// One frame, as a PNG, and as OpenEXR if the scene asks for it.
    One(u32),
    /// The frames from the first to the second, both included, as numbered stills: PNG files, and OpenEXR files if the
    /// scene asks for them (only these if it wants no movie). Each picture is the same, bit by bit, however the frames
    /// are divided.
    Run(u32, u32),
    /// One frame from all sides: this many pictures of a full turn, as stills and as a movie, as the scene asks.
    Turntable {
        /// The frame.
        frame: u32,
        /// Pictures in the turn, 2..[`MOST_PICTURES`](Pictures::MOST_PICTURES).
        pictures: u32,
    },
}

impl Pictures {
    /// Largest number of pictures of a turntable. All views are computed before the first is drawn.
    pub const MOST_PICTURES: u32 = 100_000;

    /// Refuses frames that do not exist.
    fn check(self, last: u32) -> Result<()> {
        let reaches = format!("the last frame is motion.frames = {last}");
        match self {
            Self::One(frame) | Self::Turntable { frame, .. } if frame > last => {
                Err(Error::refused(format!("--frame {frame}: {reaches}")))
            }
            Self::Run(from, through) if from > through => {
                Err(Error::refused(format!("--frames {from}..{through}: write the earlier frame first")))
            }
            Self::Run(from, through) if through > last => {
                Err(Error::refused(format!("--frames {from}..{through}: {reaches}")))
            }
            Self::Turntable { pictures, .. } if !(2..=Self::MOST_PICTURES).contains(&pictures) => {
                let most = Self::MOST_PICTURES;
                Err(Error::refused(format!("--turntable {pictures}: a turn takes 2 to {most} pictures")))
            }
            _ => Ok(()),
        }
    }
}

/// Draws all frames of a scene, or some, into `folder`.
///
/// # Errors
/// As for [`run`](super::run()); a cache of another motion, or a frame beyond the end of the scene.
pub fn render(scene: Scene, shown: Shown, options: &RenderOptions, folder: &Path, watch: &mut dyn Watch) -> Result<()> {
    options.pictures.check(scene.motion.frames)?;
    let mut scene = scene;
    // A run of frames is for a movie, which is made from PNG files, unless the scene wants only others.
    if matches!(options.pictures, Pictures::Run(..)) && (scene.output.movie || !scene.output.exr_frames) {
        scene.output.png_frames = true;
    }
    if matches!(options.pictures, Pictures::All | Pictures::Turntable { .. }) {
        outputs::check_movie(&scene, &scene.picture)?;
    }
    let built = super::build(scene, shown, watch)?;
    let scene = &built.scene;
    match options.motion {
        None => super::advise(built.advice(), watch),
        // Hair and motion were reported when the motion was made.
        Some(_) => super::advise(within_the_head(&built).into_iter().chain(of_pictures(scene)), watch),
    }
    let mut folders = Folders::default();
    let mut inputs = scene.inputs();
    inputs.extend(options.motion.clone());
    let written = match options.pictures {
        Pictures::All => {
            let mut outputs =
                PictureOutputs::begin(&built, &scene.picture, folder, &scene.name(), &inputs, &mut folders, watch)?;
            let mut film = Film::new(&built, &scene.picture, source(&built, options)?.as_mut(), watch)?;
            let summary = film.shoot(source(&built, options)?.as_mut(), &mut outputs, watch)?;
            watch.told(Told::Motion(summary));
            outputs.finish(watch)?
        }
        Pictures::One(frame) => {
            let path = folder.join(format!("{}_{frame:04}.png", scene.name()));
            let light = scene.output.exr_frames.then(|| path.with_extension("exr"));
            let files: Vec<&Path> = std::iter::once(&path).chain(&light).map(PathBuf::as_path).collect();
            folders.make(folder, outputs::WAY_OUT)?;
            files.iter().try_for_each(|file| place::free(file, outputs::WAY_OUT))?;
            place::not_inputs(&files, &inputs)?;
            let mut film = Film::new(&built, &scene.picture, source(&built, options)?.as_mut(), watch)?;
            let drawn = film.still(frame, source(&built, options)?.as_mut())?;
            png::write(&path, &drawn, &ToneMapping::new(&scene.picture), outputs::png_depth(&scene.output))?;
            light.iter().try_for_each(|file| exr::write(file, &drawn))?;
            std::iter::once(path).chain(light).collect()
        }
        Pictures::Run(from, through) => {
            let mut frames = source(&built, options)?;
            folders.make(folder, outputs::WAY_OUT)?;
            let stills = outputs::stills_folder(folder, &scene.name());
            let (frames_of_task, size) = (from..=through, scene.picture.size);
            let stills =
                Stills::begin(stills, &scene.output, frames_of_task, size, Hold::BesideOthers, &mut folders, watch)?;
            let mut film = Film::new(&built, &scene.picture, source(&built, options)?.as_mut(), watch)?;
            film.stills(from..=through, frames.as_mut(), &stills, watch)?;
            vec![stills.folder().to_owned()]
        }
        Pictures::Turntable { frame, pictures } => turntable(&built, (frame, pictures), options, folder, watch)?,
    };
    super::wrote(written, watch);
    Ok(())
}

/// Draws `frame` in `pictures` steps all the way around.
fn turntable(
    built: &BuiltScene,
    (frame, pictures): (u32, u32),
    options: &RenderOptions,
    folder: &Path,
    watch: &mut dyn Watch,
) -> Result<Vec<PathBuf>> {
    let scene = &built.scene;
    let mut folders = Folders::default();
    folders.make(folder, outputs::WAY_OUT)?;
    let name = format!("{}_{frame:04}_turntable", scene.name());
    let (output, picture) = (&scene.output, &scene.picture);
    let as_stills = output.png_frames || output.exr_frames;
    if !(output.movie || as_stills) {
        let line =
            "a turntable is a movie or stills, and output.movie is off: give output.png_frames = true or exr_frames";
        return Err(Error::refused(format!("{}: {line}", scene.file().display())));
    }
    if picture.camera.to.is_some() {
        let seen = "picture.camera.to changes nothing: a turntable goes round from picture.camera.azimuth".to_owned();
        watch.told(Told::Advice(Advice::new(seen)));
    }
    let file = output.movie.then(|| folder.join(format!("{name}.mp4")));
    let mut inputs = scene.inputs();
    inputs.extend(options.motion.clone());
    if let Some(file) = &file {
        place::free(file, outputs::WAY_OUT)?;
        place::not_inputs(&[file], &inputs)?;
    }
    let stills = as_stills
        .then(|| {
            let stills = outputs::stills_folder(folder, &name);
            Stills::begin(stills, output, 0..=pictures - 1, picture.size, Hold::Alone, &mut folders, watch)
        })
        .transpose()?;
    let frame_rate = picture.video.frame_rate.unwrap_or(scene.frame_rate());
    let mut movie = file.as_ref().map(|file| Movie::create(file, picture, frame_rate)).transpose()?;
    let tone_mapping = ToneMapping::new(picture);
    let mut frames = source(built, options)?;
    let push = |n, drawn: &Frame| {
        movie.as_mut().map_or(Ok(()), |movie| movie.push(drawn, &tone_mapping))?;
        stills.as_ref().map_or(Ok(()), |stills| stills.write(n, drawn, &tone_mapping))
    };
    Film::turntable(built, (frame, pictures), frames.as_mut(), push, watch)?;
    if let Some(stills) = &stills {
        stills.remove_beyond(pictures - 1, watch)?;
    }
    movie.map_or(Ok(()), Movie::finish)?;
    Ok(file.into_iter().chain(stills.map(|stills| stills.folder().to_owned())).collect())
}

/// Draws one frame of a built scene, as linear light. [`ToneMapping`] maps it to the range of a screen. `layers` adds
/// the layers that compositors need for hair, even if the scene does not ask for them.
///
/// # Errors
/// As for [`render`].
pub fn draw(built: &BuiltScene, frame: u32, layers: bool, watch: &mut dyn Watch) -> Result<Frame> {
    let last = built.frames();
    if frame > last {
        return Err(Error::refused(format!("frame {frame}: the last frame is motion.frames = {last}")));
    }
    let mut frames = Simulated::new(built)?;
    let mut film = Film::new(built, &built.scene.picture, &mut frames.again(), watch)?;
    if layers {
        film = film.with_layers();
    }
    if frame > 0 {
        each_frame(watch, "simulating", 0..=frame - 1, |n| frames.frame(n).map(drop))?;
    }
    film.still(frame, &mut frames)
}

fn source<'a>(built: &'a BuiltScene, options: &RenderOptions) -> Result<Box<dyn FrameSource + 'a>> {
    match &options.motion {
        Some(cache) => Ok(Box::new(Cached::of(built, cache)?)),
        None => Ok(Box::new(Simulated::new(built)?)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_turn_of_fewer_than_two_or_of_endless_pictures_is_refused() {
        let said = |pictures| Pictures::Turntable { frame: 0, pictures }.check(9).map_err(|e| e.to_string());
        for pictures in [2, Pictures::MOST_PICTURES] {
            assert_eq!(said(pictures), Ok(()));
        }
        for pictures in [0, 1, 100_001, u32::MAX] {
            assert_eq!(said(pictures), Err(format!("--turntable {pictures}: a turn takes 2 to 100000 pictures")));
        }
    }
}
