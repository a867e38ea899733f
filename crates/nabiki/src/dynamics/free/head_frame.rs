//! What the head's motion does to its hair in one frame: the turn that hair lags behind, weight, and acceleration felt.

use glam::{DAffine3, DMat3, DQuat, DVec3};

use crate::dynamics::FrameInput;
use crate::free_form::{EARTH_CM_PER_S2, FreeForm};
use crate::pose::Pose;

/// The head's motion in one frame, as head space sees it.
#[derive(Clone, Copy, Debug)]
pub(super) struct HeadFrame {
    /// The head's turn from the frame before, in head space: axis, of length 1, and angle (rad). `None` where it is 0.
    pub turn: Option<(DVec3, f64)>,
    /// The force that weight exerts.
    pub weight: DVec3,
    /// The force on a point p that is carried along by the head: `felt` p. `None` where the head goes straight on.
    pub felt: Option<DAffine3>,
}

impl HeadFrame {
    /// `frame_rate`: frames a second.
    pub fn new(input: &FrameInput, form: &FreeForm, frame_rate: f64) -> Self {
        let gravity = f64::from(form.weight());
        let jolted = gravity * f64::from(form.jolt);
        let [now, before, earlier] = [input.pose, input.before[0], input.before[1]].map(exact);
        Self {
            turn: if input.pose.rotation == input.before[0].rotation { None } else { turn(before.1, now.1) },
            weight: weight(&input.pose, gravity),
            felt: if input.before == [input.pose; 2] || jolted == 0.0 {
                None
            } else {
                Some(felt(now, before, earlier, jolted, frame_rate))
            },
        }
    }
}

/// The force of the weight under a head of this pose (head space). `gravity`: its strength.
pub(super) fn weight(pose: &Pose, gravity: f64) -> DVec3 {
    pose.rotation.as_dquat().inverse() * DVec3::new(0.0, -gravity, 0.0)
}

fn exact(pose: Pose) -> (DVec3, DQuat) {
    (pose.position_cm.as_dvec3(), pose.rotation.as_dquat().normalize())
}

/// The turn from one rotation to another, in the space that both turn into the world.
fn turn(before: DQuat, now: DQuat) -> Option<(DVec3, f64)> {
    let turn = before.inverse() * now;
    let turn = if turn.w < 0.0 { -turn } else { turn };
    let sine = turn.xyz().length();
    (sine > 0.0).then(|| (turn.xyz() / sine, 2.0 * sine.atan2(turn.w)))
}

/// -jolted a / 981 for the acceleration a (cm/s^2) of a point that the head carries, by second differences of its way.
fn felt(now: (DVec3, DQuat), before: (DVec3, DQuat), earlier: (DVec3, DQuat), jolted: f64, rate: f64) -> DAffine3 {
    let scale = -jolted / EARTH_CM_PER_S2 * rate * rate;
    let second = |a: DMat3, b: DMat3, c: DMat3| (a - b) - (b - c);
    let matrix = second(DMat3::from_quat(now.1), DMat3::from_quat(before.1), DMat3::from_quat(earlier.1));
    let translation = (now.0 - before.0) - (before.0 - earlier.0);
    let head_from_world = DMat3::from_quat(now.1.inverse());
    DAffine3 { matrix3: head_from_world * matrix * scale, translation: head_from_world * translation * scale }
}
