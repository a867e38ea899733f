//! Motion of the head: poses from files of many kinds, at the scene's own frame rate.
//!
//! A file's world becomes the scene's by one rotation and one scale: its up axis goes to +y, the axis its character
//! faces goes to +x, its unit to centimetres. The same rotation carries the joint's own axes to head space, so the
//! unturned joint of a character who faces the file's facing axis is an unturned head.

mod acclaim;
mod bvh;
mod clip;
mod csv;
mod survey;
mod tof;
mod track;

use std::fmt;
use std::fs;
use std::path::{Path, PathBuf};

use glam::{DQuat, DVec3};
use nabiki::Pose;
use serde::{Deserialize, Serialize};

use crate::error::{Error, Result};
use crate::hair::extension;

pub(crate) use survey::survey;
pub use track::{Sample, Track};

/// Poses of the head, one for each frame of the scene from frame 0 on.
#[derive(Clone, Debug, PartialEq)]
pub struct HeadMotion {
    /// Frames a second.
    pub frame_rate: f64,
    /// World poses, one for each frame.
    pub poses: Vec<Pose>,
    /// What was read and how it was converted, in one line for the user.
    pub report: String,
}

/// Which file moves the head, and what that file cannot say itself: `[head.motion]` of a scene.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields, default)]
pub struct MotionSource {
    /// A .bvh, .amc, .tof, .glb, .gltf, .abc, .usda or .usdc file, or a .csv with the columns t_s, px_m, py_m, pz_m, qx,
    /// qy, qz, qw.
    pub file: PathBuf,
    /// File of the skeleton that the motion moves: the .asf of an .amc, the .tof with the skeleton of a .tof animation.
    /// Others have none.
    pub skeleton: Option<PathBuf>,
    /// Joint, bone or node that carries the head (default "Head"; capitals do not count). Not used for .csv.
    pub node: String,
    /// Animation of a .glb by name; may stay empty where there is one only.
    pub clip: String,
    /// Length of the file's unit (cm). Needed for .bvh, .tof and .abc; .glb is in metres unless said here, .amc in
    /// inches times the `length` of its .asf; .csv and USD name their own.
    pub unit_cm: Option<f64>,
    /// Up axis of the file's world. Needed for .bvh, .amc, .tof and .csv; +y in .glb and .abc; USD names its own.
    pub up: Option<Axis>,
    /// Axis of the file's world that the character faces while the joint is unturned. Needed but for .glb:
    /// +z in that, whose node is unturned as the file's still pose has it. A bone of an .amc is unturned as the .asf
    /// has it, a joint of a .tof where its axes are the world's.
    pub facing: Option<Axis>,
    /// Samples a second. Needed for an .amc, which seldom says; all others say it themselves.
    pub frames_per_second: Option<f64>,
    /// Samples dropped at the start (a T-pose, say; default 0). Not for .glb.
    pub skip: usize,
    /// How positions between two samples are found (default cubic). Rotations turn at a constant rate (slerp). Not for
    /// .glb, whose channels say it themselves.
    pub positions: Interpolation,
    /// Whether the first frame is moved to the world's origin and turned about y to face +x (default false).
    pub start_at_origin: bool,
}

impl Default for MotionSource {
    fn default() -> Self {
        Self {
            file: PathBuf::new(),
            skeleton: None,
            node: "Head".to_owned(),
            clip: String::new(),
            unit_cm: None,
            up: None,
            facing: None,
            frames_per_second: None,
            skip: 0,
            positions: Interpolation::Cubic,
            start_at_origin: false,
        }
    }
}

/// How a position between two samples is found.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Interpolation {
    /// On the straight line between them.
    Linear,
    /// On the Hermite cubic whose end velocities are those of the neighbouring samples' chord.
    Cubic,
}

/// One of the six axis directions.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, Serialize)]
pub enum Axis {
    /// Along x.
    #[serde(rename = "+x", alias = "x")]
    PlusX,
    /// Against x.
    #[serde(rename = "-x")]
    MinusX,
    /// Along y.
    #[serde(rename = "+y", alias = "y")]
    PlusY,
    /// Against y.
    #[serde(rename = "-y")]
    MinusY,
    /// Along z.
    #[serde(rename = "+z", alias = "z")]
    PlusZ,
    /// Against z.
    #[serde(rename = "-z")]
    MinusZ,
}

