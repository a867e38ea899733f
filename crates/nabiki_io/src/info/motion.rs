//! What is in a file that moves a head.

use std::{fmt, path::Path};

use serde::Serialize;

use super::Short;
use crate::{error::Result, motion};

/// Samples of a head or of a skeleton.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct MotionInfo {
    /// Number of samples; 0 in a file that holds a skeleton alone.
    pub samples: usize,
    /// Time from the first to the last (s), where the file says so.
    pub duration: Option<f64>,
    /// Joints to choose from; none in a table of poses.
    pub joints: Vec<String>,
    /// Centimetres in the file's unit, where it says so.
    pub unit_cm: Option<f64>,
    /// Settings of `head.motion` that the file leaves for the scene to give.
    pub asked: Vec<&'static str>,
}

impl MotionInfo {
    /// Looks into a .bvh, .csv, .amc, .asf or .tof file.
    pub fn of(path: &Path) -> Result<Self> {
        motion::survey(path)
    }
}

impl fmt::Display for MotionInfo {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match (self.samples, self.duration) {
            (0, None) => writeln!(f, "skeleton: {} joints", self.joints.len())?,
            (samples, None) => writeln!(f, "motion: {samples} samples; rate: unknown")?,
            (samples, Some(duration)) => {
                let rate = samples.saturating_sub(1) as f64 / duration.max(f64::MIN_POSITIVE);
                writeln!(f, "motion: {samples} samples over {duration:.3} s, {rate:.2} a second")?;
            }
        }
        if !self.joints.is_empty() {
            writeln!(f, "joints: {}", self.joints.join(", "))?;
        }
        match self.unit_cm {
            Some(cm) => write!(f, "unit: {} cm; ", Short(cm as f32))?,
            None if self.asked.contains(&"unit_cm") => {}
            None => write!(f, "unit: as its skeleton says; ")?,
        }
        write!(f, "unknown, to be given in the scene: {}", self.asked.join(", "))
    }
}
