//! Conversion from a file's world to the scene's.
//!
//! One rotation and one scale take a file's world to the scene's: its up axis becomes +y, the axis its character faces
//! becomes +x, and its unit becomes centimetres. The same rotation takes the joint's axes to head space. The unrotated
//! joint of a character that faces the file's facing axis is therefore an unrotated head.

use glam::{DQuat, DVec3, Vec3};
use nabiki::Pose;
use nabiki::smoothing::smoothed;
use nabiki_exchange::MOST_FRAMES;

use super::source::{MotionSource, asked};
use super::track::Sample;
use crate::axis::Axis;
use crate::error::{Error, Result};

/// Poses of the head, one per frame of the scene from frame 0 on.
#[derive(Clone, Debug, PartialEq)]
pub struct HeadMotion {
    /// Frames per second.
    pub frame_rate: f64,
    /// World poses, one per frame.
    pub poses: Vec<Pose>,
    /// World pose of the joint when meshes are bound to it: a mesh of the same file is placed for this pose. `None` if
    /// the file does not have it.
    pub bound: Option<Pose>,
    /// Time in the file of frame 0, and between two frames (s).
    pub times: [f64; 2],
    /// Number of the first frame on the timeline of the shot, for files of complete scenes (USD, Alembic). `None` for
    /// others, and if the motion plays at another speed.
    pub first_frame: Option<i32>,
    /// One line for the user about what was read and how it was converted.
    pub report: String,
}

impl HeadMotion {
    /// The motion of an object that was unrotated with its origin at `place` (world, cm) at the bind pose, or else in
    /// the first frame. The joint carries it from there.
    #[must_use]
    pub fn bound_at(mut self, place: Vec3) -> Self {
        let Some(start) = self.bound.or(self.poses.first().copied()) else { return self };
        let back = start.rotation.inverse();
        for pose in &mut self.poses {
            let turned = (pose.rotation * back).normalize();
            *pose = Pose { position_cm: pose.position_cm + turned * (place - start.position_cm), rotation: turned };
        }
        self
    }
}

/// The one rotation and the one scale that carry samples of a file's world into the scene's.
#[derive(Clone, Copy, Debug)]
pub(super) struct WorldFromFile {
    rotation: DQuat,
    /// Length of the file's unit (cm).
    pub unit_cm: f64,
    /// Axis of the file that points up.
    pub up: Axis,
    /// Axis of the file that an unrotated head faces.
    pub facing: Axis,
}

impl WorldFromFile {
    /// From the declarations of file and scene together.
    ///
    /// # Errors
    /// A missing declaration, an invalid unit, or axes that are not perpendicular.
    pub fn new(unit_cm: Option<f64>, up: Option<Axis>, facing: Option<Axis>) -> Result<Self> {
        let unit_cm = unit_cm.ok_or_else(|| asked("unit_cm", "2.54 (cm in one unit)"))?;
        let up = up.ok_or_else(|| asked("up", "\"+y\""))?;
        let facing = facing.ok_or_else(|| asked("facing", "\"+z\""))?;
        if !(unit_cm.is_finite() && unit_cm > 0.0) {
            return Err(Error::of_setting(format!("unit_cm = {unit_cm}: must be a finite number above 0")));
        }
        let (y, x) = (up.vector(), facing.vector());
        if y.dot(x) != 0.0 {
            return Err(Error::of_setting(format!("up = {up} and facing = {facing}: must be perpendicular")));
        }
        let file_from_world = DQuat::from_mat3(&glam::DMat3::from_cols(x, y, x.cross(y)));
        Ok(Self { rotation: file_from_world.inverse(), unit_cm, up, facing })
    }

    pub fn pose(&self, sample: Sample) -> (DVec3, DQuat) {
        let turn = self.rotation;
        (turn * sample.position * self.unit_cm, turn * sample.rotation * turn.inverse())
    }
}

