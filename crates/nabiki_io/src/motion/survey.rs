//! What a motion file holds and what it leaves for a scene to say.

use std::path::Path;

use super::{Track, acclaim, bvh, csv, read_text, tof};
use crate::error::{Error, Result};
use crate::hair::extension;
use crate::info::MotionInfo;

/// Looks through a .bvh, .csv, .amc, .asf or .tof file.
pub(crate) fn survey(file: &Path) -> Result<MotionInfo> {
    let text = read_text(file)?;
    let named = |e: Error| e.in_file(file);
    match extension(file).as_str() {
        "csv" => csv::track(&text).map(|track| of_track(&track, Vec::new(), vec!["up", "facing"])).map_err(named),
        "amc" => amc(&text).map_err(named),
        "asf" => asf(&text).map_err(named),
        "tof" => object_stream(&text).map_err(named),
        _ => {
            let joints = bvh::joints(&text).map_err(named)?;
            let track = bvh::track(&text, joints.first().map_or("", String::as_str)).map_err(named)?;
            Ok(of_track(&track, joints, vec!["unit_cm", "up", "facing"]))
        }
    }
}

fn of_track(track: &Track, joints: Vec<String>, asked: Vec<&'static str>) -> MotionInfo {
    let duration = track.times.last().zip(track.times.first()).map_or(0.0, |(last, first)| last - first);
    MotionInfo { samples: track.samples.len(), duration: Some(duration), joints, unit_cm: track.unit_cm, asked }
}

fn amc(text: &str) -> Result<MotionInfo> {
    let outline = acclaim::outline(text)?;
    let mut asked = vec!["skeleton", "up", "facing"];
    if outline.rate.is_none() {
        asked.push("frames_per_second");
    }
    let duration = outline.rate.map(|rate| (outline.frames - 1) as f64 / rate);
    Ok(MotionInfo { samples: outline.frames, duration, joints: outline.names, unit_cm: None, asked })
}

fn asf(text: &str) -> Result<MotionInfo> {
    let skeleton = acclaim::Skeleton::read(text)?;
    let asked = if skeleton.unit_cm.is_some() { vec!["up", "facing"] } else { vec!["unit_cm", "up", "facing"] };
    Ok(MotionInfo { samples: 0, duration: None, joints: skeleton.names(), unit_cm: skeleton.unit_cm, asked })
}

/// The animation in a .tof, or else the skeleton.
fn object_stream(text: &str) -> Result<MotionInfo> {
    let mut asked = vec!["unit_cm", "up", "facing"];
    if !text.contains("object SkeletalAnimation ") {
        let joints = tof::skeleton(text)?.into_iter().map(|joint| joint.name).collect();
        return Ok(MotionInfo { samples: 0, duration: None, joints, unit_cm: None, asked });
    }
    asked.insert(0, "skeleton");
    let animation = tof::animation(text)?;
    let (duration, samples) = tof::extent(&animation);
    let joints = animation.into_iter().map(|joint| joint.name).collect();
    Ok(MotionInfo { samples, duration: Some(duration), joints, unit_cm: None, asked })
}
