//! The files that the pictures of a scene go into: a movie, a contact sheet, stills, the field.

use std::path::{Path, PathBuf};

use glam::Vec3;
use nabiki_render::output::field_plot::{self, Interval};
use nabiki_render::output::{exr, png};
use nabiki_render::{ContactSheet, Frame, Movie, Picture, RenderError, ToneMapping, View};

use crate::built::BuiltScene;
use crate::error::Result;
use crate::place::{self, Folders};

/// What is said of any place that a picture cannot use.
pub const WAY_OUT: &str = "choose another folder with --out";

type WriteField = fn(&Path, &[Interval]) -> Result<(), RenderError>;

/// Takes frames one by one, and writes of them what the scene asks for.
pub(crate) struct PictureOutputs<'a> {
    built: &'a BuiltScene,
    tone_mapping: ToneMapping,
    movie: Option<(PathBuf, Movie)>,
    sheet: ContactSheet,
    sheet_file: PathBuf,
    on_sheet: Vec<u32>,
    stills: Option<PathBuf>,
    fields: Vec<(PathBuf, WriteField)>,
}

impl<'a> PictureOutputs<'a> {
    /// Begins the files in `folder`, their names beginning with `name`. Whatever could not be written in the end is
    /// refused now.
    pub fn begin(
        built: &'a BuiltScene,
        picture: &Picture,
        folder: &Path,
        name: &str,
        inputs: &[PathBuf],
        folders: &mut Folders,
    ) -> Result<Self> {
        let (output, last) = (&built.scene.output, built.frames());
        let at = |ending: &str| folder.join(format!("{name}{ending}"));
        folders.make(folder, WAY_OUT)?;
        let movie_file = output.movie.then(|| at(".mp4"));
        let (sheet_file, on_sheet) = (at("_sheet.png"), output.sheet_frames(last));
        let stills = (output.png_frames || output.exr_frames).then(|| at("_frames"));
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
        if let Some(stills) = &stills {
            folders.make(stills, WAY_OUT)?;
            // What is there is looked through, rather than every name that will be: frames may be many.
            let asked = |ending: &str| (output.png_frames && ending == "png") || (output.exr_frames && ending == "exr");
            for there in std::fs::read_dir(stills).into_iter().flatten().flatten() {
                let path = there.path();
                let ending = path.extension().and_then(|e| e.to_str()).unwrap_or_default();
                let number = path.file_stem().and_then(|s| s.to_str()).and_then(|s| s.parse().ok());
                if number.is_some_and(|n| n <= last && asked(ending) && still(stills, n, ending) == path) {
                    place::free(&path, WAY_OUT)?;
                }
            }
        }
        let movie = match movie_file {
            Some(file) => {
                let movie = Movie::create(&file, picture, built.scene.frame_rate())?;
                Some((file, movie))
            }
            None => None,
        };
        let tone_mapping = ToneMapping::new(picture);
        Ok(Self { built, tone_mapping, movie, sheet: ContactSheet::new(2), sheet_file, on_sheet, stills, fields })
    }

    /// Takes frame `n`, which `view` shows in the space of the forces.
    pub fn push(&mut self, n: u32, frame: &Frame, view: &View) -> Result<()> {
        let output = &self.built.scene.output;
        if let Some((_, movie)) = &mut self.movie {
            movie.push(frame, &self.tone_mapping)?;
        }
        if let Some(stills) = &self.stills {
            if output.png_frames {
                let depth = if output.png_bits == 16 { png::Depth::Sixteen } else { png::Depth::Eight };
                png::write(&still(stills, n, "png"), frame, &self.tone_mapping, depth)?;
            }
            if output.exr_frames {
                exr::write(&still(stills, n, "exr"), frame)?;
            }
        }
        if self.on_sheet.contains(&n) {
            let force: Vec3 = self.built.force(n.max(1));
            self.sheet.add(frame, &self.tone_mapping, n, Some(force), view);
        }
        Ok(())
    }

    /// Completes the files. Returns what was written.
    pub fn finish(self) -> Result<Vec<PathBuf>> {
        let mut written = Vec::new();
        if let Some((file, movie)) = self.movie {
            movie.finish()?;
            written.push(file);
        }
        if !self.sheet.is_empty() {
            self.sheet.write(&self.sheet_file)?;
            written.push(self.sheet_file);
        }
        written.extend(self.stills);
        let force = self.built.scene.keyframes();
        let intervals: Vec<_> = force.iter().map(|k| Interval { through: k.through, vector: k.vector }).collect();
        for (file, write) in self.fields {
            write(&file, &intervals)?;
            written.push(file);
        }
        Ok(written)
    }
}

/// The file of frame `n` among stills.
fn still(folder: &Path, n: u32, ending: &str) -> PathBuf {
    folder.join(format!("{n:04}.{ending}"))
}
