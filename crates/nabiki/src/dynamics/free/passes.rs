//! The surroundings of a block of strands in a step: forces on its nodes, and bodies that keep them out.

use glam::Vec3;

use super::contact::{ANSWER, Going, Moving, PlacedBody, ROUNDS, Touch, gap};
use super::kernel::{AirRow, FreeRow, FreeState, advance, ends};
use super::packed::{Packed, Step};
use super::ride_row::RideRow;
use super::work::Work;
use crate::body::Shape;
use crate::dynamics::block::{Block, Pass};
use crate::dynamics::paper::Force;
use crate::dynamics::row::{LANES, PointRow, Row, beyond, lane as lane_of, rotate, set_lane};
use crate::prefetch::prefetch_ahead;
use crate::vector::{add, dot, scale, scale_add, subtract};

/// How many segments ahead memory is prefetched: it takes as long as their steps.
const AHEAD: usize = 10;

/// A block in a frame.
#[derive(Clone, Copy)]
pub(super) struct Blown<'a, 's> {
    pub packed: &'a Packed,
    pub step: &'a Step<'s>,
    pub block: &'a Block,
    /// Its number.
    pub number: usize,
    /// How skin carries it; none without skin that moves.
    pub ride: Option<&'a RideRow>,
}

/// The same in one of the steps of the frame.
#[derive(Clone, Copy)]
pub(super) struct Stepped<'a, 's> {
    pub of: Blown<'a, 's>,
    /// The bodies at its end.
    pub bodies: &'a [PlacedBody],
    /// Its share of the frame.
    pub h: f32,
    /// The largest distance that the bodies move in it (cm).
    pub closer: f32,
}

impl<'a, 's> Blown<'a, 's> {
    pub fn rows(&self) -> &'a [FreeRow] {
        &self.packed.rows[self.block.rows()]
    }

    /// Whether `work.shifted` counts.
    pub fn is_shifted(&self) -> bool {
        self.ride.is_some() || self.step.turn.is_some()
    }

    /// Where the roots are in this frame.
    pub fn roots(&self) -> PointRow {
        self.ride.map_or(self.block.roots, |ride| ride.roots)
    }

    /// Evaluates what acts once a frame: the field and the neighbours.
    #[inline(always)]
    pub fn blow(&self, states: &[FreeState], work: &mut [Work]) {
        let (rows, first) = (self.rows(), self.block.rows().start);
        for (i, work) in work.iter_mut().enumerate() {
            work.drag = self.packed.air(first + i).air;
        }
        let wind = self.packed.own(self.number).map(|own| own.wind(self.step.frame));
        if let Some(force) = self.step.everywhere {
            let mut forces = force.map(|along| Row([along; LANES]));
            if let Some(wind) = &wind {
                wind.take(&mut forces);
            }
            for (row, work) in rows.iter().zip(work) {
                work.blown = pushed(&row.push, &forces);
            }
            return;
        }
        let mut end = self.roots();
        for ((state, row), work) in states.iter().zip(rows).zip(&mut *work) {
            end = ends(state, row, &end);
            work.end = end;
        }
        for (i, (row, work)) in rows.iter().zip(work).enumerate() {
            let mut forces = self.outer_forces(first + i, &work.end);
            if let Some(wind) = &wind {
                wind.take(&mut forces);
            }
            if let Some(crowd) = self.step.crowd {
                let mut pulls = [[0.0; 4]; LANES];
                crowd.at_row(&work.end, &mut pulls);
                for (lane, &[x, y, z, held]) in pulls.iter().enumerate() {
                    let force = add(lane_of(&forces, lane), [x, y, z]);
                    set_lane(&mut forces, lane, force);
                    work.drag.0[lane] = row.push.0[lane].mul_add(held, work.drag.0[lane]);
                }
            }
            work.blown = pushed(&row.push, &forces);
        }
    }

    /// Forces of the field on a segment of every strand.
    #[inline(always)]
    fn outer_forces(&self, at: usize, points: &PointRow) -> PointRow {
        let mut forces = match self.step.uniform {
            Some([x, y, z]) => [Row([x; LANES]), Row([y; LANES]), Row([z; LANES])],
            None => match self.packed.shares(self.number) {
                None => self.step.field.at_row(points),
                Some(shares) => {
                    let share = |field: &str| shares.in_field(field, &self.packed.shared);
                    self.step.field.at_row_shared(points, &share)
                }
            },
        };
        if let Some((surroundings, eps)) = &self.packed.weakening {
            for lane in 0..LANES {
                let force = lane_of(&forces, lane);
                let weakened = surroundings.weaken(lane_of(points, lane), &Force::new(force, surroundings));
                let eps = if weakened { eps[at].0[lane] } else { 1.0 };
                set_lane(&mut forces, lane, scale(eps, force));
            }
        }
        forces
    }
}

