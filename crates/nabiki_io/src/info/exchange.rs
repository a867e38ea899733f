//! Summary of a USD layer or an Alembic archive.

use std::{fmt, path::Path};

use nabiki_exchange::{Prim, PrimKind};
use serde::Serialize;

use super::hair::HairInfo;
use super::measure::Guess;
use super::mesh::MeshInfo;
use crate::error::Result;
use crate::exchange::{self, Opened};
use crate::screen::{OneLine, list};
use crate::short::Short;
use crate::unit::Unit;

/// Summary of a layer or archive.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct ExchangeInfo {
    /// The objects in the file.
    pub prims: Vec<PrimSummary>,
    /// The curves of the first frame, transforms applied.
    pub hair: Option<HairInfo>,
    /// The meshes, transforms applied.
    pub mesh: Option<MeshInfo>,
    /// Phrases about data that is not read, for a file with neither hair nor mesh. Otherwise hair and mesh have their
    /// own.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub unread: Vec<String>,
    /// Frames of the curves; 1 for a groom that does not move.
    pub frames: usize,
    /// Frames per second, if anything moves.
    pub frame_rate: Option<f64>,
    /// The unit in centimetres: the file's own, or its format's default; `None` if neither is known.
    pub unit_cm: Option<f32>,
    /// Whether the file itself states the unit.
    pub states_unit: bool,
    /// The up axis: the file's own, or its format's default; `None` if neither is known.
    pub up: Option<String>,
    /// Whether the file itself states the up axis.
    pub states_up: bool,
    /// A guess at what the file does not declare, from the hair or else the mesh.
    #[serde(flatten)]
    pub guess: Option<Guess>,
}

/// One object of a layer or archive.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct PrimSummary {
    /// Its path.
    pub path: String,
    /// Its kind and size.
    pub what: String,
    /// Samples over time; `None` if it does not move.
    pub samples: Option<usize>,
    /// What it is bound to, in the file's terms: `material:binding`.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub relationships: Vec<String>,
    /// The paths of a skeleton's joints.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub joints: Vec<String>,
}

impl From<Prim> for PrimSummary {
    fn from(prim: Prim) -> Self {
        let mut named = Vec::new();
        let what = match prim.kind {
            PrimKind::Curves { curves, points, .. } => format!("{curves} curves, {points} points"),
            PrimKind::Mesh { faces, points } => format!("mesh, {faces} faces, {points} points"),
            PrimKind::Transform => "transform".to_owned(),
            PrimKind::Skeleton { joints } => {
                named = joints;
                format!("skeleton, {} joints", named.len())
            }
            PrimKind::Other(name) if name.is_empty() => "no type".to_owned(),
            PrimKind::Other(name) => name,
        };
        let samples = (prim.samples > 1).then_some(prim.samples);
        Self { path: prim.path, what, samples, relationships: prim.relationships, joints: named }
    }
}

impl fmt::Display for PrimSummary {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        // As many joints as fit a line or two: a face alone may have hundreds.
        const MOST_JOINTS: usize = 8;
        write!(f, "{}: {}", OneLine(&self.path), OneLine(&self.what))?;
        if !self.joints.is_empty() {
            let more = if self.joints.len() > MOST_JOINTS { ", ..." } else { "" };
            write!(f, " ({}{more})", list(&self.joints[..self.joints.len().min(MOST_JOINTS)]))?;
        }
        if let Some(samples) = self.samples {
            write!(f, ", {samples} samples")?;
        }
        for relationship in &self.relationships {
            write!(f, ", {}", OneLine(relationship))?;
        }
        Ok(())
    }
}

