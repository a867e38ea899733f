//! An open hair file, for several requests.

use std::path::{Path, PathBuf};

use glam::DAffine3;
use nabiki::Hair;
use nabiki::strands::check_points;
use nabiki_exchange::{InPlace, PrimKind};

use crate::bytes::Bytes;
use crate::declared::DeclaredSpace;
use crate::error::{Error, Result};
use crate::exchange::{MovingHair, Opened};
use crate::groom_curves::{CurvePrim, GroomCurves};
use crate::hair_format::Format;
use crate::input::{self, MOST_TEXT_BYTES};
use crate::mesh::parts;
use crate::{hair_file, obj_lines, tfx};

/// A hair file of any format.
pub struct GroomFile {
    path: PathBuf,
    kind: Kind,
    /// Curves that are kept, by name; all if empty.
    groups: Vec<String>,
}

enum Kind {
    /// A format with only hair, read on request.
    Plain(Format),
    /// A layer or archive, which has more data.
    Exchange(Opened),
}

impl GroomFile {
    /// Opens the file at `path`.
    ///
    /// # Errors
    /// If the name is not that of a hair file, or a layer or archive cannot be read.
    pub fn open(path: &Path) -> Result<Self> {
        let kind = match Format::of(path)? {
            Format::Usd | Format::Alembic => Kind::Exchange(Opened::new(path)?),
            format => Kind::Plain(format),
        };
        Ok(Self { path: path.to_owned(), kind, groups: Vec::new() })
    }

    /// Keeps only the curves named in `groups`, or the curves below these objects, by name or full path. Without
    /// `groups`, keeps all.
    ///
    /// # Errors
    /// If no curves have a name, or the format has only hair and no names.
    pub fn keep(mut self, groups: &[String]) -> Result<Self> {
        match &mut self.kind {
            _ if groups.is_empty() => return Ok(self),
            Kind::Plain(_) => {
                let line = "groups has no effect on a file that holds only hair: leave it out";
                return Err(Error::of_setting(line).in_file(&self.path));
            }
            Kind::Exchange(file) => {
                let mut curves = file.ask(|r| r.contents())?.curves;
                parts::check(groups, &curves).map_err(|e| e.in_file(&self.path))?;
                curves.retain(|path| parts::is_kept(groups, path));
                file.ask(|r| {
                    r.keep_curves(curves);
                    Ok(())
                })?;
            }
        }
        Ok(Self { groups: groups.to_vec(), ..self })
    }

    /// The space that the file declares.
    ///
    /// # Errors
    /// An invalid unit or axis.
    pub fn declared_space(&mut self) -> Result<DeclaredSpace> {
        match &mut self.kind {
            Kind::Plain(_) => Ok(DeclaredSpace::default()),
            Kind::Exchange(file) => file.declared_space(),
        }
    }

    /// Number of frames; 1 for hair that does not move.
    ///
    /// # Errors
    /// If the file is invalid.
    pub fn frames(&mut self) -> Result<usize> {
        match &mut self.kind {
            Kind::Plain(_) => Ok(1),
            Kind::Exchange(file) => Ok(file.ask(|r| r.contents())?.times.len().max(1)),
        }
    }

    /// Frames per second of the file's shot; 24 if the file does not say.
    ///
    /// # Errors
    /// If the file is invalid.
    pub fn frame_rate(&mut self) -> Result<f64> {
        match &mut self.kind {
            Kind::Plain(_) => Ok(24.0),
            Kind::Exchange(file) => Ok(file.ask(|r| r.contents())?.frame_rate),
        }
    }

    /// Start of the file's shot (s), if the file says.
    ///
    /// # Errors
    /// If the file is invalid.
    pub fn start(&mut self) -> Result<Option<f64>> {
        match &mut self.kind {
            Kind::Plain(_) => Ok(None),
            Kind::Exchange(file) => Ok(file.ask(|r| r.contents())?.start),
        }
    }

    /// Reads the hair of frame `frame` (after the end, the last frame), in the file's unit and axes. `segments` divides
    /// every curve of a layer or archive into that many and resamples other strands; `None` keeps polylines unchanged.
    ///
    /// # Errors
    /// If the file is invalid.
    pub fn hair(&mut self, frame: usize, segments: Option<usize>) -> Result<Hair> {
        let placed = self.hair_in_place(frame, segments)?;
        placed.in_world().map_err(|problem| Error::new(problem.to_string()).in_file(&self.path))
    }

    /// Like [`hair`](Self::hair), with the transform above the curves kept separate.
    ///
    /// # Errors
    /// If the file is invalid.
    pub fn hair_in_place(&mut self, frame: usize, segments: Option<usize>) -> Result<InPlace> {
        let path = self.path.as_path();
        let named = |e: Error| e.in_file(path);
        let in_world = |hair| InPlace { hair, world_from_hair: DAffine3::IDENTITY };
        let hair = match &mut self.kind {
            Kind::Exchange(file) => return file.ask(|r| r.hair_in_place(frame, segments, true)),
            Kind::Plain(Format::Tfx) => tfx::from_source(&mut Bytes::open(path)?).map_err(named)?,
            Kind::Plain(Format::ObjLines) => {
                obj_lines::from_bytes(&input::read(path, MOST_TEXT_BYTES)?).map_err(named)?
            }
            Kind::Plain(_) => hair_file::from_source(&mut Bytes::open(path)?).map_err(named)?,
        };
        let Some(segments) = segments else { return Ok(in_world(hair)) };
        check_points("segments", segments, hair.strands.len()).map_err(|refused| named(refused.into()))?;
        Ok(in_world(hair.resampled(segments + 1)))
    }

    /// The curves in the file, for a layer over them. `file` is the name to store.
    ///
    /// # Errors
    /// If the file is invalid.
    pub fn curves(&mut self, file: &Path) -> Result<GroomCurves> {
        let prims = match &mut self.kind {
            Kind::Plain(_) => Vec::new(),
            Kind::Exchange(opened) => opened.ask(|r| r.prims())?,
        };
        let curves = prims.into_iter().filter_map(|prim| match prim.kind {
            PrimKind::Curves { points, course, world_from_curves, bound, .. }
                if points > 0 && parts::is_kept(&self.groups, &prim.path) =>
            {
                Some(CurvePrim { path: prim.path, points: points as u64, course, world_from_curves, bound })
            }
            _ => None,
        });
        Ok(GroomCurves { file: file.display().to_string(), curves: curves.collect() })
    }

    /// Opens its frames for reading in order. `segments` is as for [`hair`](Self::hair).
    ///
    /// # Errors
    /// If the format has only hair that does not move, or the file is invalid.
    pub fn moving(self, segments: Option<usize>) -> Result<MovingHair> {
        match self.kind {
            Kind::Plain(_) => Err(Error::new("holds no moving hair").in_file(&self.path)),
            Kind::Exchange(file) => MovingHair::of(file, segments),
        }
    }
}
