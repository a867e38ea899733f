//! Summary of a motion file, and the settings that it leaves to the scene.

use std::fmt;
use std::path::Path;

use serde::Serialize;

use super::track::Track;
use super::{acclaim, bvh, csv, tof};
use crate::error::{Error, Result};
use crate::input::{self, MOST_TEXT_BYTES};
use crate::kind::extension;
use crate::screen::list;
use crate::unit::Unit;

/// Summary of the samples of a head or a skeleton.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct MotionInfo {
    /// Number of samples; 0 in a file with only a skeleton.
    pub samples: usize,
    /// Time from the first to the last (s), if the file says.
    pub duration: Option<f64>,
    /// Joints to choose from; empty for a table of poses.
    pub joints: Vec<String>,
    /// The file's unit in centimetres, if declared.
    pub unit_cm: Option<f64>,
    /// A phrase about the number of frames, if the file declares another number.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub unlike: Option<String>,
    /// Settings of `head.motion` that the scene must give.
    pub asked: Vec<&'static str>,
}

/// Summarises a .bvh, .csv, .amc, .asf or .tof file.
///
/// # Errors
/// If the file is invalid, in one line.
pub fn survey(file: &Path) -> Result<MotionInfo> {
    let text = input::read_text(file, MOST_TEXT_BYTES)?;
    let named = |e: Error| e.in_file(file);
    match extension(file).as_str() {
        "csv" => csv::track(&text)
            .and_then(|track| {
                track.check_times()?;
                Ok(of_track(&track, Vec::new(), vec!["up", "facing"]))
            })
            .map_err(named),
        "amc" => amc(&text).map_err(named),
        "asf" => asf(&text).map_err(named),
        "tof" => object_stream(&text).map_err(named),
        _ => {
            let (joints, track) = bvh::outline(&text).map_err(named)?;
            Ok(of_track(&track, joints, vec!["unit_cm", "up", "facing"]))
        }
    }
}

fn of_track(track: &Track, joints: Vec<String>, asked: Vec<&'static str>) -> MotionInfo {
    let duration = track.times.last().zip(track.times.first()).map_or(0.0, |(last, first)| last - first);
    let unlike = track.unlike.clone();
    MotionInfo { samples: track.samples.len(), duration: Some(duration), joints, unit_cm: track.unit_cm, unlike, asked }
}

fn amc(text: &str) -> Result<MotionInfo> {
    let outline = acclaim::outline(text)?;
    let mut asked = vec!["skeleton", "up", "facing"];
    if outline.rate.is_none() {
        asked.push("frames_per_second");
    }
    let duration = outline.rate.map(|rate| (outline.frames - 1) as f64 / rate);
    Ok(MotionInfo { samples: outline.frames, duration, joints: outline.names, unit_cm: None, unlike: None, asked })
}

fn asf(text: &str) -> Result<MotionInfo> {
    let skeleton = acclaim::Skeleton::read(text)?;
    let asked = if skeleton.unit_cm.is_some() { vec!["up", "facing"] } else { vec!["unit_cm", "up", "facing"] };
    Ok(MotionInfo {
        samples: 0,
        duration: None,
        joints: skeleton.names(),
        unit_cm: skeleton.unit_cm,
        unlike: None,
        asked,
    })
}

/// The animation in a .tof, or else the skeleton.
fn object_stream(text: &str) -> Result<MotionInfo> {
    let mut asked = vec!["unit_cm", "up", "facing"];
    if !text.contains("object SkeletalAnimation ") {
        let joints = tof::skeleton(text)?.into_iter().map(|joint| joint.name).collect();
        return Ok(MotionInfo { samples: 0, duration: None, joints, unit_cm: None, unlike: None, asked });
    }
    asked.insert(0, "skeleton");
    let animation = tof::animation(text)?;
    let (duration, samples) = tof::extent(&animation);
    let joints = animation.into_iter().map(|joint| joint.name).collect();
    Ok(MotionInfo { samples, duration: Some(duration), joints, unit_cm: None, unlike: None, asked })
}

impl fmt::Display for MotionInfo {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match (self.samples, self.duration) {
            (0, None) => writeln!(f, "skeleton: {} joints", self.joints.len())?,
            (samples, None) => writeln!(f, "motion: {samples} samples; rate: unknown")?,
            (samples @ 0..2, Some(_)) => writeln!(f, "motion: {samples} samples, too few to move anything")?,
            (samples, Some(duration)) => {
                let rate = samples.saturating_sub(1) as f64 / duration.max(f64::MIN_POSITIVE);
                writeln!(f, "motion: {samples} samples over {duration:.3} s, {rate:.2} a second")?;
            }
        }
        if let Some(unlike) = &self.unlike {
            writeln!(f, "frames: {unlike}")?;
        }
        if !self.joints.is_empty() {
            writeln!(f, "joints: {}", list(&self.joints))?;
        }
        match self.unit_cm {
            Some(cm) => write!(f, "unit: {}; ", Unit { cm: cm as f32 })?,
            None if self.asked.contains(&"unit_cm") => {}
            None => write!(f, "unit: as its skeleton says; ")?,
        }
        write!(f, "not in the file, required in the scene: {}", self.asked.join(", "))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_motion_lasts_from_its_first_sample_to_its_last() {
        let frames = "1\nroot 0\n2\nroot 0\n3\nroot 0\n";
        let found = amc(&format!(":SAMPLES-PER-SECOND 48\n{frames}")).unwrap();
        assert_eq!((found.samples, found.duration), (3, Some(2.0 / 48.0)));
        assert_eq!(found.asked, ["skeleton", "up", "facing"]);
        let found = amc(frames).unwrap();
        assert_eq!((found.samples, found.duration), (3, None));
        assert_eq!(found.asked, ["skeleton", "up", "facing", "frames_per_second"]);
    }
}