/// The acceleration of the nodes by forces.
#[inline(always)]
fn pushed(push: &Row, forces: &PointRow) -> PointRow {
    let (push, forces, mut pushed) = (*push, *forces, PointRow::default());
    for lane in 0..LANES {
        set_lane(&mut pushed, lane, scale(push.0[lane], lane_of(&forces, lane)));
    }
    pushed
}

impl<'a, 's> Stepped<'a, 's> {
    /// All acceleration of the nodes except by the chain.
    #[inline(always)]
    pub fn push(&self, states: &mut [FreeState], work: &mut [Work]) {
        let Blown { packed, step, block, number, .. } = self.of;
        let (rows, first) = (self.of.rows(), block.rows().start);
        // Of the points by which the head carries the strands.
        let (mut velocity, mut acceleration) = (PointRow::default(), PointRow::default());
        if let Some(ride) = self.of.ride {
            (velocity, acceleration) = (ride.velocity, ride.acceleration);
        } else if let Some(way) = &step.way {
            for lane in 0..LANES {
                let root = lane_of(&packed.anchors[number], lane);
                set_lane(&mut velocity, lane, add(rotate(&way.velocity.0, root), way.velocity.1));
                set_lane(&mut acceleration, lane, add(rotate(&way.acceleration.0, root), way.acceleration.1));
            }
        }
        let weight = packed.weight(number, step.weight);
        let is_carried = self.of.ride.is_some() || step.way.is_some();
        for (i, ((state, row), work)) in states.iter_mut().zip(rows).zip(work).enumerate() {
            prefetch_ahead(row, AHEAD);
            let mut other = work.blown;
            if is_carried {
                let AirRow { air, drag } = *packed.air(first + i);
                for lane in 0..LANES {
                    let (velocity, acceleration) = (lane_of(&velocity, lane), lane_of(&acceleration, lane));
                    let still_air = scale_add(air.0[lane], velocity, acceleration);
                    let all = scale_add(-drag.0[lane], still_air, lane_of(&other, lane));
                    set_lane(&mut other, lane, all);
                }
            }
            let (push, mut all) = (row.push, other);
            for lane in 0..LANES {
                let pushed = scale_add(push.0[lane], lane_of(&weight, lane), lane_of(&other, lane));
                set_lane(&mut all, lane, pushed);
            }
            work.pushed = all;
            if !self.bodies.is_empty() {
                self.push_back(state, row, first + i, [&other, &weight], work);
            }
        }
    }

