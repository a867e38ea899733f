//! Which file moves a head, and what that file cannot say itself.

use std::path::PathBuf;

use nabiki::{SettingError, smoothing};
use serde::{Deserialize, Serialize};

use crate::axis::Axis;
use crate::error::{Error, Result};
use crate::kind::extension;

/// Which file moves the head, and what that file cannot say itself: `[head.motion]` of a scene.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields, default)]
pub struct MotionSource {
    /// A .bvh, .amc, .tof, .glb, .gltf, .abc, .usd, .usda or .usdc file, or a .csv with the columns t_s, px_m, py_m, pz_m (or
    /// _cm, _mm), qx, qy, qz, qw.
    pub file: PathBuf,
    /// File of the skeleton that the motion moves: the .asf of an .amc, the .tof with the skeleton of a .tof animation.
    /// Others have none.
    pub skeleton: Option<PathBuf>,
    /// Joint, bone or node that carries the head (default "Head"; capitals do not count). Not used for .csv.
    pub node: String,
    /// Animation of a .glb or .gltf by name; may stay empty where there is one only.
    pub clip: String,
    /// Length of the file's unit (cm). Needed for .bvh, .tof and .abc; .glb and .gltf are in metres unless said here, .amc in
    /// inches times the `length` of its .asf; .csv and USD name their own.
    pub unit_cm: Option<f64>,
    /// Up axis of the file's world. Needed for .bvh, .amc, .tof and .csv; +y in .glb, .gltf and .abc; USD names its own.
    pub up: Option<Axis>,
    /// Axis of the file's world that the character faces while the joint is unturned. Needed but for .glb and .gltf:
    /// +z in those, whose node is unturned as the file's still pose has it; and but for a USD layer or Alembic archive that the mesh
    /// is from, too, which face as the mesh does. A bone of an .amc is unturned as the .asf has it, a joint of a .tof where its axes are
    /// the world's.
    pub facing: Option<Axis>,
    /// Samples a second. Needed for an .amc, which seldom says; all others say it themselves.
    pub frames_per_second: Option<f64>,
    /// Samples dropped at the start (a T-pose, say; default 0). Not for .glb and .gltf.
    pub skip: usize,
    /// How positions between two samples are found (default cubic). Rotations turn at a constant rate (slerp). Not for
    /// .glb and .gltf, whose channels say it themselves.
    pub positions: Interpolation,
    /// How fast the motion is played, 0.01..100: 0.25 takes four times as long (default 1).
    pub speed: f64,
    /// Deviation of the bell that places and turns are averaged by (frames of the scene), 0..240 (default 0: as they are).
    /// Recordings tremble, and hair feels accelerations.
    pub smoothing: f32,
    /// Whether the first frame is moved to the world's origin and turned about y to face +x (default false).
    pub start_at_origin: bool,
    /// Whether the mesh stands in its file as the first frame has it, wherever that is and however it is turned there, as one out of
    /// the same scene does: it is then carried on from there (default false). Beside a joint of the same USD layer it stands as the
    /// skeleton binds it. Hair that grows on a head stands there as well.
    pub bind_at_start: bool,
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
            speed: 1.0,
            smoothing: 0.0,
            start_at_origin: false,
            bind_at_start: false,
        }
    }
}

/// How a position between two samples is found.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Interpolation {
    /// On the straight line between them.
    Linear,
    /// On the Hermite cubic whose velocity at a sample is that of the parabola through it and its two neighbours; at the first and the
    /// last, through the three there.
    Cubic,
}

impl MotionSource {
    /// Whether the motion is in one file and its skeleton in another.
    pub(super) fn has_skeleton(&self) -> bool {
        matches!(extension(&self.file).as_str(), "amc" | "tof")
    }

    /// Refuses numbers out of range; `name` is what the motion is called, `head.motion`.
    ///
    /// # Errors
    /// Names the setting.
    pub fn check_numbers(&self, name: &str) -> std::result::Result<(), SettingError> {
        if !(0.01..=100.0).contains(&self.speed) {
            return Err(SettingError::new(format!("{name}.speed"), self.speed, "must lie in 0.01..100"));
        }
        smoothing::check(&format!("{name}.smoothing"), self.smoothing)
    }

    /// What is done to the samples' times and places, for the report; empty where nothing is.
    pub(super) fn changes(&self) -> String {
        let mut text = String::new();
        if self.speed != 1.0 {
            text += &format!(", at {} of its speed", self.speed);
        }
        if self.smoothing > 0.0 {
            text += &format!(", smoothed over {} frames", self.smoothing);
        }
        text
    }

    /// Refuses what has no effect on a file of this kind.
    pub(super) fn check(&self) -> Result<()> {
        let ending = extension(&self.file);
        let is_clip = matches!(ending.as_str(), "glb" | "gltf");
        let useless = [
            (self.skeleton.is_some() && !self.has_skeleton(), "skeleton"),
            (self.node != Self::default().node && ending == "csv", "node"),
            (self.frames_per_second.is_some() && ending != "amc", "frames_per_second"),
            (!self.clip.is_empty() && !is_clip, "clip"),
            (self.skip > 0 && is_clip, "skip"),
            (self.positions != Interpolation::Cubic && is_clip, "positions"),
        ];
        if self.start_at_origin && self.bind_at_start {
            let line = "start_at_origin and bind_at_start = true: the first frame cannot be both at the origin and where the file has it";
            return Err(Error::of_setting(line));
        }
        match useless.into_iter().find(|&(given, _)| given) {
            Some((_, key)) => Err(Error::of_setting(format!("{key} has no effect on a .{ending} file: remove it"))),
            None => Ok(()),
        }
    }
}

/// A setting that a scene must give, since a file of this kind does not.
pub(super) fn asked(key: &str, example: &str) -> Error {
    Error::of_setting(format!("{key} is not in the file: give {key} = {example} in the scene"))
}
