//! How skin carries the strands of a block in one frame.

use glam::{DQuat, DVec3, Vec3};

use super::kernel::{FrameRow, FreeRow, FreeState, ZERO};
use crate::dynamics::ride::{Ride, SkinStep};
use crate::dynamics::row::{LANES, PointRow, Row, lane as lane_of, set_lane};
use crate::skin::{SkinFrame, SkinPlace};

/// [`Ride`] of every strand of a block.
#[derive(Clone, Copy, Debug)]
pub(super) struct RideRow {
    pub roots: PointRow,
    /// In the frame before.
    pub roots_before: PointRow,
    pub from_rest: FrameRow,
    carried: FrameRow,
    /// Axis, of length 1, and angle (rad).
    pub axis: PointRow,
    pub angle: Row,
    pub velocity: PointRow,
    pub acceleration: PointRow,
    /// Whether the skin turns anywhere by itself, and whether it turns in the world.
    is_carried: bool,
    pub turns: bool,
}

impl RideRow {
    /// Of strands with these places; `anchors` are the points by which they are carried. Lanes without a strand stay.
    pub fn new(skin: &SkinStep, places: &[SkinPlace], anchors: &PointRow) -> Self {
        let mut row = Self {
            roots: ZERO,
            roots_before: ZERO,
            from_rest: FrameRow::AT_REST,
            carried: FrameRow::AT_REST,
            axis: ZERO,
            angle: Row::default(),
            velocity: ZERO,
            acceleration: ZERO,
            is_carried: false,
            turns: false,
        };
        for (lane, place) in places.iter().enumerate() {
            row.set(lane, &skin.ride(place, Vec3::from(lane_of(anchors, lane)).as_dvec3()));
        }
        row
    }

    fn set(&mut self, lane: usize, ride: &Ride) {
        let narrow = |v: DVec3| v.as_vec3().to_array();
        let (axis, angle) = ride.turn.unwrap_or_default();
        set_lane(&mut self.roots, lane, narrow(ride.root));
        set_lane(&mut self.roots_before, lane, narrow(ride.root_before));
        self.from_rest.set(lane, ride.from_rest.as_quat());
        self.carried.set(lane, ride.carried.as_quat());
        set_lane(&mut self.axis, lane, narrow(axis));
        self.angle.0[lane] = angle as f32;
        set_lane(&mut self.velocity, lane, narrow(ride.velocity));
        set_lane(&mut self.acceleration, lane, narrow(ride.acceleration));
        self.is_carried |= ride.carried != DQuat::IDENTITY;
        self.turns |= ride.turn.is_some();
    }

    /// Takes a segment of every strand along. What is held stays in its shape at rest.
    #[inline(always)]
    pub fn carry(&self, state: &mut FreeState, row: &FreeRow) {
        let held = self.from_rest.of(&row.rest);
        let (mut direction, mut increment) = (state.direction, state.increment);
        if self.is_carried {
            (direction, increment) = (self.carried.of(&direction), self.carried.of(&increment));
        }
        for lane in 0..LANES {
            if row.lightness.0[lane] == 0.0 {
                set_lane(&mut direction, lane, lane_of(&held, lane));
            }
        }
        (state.direction, state.increment) = (direction, increment);
    }
}

/// The roots of a block, and the turns from rest, on skin of this shape.
pub(super) fn at_rest_on(skin: &SkinFrame, places: &[SkinPlace]) -> (PointRow, FrameRow) {
    let (mut roots, mut turns) = (ZERO, FrameRow::AT_REST);
    for (lane, place) in places.iter().enumerate() {
        set_lane(&mut roots, lane, place.root(skin).as_vec3().to_array());
        turns.set(lane, place.turn(skin).as_quat());
    }
    (roots, turns)
}
