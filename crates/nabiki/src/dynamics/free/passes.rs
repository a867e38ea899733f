//! What the free form does to each segment of a block on the way from root to tip.

use glam::Vec3;

use super::contact::{Going, ROUNDS, Touch, gap};
use super::kernel::{Forces, FreeRow, FreeState, Next, Walk, ends, step_segment};
use super::packed::{Packed, Step};
use super::pulls::neighbours;
use super::pulls::weight::Weight;
use super::rotate::turned_about;
use crate::body::Shape;
use crate::dynamics::block::{Block, Pass, RUN, RunPass};
use crate::dynamics::paper::Force;
use crate::dynamics::row::{LANES, PointRow, Row, beyond, lane as lane_of, set_lane};
use crate::prefetch::prefetch_ahead;
use crate::vector::{add, dot, scale, subtract};

/// How many segments ahead memory is asked for: its answer takes as long as their steps.
const AHEAD: usize = 10;

/// A step under the same force everywhere, with nothing in the way.
pub(super) struct Free<'a> {
    pub packed: &'a Packed,
    pub force: [f32; 3],
    pub weight: Weight,
    pub walk: Walk,
    /// Number of the row among those of all blocks.
    pub at: usize,
}

impl Pass<FreeState, FreeRow> for Free<'_> {
    #[inline(always)]
    fn segment(
        &mut self,
        state: &mut FreeState,
        row: &FreeRow,
        next: Option<(&FreeState, &FreeRow)>,
        from: &PointRow,
        to: &mut PointRow,
    ) {
        let Self { packed, force, weight, walk, at } = self;
        prefetch_ahead(&*state, AHEAD);
        prefetch_ahead(row, AHEAD);
        step_segment(state, row, packed.strength(*at), force, weight, &Next::of(next), walk, from, to);
        *at += 1;
    }
}

/// A step among fields, bodies and other hair.
///
/// It goes through a run of segments more than once: first for all forces, which are asked for in many places, then for the
/// step. What is written number by number can be read as vectors only a little later.
pub(super) struct Among<'a, 's> {
    packed: &'a Packed,
    step: &'a Step<'s>,
    walk: Walk,
    /// Of p_(i-1), by the increments of frame n (cm a frame).
    velocity: PointRow,
    /// Number of the row among those of all blocks.
    at: usize,
}

/// Forces on a run of segments.
trait RunForces {
    type Row: Forces;

    fn row(&self, i: usize) -> &Self::Row;
}

impl RunForces for [f32; 3] {
    type Row = Self;

    #[inline(always)]
    fn row(&self, _: usize) -> &Self {
        self
    }
}

impl RunForces for [PointRow; RUN] {
    type Row = PointRow;

    #[inline(always)]
    fn row(&self, i: usize) -> &PointRow {
        &self[i]
    }
}

impl RunPass<FreeState, FreeRow> for Among<'_, '_> {
    #[inline(always)]
    fn run(
        &mut self,
        states: &mut [FreeState],
        rows: &[FreeRow],
        next: Option<(&FreeState, &FreeRow)>,
        points: &mut [PointRow],
    ) {
        match self.step.everywhere {
            Some(force) => self.move_all(&force, states, rows, next, points),
            None => {
                let mut forces = [PointRow::default(); RUN];
                self.forces(states, rows, &mut forces);
                self.move_all(&forces, states, rows, next, points);
            }
        }
    }
}

impl<'a, 's> Among<'a, 's> {
    #[inline(always)]
    pub fn new(packed: &'a Packed, step: &'a Step<'s>, block: &Block, walk: Walk) -> Self {
        Self { packed, step, walk, velocity: PointRow::default(), at: block.rows().start }
    }