impl Axis {
    /// Its unit vector.
    pub fn vector(self) -> DVec3 {
        match self {
            Self::PlusX => DVec3::X,
            Self::MinusX => DVec3::NEG_X,
            Self::PlusY => DVec3::Y,
            Self::MinusY => DVec3::NEG_Y,
            Self::PlusZ => DVec3::Z,
            Self::MinusZ => DVec3::NEG_Z,
        }
    }
}

impl fmt::Display for Axis {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::PlusX => "+x",
            Self::MinusX => "-x",
            Self::PlusY => "+y",
            Self::MinusY => "-y",
            Self::PlusZ => "+z",
            Self::MinusZ => "-z",
        })
    }
}

impl MotionSource {
    /// Whether the motion is in one file and its skeleton in another.
    fn has_skeleton(&self) -> bool {
        matches!(extension(&self.file).as_str(), "amc" | "tof")
    }

    /// Refuses what has no effect on a file of this kind.
    fn check(&self) -> Result<()> {
        let ending = extension(&self.file);
        let is_clip = matches!(ending.as_str(), "glb" | "gltf");
        let useless = [
            (self.skeleton.is_some() && !self.has_skeleton(), "skeleton"),
            (self.frames_per_second.is_some() && ending != "amc", "frames_per_second"),
            (!self.clip.is_empty() && !is_clip, "clip"),
            (self.skip > 0 && is_clip, "skip"),
            (self.positions != Interpolation::Cubic && is_clip, "positions"),
        ];
        match useless.into_iter().find(|&(given, _)| given) {
            Some((_, key)) => Err(Error::new(format!("{key} has no effect on a .{ending} file: remove it"))),
            None => Ok(()),
        }
    }
}

/// Reads the head's motion at `frame_rate` frames a second.
///
/// # Errors
/// A file that is missing, malformed or too short, a joint or clip it does not have, a number that is not finite,
/// a skeleton, rate, unit or axis that neither file nor `source` gives.
pub fn read(source: &MotionSource, frame_rate: f64) -> Result<HeadMotion> {
    let file = &source.file;
    let named = |e: Error| e.in_file(file);
    if !(frame_rate.is_finite() && frame_rate > 0.0) {
        return Err(named(Error::new(format!("frame rate {frame_rate}: must be a finite number above 0"))));
    }
    source.check().map_err(named)?;
    match extension(file).as_str() {
        "bvh" | "csv" | "amc" | "tof" => {
            let text = read_text(file)?;
            let skeleton = source.skeleton.as_deref().map(read_text).transpose()?;
            track(source, &text, skeleton.as_deref())?.head_motion(source, frame_rate)
        }
        "glb" | "gltf" => {
            let bytes = fs::read(file).map_err(|e| named(Error::from(e)))?;
            clip(source, &bytes, frame_rate)
        }
        "abc" | "usd" | "usda" | "usdc" => crate::exchange::track(file, &source.node)?.head_motion(source, frame_rate),
        other => {
            let known = ".bvh, .amc, .tof, .glb, .gltf, .csv, .abc and .usd are read";
            Err(named(Error::new(format!("motion in a .{other} file: {known}"))))
        }
    }
}

/// The samples of a text file, .bvh, .csv, .amc or .tof, which holds `text`; `skeleton`: what `source.skeleton` holds.
///
/// # Errors
/// As [`read`], but for unit and axes, which samples are without.
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

/// The motion in a .glb or .gltf, which holds `bytes`.
///
/// # Errors
/// As [`read`].
pub fn clip(source: &MotionSource, bytes: &[u8], frame_rate: f64) -> Result<HeadMotion> {
    clip::head_motion(source, bytes, frame_rate).map_err(|e| e.in_file(&source.file))
}

fn read_text(file: &Path) -> Result<String> {
    let bytes = fs::read(file).map_err(|e| Error::from(e).in_file(file))?;
    String::from_utf8(bytes).map_err(|e| {
        let at = e.utf8_error().valid_up_to();
        Error::new(format!("byte {at} is not text: is this the file that was meant?")).in_file(file)
    })
}

/// A setting that a scene must give, since a file of this kind does not.
fn asked(key: &str, example: &str) -> Error {
    Error::new(format!("{key} is not in the file: give {key} = {example} in the scene"))
}