    /// Removes from the acceleration of some nodes what would carry them into the bodies. `by`: all acceleration but by weight, and
    /// the force of weight.
    #[inline(always)]
    fn push_back(&self, state: &mut FreeState, row: &FreeRow, at: usize, by: [&PointRow; 2], work: &mut Work) {
        work.clear = Row([f32::INFINITY; LANES]);
        let (h, [other, weight], push) = (self.h, by.map(|by| *by), row.push);
        let Work { velocity, weight: at_rest, drag, .. } = *work;
        let (mut net, mut reach) = (PointRow::default(), Row::default());
        for lane in 0..LANES {
            let velocity = lane_of(&velocity, lane);
            // The effect of weight minus the weight that balances the hair at rest.
            let unbalanced = scale(push.0[lane], subtract(lane_of(&weight, lane), lane_of(&at_rest, lane)));
            let sum = add(lane_of(&other, lane), unbalanced);
            let sum = scale_add(-drag.0[lane], velocity, sum);
            set_lane(&mut net, lane, sum);
            reach.0[lane] = h * (h * dot(sum, sum).sqrt() + dot(velocity, velocity).sqrt()) + self.closer;
        }
        let by = state.pressed;
        let pressed = mask(|lane| by.0[lane] > 0.0);
        let mut near = near(&state.gap, &reach, row) | pressed;
        if near == 0 {
            return;
        }
        if let [body] = self.bodies
            && body.rests()
            && self.of.ride.is_none()
        {
            // The contact returns the distance, too.
            while near != 0 {
                let lane = next_lane(&mut near);
                self.push_one_back(state, at, &net, work, lane);
            }
            return;
        }
        let mut gaps = [f32::INFINITY; LANES];
        for b in 0..self.bodies.len() {
            self.read_gaps(b, at, near, &work.end, &mut gaps);
        }
        let mut read = near;
        while read != 0 {
            let lane = next_lane(&mut read);
            // If negative, the pass to the tips checks again.
            state.gap.0[lane] = gaps[lane];
            if gaps[lane] >= reach.0[lane] && pressed >> lane & 1 == 0 {
                near &= !(1 << lane);
            }
        }
        while near != 0 {
            let lane = next_lane(&mut near);
            self.push_one_back(state, at, &net, work, lane);
        }
    }

    /// The same for one node. The push of the step before belongs to the nearest body.
    #[inline(always)]
    fn push_one_back(&self, state: &mut FreeState, at: usize, net: &PointRow, work: &mut Work, lane: usize) {
        let of = |row: &PointRow| Vec3::from(lane_of(row, lane));
        let moving = Moving {
            at: of(&work.end),
            ridden: if self.of.ride.is_some() { of(&work.ridden) } else { Vec3::ZERO },
            shifted: if self.of.is_shifted() { of(&work.shifted) } else { Vec3::ZERO },
            velocity: of(&work.velocity),
            acceleration: of(net),
            pressed: 0.0,
        };
        let packed = self.of.packed;
        let kept = |b: usize| {
            let (surface, clearance) = packed.kept_out_of(b, at, lane);
            (&self.bodies[b], &packed.free.bodies[b], surface, clearance)
        };
        let mut nearest = (0, f32::INFINITY);
        for b in 1..self.bodies.len() {
            for b in [0, b] {
                let (placed, body, surface, clearance) = kept(b);
                let gap = placed.clear(body, surface, clearance, &moving).unwrap_or(f32::MAX);
                nearest = if gap < nearest.1 { (b, gap) } else { nearest };
            }
        }
        let before = std::mem::take(&mut state.pressed.0[lane]);
        for b in 0..self.bodies.len() {
            let (placed, body, surface, clearance) = kept(b);
            let pressed = if b == nearest.0 { before } else { 0.0 };
            if let Some(push) = placed.against(body, surface, clearance, &Moving { pressed, ..moving }) {
                let all = add(lane_of(&work.pushed, lane), push.force.to_array());
                set_lane(&mut work.pushed, lane, all);
                if b == nearest.0 {
                    (state.pressed.0[lane], work.clear.0[lane]) = (push.outward, push.clear);
                }
                if placed.rests() && self.bodies.len() == 1 && self.of.ride.is_none() {
                    state.gap.0[lane] = push.gap;
                }
            }
        }
    }

    /// Lower bounds of how far the ends of some segments are from touching body `b`, where less than `gaps`.
    #[inline(always)]
    fn read_gaps(&self, b: usize, at: usize, mut near: u32, to: &PointRow, gaps: &mut [f32; LANES]) {
        let (packed, placed) = (self.of.packed, &self.bodies[b]);
        let (body, kept) = (&packed.free.bodies[b], &packed.kept_from[b]);
        // Nearly all hair on a body with filled folds is kept out of these.
        let (usual, unusual) = match (&body.filled, &body.shape) {
            (Some(filled), _) => (Some(filled), !kept.filled[at]),
            (None, Shape::Mesh(skin)) => (Some(skin), 0),
            (None, Shape::Other(_)) => (None, 0),
        };
        let places = usual.and_then(|usual| Some((&**usual, placed.places(usual, to)?)));
        while near != 0 {
            let lane = next_lane(&mut near);
            let clearance = kept.clearances[at].0[lane];
            let distance = match &places {
                Some((usual, places)) if unusual >> lane & 1 == 0 => usual.fine_distance(places, lane),
                _ => None,
            };
            let found = match distance {
                Some(distance) => gap(distance, clearance),
                None => {
                    let (surface, clearance) = packed.kept_out_of(b, at, lane);
                    placed.gap(body, surface, Vec3::from(lane_of(to, lane)), clearance)
                }
            };
            gaps[lane] = gaps[lane].min(found);
        }
    }
}

