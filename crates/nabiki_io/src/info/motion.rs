//! What is in a file that moves a head.

use std::{fmt, path::Path};

use serde::Serialize;

use crate::{
    error::{Error, Result},
    motion,
};

/// Samples of a head or of a skeleton.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct MotionInfo {
    /// Number of samples.
    pub samples: usize,
    /// Time from the first to the last (s).
    pub duration: f64,
    /// Joints to choose from; none in a table of poses.
    pub joints: Vec<String>,
    /// Centimetres in the file's unit, where it says so.
    pub unit_cm: Option<f64>,
}

impl MotionInfo {
    /// Looks into a .bvh or .csv file.
    pub fn of(path: &Path) -> Result<Self> {
        let (track, joints) = motion::survey(path).map_err(|e| Error::new(e.problem).in_file(path))?;
        let duration = track.times.last().zip(track.times.first()).map_or(0.0, |(last, first)| last - first);
        Ok(Self { samples: track.samples.len(), duration, joints, unit_cm: track.unit_cm })
    }
}

impl fmt::Display for MotionInfo {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let rate = (self.samples.saturating_sub(1)) as f64 / self.duration.max(f64::MIN_POSITIVE);
        writeln!(f, "motion: {} samples over {:.3} s, {rate:.2} a second", self.samples, self.duration)?;
        if !self.joints.is_empty() {
            writeln!(f, "joints: {}", self.joints.join(", "))?;
        }
        match self.unit_cm {
            Some(cm) => write!(f, "unit: {cm} cm; up, facing: unknown, to be given in the scene"),
            None => write!(f, "unit, up, facing: unknown, to be given in the scene"),
        }
    }
}
