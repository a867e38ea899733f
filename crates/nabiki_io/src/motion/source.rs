//! Which file moves a head, and what that file cannot say itself.

use std::path::PathBuf;

use nabiki::{settings, smoothing, words};

use crate::axis::Axis;
use crate::error::{Error, Result};
use crate::kind::extension;
use crate::point_cache::is_point_cache;

settings! {
    /// The file that moves the head, and what the file does not contain.
    pub struct MotionSource {
        /// The motion: a .bvh, .amc, .tof, .glb, .gltf, .fbx, .abc, .usd, .usda or .usdc file, a .csv, or a .pc2 or .mdd
        /// with the mesh's points. A .csv has the columns t_s, px_m, py_m, pz_m (or _cm, _mm), qx, qy, qz, qw.
        pub file: PathBuf = PathBuf::new() => "File";
        /// Skeleton file of the motion: the .asf of an .amc, or the .tof with the skeleton of a .tof animation. Other
        /// formats have none.
        pub skeleton: Option<PathBuf> = None => "Skeleton", open "none";
        /// Joint, bone or node that carries the head. Case does not matter. Not used for .csv.
        pub node: String = "Head".to_owned() => "Node";
        /// Name of the animation in a .glb, .gltf or .fbx. Needed only if there are several.
        pub clip: String = String::new() => "Clip";
        /// Length of the file's unit. Required for .bvh, .tof and .abc. A .glb or .gltf is in metres unless you set
        /// this, an .amc in inches times the `length` of its .asf. A .csv, USD or
        /// FBX file names its own unit.
        pub unit_cm: Option<f64> = None => "Unit", unit "cm", above 0.0, open "what the file says";
        /// Up axis of the file's world. Required for .bvh, .amc, .tof and .csv. It is +y in .glb, .gltf and .abc; USD
        /// and FBX files name their own.
        pub up: Option<Axis> = None => "Up", open "what the file says";
        /// Axis of the file's world along which the character looks while the joint is unturned. Not required for .glb
        /// and .gltf, where it is +z in the still pose, nor for a USD layer, Alembic archive or FBX that the mesh is from
        /// too. A bone of an .amc is unturned in the rest pose of the .asf, a joint of a .tof when its axes are those
        /// of the world.
        pub facing: Option<Axis> = None => "Facing", open "what the file says";
        /// Sample rate of the file. Required for most .amc files; a .pc2 has that of the scene unless you set this. All
        /// other formats contain it.
        pub frames_per_second: Option<f64> = None => "Sample rate", unit "per second", above 0.0, open "what the file says";
        /// Number of samples to drop at the start, for example a T-pose. Not for .glb, .gltf and .fbx.
        pub skip: usize = 0 => "Skip", unit "samples";
        /// How to interpolate positions between two samples. Rotations turn at a constant rate (slerp). Not for .glb,
        /// .gltf and .fbx, whose curves define it.
        pub positions: Interpolation = Interpolation::Cubic => "Positions";
        /// Playback speed of the motion. 0.25 makes it four times as long.
        pub speed: f64 = 1.0 => "Speed", least 0.01, most 100.0;
        /// Standard deviation of the bell that averages positions and rotations, in frames of the scene. Raise it if a
        /// recording trembles, since hair feels accelerations. 0 leaves the motion as it is.
        pub smoothing: f32 = 0.0 => "Smoothing", unit "frames", least 0.0, most smoothing::MOST as f64;
        /// Whether to move the first frame to the world's origin and turn it about y to face +x.
        pub start_at_origin: bool = false => "Start at origin";
        /// Whether the mesh is already placed as the first frame has it, as in a file that contains both mesh and
        /// motion. The motion then carries the mesh on from there. With a joint of the same USD layer or FBX, the mesh is
        /// placed as the skeleton binds it. Hair that grows on the head goes along. If the mesh bends in that file, so does
        /// its skin here.
        pub bind_at_start: bool = false => "Bind at start";
    }
}

words! {
    /// How to interpolate a position between two samples.
    pub enum Interpolation {
        /// Straight lines between samples.
        Linear = "linear",
        /// A Hermite cubic. The velocity at a sample is that of the parabola through it and its two neighbours; at the
        /// first and last sample, through the three samples there.
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
        let is_clip = matches!(ending.as_str(), "glb" | "gltf" | "fbx");
        let is_cache = is_point_cache(&self.file);
        let useless = [
            (self.skeleton.is_some() && !self.has_skeleton(), "skeleton"),
            (self.node != Self::default().node && (ending == "csv" || is_cache), "node"),
            (self.frames_per_second.is_some() && ending != "amc" && ending != "pc2", "frames_per_second"),
            (self.start_at_origin && is_cache, "start_at_origin"),
            (!self.clip.is_empty() && !is_clip, "clip"),
            (self.skip > 0 && is_clip, "skip"),
            (self.positions != Interpolation::Cubic && is_clip, "positions"),
        ];
        if self.start_at_origin && self.bind_at_start {
            let line = "start_at_origin and bind_at_start = true: the first frame cannot be both at the origin and at its place in the file";
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
