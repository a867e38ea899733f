//! The effect of the head's motion on its hair in one frame: the turn that hair is left behind by, weight, and acceleration of the roots.

use glam::{DAffine3, DMat3, DQuat, DVec3};

use super::pulls::weight;
use crate::dynamics::FrameInput;
use crate::dynamics::ride::axis_and_angle;
use crate::free_form::FreeForm;
use crate::pose::Pose;

/// The head's motion in one frame, as head space sees it.
#[derive(Clone, Copy, Debug)]
pub(in crate::dynamics) struct HeadFrame {
    /// The head's turn from the frame before, in head space: axis, of length 1, and angle (rad). `None` where it is 0.
    pub turn: Option<(DVec3, f64)>,
    /// The force that weight exerts.
    pub weight: DVec3,
    /// The motion of a point that the head carries. `None` if the head does not move.
    pub way: Option<HeadWay>,
}

/// Velocity (cm a frame) and acceleration (cm a frame^2) of every point that the head carries.
#[derive(Clone, Copy, Debug)]
pub(in crate::dynamics) struct HeadWay {
    pub velocity: DAffine3,
    pub acceleration: DAffine3,
}

impl HeadFrame {
    pub fn new(input: &FrameInput, form: &FreeForm) -> Self {
        let [now, before, earlier] = [input.pose, input.before[0], input.before[1]].map(exact);
        Self {
            turn: if input.pose.rotation == input.before[0].rotation {
                None
            } else {
                axis_and_angle(before.1.inverse() * now.1)
            },
            weight: weight::on_head(&input.pose, f64::from(form.gravity)),
            way: (input.before != [input.pose; 2]).then(|| HeadWay::new(now, before, earlier)),
        }
    }
}

impl HeadWay {
    /// From differences of the poses of three frames.
    fn new(now: (DVec3, DQuat), before: (DVec3, DQuat), earlier: (DVec3, DQuat)) -> Self {
        let [a, b, c] = [now, before, earlier].map(|(p, turn)| (p, DMat3::from_quat(turn)));
        let head_from_world = DMat3::from_quat(now.1.inverse());
        let seen = |translation: DVec3, matrix: DMat3| DAffine3 {
            matrix3: head_from_world * matrix,
            translation: head_from_world * translation,
        };
        Self {
            velocity: seen(a.0 - b.0, a.1 - b.1),
            acceleration: seen((a.0 - b.0) - (b.0 - c.0), (a.1 - b.1) - (b.1 - c.1)),
        }
    }
}

fn exact(pose: Pose) -> (DVec3, DQuat) {
    (pose.position_cm.as_dvec3(), pose.rotation.as_dquat().normalize())
}
