//! What is in a USD layer or an Alembic archive.

use std::{fmt, path::Path};

use serde::Serialize;

use super::hair::HairInfo;
use super::measure::Guess;
use super::mesh::MeshInfo;
use crate::error::{Error, Result};
use crate::exchange::{archive, declared_space, hair, is_alembic, mesh, stage};
use crate::short::Short;
use crate::unit::Unit;

/// What is in a layer or archive.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ExchangeInfo {
    /// Paths of the curves.
    pub curves: Vec<String>,
    /// Paths of the meshes.
    pub meshes: Vec<String>,
    /// Transforms that may carry a head.
    pub transforms: Vec<TransformInfo>,
    /// The curves of the first frame, transforms applied.
    pub hair: Option<HairInfo>,
    /// The meshes, transforms applied.
    pub mesh: Option<MeshInfo>,
    /// Frames of the curves; 1 for a groom that stands still.
    pub frames: usize,
    /// Frames a second, where there are several.
    pub frame_rate: Option<f64>,
    /// Centimetres in the file's unit, where it says so.
    pub unit_cm: Option<f32>,
    /// Axis that points up, where it says so.
    pub up: Option<String>,
    /// What the hair, or else the mesh, makes likely of what the file does not say.
    #[serde(flatten)]
    pub guess: Option<Guess>,
}

/// A transform in a layer or archive.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct TransformInfo {
    /// Where it stands.
    pub path: String,
    /// Samples over time; 1 for one that stands still.
    pub samples: usize,
}

impl ExchangeInfo {
    /// Looks into the file.
    ///
    /// # Errors
    /// What is wrong with it.
    pub fn of_file(path: &Path) -> Result<Self> {
        let outline = Outline::of_file(path)?;
        let declared = declared_space(path)?;
        let hair = if outline.curves.is_empty() { None } else { Some(HairInfo::of(&hair(path, 0, None)?)) };
        let mesh = if outline.meshes.is_empty() { None } else { Some(MeshInfo::of(&mesh(path)?)) };
        // One guess for the whole file, and only of what it leaves open.
        let likely = hair.as_ref().map(|hair| hair.guess).or(mesh.as_ref().map(|mesh| mesh.guess)).flatten();
        let guess = likely
            .filter(|_| declared.unit.is_none())
            .map(|likely| Guess { likely_up: likely.likely_up.filter(|_| declared.up.is_none()), ..likely });
        Ok(Self {
            hair: hair.map(|hair| HairInfo { guess: None, ..hair }),
            mesh: mesh.map(|mesh| MeshInfo { guess: None, ..mesh }),
            frames: outline.frames.max(1),
            frame_rate: (outline.frames > 1).then_some(outline.frame_rate),
            curves: outline.curves,
            meshes: outline.meshes,
            transforms: outline.transforms,
            unit_cm: declared.unit.map(|unit| unit.cm),
            up: declared.up.map(|axis| axis.to_string()),
            guess,
        })
    }
}

/// What the two formats' own contents have in common.
struct Outline {
    curves: Vec<String>,
    meshes: Vec<String>,
    transforms: Vec<TransformInfo>,
    frames: usize,
    frame_rate: f64,
}

impl Outline {
    fn of_file(path: &Path) -> Result<Self> {
        let named = |problem: String| Error::new(problem).in_file(path);
        if is_alembic(path) {
            let contents = archive(path)?.contents().map_err(|e| named(e.to_string()))?;
            let transforms = contents.transforms.into_iter().map(|(path, samples)| TransformInfo { path, samples });
            return Ok(Self {
                curves: contents.curves.into_iter().map(|(path, _)| path).collect(),
                meshes: contents.meshes,
                transforms: transforms.collect(),
                frames: contents.frames,
                frame_rate: contents.frame_rate,
            });
        }
        let contents = stage(path)?.contents().map_err(|e| named(e.to_string()))?;
        Ok(Self {
            curves: contents.curves,
            meshes: contents.meshes,
            transforms: Vec::new(),
            frames: contents.times.len(),
            frame_rate: contents.frame_rate,
        })
    }
}

impl fmt::Display for ExchangeInfo {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(hair) = &self.hair {
            writeln!(f, "{hair}")?;
        }
        if let Some(mesh) = &self.mesh {
            writeln!(f, "{mesh}")?;
        }
        for (kind, paths) in [("curves", &self.curves), ("meshes", &self.meshes)] {
            list(f, kind, paths.iter().map(String::clone))?;
        }
        let frames = |transform: &TransformInfo| match transform.samples {
            0 | 1 => transform.path.clone(),
            samples => format!("{} ({samples} frames)", transform.path),
        };
        list(f, "transforms", self.transforms.iter().map(frames))?;
        match self.frame_rate {
            Some(rate) => writeln!(f, "frames: {} at {} a second", self.frames, Short(rate as f32))?,
            None => writeln!(f, "frames: {}", self.frames)?,
        }
        match self.unit_cm {
            Some(cm) => write!(f, "the file says: unit {}", Unit { cm })?,
            None => write!(f, "the file says: no unit")?,
        }
        match &self.up {
            Some(up) => write!(f, ", up {up}; facing: unknown")?,
            None => write!(f, "; up, facing: unknown")?,
        }
        match self.guess {
            Some(Guess { likely_unit: Some(unit), .. }) => write!(f, "\nunit: {unit} (a guess)"),
            _ => Ok(()),
        }
    }
}

/// A line of names, cut short where there are very many.
fn list(f: &mut fmt::Formatter<'_>, kind: &str, names: impl ExactSizeIterator<Item = String>) -> fmt::Result {
    const SHOWN: usize = 40;
    let count = names.len();
    if count == 0 {
        return Ok(());
    }
    let shown: Vec<String> = names.take(SHOWN).collect();
    let more = if count > SHOWN { format!(", and {} more", count - SHOWN) } else { String::new() };
    writeln!(f, "{kind}: {}{more}", shown.join(", "))
}