impl ExchangeInfo {
    /// Summarises the file.
    ///
    /// # Errors
    /// If the file is invalid.
    pub fn of_file(path: &Path) -> Result<Self> {
        let mut file = Opened::new(path)?;
        let contents = file.ask(|r| r.contents())?;
        let declared = file.declared_space()?;
        let prims: Vec<PrimSummary> = file.ask(|r| r.prims())?.into_iter().map(PrimSummary::from).collect();
        let has = |paths: &[String]| !paths.is_empty();
        let hair = has(&contents.curves).then(|| file.ask(|r| r.hair(0, None))).transpose()?;
        let mesh = has(&contents.meshes).then(|| file.ask(|r| r.meshes_with_losses(&|_| true))).transpose()?;
        let (hair, lost) = (hair.as_ref().map(HairInfo::of), mesh.as_ref().map(|(_, lost)| lost.clone()));
        let mut mesh = mesh.as_ref().map(|(mesh, _)| MeshInfo::of(mesh));
        if let Some(mesh) = &mut mesh {
            mesh.unread = file.ask(|r| r.mesh_unread())?.into_iter().chain(lost.unwrap_or_default()).collect();
            // What the hair says already.
            mesh.unread.retain(|line| hair.as_ref().is_none_or(|hair| !hair.unread.contains(line)));
        }
        let unread = if hair.is_none() && mesh.is_none() { file.ask(|r| r.mesh_unread())? } else { Vec::new() };
        // One guess for the whole file, and only of what it leaves open.
        let likely = hair.as_ref().map(|hair| hair.guess).or(mesh.as_ref().map(|mesh| mesh.guess)).flatten();
        let guess = likely
            .filter(|_| declared.unit.is_none())
            .map(|likely| Guess { likely_up: likely.likely_up.filter(|_| declared.up.is_none()), ..likely });
        let moves = prims.iter().any(|prim| prim.samples.is_some());
        Ok(Self {
            prims,
            hair: hair.map(|hair| HairInfo { guess: None, ..hair }),
            mesh: mesh.map(|mesh| MeshInfo { guess: None, ..mesh }),
            unread,
            frames: contents.times.len().max(1),
            frame_rate: moves.then_some(contents.frame_rate),
            unit_cm: declared.unit.map(|unit| unit.cm),
            states_unit: contents.meters_per_unit.is_some(),
            // An archive states no axis: the reader has that of the format.
            states_up: contents.z_up.is_some() && !exchange::is_alembic(path),
            up: declared.up.map(|axis| axis.to_string()),
            guess,
        })
    }
}

impl fmt::Display for ExchangeInfo {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        // As many prims as fit a screen.
        const MOST_LISTED: usize = 40;
        if let Some(hair) = &self.hair {
            writeln!(f, "{hair}")?;
        }
        if let Some(mesh) = &self.mesh {
            writeln!(f, "{mesh}")?;
        }
        for unread in &self.unread {
            writeln!(f, "not read: {}", OneLine(unread))?;
        }
        match (&self.hair, self.frame_rate) {
            (Some(_), Some(rate)) => writeln!(f, "frames: {} at {} a second", self.frames, Short(rate as f32))?,
            (Some(_), None) => writeln!(f, "frames: {}", self.frames)?,
            (None, Some(rate)) => writeln!(f, "frames a second: {}", Short(rate as f32))?,
            (None, None) => {}
        }
        for prim in self.prims.iter().take(MOST_LISTED) {
            writeln!(f, "{prim}")?;
        }
        if self.prims.len() > MOST_LISTED {
            writeln!(f, "and {} more", self.prims.len() - MOST_LISTED)?;
        }
        let unit = self.unit_cm.map(|cm| (format!("unit {}", Unit { cm }), self.states_unit));
        let up = self.up.as_ref().map(|up| (format!("up {up}"), self.states_up));
        let (stated, assumed): (Vec<_>, Vec<_>) = unit.into_iter().chain(up).partition(|(_, stated)| *stated);
        let listed = |all: &[(String, bool)]| all.iter().map(|(text, _)| &text[..]).collect::<Vec<_>>().join(", ");
        match &stated[..] {
            [] => write!(f, "the file says no unit and no up axis")?,
            stated => write!(f, "the file says: {}", listed(stated))?,
        }
        if !assumed.is_empty() {
            write!(f, "; by the format's default: {}", listed(&assumed))?;
        }
        write!(f, "; facing: unknown")?;
        match self.guess {
            Some(Guess { likely_unit: Some(unit), .. }) => write!(f, "\nunit: {unit} (a guess)"),
            _ => Ok(()),
        }
    }
}