    /// Moves a run of segments under forces that are known.
    #[inline(always)]
    fn move_all(
        &mut self,
        forces: &impl RunForces,
        states: &mut [FreeState],
        rows: &[FreeRow],
        next: Option<(&FreeState, &FreeRow)>,
        points: &mut [PointRow],
    ) {
        let (packed, weight) = (self.packed, &self.step.weight);
        for i in 0..rows.len().min(RUN) {
            let Some((state, after)) = states[i..].split_first_mut() else { break };
            prefetch_ahead(&*state, AHEAD);
            prefetch_ahead(&rows[i], AHEAD);
            let next = Next::of(after.first().zip(rows.get(i + 1)).or(next));
            let was = state.direction;
            let (from, to) = points.split_at_mut(i + 1);
            let (from, to) = (&from[i], &mut to[0]);
            let (force, strength) = (forces.row(i), packed.strength(self.at));
            step_segment(state, &rows[i], strength, force, weight, &next, &mut self.walk, from, to);
            if !self.step.bodies.is_empty() {
                for kept in &packed.kept_from {
                    prefetch_ahead(&kept.clearances[self.at], AHEAD);
                }
                self.keep_out(state, &was, &rows[i], from, to);
            }
            self.at += 1;
        }
    }

    /// All forces on a run of segments, at p_i of frame n, but for those that come from their shape.
    #[allow(clippy::needless_range_loop, reason = "a loop over lanes, as in the kernels")]
    #[inline(always)]
    fn forces(&mut self, states: &[FreeState], rows: &[FreeRow], forces: &mut [PointRow; RUN]) {
        let mut points = [PointRow::default(); RUN];
        let mut before = self.walk.before;
        for ((state, row), point) in states.iter().zip(rows).zip(&mut points) {
            before = ends(state, row, &before);
            *point = before;
        }
        for (i, (force, point)) in forces[..rows.len()].iter_mut().zip(&points).enumerate() {
            *force = self.outer_forces(self.at + i, point);
        }
        let Some(crowd) = self.step.crowd else { return };
        let mut pulls = [[[0.0; 4]; LANES]; RUN];
        for (pulls, point) in pulls[..rows.len()].iter_mut().zip(&points) {
            crowd.at_row(point, pulls);
        }
        let of_all = states.iter().zip(rows).zip(&pulls);
        for (((state, row), pulls), force) in of_all.zip(forces) {
            for lane in 0..LANES {
                let velocity = beyond(&self.velocity, lane, row.length.0[lane], lane_of(&state.increment, lane));
                set_lane(&mut self.velocity, lane, velocity);
                let sum = add(lane_of(force, lane), neighbours::force_lane(pulls[lane], velocity));
                set_lane(force, lane, sum);
            }
        }
    }

    /// Forces of the field and of the head's acceleration on a segment of every strand.
    #[inline(always)]
    fn outer_forces(&self, at: usize, points: &PointRow) -> PointRow {
        let mut forces = match self.step.uniform {
            Some([x, y, z]) => [Row([x; LANES]), Row([y; LANES]), Row([z; LANES])],
            None => self.step.field.at_row(points),
        };
        if let Some((surroundings, eps)) = &self.packed.weakening {
            for lane in 0..LANES {
                let force = lane_of(&forces, lane);
                let weakened = surroundings.weaken(lane_of(points, lane), &Force::new(force, surroundings));
                let eps = if weakened { eps[at].0[lane] } else { 1.0 };
                set_lane(&mut forces, lane, scale(eps, force));
            }
        }
        if let Some(felt) = &self.step.felt {
            for lane in 0..LANES {
                let force = add(lane_of(&forces, lane), felt.force_lane(lane_of(points, lane)));
                set_lane(&mut forces, lane, force);
            }
        }
        forces
    }

