//! The effect of skin that moves on the strands that it carries, in one frame.
//!
//! Skin carries a strand as a head carries all of its hair: the root goes along, the shape at rest turns with it, and the
//! strand feels the acceleration of its root and lags behind the turn.

use glam::{DMat3, DQuat, DVec3};

use super::free::{HeadFrame, HeadWay};
use super::{Dynamics, FrameInput};
use crate::skin::{SkinFrame, SkinPlace};

/// A skin in one frame, on a head that may move meanwhile.
#[derive(Clone, Copy, Debug)]
pub(super) struct SkinStep<'a> {
    /// In this frame, in the frame before and in the one before that.
    frames: [&'a SkinFrame; 3],
    /// The head's turn from the frame before, in head space.
    head_turn: DQuat,
    /// From head space in the two frames before to head space now.
    earlier: [DMat3; 2],
    head_way: Option<HeadWay>,
}

/// How its skin carries one strand in one frame (head space, cm).
#[derive(Clone, Copy, Debug)]
pub(super) struct Ride {
    pub root: DVec3,
    pub root_before: DVec3,
    /// The skin's turn from rest.
    pub from_rest: DQuat,
    /// The skin's turn from the frame before.
    pub carried: DQuat,
    /// The turn from the frame before by skin and head, in the world: axis, of length 1, and angle (rad). `None` if it is 0.
    pub turn: Option<(DVec3, f64)>,
    /// Of the point that carries the strand, in the world (cm a frame, cm a frame^2).
    pub velocity: DVec3,
    pub acceleration: DVec3,
}

/// The skin's shape in the frame of `input`, in the frame before and in the one before that; none without skin.
pub(super) fn skin_frames<'a>(dynamics: &'a Dynamics, input: &FrameInput<'a>) -> Option<[&'a SkinFrame; 3]> {
    let skin = dynamics.skin.as_deref()?;
    Some(input.skin.unwrap_or_else(|| skin.around(input.frame)))
}

impl<'a> SkinStep<'a> {
    pub fn new(dynamics: &'a Dynamics, input: &FrameInput<'a>, head: &HeadFrame) -> Option<Self> {
        let frames = skin_frames(dynamics, input)?;
        let [now, before, earlier] =
            [input.pose, input.before[0], input.before[1]].map(|pose| pose.rotation.as_dquat().normalize());
        Some(Self {
            frames,
            head_turn: head.turn.map_or(DQuat::IDENTITY, |(axis, angle)| DQuat::from_axis_angle(axis, angle)),
            earlier: [before, earlier].map(|turn| DMat3::from_quat(now.inverse() * turn)),
            head_way: head.way,
        })
    }

    /// How it carries the strand of a place; `anchor` is the point at rest that the skin carries.
    pub fn ride(&self, place: &SkinPlace, anchor: DVec3) -> Ride {
        let turns = self.frames.map(|frame| place.turn(frame));
        let [now, before, earlier] = [0, 1, 2].map(|n| place.carried(self.frames[n], turns[n], anchor));
        let carried = turns[0] * turns[1].inverse();
        let [once, twice] = [self.earlier[0] * (now - before), self.earlier[1] * (now - earlier)];
        let [velocity, acceleration] = match &self.head_way {
            Some(way) => [way.velocity, way.acceleration].map(|of| of.transform_point3(now)),
            None => [DVec3::ZERO; 2],
        };
        Ride {
            root: place.root_on(self.frames[0], turns[0]),
            root_before: place.root_on(self.frames[1], turns[1]),
            from_rest: turns[0],
            carried: if turns[0] == turns[1] { DQuat::IDENTITY } else { carried },
            turn: axis_and_angle(carried * self.head_turn),
            velocity: velocity + once,
            acceleration: acceleration + 2.0 * once - twice,
        }
    }
}

/// Axis, of length 1, and angle (rad) of a turn; `None` if it is 0.
pub(super) fn axis_and_angle(turn: DQuat) -> Option<(DVec3, f64)> {
    let turn = if turn.w < 0.0 { -turn } else { turn };
    let sine = turn.xyz().length();
    (sine > 0.0).then(|| (turn.xyz() / sine, 2.0 * sine.atan2(turn.w)))
}
