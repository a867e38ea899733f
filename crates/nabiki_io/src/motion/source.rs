//! Which file moves a head, and what that file cannot say itself.

use std::path::PathBuf;

use nabiki::{settings, smoothing, words};

use crate::axis::Axis;
use crate::error::{Error, Result};
use crate::kind::extension;

settings! {
    /// Which file moves the head, and what that file cannot say itself.
    pub struct MotionSource {
        /// A .bvh, .amc, .tof, .glb, .gltf, .abc, .usd, .usda or .usdc file, or a .csv with the columns t_s, px_m, py_m, pz_m (or
        /// _cm, _mm), qx, qy, qz, qw.
        pub file: PathBuf = PathBuf::new() => "File";
        /// File of the skeleton that the motion moves: the .asf of an .amc, the .tof with the skeleton of a .tof animation.
        /// Others have none.
        pub skeleton: Option<PathBuf> = None => "Skeleton", open "none";
        /// Joint, bone or node that carries the head; capitals do not count. Not used for .csv.
        pub node: String = "Head".to_owned() => "Node";
        /// Animation of a .glb or .gltf by name; may stay empty where there is one only.
        pub clip: String = String::new() => "Clip";
        /// Length of the file's unit. Needed for .bvh, .tof and .abc; .glb and .gltf are in metres unless said here, .amc in
        /// inches times the `length` of its .asf; .csv and USD name their own.
        pub unit_cm: Option<f64> = None => "Unit", unit "cm", above 0.0, open "what the file says";
        /// Up axis of the file's world. Needed for .bvh, .amc, .tof and .csv; +y in .glb, .gltf and .abc; USD names its own.
        pub up: Option<Axis> = None => "Up", open "what the file says";
        /// Axis of the file's world that the character faces while the joint is unturned. Needed but for .glb and .gltf:
        /// +z in those, whose node is unturned as the file's still pose has it; and but for a USD layer or Alembic archive that the mesh
        /// is from, too, which face as the mesh does. A bone of an .amc is unturned as the .asf has it, a joint of a .tof where its axes
        /// are the world's.
        pub facing: Option<Axis> = None => "Facing", open "what the file says";
        /// Samples a second. Needed for an .amc, which seldom says; all others say it themselves.
        pub frames_per_second: Option<f64> = None => "Samples", unit "a second", above 0.0, open "what the file says";
        /// Samples dropped at the start, as of a T-pose. Not for .glb and .gltf.
        pub skip: usize = 0 => "Skip", unit "samples";
        /// How positions between two samples are found. Rotations turn at a constant rate (slerp). Not for .glb and .gltf, whose
        /// channels say it themselves.
        pub positions: Interpolation = Interpolation::Cubic => "Positions";
        /// How fast the motion is played: 0.25 takes four times as long.
        pub speed: f64 = 1.0 => "Speed", least 0.01, most 100.0;
        /// Deviation of the bell that places and turns are averaged by, in frames of the scene; 0: as they are. Recordings tremble, and
        /// hair feels accelerations.
        pub smoothing: f32 = 0.0 => "Smoothing", unit "frames", least 0.0, most smoothing::MOST as f64;
        /// Whether the first frame is moved to the world's origin and turned about y to face +x.
        pub start_at_origin: bool = false => "Start at origin";
        /// Whether the mesh stands in its file as the first frame has it, wherever that is and however it is turned there, as one out of
        /// the same scene does: it is then carried on from there. Beside a joint of the same USD layer it stands as the skeleton binds it.
        /// Hair that grows on a head stands there as well.
        pub bind_at_start: bool = false => "Bind at start";
    }
}

words! {
    /// How a position between two samples is found.
    pub enum Interpolation {
        /// On the straight line between them.
        Linear = "linear",
        /// On the Hermite cubic whose velocity at a sample is that of the parabola through it and its two neighbours; at the first and
        /// the last, through the three there.
        Cubic = "cubic",
    }
}

impl MotionSource {
    /// Whether the motion is in one file and its skeleton in another.
    pub(super) fn has_skeleton(&self) -> bool {
        matches!(extension(&self.file).as_str(), "amc" | "tof")
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
