//! Motion of the head: poses from .bvh, .glb or .csv, at the scene's own frame rate.
//!
//! A file's world becomes the scene's by one rotation and one scale: its up axis goes to +y, the axis its character
//! faces goes to +x, its unit to centimetres. The same rotation carries the joint's own axes to head space, so the
//! unturned joint of a character who faces the file's facing axis is an unturned head.

mod bvh;
mod clip;
mod csv;
mod track;

use std::fmt;
use std::path::{Path, PathBuf};

use glam::{DQuat, DVec3, Quat, Vec3};
use serde::{Deserialize, Serialize};

pub use track::{Sample, Track};

/// Where the head is in one frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose {
    /// Origin of head space in the world (cm; y up, right-handed).
    pub position_cm: Vec3,
    /// Turns head space into the world: world = `rotation` head + `position_cm`.
    pub rotation: Quat,
}

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
    /// A .bvh, .glb, .gltf, .abc, .usda or .usdc file, or a .csv with the columns t_s, px_m, py_m, pz_m, qx, qy, qz, qw.
    pub file: PathBuf,
    /// Joint or node that carries the head (default "Head"; capitals do not count). Not used for .csv.
    pub node: String,
    /// Animation of a .glb by name; may stay empty where there is one only.
    pub clip: String,
    /// Length of the file's unit (cm). Needed for .bvh and .abc; .glb is in metres unless said here; .csv and USD name
    /// their own.
    pub unit_cm: Option<f64>,
    /// Up axis of the file's world. Needed for .bvh and .csv; +y in .glb and .abc; USD names its own.
    pub up: Option<Axis>,
    /// Axis of the file's world that the character faces while the joint is unturned. Needed but for .glb:
    /// +z in that, whose node is unturned as the file's still pose has it.
    pub facing: Option<Axis>,
    /// Samples dropped at the start of a .bvh or .csv (a T-pose, say; default 0).
    pub skip: usize,
    /// How positions between two samples are found (default cubic). Rotations turn at a constant rate (slerp).
    pub positions: Interpolation,
    /// Whether the first frame is moved to the world's origin and turned about y to face +x (default false).
    pub start_at_origin: bool,
}

impl Default for MotionSource {
    fn default() -> Self {
        Self {
            file: PathBuf::new(),
            node: "Head".to_owned(),
            clip: String::new(),
            unit_cm: None,
            up: None,
            facing: None,
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

/// A motion file that cannot be used: which one, and what is wrong with what in it.
#[derive(Debug, thiserror::Error)]
#[error("{}: {problem}", file.display())]
pub struct MotionError {
    /// The file.
    pub file: PathBuf,
    /// The thing found, its value and the way out, in one line.
    pub problem: String,
}

impl MotionError {
    fn new(file: &Path, problem: impl Into<String>) -> Self {
        Self { file: file.to_owned(), problem: problem.into() }
    }
}

/// Reads the head's motion at `frame_rate` frames a second.
///
/// # Errors
/// A file that is missing, malformed or too short, a joint or clip it does not have, a number that is not finite,
/// a unit or axis that neither file nor `source` gives.
pub fn read(source: &MotionSource, frame_rate: f64) -> Result<HeadMotion, MotionError> {
    let file = &source.file;
    let error = |problem: String| MotionError::new(file, problem);
    if !(frame_rate.is_finite() && frame_rate > 0.0) {
        return Err(error(format!("frame rate {frame_rate}: must be a finite number above 0")));
    }
    let extension = file.extension().and_then(|e| e.to_str()).unwrap_or_default().to_lowercase();
    match extension.as_str() {
        "bvh" => {
            let track = bvh::track(&read_text(file)?, &source.node).map_err(error)?;
            track.head_motion(source, frame_rate)
        }
        "csv" => csv::track(&read_text(file)?).map_err(error)?.head_motion(source, frame_rate),
        "glb" | "gltf" => clip::head_motion(source, frame_rate).map_err(error),
        "abc" | "usd" | "usda" | "usdc" => {
            crate::exchange::track(file, &source.node).map_err(error)?.head_motion(source, frame_rate)
        }
        other => Err(error(format!("motion in a .{other} file: .bvh, .glb, .gltf, .csv, .abc and .usd are read"))),
    }
}

/// The samples of a .csv, or those of the first joint of a .bvh and the names of all.
pub(crate) fn survey(file: &Path) -> Result<(Track, Vec<String>), MotionError> {
    let error = |problem: String| MotionError::new(file, problem);
    let text = read_text(file)?;
    if file.extension().is_some_and(|e| e.eq_ignore_ascii_case("csv")) {
        return Ok((csv::track(&text).map_err(error)?, Vec::new()));
    }
    let joints = bvh::joints(&text).map_err(error)?;
    let first = joints.first().cloned().unwrap_or_default();
    Ok((bvh::track(&text, &first).map_err(error)?, joints))
}

fn read_text(file: &Path) -> Result<String, MotionError> {
    let bytes = std::fs::read(file).map_err(|e| MotionError::new(file, e.to_string()))?;
    String::from_utf8(bytes).map_err(|e| {
        let at = e.utf8_error().valid_up_to();
        MotionError::new(file, format!("byte {at} is not text: is this the file that was meant?"))
    })
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
    fn new(unit_cm: Option<f64>, up: Option<Axis>, facing: Option<Axis>) -> Result<Self, String> {
        let asked = |key: &str, example: &str| format!("{key} is not in the file: give {key} = {example} in the scene");
        let unit_cm = unit_cm.ok_or_else(|| asked("unit_cm", "2.54 (cm in one unit)"))?;
        let up = up.ok_or_else(|| asked("up", "\"+y\""))?;
        let facing = facing.ok_or_else(|| asked("facing", "\"+z\""))?;
        if !(unit_cm.is_finite() && unit_cm > 0.0) {
            return Err(format!("unit_cm = {unit_cm}: must be a finite number above 0"));
        }
        let (y, x) = (up.vector(), facing.vector());
        if y.dot(x) != 0.0 {
            return Err(format!("up = {up} and facing = {facing}: must be normal to each other"));
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
fn poses(door: &Door, samples: impl Iterator<Item = Sample>, start_at_origin: bool) -> Result<Vec<Pose>, String> {
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
        Some(frame) => Err(format!("frame {frame}: the pose is not finite; look at unit_cm and the file's numbers")),
        None => Ok(single),
    }
}

/// Number of scene frames that fit into `duration` seconds, the first at 0.
fn frame_count(duration: f64, frame_rate: f64) -> Result<usize, String> {
    const MOST: f64 = 1e7;
    // A last frame that misses the end by rounding only still counts.
    let last = (duration * frame_rate + 1e-4).floor();
    if (0.0..MOST).contains(&last) {
        Ok(last as usize + 1)
    } else {
        Err(format!("lasts {duration} s, {last} frames at {frame_rate} a second: more than {MOST} are not read"))
    }
}

#[cfg(test)]
#[path = "motion/tests.rs"]
mod tests;
