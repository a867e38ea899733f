//! The files of a scene's pictures: a movie, a contact sheet, stills, the field.

use std::fs;
use std::ops::RangeInclusive;
use std::path::{Path, PathBuf};

use nabiki_file::{HeldFolder, Hold};
use nabiki_render::output::field_plot::{self, FieldPlot};
use nabiki_render::output::{exr, png};
use nabiki_render::{ContactSheet, Frame, Movie, Picture, RenderError, ToneMapping, View};

use crate::advice::Advice;
use crate::built::BuiltScene;
use crate::error::{Error, Result};
use crate::field_picture;
use crate::place::{self, Folders};
use crate::scene::{Output, Scene};
use crate::told::Told;
use crate::watch::Watch;

/// The remedy for any place that pictures cannot use.
pub const WAY_OUT: &str = "choose another folder with --out";

type WriteField = fn(&Path, &FieldPlot) -> Result<(), RenderError>;

/// A folder of numbered stills, in the formats of a scene.
pub(crate) struct Stills {
    folder: PathBuf,
    output: Output,
    /// Frames of two films would overwrite each other.
    _held: HeldFolder,
}

impl Stills {
    /// Begins the stills of the `wanted` frames, of this size, in `folder`. Refuses what cannot be written, and a
    /// folder that another command writes to, unless both share its `hold`.
    pub fn begin(
        folder: PathBuf,
        output: &Output,
        wanted: RangeInclusive<u32>,
        size: [u32; 2],
        hold: Hold,
        folders: &mut Folders,
        watch: &mut dyn Watch,
    ) -> Result<Self> {
        folders.make(&folder, WAY_OUT)?;
        let held = HeldFolder::hold(&folder, hold).map_err(|lock| {
            let line = "this is not a regular file, as a lock must be; remove it, or";
            Error::refused(format!("{}: {line} {WAY_OUT}", lock.display()))
        })?;
        let Some(held) = held else {
            let line = "another command is writing frames into this folder; wait until it is done, or";
            return Err(Error::refused(format!("{}: {line} {WAY_OUT}", folder.display())));
        };
        let mut replaced = numbered(&folder, output).into_iter().filter(|(n, _)| wanted.contains(n));
        replaced.try_for_each(|(_, file)| place::free(&file, WAY_OUT))?;
        let frames = u64::from(wanted.end() - wanted.start()) + 1;
        place::room(&folder, frames.saturating_mul(least_bytes(output, size)), watch)?;
        Ok(Self { folder, output: output.clone(), _held: held })
    }

    /// Writes frame `n`.
    pub fn write(&self, n: u32, frame: &Frame, tone_mapping: &ToneMapping) -> Result<()> {
        if self.output.png_frames {
            png::write(&still(&self.folder, n, "png"), frame, tone_mapping, png_depth(&self.output))?;
        }
        if self.output.exr_frames {
            exr::write(&still(&self.folder, n, "exr"), frame)?;
        }
        Ok(())
    }

    /// Removes those after `last` that Nabiki has drawn, so that the folder holds one film. Files with other names,
    /// special files, and files by other programs stay.
    pub fn remove_beyond(&self, last: u32, watch: &mut dyn Watch) -> Result<()> {
        let is_file = |file: &Path| fs::symlink_metadata(file).is_ok_and(|about| about.is_file());
        let there = numbered(&self.folder, &self.output).into_iter();
        let beyond = there.filter(|(n, file)| *n > last && is_file(file)).map(|(_, file)| file);
        let (ours, others): (Vec<_>, Vec<_>) = beyond.partition(|file| png::is_ours(file) || exr::is_ours(file));
        for file in &ours {
            fs::remove_file(file).map_err(|e| nabiki_io::Error::from(e).in_file(file))?;
        }
        if !ours.is_empty() {
            watch.told(Told::Removed { folder: self.folder.clone(), frames: ours.len(), last });
        }
        if let Some(first) = others.iter().min() {
            let (files, them) = if others.len() == 1 { ("file", "it is") } else { ("files", "they are") };
            let seen = format!(
                "{} contains {} {files} of frames after {last} that nabiki did not write, {} first: {them} left there",
                self.folder.display(),
                others.len(),
                first.file_name().unwrap_or_default().display()
            );
            watch.told(Told::Advice(Advice::new(seen)));
        }
        Ok(())
    }

