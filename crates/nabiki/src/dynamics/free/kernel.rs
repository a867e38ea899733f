//! The fast step of the free form for one block of strands: sixteen at a time, f32.
//!
//! As in the paper's kernel every lane does the same operations whatever the machine's vectors hold, and multiplies and
//! adds are fused by name: the bits do not depend on the vector width, nor on the other lanes.
//!
//! Loops over lanes read and write local rows alone, which are copied from and to the arrays around them: of places in arrays
//! the compiler does not know that they are apart, and asks that at every segment, or gives vectors up.
//!
//! A step goes along the strands to and fro: [`carry`], [`untwist`] and [`bend`] for the joints, the systems of [`solve`](super::solve), and
//! [`advance`], on which segments are turned.

use glam::Quat;

use super::aimed::AimRow;
use super::pulls::{hold, joints, weight};
use super::rotate::turned;
use super::segment::FreeSegment;
use super::solve::slacken;
use super::work::Work;
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
    /// Twist of the joint at its beginning (rad).
    pub twist: Row,
    /// How strongly a body pushes the node at its end outward (cm per frame^2).
    pub pressed: Row,
    /// A lower bound of the distance of the segment's end from touching a body (cm). Unused without bodies.
    pub gap: Row,
}

impl FreeState {
    /// Of all its rows.
    pub const NUMBERS: usize = 9 * LANES;

    pub fn rows(&self) -> [&Row; 9] {
        let Self { direction: [x, y, z], increment: [u, v, w], twist, pressed, gap } = self;
        [x, y, z, u, v, w, twist, pressed, gap]
    }

    pub fn rows_mut(&mut self) -> [&mut Row; 9] {
        let Self { direction: [x, y, z], increment: [u, v, w], twist, pressed, gap } = self;
        [x, y, z, u, v, w, twist, pressed, gap]
    }
}

/// One segment of every strand of a block, see [`FreeSegment`]. All 0 where a strand has no such segment.
#[derive(Clone, Copy, Debug, Default)]
#[repr(C)]
pub(super) struct FreeRow {
    /// cm, and 1 / cm.
    pub length: Row,
    pub over_length: Row,
    /// r_i.
    pub rest: PointRow,
    /// A.
    pub push: Row,
    /// 1/m_i; 0 where the segment is held.
    pub lightness: Row,
    /// B_i of the joint at its beginning.
    pub bending: Row,
    /// u_i and S_i.
    pub up: PointRow,
    pub supports: Row,
    /// C_i.
    pub hold: Row,
    /// The rounding error that the solve leaves at rest.
    pub residual: PointRow,
}

/// The effect of the air on one segment of every strand of a block.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub(super) struct AirRow {
    /// alpha_i.
    pub air: Row,
    /// The share of the head's motion that it is left behind by.
    pub drag: Row,
}

impl FreeRow {
    pub fn set(&mut self, lane: usize, segment: &FreeSegment) {
        self.length.0[lane] = segment.shape.length as f32;
        self.over_length.0[lane] = (1.0 / segment.shape.length) as f32;
        set_lane(&mut self.rest, lane, segment.rest.as_vec3().to_array());
        self.push.0[lane] = segment.push as f32;
        self.lightness.0[lane] = segment.lightness as f32;
        self.bending.0[lane] = segment.bending as f32;
        set_lane(&mut self.up, lane, segment.up.as_vec3().to_array());
        self.supports.0[lane] = segment.supports as f32;
        self.hold.0[lane] = segment.hold as f32;
    }
}

impl AirRow {
    /// Lanes without a segment get the form's value at the root.
    pub fn of(form: &FreeForm, slow: f64) -> Self {
        Self { air: Row([(form.air(0.0) / slow) as f32; LANES]), drag: Row([form.drag.at(0.0) as f32; LANES]) }
    }

    pub fn set(&mut self, lane: usize, segment: &FreeSegment) {
        self.air.0[lane] = segment.air as f32;
        self.drag.0[lane] = segment.drag as f32;
    }
}

/// R_(i-1) of every strand of a block, a quaternion of length about 1: it has carried the segments before this one from
/// rest to their current directions.
#[derive(Clone, Copy, Debug)]
pub(super) struct FrameRow {
    vector: PointRow,
    scalar: Row,
    /// 2 / its squared length, computed early because the next segment waits for both.
    over_length: Row,
}

impl FrameRow {
    pub const AT_REST: Self =
        Self { vector: [Row([0.0; LANES]); 3], scalar: Row([1.0; LANES]), over_length: Row([2.0; LANES]) };

