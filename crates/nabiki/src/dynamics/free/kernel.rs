//! The fast step of the free form for one block of strands: sixteen at a time, f32.
//!
//! As in the paper's kernel every lane does the same operations whatever the machine's vectors hold, and multiplies and
//! adds are fused by name: the bits do not depend on the vector width, nor on the other lanes.

use super::pulls::joints::moment_lane;
use super::pulls::sum_of_shape;
use super::pulls::weight::Weight;
use super::rotate::turned;
use super::segment::FreeSegment;
use crate::dynamics::row::{LANES, PointRow, Row, beyond, lane as lane_of, set_lane};
use crate::dynamics::trigonometry::sin_cos;
use crate::free_form::FreeForm;
use crate::vector::{add, cross, dot, scale, scale_add, subtract};

/// Direction and increment (rad a frame) of one segment of every strand of a block, in head space.
#[derive(Clone, Copy, Debug, Default)]
#[repr(C)]
pub(super) struct FreeState {
    pub direction: PointRow,
    pub increment: PointRow,
    /// How far at least the segment's end is from touching a body (cm). Unused where there is none.
    pub gap: Row,
}

impl FreeState {
    /// Of all its rows.
    pub const NUMBERS: usize = 7 * LANES;

    pub fn rows(&self) -> [&Row; 7] {
        let Self { direction: [x, y, z], increment: [u, v, w], gap } = self;
        [x, y, z, u, v, w, gap]
    }

    pub fn rows_mut(&mut self) -> [&mut Row; 7] {
        let Self { direction: [x, y, z], increment: [u, v, w], gap } = self;
        [x, y, z, u, v, w, gap]
    }
}

/// One segment of every strand of a block. All 0 where a strand has no such segment.
#[derive(Clone, Copy, Debug, Default)]
#[repr(C)]
pub(super) struct FreeRow {
    /// cm.
    pub length: Row,
    /// c_i.
    pub gain: Row,
    /// K of the joint at its beginning.
    pub stiffness: Row,
    /// r_i.
    pub rest: PointRow,
}

/// Strengths of one segment of every strand of a block.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub(super) struct StrengthRow {
    /// H.
    pub hold: Row,
    /// What is left of an increment after a frame.
    pub decay: Row,
}

impl FreeRow {
    pub fn set(&mut self, lane: usize, segment: &FreeSegment) {
        self.length.0[lane] = segment.shape.length as f32;
        self.gain.0[lane] = segment.shape.gain as f32;
        self.stiffness.0[lane] = segment.stiffness as f32;
        set_lane(&mut self.rest, lane, segment.rest.as_vec3().to_array());
    }
}

impl StrengthRow {
    /// That of lanes without a segment: as all others, where all others are alike.
    pub fn of(form: &FreeForm) -> Self {
        Self { hold: Row([form.hold.at(0.0) as f32; LANES]), decay: Row([form.decay(0.0) as f32; LANES]) }
    }

    pub fn set(&mut self, lane: usize, segment: &FreeSegment) {
        self.hold.0[lane] = segment.hold as f32;
        self.decay.0[lane] = segment.decay as f32;
    }
}

/// R_(i-1) of every strand of a block, a quaternion of about length 1: it has carried the segments before this one from
/// their rest to where they are.
#[derive(Clone, Copy, Debug)]
struct FrameRow {
    vector: PointRow,
    scalar: Row,
    /// 2 / its squared length, worked out beside it: the next segment waits for both.
    over_length: Row,
}

impl FrameRow {
    const AT_REST: Self =
        Self { vector: [Row([0.0; LANES]); 3], scalar: Row([1.0; LANES]), over_length: Row([2.0; LANES]) };
}

/// Forces on a segment of every strand of a block, but for those that come from its shape.
pub(super) trait Forces: Copy {
    fn lane(&self, lane: usize) -> [f32; 3];
}

impl Forces for [f32; 3] {
    #[inline(always)]
    fn lane(&self, _: usize) -> [f32; 3] {
        *self
    }
}

impl Forces for PointRow {
    #[inline(always)]
    fn lane(&self, lane: usize) -> [f32; 3] {
        lane_of(self, lane)
    }
}

/// What a step carries along a block from root to tip.
#[derive(Clone, Copy, Debug)]
pub(super) struct Walk {
    /// p_(i-1) at frame n.
    pub before: PointRow,
    frame: FrameRow,
    /// Where R_(i-1) carries r_i to.
    carried_rest: PointRow,
    /// The moment of the joint between segment i - 1 and i.
    moment: PointRow,
}

impl Walk {
    /// At the root: the first joint holds the first segment to the head.
    #[inline(always)]
    pub fn new(roots: &PointRow, first: Option<(&FreeState, &FreeRow)>) -> Self {
        let mut walk = Self {
            before: *roots,
            frame: FrameRow::AT_REST,
            carried_rest: PointRow::default(),
            moment: PointRow::default(),
        };
        if let Some((state, row)) = first {
            walk.carried_rest = row.rest;
            for lane in 0..LANES {
                let (rest, d) = (lane_of(&row.rest, lane), lane_of(&state.direction, lane));
                set_lane(&mut walk.moment, lane, moment_lane(row.stiffness.0[lane], rest, d));
            }
        }
        walk
    }
}

/// The segment after the one that is stepped, as it is at frame n. All 0 beyond the last one.
#[derive(Clone, Copy, Debug)]
pub(super) struct Next<'a> {
    pub direction: &'a PointRow,
    pub rest: &'a PointRow,
    /// K of the joint between the two.
    pub stiffness: &'a Row,
}