    /// Where they are.
    pub fn folder(&self) -> &Path {
        &self.folder
    }
}

/// Refuses a size or frame rate that no movie has, if the scene wants a movie, before the work starts.
pub(crate) fn check_movie(scene: &Scene, picture: &Picture) -> Result<()> {
    if !scene.output.movie {
        return Ok(());
    }
    let rate = picture.video.frame_rate.unwrap_or(scene.frame_rate());
    Movie::check(picture, rate).map_err(|refused| match refused {
        RenderError::Setting(refused) => scene.refusal(refused).into(),
        other => other.into(),
    })
}

/// The bits of a scene's PNG files.
pub(crate) fn png_depth(output: &Output) -> png::Depth {
    if output.png_bits == 16 { png::Depth::Sixteen } else { png::Depth::Eight }
}

/// The folder of a scene's stills among its results.
pub(crate) fn stills_folder(folder: &Path, name: &str) -> PathBuf {
    folder.join(format!("{name}_frames"))
}

/// Takes frames one by one, and writes the outputs that the scene asks for.
pub(crate) struct PictureOutputs<'a> {
    built: &'a BuiltScene,
    tone_mapping: ToneMapping,
    movie: Option<(PathBuf, Movie)>,
    sheet: ContactSheet,
    sheet_file: PathBuf,
    on_sheet: Vec<u32>,
    stills: Option<Stills>,
    fields: Vec<(PathBuf, WriteField)>,
}

impl<'a> PictureOutputs<'a> {
    /// Begins the files in `folder`, with names that begin with `name`. Refuses now whatever could not be written in
    /// the end.
    pub fn begin(
        built: &'a BuiltScene,
        picture: &Picture,
        folder: &Path,
        name: &str,
        inputs: &[PathBuf],
        folders: &mut Folders,
        watch: &mut dyn Watch,
    ) -> Result<Self> {
        let (output, last) = (&built.scene.output, built.frames());
        let at = |ending: &str| folder.join(format!("{name}{ending}"));
        let nothing = !(output.movie || output.png_frames || output.exr_frames || output.field);
        if nothing && output.sheet_frames(last).is_empty() {
            let line = "nothing to write: output.movie, png_frames, exr_frames, field and sheet are all off; turn on one of them";
            return Err(Error::refused(format!("{}: {line}", built.scene.file().display())));
        }
        folders.make(folder, WAY_OUT)?;
        let movie_file = output.movie.then(|| at(".mp4"));
        let (sheet_file, on_sheet) = (at("_sheet.png"), output.sheet_frames(last));
        let fields: Vec<(PathBuf, WriteField)> = if output.field {
            vec![(at("_field.svg"), field_plot::write_svg), (at("_field.png"), field_plot::write_png)]
        } else {
            Vec::new()
        };
        let sheet = (!on_sheet.is_empty()).then_some(&sheet_file);
        let files: Vec<&Path> =
            movie_file.iter().chain(sheet).chain(fields.iter().map(|(file, _)| file)).map(PathBuf::as_path).collect();
        files.iter().try_for_each(|file| place::free(file, WAY_OUT))?;
        place::not_inputs(&files, inputs)?;
        let stills = (output.png_frames || output.exr_frames)
            .then(|| {
                let stills = stills_folder(folder, name);
                Stills::begin(stills, output, 0..=last, picture.size, Hold::Alone, folders, watch)
            })
            .transpose()?;
        let movie = match movie_file {
            Some(file) => {
                let movie =
                    Movie::create(&file, picture, picture.video.frame_rate.unwrap_or(built.scene.frame_rate()))?;
                Some((file, movie))
            }
            None => None,
        };
        let tone_mapping = ToneMapping::new(picture);
        Ok(Self { built, tone_mapping, movie, sheet: ContactSheet::new(2), sheet_file, on_sheet, stills, fields })
    }