/// Which nodes may be nearer to a body than they can move: a bit for each strand.
#[inline(always)]
fn near(gap: &Row, reach: &Row, row: &FreeRow) -> u32 {
    let (gap, reach, lightness) = (*gap, *reach, row.lightness);
    // Held and missing segments have infinite mass.
    mask(|lane| (gap.0[lane] < reach.0[lane]) & (lightness.0[lane] > 0.0))
}

/// A bit for each lane in which the condition holds.
#[inline(always)]
fn mask(is: impl Fn(usize) -> bool) -> u32 {
    let mut bits = [0; LANES];
    for (lane, bit) in bits.iter_mut().enumerate() {
        *bit = u32::from(is(lane)) << lane;
    }
    bits.iter().fold(0, |all, bit| all | bit)
}

/// The pass to the tips that turns segments, and moves them out of bodies.
pub(super) struct Go<'a, 's> {
    stepped: Stepped<'a, 's>,
    work: &'a [Work],
    /// Number of the segment.
    i: usize,
    /// Of p_(i-1) at the end of the step (cm per frame), if there are bodies.
    velocity: PointRow,
}

impl<'a, 's> Go<'a, 's> {
    pub fn new(stepped: Stepped<'a, 's>, work: &'a [Work]) -> Self {
        Self { stepped, work, i: 0, velocity: PointRow::default() }
    }
}

impl Pass<FreeState, FreeRow> for Go<'_, '_> {
    #[inline(always)]
    fn segment(
        &mut self,
        state: &mut FreeState,
        row: &FreeRow,
        _: Option<(&FreeState, &FreeRow)>,
        from: &PointRow,
        to: &mut PointRow,
    ) {
        prefetch_ahead(&*state, AHEAD);
        let work = &self.work[self.i];
        if self.stepped.bodies.is_empty() {
            advance(state, row, work, self.stepped.h, from, to);
        } else {
            let was = state.direction;
            advance(state, row, work, self.stepped.h, from, to);
            self.keep_out(state, &was, row, from, to);
            for lane in 0..LANES {
                let goes = beyond(&self.velocity, lane, row.length.0[lane], lane_of(&state.increment, lane));
                set_lane(&mut self.velocity, lane, goes);
            }
        }
        self.i += 1;
    }
}

impl Go<'_, '_> {
    /// Index of the row among those of all blocks.
    fn at(&self) -> usize {
        self.stepped.of.block.rows().start + self.i
    }

    /// Turns segments out of the bodies: of sixteen nodes a few may be near, and fewer touch.
    #[allow(clippy::needless_range_loop, reason = "a loop over lanes, as in the kernels")]
    #[inline(always)]
    fn keep_out(&self, state: &mut FreeState, was: &PointRow, row: &FreeRow, from: &PointRow, to: &mut PointRow) {
        let (end, there, closer) = (self.work[self.i].end, *to, self.stepped.closer);
        let mut gap = state.gap;
        for lane in 0..LANES {
            let way = subtract(lane_of(&there, lane), lane_of(&end, lane));
            gap.0[lane] -= dot(way, way).sqrt() + closer;
        }
        state.gap = gap;
        let near = near(&state.gap, &Row::default(), row);
        if near == 0 {
            return;
        }
        let mut gaps = [f32::INFINITY; LANES];
        for b in 0..self.stepped.bodies.len() {
            self.stepped.read_gaps(b, self.at(), near, to, &mut gaps);
        }
        // One number at a time: vector loads would wait for numbers just written one by one.
        let (mut read, mut touching) = (near, 0);
        while read != 0 {
            let lane = next_lane(&mut read);
            state.gap.0[lane] = gaps[lane].max(0.0);
            touching |= u32::from(gaps[lane] < 0.0) << lane;
        }
        while touching != 0 {
            let lane = next_lane(&mut touching);
            self.keep_one_out(state, was, row, from, to, lane);
        }
    }