impl<'a> Next<'a> {
    #[inline(always)]
    pub fn of(next: Option<(&'a FreeState, &'a FreeRow)>) -> Self {
        static BEYOND: (PointRow, Row) = ([Row([0.0; LANES]); 3], Row([0.0; LANES]));
        match next {
            Some((state, row)) => Self { direction: &state.direction, rest: &row.rest, stiffness: &row.stiffness },
            None => Self { direction: &BEYOND.0, rest: &BEYOND.0, stiffness: &BEYOND.1 },
        }
    }
}

/// Moves segment i of every strand of a block from frame n to n + 1, as if nothing were in its way. `from` and `to` are
/// p_(i-1) and p_i at frame n + 1.
#[inline(always)]
#[expect(clippy::too_many_arguments, reason = "rows that lie in different places, none of which goes with another")]
pub(super) fn step_segment(
    state: &mut FreeState,
    row: &FreeRow,
    strength: &StrengthRow,
    forces: &impl Forces,
    weight: &Weight,
    next: &Next,
    walk: &mut Walk,
    from: &PointRow,
    to: &mut PointRow,
) {
    for lane in 0..LANES {
        let (d, w) = (lane_of(&state.direction, lane), lane_of(&state.increment, lane));
        let (rest, length) = (lane_of(&row.rest, lane), row.length.0[lane]);
        let hold = strength.hold.0[lane];
        let end = beyond(&walk.before, lane, length, d);
        set_lane(&mut walk.before, lane, end);

        let (u, s) = (lane_of(&walk.frame.vector, lane), walk.frame.scalar.0[lane]);
        let over_length = walk.frame.over_length.0[lane];
        let f = add(forces.lane(lane), sum_of_shape(weight, (u, s, over_length), hold, rest, d));

        // The turn from where the segment before it would carry it to where it is, which carries the next one.
        let carried_rest = lane_of(&walk.carried_rest, lane);
        let bend = cross(carried_rest, subtract(d, carried_rest));
        let (v, t) = shortened(bend, (1.0 + dot(carried_rest, d)).max(1e-12));
        let (u, s) = after(u, s, v, t);
        // The length of a product is that of its factors; finite even where many kinks have left nothing of it.
        let over_length = (over_length / t.mul_add(t, dot(v, v))).min(2e30);
        set_lane(&mut walk.frame.vector, lane, u);
        walk.frame.scalar.0[lane] = s;
        walk.frame.over_length.0[lane] = over_length;
        let next_rest = turned(u, s, over_length, lane_of(next.rest, lane));
        let next_moment = moment_lane(next.stiffness.0[lane], next_rest, lane_of(next.direction, lane));
        let moment = subtract(lane_of(&walk.moment, lane), next_moment);
        set_lane(&mut walk.carried_rest, lane, next_rest);
        set_lane(&mut walk.moment, lane, next_moment);

        let (gain, decay) = (row.gain.0[lane], strength.decay.0[lane]);
        let across = add(scale_add(-dot(f, d), d, f), cross(d, moment));
        let w = scale(decay, scale_add(gain, across, w));
        let speed_squared = dot(w, w);
        let sum = add(d, w);
        // What rests keeps its bits: a length of 1 but for its rounding is not brought back to 1.
        let shorter = if speed_squared > 0.0 { 1.0 / dot(sum, sum).sqrt() } else { 1.0 };
        let e = scale(shorter, sum);
        set_lane(&mut state.direction, lane, e);
        set_lane(&mut state.increment, lane, scale(shorter, scale_add(-speed_squared, d, w)));
        set_lane(to, lane, beyond(from, lane, length, e));
    }
}

/// The turn (v, t) from one direction to another, of which t is 1 + their cosine, brought near to length 1, not to it:
/// whoever turns by it divides by its length.
#[inline(always)]
fn shortened(v: [f32; 3], t: f32) -> ([f32; 3], f32) {
    // |(v, t)|^2 is 2 t for directions of length 1; half of it, x, is near 1 unless hair is kinked, and (3 - x) / 4 is
    // near 1 / (2 sqrt x) there.
    let shorter = t.mul_add(-0.125, 0.75);
    (scale(shorter, v), t * shorter)
}

/// The turn (v, t) after the turn (u, s).
#[inline(always)]
fn after(u: [f32; 3], s: f32, v: [f32; 3], t: f32) -> ([f32; 3], f32) {
    (scale_add(t, u, scale_add(s, v, cross(v, u))), t.mul_add(s, -dot(v, u)))
}

/// Where the ends of a segment of every strand are at frame n.
#[inline(always)]
pub(super) fn ends(state: &FreeState, row: &FreeRow, from: &PointRow) -> PointRow {
    let mut to = PointRow::default();
    for lane in 0..LANES {
        set_lane(&mut to, lane, beyond(from, lane, row.length.0[lane], lane_of(&state.direction, lane)));
    }
    to
}

/// Turns a segment of every strand back by the part of the head's turn that it lags behind: `axis` of length 1, `angle`
/// in rad.
#[inline(always)]
pub(super) fn lag_behind(state: &mut FreeState, axis: [f32; 3], angle: f32, lag: &Row) {
    for lane in 0..LANES {
        let (sin, cos) = sin_cos(-0.5 * (angle * lag.0[lane]));
        let u = scale(sin, axis);
        let over_length = 2.0 / cos.mul_add(cos, dot(u, u));
        let direction = turned(u, cos, over_length, lane_of(&state.direction, lane));
        set_lane(&mut state.direction, lane, direction);
        let increment = turned(u, cos, over_length, lane_of(&state.increment, lane));
        set_lane(&mut state.increment, lane, increment);
    }
}