/// A joint that is not there, and those that are.
fn unknown_node<'a>(kind: &str, node: &str, names: impl Iterator<Item = &'a str>) -> Error {
    let names: Vec<&str> = names.take(60).collect();
    Error::new(format!("no {kind} \"{node}\": node can be {}", names.join(", ")))
}

/// The joints from the root down to `joint`, of `count` that there are.
fn chain_to_root(joint: usize, parent: impl Fn(usize) -> Option<usize>, count: usize) -> Result<Vec<usize>> {
    // Each frame walks the chain, so this bounds the time that a small file can take; a body has a dozen.
    const DEEPEST: usize = 1000;
    let mut chain = vec![joint];
    while let Some(parent) = parent(chain[chain.len() - 1]) {
        chain.push(parent);
        if chain.len() > count {
            return Err(Error::new("a joint is its own ancestor"));
        }
        if chain.len() > DEEPEST {
            return Err(Error::new(format!("a joint has more than {DEEPEST} ancestors, which is more than are read")));
        }
    }
    chain.reverse();
    Ok(chain)
}

/// Carries samples of a file's world into the scene's.
#[derive(Clone, Copy, Debug)]
struct Door {
    world_from_file: DQuat,
    unit_cm: f64,
    up: Axis,
    facing: Axis,
}

impl Door {
    fn new(unit_cm: Option<f64>, up: Option<Axis>, facing: Option<Axis>) -> Result<Self> {
        let unit_cm = unit_cm.ok_or_else(|| asked("unit_cm", "2.54 (cm in one unit)"))?;
        let up = up.ok_or_else(|| asked("up", "\"+y\""))?;
        let facing = facing.ok_or_else(|| asked("facing", "\"+z\""))?;
        if !(unit_cm.is_finite() && unit_cm > 0.0) {
            return Err(Error::new(format!("unit_cm = {unit_cm}: must be a finite number above 0")));
        }
        let (y, x) = (up.vector(), facing.vector());
        if y.dot(x) != 0.0 {
            return Err(Error::new(format!("up = {up} and facing = {facing}: must be normal to each other")));
        }
        let file_from_world = DQuat::from_mat3(&glam::DMat3::from_cols(x, y, x.cross(y)));
        Ok(Self { world_from_file: file_from_world.inverse(), unit_cm, up, facing })
    }

    fn pose(&self, sample: Sample) -> (DVec3, DQuat) {
        let turn = self.world_from_file;
        (turn * sample.position * self.unit_cm, turn * sample.rotation * turn.inverse())
    }
}

/// The poses of all frames, moved to start at the origin where asked.
fn poses(door: &Door, samples: impl Iterator<Item = Sample>, start_at_origin: bool) -> Result<Vec<Pose>> {
    let mut poses: Vec<(DVec3, DQuat)> = samples.map(|s| door.pose(s)).collect();
    if let (true, Some(&(start, turned))) = (start_at_origin, poses.first()) {
        let face = turned * DVec3::X;
        let upright = DQuat::from_rotation_y(face.z.atan2(face.x));
        for (position, rotation) in &mut poses {
            *position = upright * (*position - start);
            *rotation = upright * *rotation;
        }
    }
    let single: Vec<Pose> = poses
        .into_iter()
        .map(|(position, rotation)| Pose { position_cm: position.as_vec3(), rotation: rotation.normalize().as_quat() })
        .collect();
    match single.iter().position(|p| !(p.position_cm.is_finite() && p.rotation.is_finite())) {
        Some(frame) => {
            Err(Error::new(format!("frame {frame}: the pose is not finite; look at unit_cm and the file's numbers")))
        }
        None => Ok(single),
    }
}

/// Number of scene frames that fit into `duration` seconds, the first at 0.
fn frame_count(duration: f64, frame_rate: f64) -> Result<usize> {
    const MOST: f64 = 1e7;
    // A last frame that misses the end by rounding only still counts.
    let last = (duration * frame_rate + 1e-4).floor();
    if (0.0..MOST).contains(&last) {
        Ok(last as usize + 1)
    } else {
        Err(Error::new(format!(
            "lasts {duration} s, {last} frames at {frame_rate} a second: more than {MOST} are not read"
        )))
    }
}

#[cfg(test)]
#[path = "motion/tests.rs"]
mod tests;