    /// Sets that of one strand.
    pub fn set(&mut self, lane: usize, turn: Quat) {
        set_lane(&mut self.vector, lane, turn.xyz().to_array());
        self.scalar.0[lane] = turn.w;
        self.over_length.0[lane] = 2.0 / turn.length_squared();
    }

    /// The vectors of all strands rotated.
    #[inline(always)]
    pub fn of(&self, vectors: &PointRow) -> PointRow {
        let (of, vectors, mut there) = (*self, *vectors, ZERO);
        for lane in 0..LANES {
            let (u, s, over) = (lane_of(&of.vector, lane), of.scalar.0[lane], of.over_length.0[lane]);
            set_lane(&mut there, lane, turned(u, s, over, lane_of(&vectors, lane)));
        }
        there
    }
}

pub(super) static BEYOND: (FreeState, FreeRow, Work) = (
    FreeState { direction: ZERO, increment: ZERO, twist: NONE, pressed: NONE, gap: NONE },
    FreeRow {
        length: NONE,
        over_length: NONE,
        rest: ZERO,
        push: NONE,
        lightness: NONE,
        bending: NONE,
        up: ZERO,
        supports: NONE,
        hold: NONE,
        residual: ZERO,
    },
    Work::NONE,
);

pub(super) const NONE: Row = Row([0.0; LANES]);
pub(super) const ZERO: PointRow = [NONE; 3];

/// What comes after a segment; all 0 after the last one.
#[inline(always)]
pub(super) fn next<'a, T>(of: &'a [T], i: usize, beyond: &'a T) -> &'a T {
    of.get(i + 1).unwrap_or(beyond)
}

/// Goes to the tips: positions and velocities of the nodes, where the frames carry the shape at rest, and the first half of the
/// tridiagonal system of the segments' turns about themselves. `from_rest`: R_0, if skin moves. `weight`: that at rest, if wanted where
/// the frames carry it.
#[inline(always)]
pub(super) fn carry(
    states: &[FreeState],
    rows: &[FreeRow],
    roots: &PointRow,
    from_rest: Option<&FrameRow>,
    weight: Option<&PointRow>,
    work: &mut [Work],
) {
    let (mut end, mut velocity, mut frame) = (*roots, ZERO, from_rest.copied().unwrap_or(FrameRow::AT_REST));
    let mut carried = from_rest.map_or(rows[0].rest, |turn| turn.of(&rows[0].rest));
    let (mut handed, mut above, mut turned_by) = (NONE, NONE, NONE);
    let torsion = joints::TORSION as f32;
    for (i, ((state, row), work)) in states.iter().zip(rows).zip(work).enumerate() {
        let (next_state, next_row) = (next(states, i, &BEYOND.0), next(rows, i, &BEYOND.1));
        (work.carried, work.handed) = (carried, handed);
        if let Some(weight) = weight {
            let mut of_rest = ZERO;
            for lane in 0..LANES {
                let (u, s, over) = (lane_of(&frame.vector, lane), frame.scalar.0[lane], frame.over_length.0[lane]);
                set_lane(&mut of_rest, lane, turned(u, s, over, lane_of(weight, lane)));
            }
            work.weight = of_rest;
        }
        let FreeState { direction, increment, twist, .. } = *state;
        let FreeRow { length, lightness, bending: bends, .. } = *row;
        let FreeState { direction: next_direction, twist: next_twist, .. } = *next_state;
        let FreeRow { rest: next_at_rest, bending: next_bends, .. } = *next_row;
        for lane in 0..LANES {
            let (d, w) = (lane_of(&direction, lane), lane_of(&increment, lane));
            let length = length.0[lane];
            let there = beyond(&end, lane, length, d);
            set_lane(&mut end, lane, there);
            let goes = beyond(&velocity, lane, length, w);
            set_lane(&mut velocity, lane, goes);

            // The rotation of a segment from where the segment before would carry it to its direction, and the twist of its joint about
            // it.
            let (u, s) = (lane_of(&frame.vector, lane), frame.scalar.0[lane]);
            let carried_rest = lane_of(&carried, lane);
            let bend = cross(carried_rest, subtract(d, carried_rest));
            let (v, t) = shortened(bend, (1.0 + dot(carried_rest, d)).max(1e-12));
            let (u, s) = after(u, s, v, t);
            let half = 0.5 * twist.0[lane];
            let (u, s) = after(u, s, scale(half, d), 1.0);
            // The length of a product is that of its factors. Finite even if many kinks have left nothing of it.
            let longer = t.mul_add(t, dot(v, v)) * half.mul_add(half, 1.0);
            let over = (frame.over_length.0[lane] / longer).min(2e30);
            set_lane(&mut frame.vector, lane, u);
            frame.scalar.0[lane] = s;
            frame.over_length.0[lane] = over;
            let next_rest = turned(u, s, over, lane_of(&next_at_rest, lane));

            let (next_d, bending) = (lane_of(&next_direction, lane), next_bends.0[lane]);
            let stiff = torsion * bends.0[lane];
            let next_stiff = torsion * bending;
            let hands = dot(d, add(next_d, next_rest)) / (1.0 + dot(next_d, next_rest)).max(1e-12);
            let across = cross(d, next_rest);
            let middle = next_stiff.mul_add(hands * hands, bending.mul_add(dot(across, across), stiff));
            let moment = dot(joints::moment_lane(bending, next_rest, next_d), d);
            let right = (next_stiff * hands).mul_add(next_twist.0[lane], -moment);
            let right = (-stiff).mul_add(twist.0[lane], right);
            let lower = -stiff * handed.0[lane];
            let middle = (-lower).mul_add(above.0[lane], middle);
            // A held segment does not turn.
            let over = if (lightness.0[lane] > 0.0) & (middle > 0.0) { 1.0 / middle } else { 0.0 };
            above.0[lane] = -next_stiff * hands * over;
            turned_by.0[lane] = (-lower).mul_add(turned_by.0[lane], right) * over;
            handed.0[lane] = hands;
            set_lane(&mut carried, lane, next_rest);
        }
        (work.end, work.velocity) = (end, velocity);
        (work.above, work.tension) = (above, turned_by);
    }
}

