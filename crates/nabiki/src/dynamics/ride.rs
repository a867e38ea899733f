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
    /// In the frame before, and in this one.
    roots: [DVec3; 2],
    /// The skin's turn from rest, in the same.
    turns: [DQuat; 2],
    /// The skin's turn from the frame before, as [`turn`](Self::turn).
    carried: Option<(DVec3, f64)>,
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
            roots: [1, 0].map(|back| place.root_on(self.frames[back], turns[back])),
            turns: [turns[1], turns[0]],
            carried: if turns[0] == turns[1] { None } else { axis_and_angle(carried) },
            turn: axis_and_angle(carried * self.head_turn),
            velocity: velocity + once,
            acceleration: acceleration + 2.0 * once - twice,
        }
    }
}

impl Ride {
    /// Root and turn from rest after step `n` of the `steps` of the frame; 0 is the end of the frame before.
    pub fn at(&self, n: u32, steps: u32) -> (DVec3, DQuat) {
        let Self { roots: [root_before, root], turns: [turn_before, turn], .. } = *self;
        if n == steps {
            return (root, turn);
        }
        let part = f64::from(n) / f64::from(steps);
        (root_before.lerp(root, part), self.carried(part) * turn_before)
    }

    /// The skin's turn in a part of the frame.
    pub fn carried(&self, part: f64) -> DQuat {
        self.carried.map_or(DQuat::IDENTITY, |(axis, angle)| DQuat::from_axis_angle(axis, part * angle))
    }
}

/// Axis, of length 1, and angle (rad) of a turn; `None` if it is 0.
pub(super) fn axis_and_angle(turn: DQuat) -> Option<(DVec3, f64)> {
    let turn = if turn.w < 0.0 { -turn } else { turn };
    let sine = turn.xyz().length();
    (sine > 0.0).then(|| (turn.xyz() / sine, 2.0 * sine.atan2(turn.w)))
}
