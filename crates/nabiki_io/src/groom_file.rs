//! A hair file that is open: what it says of itself and its hair, from one opening.

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
    /// Of hair alone, read when it is asked for.
    Plain(Format),
    /// A layer or archive, which says more.
    Exchange(Opened),
}

impl GroomFile {
    /// Opens the file at `path`.
    ///
    /// # Errors
    /// A name that is none of a hair file; a layer or archive that cannot be read.
    pub fn open(path: &Path) -> Result<Self> {
        let kind = match Format::of(path)? {
            Format::Usd | Format::Alembic => Kind::Exchange(Opened::new(path)?),
            format => Kind::Plain(format),
        };
        Ok(Self { path: path.to_owned(), kind, groups: Vec::new() })
    }

    /// Keeps the curves that `groups` name, or what these stand below, by name or whole path; all, if there are none.
    ///
    /// # Errors
    /// A name that none of the file's curves has; a file of hair alone, which has none.
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

    /// What the file says of its space.
    ///
    /// # Errors
    /// A unit or an axis that is none.
    pub fn declared_space(&mut self) -> Result<DeclaredSpace> {
        match &mut self.kind {
            Kind::Plain(_) => Ok(DeclaredSpace::default()),
            Kind::Exchange(file) => file.declared_space(),
        }
    }

    /// Number of frames; 1 for hair that stands still.
    ///
    /// # Errors
    /// What is wrong with the file.
    pub fn frames(&mut self) -> Result<usize> {
        match &mut self.kind {
            Kind::Plain(_) => Ok(1),
            Kind::Exchange(file) => Ok(file.ask(|r| r.contents())?.times.len().max(1)),
        }
    }

    /// Frames a second of the shot that the file is of; 24 where it does not say so.
    ///
    /// # Errors
    /// What is wrong with the file.
    pub fn frame_rate(&mut self) -> Result<f64> {
        match &mut self.kind {
            Kind::Plain(_) => Ok(24.0),
            Kind::Exchange(file) => Ok(file.ask(|r| r.contents())?.frame_rate),
        }
    }

    /// When the shot begins that the file is of (s), where it says so.
    ///
    /// # Errors
    /// What is wrong with the file.
    pub fn start(&mut self) -> Result<Option<f64>> {
        match &mut self.kind {
            Kind::Plain(_) => Ok(None),
            Kind::Exchange(file) => Ok(file.ask(|r| r.contents())?.start),
        }
    }

    /// Reads the hair of frame `frame` (the last one after those there are), in the file's own unit and axes.
    /// `segments`: walks every curve of a layer or archive into as many, and cuts other strands anew; `None` keeps
    /// polylines as they are.
    ///
    /// # Errors
    /// What is wrong with the file.
    pub fn hair(&mut self, frame: usize, segments: Option<usize>) -> Result<Hair> {
        let placed = self.hair_in_place(frame, segments)?;
        placed.in_world().map_err(|problem| Error::new(problem.to_string()).in_file(&self.path))
    }

    /// The same below the transform that the file has above its curves.
    ///
    /// # Errors
    /// What is wrong with the file.
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

    /// Where the curves are, for a layer to be laid over them. `file`: the name that is remembered.
    ///
    /// # Errors
    /// What is wrong with the file.
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

    /// Its frames, one after another. `segments`: as for [`hair`](Self::hair).
    ///
    /// # Errors
    /// A file of hair alone, which does not move; what is wrong with the file.
    pub fn moving(self, segments: Option<usize>) -> Result<MovingHair> {
        match self.kind {
            Kind::Plain(_) => Err(Error::new("holds no moving hair").in_file(&self.path)),
            Kind::Exchange(file) => MovingHair::of(file, segments),
        }
    }
}