/// Comes back from the tips with the turns of the segments about themselves.
#[inline(always)]
pub(super) fn untwist(work: &mut [Work]) {
    slacken(work);
}

/// Goes to the tips with the new twists of the joints: s_i, the shear of their moments. `from_rest`: as in [`carry`].
#[inline(always)]
pub(super) fn bend(
    states: &mut [FreeState],
    rows: &[FreeRow],
    from_rest: Option<&FrameRow>,
    aims: Option<&[AimRow]>,
    work: &mut [Work],
) {
    let torsion = joints::TORSION as f32;
    let (mut before, mut turned_before) = (ZERO, NONE);
    for (i, (state, row)) in states.iter_mut().zip(rows).enumerate() {
        let (done, work) = work.split_at_mut(i);
        let work = &mut work[0];
        let FreeState { direction, mut twist, .. } = *state;
        let FreeRow { over_length, mut rest, bending: bends, hold, mut up, supports, .. } = *row;
        if let Some(turn) = from_rest {
            (rest, up) = (turn.of(&rest), turn.of(&up));
        }
        let Work { handed, tension: turned_by, carried: at_rest, .. } = *work;
        let mut moment = ZERO;
        for lane in 0..LANES {
            let (d, bending) = (lane_of(&direction, lane), bends.0[lane]);
            let by = turned_before.0[lane];
            twist.0[lane] += (-handed.0[lane]).mul_add(by, turned_by.0[lane]);
            let half = 0.5 * by;
            let (u, over) = (scale(half, lane_of(&before, lane)), 2.0 / half.mul_add(half, 1.0));
            let carried = turned(u, 1.0, over, lane_of(&at_rest, lane));
            let bent = joints::moment_lane(bending, carried, d);
            let along = torsion * bending * twist.0[lane] / (1.0 + dot(d, carried)).max(1e-12);
            set_lane(&mut moment, lane, scale_add(-along, add(d, carried), bent));
        }
        (turned_before, before) = (turned_by, direction);
        (state.twist, work.moment) = (twist, moment);
        if let Some(done) = done.last_mut() {
            shear(&moment, done);
        }
        let (mut held, mut end_way) = (ZERO, ZERO);
        for lane in 0..LANES {
            let d = lane_of(&direction, lane);
            let supported = weight::moment_lane(lane_of(&up, lane), supports.0[lane], d);
            set_lane(&mut held, lane, add(supported, hold::moment_lane(hold.0[lane], lane_of(&rest, lane), d)));
            set_lane(&mut end_way, lane, scale(over_length.0[lane], d));
        }
        if let Some(AimRow { toward, hold }) = aims.map(|aims| aims[i]) {
            for lane in 0..LANES {
                let led = hold::moment_lane(hold.0[lane], lane_of(&toward, lane), lane_of(&direction, lane));
                // Strands that no aim leads keep their bits, including the sign of 0.
                let was = lane_of(&held, lane);
                let all = if hold.0[lane] > 0.0 { add(was, led) } else { was };
                set_lane(&mut held, lane, all);
            }
        }
        // The shear is only hold, support and aims until the moment of the next joint is known.
        (work.shear, work.end_way) = (held, end_way);
    }
    if let Some(last) = work.last_mut() {
        shear(&ZERO, last);
    }
}