/// The poses of all frames, smoothed and moved to start at the origin where asked.
pub(super) fn poses(
    world_from_file: &WorldFromFile,
    samples: impl Iterator<Item = Sample>,
    source: &MotionSource,
) -> Result<Vec<Pose>> {
    let mut poses: Vec<(DVec3, DQuat)> = samples.map(|s| world_from_file.pose(s)).collect();
    if source.smoothing > 0.0 {
        poses = smoothed(&poses, f64::from(source.smoothing), mean);
    }
    if let (true, Some(&(start, turned))) = (source.start_at_origin, poses.first()) {
        let face = turned * DVec3::X;
        let upright = DQuat::from_rotation_y(face.z.atan2(face.x));
        for (position, rotation) in &mut poses {
            *position = upright * (*position - start);
            *rotation = upright * *rotation;
        }
    }
    let single: Vec<Pose> = poses.into_iter().map(pose_of).collect();
    match single.iter().position(|p| !(p.position_cm.is_finite() && p.rotation.is_finite())) {
        Some(frame) => {
            Err(Error::new(format!("frame {frame}: the pose is not finite: check unit_cm and the file's numbers")))
        }
        None => Ok(single),
    }
}

/// A place and a turn in singles.
pub(super) fn pose_of((position, rotation): (DVec3, DQuat)) -> Pose {
    Pose { position_cm: position.as_vec3(), rotation: rotation.normalize().as_quat() }
}

/// One round of smoothing. Turns are averaged as quaternions of one hemisphere: the mean of a constant turn's neighbours is the one
/// between them.
fn mean(before: (DVec3, DQuat), now: (DVec3, DQuat), after: (DVec3, DQuat), b: f64) -> (DVec3, DQuat) {
    let place = now.0 + b * (before.0 - now.0 + (after.0 - now.0));
    let beside = |turn: DQuat| if turn.dot(now.1) < 0.0 { -turn } else { turn };
    let turn = now.1 * (1.0 - 2.0 * b) + beside(before.1) * b + beside(after.1) * b;
    (place, turn.normalize())
}

/// Number of scene frames that fit into `duration` seconds, the first at 0.
pub(super) fn frame_count(duration: f64, frame_rate: f64) -> Result<usize> {
    const MOST: f64 = MOST_FRAMES as f64;
    // A last frame that misses the end by no more than times of three decimals are rounded by still counts.
    const MISSED: f64 = 0.05;
    let last = (duration * frame_rate + MISSED).floor();
    if (0.0..MOST).contains(&last) {
        Ok(last as usize + 1)
    } else {
        Err(Error::new(format!("lasts {duration} s, {last} frames at {frame_rate} a second: at most {MOST} are read")))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::FRAC_PI_2;

    #[test]
    fn a_head_faces_x_and_stands_up_along_y_whatever_its_file_does() {
        for (up, facing, place, of_x, of_z) in [
            (Axis::PlusY, Axis::PlusX, [1.0, 2.0, 3.0], DVec3::X, DVec3::Z),
            (Axis::PlusY, Axis::PlusZ, [3.0, 2.0, -1.0], DVec3::NEG_Z, DVec3::X),
            (Axis::PlusZ, Axis::MinusY, [-2.0, 3.0, -1.0], DVec3::NEG_Z, DVec3::Y),
            (Axis::MinusX, Axis::PlusZ, [3.0, -1.0, -2.0], DVec3::NEG_Y, DVec3::X),
        ] {
            let world_from_file = WorldFromFile::new(Some(2.0), Some(up), Some(facing)).unwrap();
            for (axis, expected) in [(DVec3::X, of_x), (DVec3::Z, of_z)] {
                let rotation = DQuat::from_axis_angle(axis, FRAC_PI_2);
                let (position, turned) = world_from_file.pose(Sample { position: DVec3::new(1.0, 2.0, 3.0), rotation });
                assert!(position.distance(2.0 * DVec3::from(place)) < 1e-14, "up {up}, facing {facing}: {position}");
                let expected = DQuat::from_axis_angle(expected, FRAC_PI_2);
                assert!(turned.dot(expected).abs() > 1.0 - 1e-14, "up {up}, facing {facing}, about {axis}: {turned}");
            }
        }
    }
}
