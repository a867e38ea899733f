//! How skin carries the strands of a block in one frame.

use glam::{DQuat, DVec3, Vec3};

use super::kernel::{FrameRow, FreeRow, FreeState, ZERO};
use crate::dynamics::ride::{Ride, SkinStep};
use crate::dynamics::row::{LANES, PointRow, Row, lane as lane_of, set_lane};
use crate::skin::{SkinFrame, SkinPlace};

/// [`Ride`] of every strand of a block, in one step of a frame.
#[derive(Clone, Debug)]
pub(super) struct RideRow {
    rides: [Option<Ride>; LANES],
    pub roots: PointRow,
    /// At the beginning of the step.
    pub roots_before: PointRow,
    pub from_rest: FrameRow,
    /// In a step.
    carried: FrameRow,
    /// Axis, of length 1, and angle (rad) in the whole frame.
    pub axis: PointRow,
    pub angle: Row,
    pub velocity: PointRow,
    pub acceleration: PointRow,
    /// Whether the skin turns anywhere by itself, and whether it turns in the world.
    is_carried: bool,
    pub turns: bool,
}

impl RideRow {
    /// Of strands with these places, at the end of the frame before; `anchors` are the points by which they are carried.
    pub fn new(skin: &SkinStep, places: &[SkinPlace], anchors: &PointRow, steps: u32) -> Self {
        let mut row = Self {
            rides: [None; LANES],
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
            let ride = skin.ride(place, Vec3::from(lane_of(anchors, lane)).as_dvec3());
            let narrow = |v: DVec3| v.as_vec3().to_array();
            let (axis, angle) = ride.turn.unwrap_or_default();
            let carried = ride.carried(1.0 / f64::from(steps));
            row.carried.set(lane, carried.as_quat());
            set_lane(&mut row.axis, lane, narrow(axis));
            row.angle.0[lane] = angle as f32;
            set_lane(&mut row.velocity, lane, narrow(ride.velocity));
            set_lane(&mut row.acceleration, lane, narrow(ride.acceleration));
            row.is_carried |= carried != DQuat::IDENTITY;
            row.turns |= ride.turn.is_some();
            row.rides[lane] = Some(ride);
        }
        row.go_to(0, steps);
        row
    }

    /// Goes to the end of step `n` of the `steps` of the frame.
    pub fn go_to(&mut self, n: u32, steps: u32) {
        self.roots_before = self.roots;
        for (lane, ride) in self.rides.iter().enumerate() {
            if let Some(ride) = ride {
                let (root, from_rest) = ride.at(n, steps);
                set_lane(&mut self.roots, lane, root.as_vec3().to_array());
                self.from_rest.set(lane, from_rest.as_quat());
            }
        }
    }

    /// Takes a segment of every strand along in a step. What is held stays in its shape at rest.
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