    /// Refuses other results of the same task that would overwrite a picture.
    pub fn check_apart_from(&self, others: &[&Path]) -> Result<()> {
        let sheet = (!self.on_sheet.is_empty()).then_some(&self.sheet_file);
        let movie = self.movie.iter().map(|(file, _)| file);
        let own = movie.chain(sheet).chain(self.fields.iter().map(|(file, _)| file)).map(PathBuf::as_path);
        place::distinct(&own.chain(others.iter().copied()).collect::<Vec<_>>())
    }

    /// Takes frame `n`, seen as in `view` in the space of the forces.
    pub fn push(&mut self, n: u32, frame: &Frame, view: &View) -> Result<()> {
        if let Some((_, movie)) = &mut self.movie {
            movie.push(frame, &self.tone_mapping)?;
        }
        if let Some(stills) = &self.stills {
            stills.write(n, frame, &self.tone_mapping)?;
        }
        if self.on_sheet.contains(&n) {
            match self.built.forces.field.uniform(n.max(1)) {
                Some(force) => self.sheet.add(frame, &self.tone_mapping, n, Some(force), view),
                None => {
                    let arrows = field_picture::arrows(self.built, n.max(1), view);
                    self.sheet.add_arrows(frame, &self.tone_mapping, n, &arrows, view);
                }
            }
        }
        Ok(())
    }

    /// Completes the files, and removes the frames that a longer run left after the last. Returns what was written.
    pub fn finish(self, watch: &mut dyn Watch) -> Result<Vec<PathBuf>> {
        if let Some(stills) = &self.stills {
            stills.remove_beyond(self.built.frames(), watch)?;
        }
        let mut written = Vec::new();
        if let Some((file, movie)) = self.movie {
            movie.finish()?;
            written.push(file);
        }
        if !self.sheet.is_empty() {
            self.sheet.write(&self.sheet_file)?;
            written.push(self.sheet_file);
        }
        written.extend(self.stills.map(|stills| stills.folder));
        for (file, write) in self.fields {
            write(&file, &field_picture::plot(self.built))?;
            written.push(file);
        }
        Ok(written)
    }
}

/// The files among stills with the name of a frame in a written format, and its number. Reads the folder instead of
/// trying every name, because frames may be many.
fn numbered(stills: &Path, output: &Output) -> Vec<(u32, PathBuf)> {
    let written = |ending: &str| (output.png_frames && ending == "png") || (output.exr_frames && ending == "exr");
    let frame = |path: PathBuf| {
        let ending = path.extension()?.to_str()?;
        let number = path.file_stem()?.to_str()?.parse().ok()?;
        (written(ending) && still(stills, number, ending) == path).then_some((number, path))
    };
    fs::read_dir(stills).into_iter().flatten().flatten().filter_map(|there| frame(there.path())).collect()
}

/// Least bytes of the stills of a frame. A bald head on an empty background takes a twelfth of a byte per pixel in a
/// PNG file of 8 bits and two bytes in an EXR file; these are somewhat less.
fn least_bytes(output: &Output, [width, height]: [u32; 2]) -> u64 {
    let pixels = u64::from(width) * u64::from(height);
    let png = if output.png_frames { pixels * u64::from(output.png_bits) / 128 } else { 0 };
    png + if output.exr_frames { pixels } else { 0 }
}

/// The file of frame `n` among stills.
fn still(folder: &Path, n: u32, ending: &str) -> PathBuf {
    folder.join(format!("{n:04}.{ending}"))
}