/// The shear of a segment, from the moments at both of its ends and hold.
#[inline(always)]
fn shear(next: &PointRow, work: &mut Work) {
    let Work { moment, mut shear, end_way, .. } = *work;
    let next = *next;
    for lane in 0..LANES {
        let moment = subtract(lane_of(&moment, lane), lane_of(&next, lane));
        let all = add(moment, lane_of(&shear, lane));
        set_lane(&mut shear, lane, cross(all, lane_of(&end_way, lane)));
    }
    work.shear = shear;
}

/// Turns a segment of every strand through a step of `h` frames, ignoring bodies. `from` and `to`: p_(i-1) and p_i after it.
#[inline(always)]
pub(super) fn advance(state: &mut FreeState, row: &FreeRow, work: &Work, h: f32, from: &PointRow, to: &mut PointRow) {
    let FreeState { mut direction, mut increment, .. } = *state;
    let (length, driven, from) = (row.length, work.driven, *from);
    let mut end = ZERO;
    for lane in 0..LANES {
        let (d, w) = (lane_of(&direction, lane), lane_of(&driven, lane));
        let w = scale_add(-dot(w, d), d, w);
        let speed = dot(w, w) * (h * h);
        let w = scale(if speed > 1.0 { 1.0 / speed.sqrt() } else { 1.0 }, w);
        let way = scale(h, w);
        let sum = add(d, way);
        // Hair at rest keeps its bits: a length that is 1 up to rounding is not corrected.
        let shorter = if dot(way, way) > 0.0 { 1.0 / dot(sum, sum).sqrt() } else { 1.0 };
        let there = scale(shorter, sum);
        let w = scale_add(-dot(w, there) / (1.0 + dot(d, there)), add(d, there), w);
        set_lane(&mut direction, lane, there);
        set_lane(&mut increment, lane, w);
        set_lane(&mut end, lane, beyond(&from, lane, length.0[lane], there));
    }
    (state.direction, state.increment, *to) = (direction, increment, end);
}

/// The rotation (v, t) from one direction to another, t being 1 + their cosine, brought near length 1 but not exactly:
/// users divide by its length.
#[inline(always)]
fn shortened(v: [f32; 3], t: f32) -> ([f32; 3], f32) {
    // |(v, t)|^2 is 2 t for directions of length 1; half of it, x, is near 1 unless hair is kinked, and (3 - x) / 4 is
    // near 1 / (2 sqrt x) there.
    let shorter = t.mul_add(-0.125, 0.75);
    (scale(shorter, v), t * shorter)
}

/// The rotation (v, t) after the rotation (u, s).
#[inline(always)]
fn after(u: [f32; 3], s: f32, v: [f32; 3], t: f32) -> ([f32; 3], f32) {
    (scale_add(t, u, scale_add(s, v, cross(v, u))), t.mul_add(s, -dot(v, u)))
}

/// The ends of a segment of every strand.
#[inline(always)]
pub(super) fn ends(state: &FreeState, row: &FreeRow, from: &PointRow) -> PointRow {
    let (direction, length, from) = (state.direction, row.length, *from);
    let mut to = ZERO;
    for lane in 0..LANES {
        set_lane(&mut to, lane, beyond(&from, lane, length.0[lane], lane_of(&direction, lane)));
    }
    to
}

/// Leaves a segment of every strand behind by its share of a turn: for a lane an axis, of length 1, and an angle (rad).
#[inline(always)]
pub(super) fn stay_behind(state: &mut FreeState, row: &FreeRow, turn: impl Fn(usize) -> ([f32; 3], f32), drag: &Row) {
    let FreeState { mut direction, mut increment, .. } = *state;
    let (lightness, drag) = (row.lightness, *drag);
    for lane in 0..LANES {
        // Held segments move with the head.
        let share = if lightness.0[lane] > 0.0 { drag.0[lane] } else { 0.0 };
        let (axis, angle) = turn(lane);
        let (sin, cos) = sin_cos(-0.5 * (angle * share));
        let u = scale(sin, axis);
        let over_length = 2.0 / cos.mul_add(cos, dot(u, u));
        let there = turned(u, cos, over_length, lane_of(&direction, lane));
        set_lane(&mut direction, lane, there);
        let goes = turned(u, cos, over_length, lane_of(&increment, lane));
        set_lane(&mut increment, lane, goes);
    }
    (state.direction, state.increment) = (direction, increment);
}