    /// Turns segments out of the bodies: of sixteen nodes a few may have come near, and fewer touch.
    #[allow(clippy::needless_range_loop, reason = "a loop over lanes, as in the kernels")]
    #[inline(always)]
    fn keep_out(&self, state: &mut FreeState, was: &PointRow, row: &FreeRow, from: &PointRow, to: &mut PointRow) {
        let near = self.near(state, row, to);
        if near == 0 {
            return;
        }
        let mut gaps = [f32::INFINITY; LANES];
        for b in 0..self.step.bodies.len() {
            self.read_gaps(b, near, to, &mut gaps);
        }
        // Number by number: vectors would wait for what has just been written so.
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

    /// Takes from the gaps what nodes and bodies may have come closer, and says which may touch: a bit for each strand.
    #[inline(always)]
    fn near(&self, state: &mut FreeState, row: &FreeRow, to: &PointRow) -> u32 {
        let (mut near, closer) = (0, self.step.closer);
        for lane in 0..LANES {
            let way = subtract(lane_of(to, lane), lane_of(&self.walk.before, lane));
            let gap = state.gap.0[lane] - (dot(way, way).sqrt() + closer);
            state.gap.0[lane] = gap;
            // What is held, and what is no segment, has no gain.
            near |= u32::from((gap < 0.0) & (row.gain.0[lane] > 0.0)) << lane;
        }
        near
    }

    /// How far at least the ends of some segments are from touching body `b`, where that is less than `gaps`.
    #[inline(always)]
    fn read_gaps(&self, b: usize, mut near: u32, to: &PointRow, gaps: &mut [f32; LANES]) {
        let (packed, placed) = (self.packed, &self.step.bodies[b]);
        let (body, kept) = (&packed.free.bodies[b], &packed.kept_from[b]);
        // Nearly all that lies on a body with filled folds keeps out of those.
        let (usual, unusual) = match (&body.filled, &body.shape) {
            (Some(filled), _) => (Some(filled), !kept.filled[self.at]),
            (None, Shape::Mesh(skin)) => (Some(skin), 0),
            (None, Shape::Other(_)) => (None, 0),
        };
        let places = usual.and_then(|usual| Some((&**usual, placed.places(usual, to)?)));
        while near != 0 {
            let lane = next_lane(&mut near);
            let clearance = kept.clearances[self.at].0[lane];
            let distance = match &places {
                Some((usual, places)) if unusual >> lane & 1 == 0 => usual.fine_distance(places, lane),
                _ => None,
            };
            let found = match distance {
                Some(distance) => gap(distance, clearance),
                None => {
                    let (surface, clearance) = packed.kept_out_of(b, self.at, lane);
                    placed.gap(body, surface, Vec3::from(lane_of(to, lane)), clearance)
                }
            };
            gaps[lane] = gaps[lane].min(found);
        }
    }

    /// What the head's turn has moved a direction by that lags behind it.
    #[inline(always)]
    fn lagged(&self, was: Vec3, lane: usize) -> Vec3 {
        match self.step.turn {
            Some((axis, angle)) => was - turned_about(axis, angle * self.packed.lags[self.at].0[lane], was),
            None => Vec3::ZERO,
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
        let at = |row: &PointRow| Vec3::from(lane_of(row, lane));
        let mut going = Going { direction: at(&state.direction), increment: at(&state.increment) };
        let (from, length, was) = (at(from), row.length.0[lane], at(was));
        let lagged = self.lagged(was, lane);
        let mut stopped = false;
        let touched = |b: usize| {
            let (surface, clearance) = self.packed.kept_out_of(b, self.at, lane);
            (&self.packed.free.bodies[b], surface, Touch { from, length, clearance, was, lagged })
        };
        for (b, placed) in self.step.bodies.iter().enumerate() {
            let (body, surface, touch) = touched(b);
            if let Some(there) = placed.stop(body, surface, going, &touch) {
                (going, stopped) = (there, true);
            }
        }
        // What touches nothing keeps its bits: when it is asked for depends on the hair that is stepped with it.
        if !stopped {
            return;
        }
        // What one body has turned may be in another: a corner is left by turns.
        let mut rounds = if self.step.bodies.len() > 1 { ROUNDS } else { 0 };
        while stopped && rounds > 0 {
            stopped = false;
            for (b, placed) in self.step.bodies.iter().enumerate() {
                let (body, surface, touch) = touched(b);
                if let Some(there) = placed.part(body, surface, going, &touch) {
                    (going, stopped) = (there, true);
                }
            }
            rounds -= 1;
        }
        set_lane(&mut state.direction, lane, going.direction.to_array());
        set_lane(&mut state.increment, lane, going.increment.to_array());
        set_lane(to, lane, (from + length * going.direction).to_array());
    }
}

/// Takes the first lane out of a set of them, a bit for each.
#[inline(always)]
fn next_lane(set: &mut u32) -> usize {
    let lane = set.trailing_zeros() as usize;
    *set &= *set - 1;
    lane
}

/// Puts strands together as they are.
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

/// Adds up what the increments move each point by, from a root that stands still.
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
