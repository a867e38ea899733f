//! Motion of the head: poses from many file formats, at the scene's frame rate.

mod acclaim;
mod bvh;
mod clip;
mod csv;
#[cfg(feature = "fbx")]
pub(crate) mod fbx;
mod joints;
mod mover;
mod points;
mod resample;
mod source;
mod survey;
mod tof;
pub(crate) mod track;
mod words;
mod world;

use std::path::Path;

use crate::error::{Error, Result};
use crate::exchange;
use crate::fbx_file;
use crate::input::{self, MOST_BINARY_BYTES, MOST_TEXT_BYTES};
use crate::kind::extension;
use source::asked;

pub(crate) use clip::Clip;
#[cfg(feature = "fbx")]
pub(crate) use {clip::choose_clip, joints::DEEPEST};

pub use crate::axis::Axis;
pub use mover::{ClipMover, clip_carries, clip_mover};
pub use points::of_points;
pub use source::{Interpolation, MotionSource};
pub use survey::{MotionInfo, survey};
pub use track::{Sample, Track};
pub use world::HeadMotion;

/// Reads the head's motion at `frame_rate` frames per second.
///
/// # Errors
/// A file that is missing, malformed or too short; a joint or clip that it does not have; a number that is not finite;
/// or a skeleton, rate, unit or axis that neither file nor `source` gives.
pub fn read(source: &MotionSource, frame_rate: f64) -> Result<HeadMotion> {
    let file = &source.file;
    let named = |e: Error| e.in_file(file);
    if !(frame_rate.is_finite() && frame_rate > 0.0) {
        return Err(named(Error::new(format!("frame rate {frame_rate}: must be a finite number above 0"))));
    }
    source.check().map_err(named)?;
    match extension(file).as_str() {
        "bvh" | "csv" | "amc" | "tof" => {
            let text = input::read_text(file, MOST_TEXT_BYTES)?;
            let skeleton = source.skeleton.as_deref();
            let skeleton = skeleton.map(|file| input::read_text(file, MOST_TEXT_BYTES)).transpose()?;
            track(source, &text, skeleton.as_deref())?.head_motion(source, frame_rate)
        }
        "glb" | "gltf" => clip(source, &input::read(file, MOST_BINARY_BYTES)?, frame_rate),
        "fbx" => fbx_file::head_motion(source, &input::read(file, MOST_BINARY_BYTES)?, frame_rate).map_err(named),
        "abc" | "usd" | "usda" | "usdc" => exchange::track(file, &source.node)?.head_motion(source, frame_rate),
        other => {
            let known = ".bvh, .amc, .tof, .glb, .gltf, .fbx, .csv, .abc, .usd, .usda, .usdc, .pc2 and .mdd are read";
            Err(named(Error::new(format!("motion in a .{other} file: {known}"))))
        }
    }
}

/// The samples of a .bvh, .csv, .amc or .tof file with this `text`. `skeleton` is the text of the file
/// `source.skeleton`.
///
/// # Errors
/// As for [`read`], except unit and axes, which samples do not have.
pub fn track(source: &MotionSource, text: &str, skeleton: Option<&str>) -> Result<Track> {
    let named = |e: Error| e.in_file(&source.file);
    let skeleton_file = source.skeleton.as_deref().unwrap_or(Path::new(""));
    let in_skeleton = |e: Error| e.in_file(skeleton_file);
    let skeleton = || {
        let example = if extension(&source.file) == "tof" { "\"skeleton.tof\"" } else { "\"skeleton.asf\"" };
        skeleton.ok_or_else(|| named(asked("skeleton", example)))
    };
    let mut track = match extension(&source.file).as_str() {
        "amc" => {
            let skeleton = acclaim::Skeleton::read(skeleton()?).map_err(in_skeleton)?;
            let chain = skeleton.chain(&source.node).map_err(in_skeleton)?;
            skeleton.track(&chain, text, source.frames_per_second).map_err(named)?
        }
        "tof" => {
            let skeleton = tof::skeleton(skeleton()?).map_err(in_skeleton)?;
            let chain = tof::chain(&skeleton, &source.node).map_err(in_skeleton)?;
            tof::animation(text).and_then(|animation| tof::track(&chain, &animation)).map_err(named)?
        }
        "csv" => csv::track(text).map_err(named)?,
        _ => bvh::track(text, &source.node).map_err(named)?,
    };
    if source.has_skeleton() {
        track.what += &format!(" of {}", skeleton_file.display());
    }
    Ok(track)
}

/// The motion in a .glb or .gltf file with these `bytes`.
///
/// # Errors
/// As for [`read`].
pub fn clip(source: &MotionSource, bytes: &[u8], frame_rate: f64) -> Result<HeadMotion> {
    clip::head_motion(source, bytes, frame_rate).map_err(|e| e.in_file(&source.file))
}

#[cfg(test)]
#[path = "motion/tests.rs"]
mod tests;