    /// Turns a segment out of the bodies that its end touches.
    #[inline(always)]
    fn keep_one_out(
        &self,
        state: &mut FreeState,
        was: &PointRow,
        row: &FreeRow,
        from: &PointRow,
        to: &mut PointRow,
        lane: usize,
    ) {
        let Stepped { of: Blown { packed, .. }, bodies, h, .. } = self.stepped;
        let at = |row: &PointRow| Vec3::from(lane_of(row, lane));
        let mut going = Going { direction: at(&state.direction), increment: h * at(&state.increment) };
        let (from, length, was) = (at(from), row.length.0[lane], at(was));
        let left_behind = if self.stepped.of.is_shifted() { at(&self.work[self.i].shifted) } else { Vec3::ZERO };
        let carried = h * at(&self.velocity) + left_behind;
        let mut stopped = false;
        let mut inward = 0.0_f32;
        let touched = |b: usize| {
            let (surface, clearance) = packed.kept_out_of(b, self.at(), lane);
            (&packed.free.bodies[b], surface, Touch { from, length, clearance, was, carried })
        };
        for (b, placed) in bodies.iter().enumerate() {
            let (body, surface, touch) = touched(b);
            if let Some((there, went)) = placed.stop(body, surface, going, &touch) {
                (going, stopped) = (there, true);
                inward = inward.max(went);
            }
        }
        // A segment that touches nothing keeps its bits, because when it is tested depends on the other strands in the
        // block.
        if !stopped {
            return;
        }
        // A turn out of one body may lead into another: this alternates until the segment leaves the corner.
        let mut rounds = if bodies.len() > 1 { ROUNDS } else { 0 };
        while stopped && rounds > 0 {
            stopped = false;
            for (b, placed) in bodies.iter().enumerate() {
                let (body, surface, touch) = touched(b);
                if let Some(there) = placed.part(body, surface, going, &touch) {
                    (going, stopped) = (there, true);
                }
            }
            rounds -= 1;
        }
        // Only beyond the motion it had: the part that was stopped is not what presses it.
        state.pressed.0[lane] += ANSWER * (inward - self.work[self.i].clear.0[lane]).max(0.0) / (h * h);
        set_lane(&mut state.direction, lane, going.direction.to_array());
        set_lane(&mut state.increment, lane, (going.increment / h).to_array());
        set_lane(to, lane, (from + length * going.direction).to_array());
    }
}

/// Removes the first lane from a set, a bit for each, and returns it.
#[inline(always)]
fn next_lane(set: &mut u32) -> usize {
    let lane = set.trailing_zeros() as usize;
    *set &= *set - 1;
    lane
}

/// Computes the points of the strands as they are.
pub(super) struct Place;

impl Pass<FreeState, FreeRow> for Place {
    #[inline(always)]
    fn segment(
        &mut self,
        state: &mut FreeState,
        row: &FreeRow,
        _: Option<(&FreeState, &FreeRow)>,
        from: &PointRow,
        to: &mut PointRow,
    ) {
        *to = ends(state, row, from);
    }
}

/// Adds up the motion of each point by the increments, for a root at rest.
pub(super) struct Velocities;

impl Pass<FreeState, FreeRow> for Velocities {
    #[inline(always)]
    fn segment(
        &mut self,
        state: &mut FreeState,
        row: &FreeRow,
        _: Option<(&FreeState, &FreeRow)>,
        from: &PointRow,
        to: &mut PointRow,
    ) {
        for lane in 0..LANES {
            set_lane(to, lane, beyond(from, lane, row.length.0[lane], lane_of(&state.increment, lane)));
        }
    }
}
