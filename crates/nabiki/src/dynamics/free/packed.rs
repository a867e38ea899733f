//! Hair packed into blocks for the free form, and what a frame does to a block.

use std::ops::Range;

use glam::Vec3;

use super::contact::{Going, Obstacle, Touch, gap};
use super::grid::Crowd;
use super::head_frame::{HeadFrame, weight};
use super::kernel::{FreeRow, FreeState, Next, StrengthRow, Walk, Weight, ends, lag_behind, step_segment};
use super::segment::{FreeSegment, free_segments};
use crate::body::{Body, Surface};
use crate::distance::SkinDistance;
use crate::dynamics::block::{Block, Pass};
use crate::dynamics::gain::Stability;
use crate::dynamics::paper::{Force, Surroundings};
use crate::dynamics::row::{LANES, PointRow, Row, beyond, lane as lane_of, rotate, set_lane};
use crate::dynamics::sweep::Form;
use crate::dynamics::wind::FieldFrame;
use crate::dynamics::{Dynamics, FrameInput};
use crate::error::SettingError;
use crate::field::Field;
use crate::free_form::FreeMotion;
use crate::strands::{Strands, bounds};
use crate::vector::{add, dot, scale, scale_add, subtract};

/// Everything about hair that no frame changes.
#[derive(Clone, Debug)]
pub(super) struct Packed {
    dynamics: Dynamics,
    free: FreeMotion,
    stability: Stability,
    blocks: Vec<Block>,
    rows: Vec<FreeRow>,
    /// Of every row, or a single one where they are all alike.
    strengths: Vec<StrengthRow>,
    /// The part of the head's turn that segments lag behind.
    lags: Vec<Row>,
    /// eps_i, where the scene has a pseudo-force.
    weakening: Option<(Surroundings, Vec<Row>)>,
    /// For each body, what the ends of the segments are kept out of.
    kept_from: Vec<Vec<KeptRow>>,
    rest: Vec<FreeState>,
    weight_at_rest: [f32; 3],
    /// A ball that hair does not leave (head space, cm), and the length of the longest strand.
    center: Vec3,
    radius: f32,
    longest: f32,
}

impl Packed {
    /// Packs hair at rest in the given shape, whose settings have been checked.
    pub fn new(strands: &Strands, dynamics: &Dynamics, free: &FreeMotion) -> Result<Self, SettingError> {
        let stability = Stability::of(strands, dynamics)?;
        let [low, high] = bounds(strands.points());
        let longest = strands.lengths().fold(0.0, f32::max);
        let weakens = dynamics.pseudo_force.coefficients.iter().any(|&eps| eps != 1.0);
        let mut packed = Self {
            weakening: weakens.then(|| (Surroundings::upright(dynamics), Vec::new())),
            dynamics: dynamics.clone(),
            free: free.clone(),
            stability,
            blocks: Vec::with_capacity(strands.len().div_ceil(LANES)),
            rows: Vec::new(),
            strengths: Vec::new(),
            lags: Vec::new(),
            kept_from: Vec::new(),
            rest: Vec::new(),
            weight_at_rest: weight(&free.rest_pose, f64::from(free.form.gravity)).as_vec3().to_array(),
            center: 0.5 * (low + high),
            radius: 0.5 * low.distance(high) + 2.0 * longest,
            longest,
        };
        for first in (0..strands.len()).step_by(LANES) {
            packed.pack(strands, first..strands.len().min(first + LANES))?;
        }
        if packed.strengths.iter().all(|strength| *strength == packed.strengths[0]) {
            packed.strengths.truncate(1);
        }
        packed.kept_from = free.bodies.iter().map(|body| packed.kept_from(body)).collect();
        Ok(packed)
    }

    fn pack(&mut self, strands: &Strands, range: Range<usize>) -> Result<(), SettingError> {
        let segments: Vec<Vec<FreeSegment>> = range
            .clone()
            .map(|s| free_segments(&self.dynamics, &self.free.form, strands.strand(s), s))
            .collect::<Result<_, _>>()?;
        let of_block = range.clone().zip(&segments).map(|(s, segments)| (strands.strand(s)[0], segments.len()));
        let block = Block::new(range.start, self.rows.len(), of_block);
        let rows = block.rows();
        self.rows.resize(rows.end, FreeRow::default());
        self.strengths.resize(rows.end, StrengthRow::of(&self.free.form));
        self.lags.resize(rows.end, Row::default());
        self.rest.resize(rows.end, FreeState::default());
        if let Some((_, eps)) = &mut self.weakening {
            eps.resize(rows.end, Row::default());
        }
        for (lane, segments) in segments.iter().enumerate() {
            for (row, segment) in rows.clone().zip(segments) {
                self.rows[row].set(lane, segment);
                self.strengths[row].set(lane, segment);
                self.lags[row].0[lane] = segment.lag as f32;
                self.rest[row].direction = self.rows[row].rest;
                if let Some((_, eps)) = &mut self.weakening {
                    eps[row].0[lane] = segment.shape.eps() as f32;
                }
            }
        }
        self.blocks.push(block);
        Ok(())
    }

    /// From the very points that the step puts together, so that what rests does not touch.
    fn kept_from(&self, body: &Body) -> Vec<KeptRow> {
        let body_from_head = body.head_from_body(0, &self.free.rest_pose).inverse();
        let mut kept = vec![KeptRow::default(); self.rows.len()];
        for block in &self.blocks {
            let mut from = block.roots;
            for at in block.rows() {
                let to = ends(&self.rest[at], &self.rows[at], &from);
                for lane in 0..LANES {
                    let at_rest = body_from_head.transform_point3(Vec3::from(lane_of(&to, lane)));
                    let (surface, clearance) = body.kept_from(at_rest);
                    kept[at].clearance.0[lane] = clearance;
                    kept[at].filled |= u16::from(surface == Surface::Filled) << lane;
                }
                from = to;
            }
        }
        kept
    }

    /// Refuses a field under which this hair cannot be stepped.
    pub fn check_field(&self, field: &dyn Field) -> Result<(), SettingError> {
        self.stability.check(field)
    }

    pub fn dynamics(&self) -> &Dynamics {
        &self.dynamics
    }

    /// Room for the state of every segment.
    pub fn states(&self) -> Vec<FreeState> {
        self.rest.clone()
    }

    /// The state of every segment at rest.
    pub fn at_rest(&self) -> &[FreeState] {
        &self.rest
    }

    /// The bodies in a frame.
    pub fn obstacles(&self, input: &FrameInput, obstacles: &mut Vec<Obstacle>) {
        obstacles.clear();
        obstacles.extend(self.free.bodies.iter().map(|body| Obstacle::new(body, input)));
    }

    /// What a frame does to every block. `crowd`: what the carriers left in the frame before.
    pub fn plan<'a>(&self, input: &FrameInput<'a>, obstacles: &'a [Obstacle], crowd: Option<&'a Crowd>) -> Plan<'a> {
        let gravity = f64::from(self.free.form.gravity);
        let head = HeadFrame::new(input, gravity, self.dynamics.motion.frame_rate);
        let field = FieldFrame::new(input, self.dynamics.motion.force_space);
        let turned_by = head.turn.map_or(0.0, |(_, angle)| angle.abs() as f32);
        let of_bodies = obstacles.iter().map(|o| o.farthest_moved(self.center, self.radius)).fold(0.0, f32::max);
        let felt = head.felt.map(|felt| Felt {
            columns: felt.matrix3.as_mat3().to_cols_array_2d(),
            constant: felt.translation.as_vec3().to_array(),
        });
        let uniform = field.uniform();
        let everywhere = uniform.filter(|_| felt.is_none() && crowd.is_none() && self.weakening.is_none());
        Plan::Step(Step {
            field,
            uniform,
            everywhere,
            turn: head.turn.map(|(axis, angle)| (axis.as_vec3().to_array(), angle as f32)),
            weight: Weight { now: head.weight.as_vec3().to_array(), at_rest: self.weight_at_rest },
            felt,
            obstacles,
            closer: of_bodies + turned_by * self.longest,
            crowd,
        })
    }
}

/// What a body keeps the end of a segment of every strand of a block out of.
#[derive(Clone, Copy, Debug, Default)]
struct KeptRow {
    /// How far from it they are kept (cm).
    clearance: Row,
    /// A bit for each strand: whether that is the skin with its folds filled.
    filled: u16,
}

/// What becomes of the hair in one frame.
#[derive(Clone, Copy, Debug)]
#[expect(clippy::large_enum_variant, reason = "there is one for each frame")]
pub(super) enum Plan<'a> {
    /// It is put back to rest.
    Rest,
    /// It moves.
    Step(Step<'a>),
    /// It stays, and the points are what the increments alone move them by (cm a frame).
    Velocities,
}

/// What a frame does to every block.
#[derive(Clone, Copy, Debug)]
pub(super) struct Step<'a> {
    field: FieldFrame<'a>,
    /// The field's force, where that is the same everywhere (head space).
    uniform: Option<[f32; 3]>,
    /// All forces, where they are.
    everywhere: Option<[f32; 3]>,
    /// The head's turn: axis and angle (rad).
    turn: Option<([f32; 3], f32)>,
    weight: Weight,
    felt: Option<Felt>,
    obstacles: &'a [Obstacle],
    /// How much closer nodes and bodies may have come but by the nodes' own motion (cm).
    closer: f32,
    crowd: Option<&'a Crowd>,
}

/// The force of the head's acceleration at a point: columns of a matrix, and what it has in the origin.
#[derive(Clone, Copy, Debug)]
struct Felt {
    columns: [[f32; 3]; 3],
    constant: [f32; 3],
}

impl Form for Packed {
    type State = FreeState;
    type Plan<'a> = Plan<'a>;

    fn blocks(&self) -> &[Block] {
        &self.blocks
    }

    #[inline(always)]
    fn frame(&self, block: &Block, plan: &Plan<'_>, states: &mut [FreeState], page: Option<&mut [Vec3]>) {
        let rows = &self.rows[block.rows()];
        match plan {
            Plan::Rest => {
                states.copy_from_slice(&self.rest[block.rows()]);
                block.walk(&block.roots, states, rows, page, Place);
            }
            Plan::Velocities => block.walk(&PointRow::default(), states, rows, page, Velocities),
            Plan::Step(step) => {
                if let Some((axis, angle)) = step.turn {
                    for (state, lag) in states.iter_mut().zip(&self.lags[block.rows()]) {
                        lag_behind(state, axis, angle, lag);
                    }
                }
                let walk = Walk::new(&block.roots, states.first().zip(rows.first()));
                match step.everywhere {
                    Some(force) if step.obstacles.is_empty() => {
                        let (weight, at) = (step.weight, block.rows().start);
                        let pass = Free { packed: self, force, weight, walk, at };
                        block.walk(&block.roots, states, rows, page, pass);
                    }
                    _ => {
                        let pass =
                            Among { packed: self, step, walk, velocity: PointRow::default(), at: block.rows().start };
                        block.walk(&block.roots, states, rows, page, pass);
                    }
                }
            }
        }
    }
}

impl Packed {
    /// What body `b` keeps the end of a segment of row `at` out of, and how far from it (cm).
    #[inline(always)]
    fn kept_out_of(&self, b: usize, at: usize, lane: usize) -> (&SkinDistance, f32) {
        let kept = &self.kept_from[b][at];
        let surface = if kept.filled >> lane & 1 == 1 { Surface::Filled } else { Surface::Skin };
        (self.free.bodies[b].surface(surface), kept.clearance.0[lane])
    }

    #[inline(always)]
    fn strength(&self, at: usize) -> &StrengthRow {
        &self.strengths[if self.strengths.len() == 1 { 0 } else { at }]
    }
}

/// A step under the same force everywhere, with nothing in the way.
struct Free<'a> {
    packed: &'a Packed,
    force: [f32; 3],
    weight: Weight,
    walk: Walk,
    /// Number of the row among those of all blocks.
    at: usize,
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
        step_segment(state, row, packed.strength(*at), force, weight, &Next::of(next), walk, from, to);
        *at += 1;
    }
}

/// A step among fields, bodies and other hair.
struct Among<'a, 's> {
    packed: &'a Packed,
    step: &'a Step<'s>,
    walk: Walk,
    /// Of p_(i-1), by the increments of frame n (cm a frame).
    velocity: PointRow,
    /// Number of the row among those of all blocks.
    at: usize,
}

impl Pass<FreeState, FreeRow> for Among<'_, '_> {
    #[inline(always)]
    fn segment(
        &mut self,
        state: &mut FreeState,
        row: &FreeRow,
        next: Option<(&FreeState, &FreeRow)>,
        from: &PointRow,
        to: &mut PointRow,
    ) {
        let (strength, weight, was) = (self.packed.strength(self.at), &self.step.weight, state.direction);
        let next = Next::of(next);
        match self.step.everywhere {
            Some(force) => step_segment(state, row, strength, &force, weight, &next, &mut self.walk, from, to),
            None => {
                let forces = self.forces(state, row);
                step_segment(state, row, strength, &forces, weight, &next, &mut self.walk, from, to);
            }
        }
        if !self.step.obstacles.is_empty() {
            self.keep_out(state, &was, row, from, to);
        }
        self.at += 1;
    }
}

impl Among<'_, '_> {
    /// All forces on a segment of every strand, at p_i of frame n, but for those that come from its shape.
    #[inline(always)]
    fn forces(&mut self, state: &FreeState, row: &FreeRow) -> PointRow {
        let points = ends(state, row, &self.walk.before);
        let mut forces = match self.step.uniform {
            Some([x, y, z]) => [Row([x; LANES]), Row([y; LANES]), Row([z; LANES])],
            None => self.step.field.at_row(&points),
        };
        if let Some((surroundings, eps)) = &self.packed.weakening {
            for lane in 0..LANES {
                let force = lane_of(&forces, lane);
                let weakened = surroundings.weaken(lane_of(&points, lane), &Force::new(force, surroundings));
                let eps = if weakened { eps[self.at].0[lane] } else { 1.0 };
                set_lane(&mut forces, lane, scale(eps, force));
            }
        }
        if let Some(Felt { columns, constant }) = &self.step.felt {
            for lane in 0..LANES {
                let felt = add(rotate(columns, lane_of(&points, lane)), *constant);
                let force = add(lane_of(&forces, lane), felt);
                set_lane(&mut forces, lane, force);
            }
        }
        if let Some(crowd) = self.step.crowd {
            let (pull, drag) = crowd.at_row(&points);
            for lane in 0..LANES {
                let velocity = beyond(&self.velocity, lane, row.length.0[lane], lane_of(&state.increment, lane));
                set_lane(&mut self.velocity, lane, velocity);
                let felt = scale_add(-drag.0[lane], velocity, lane_of(&pull, lane));
                let force = add(lane_of(&forces, lane), felt);
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
        for b in 0..self.step.obstacles.len() {
            self.read_gaps(b, near, to, &mut gaps);
        }
        let mut touching = 0;
        for lane in 0..LANES {
            let read = near >> lane & 1 == 1;
            state.gap.0[lane] = if read { gaps[lane].max(0.0) } else { state.gap.0[lane] };
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
            near |= u32::from((gap < 0.0) & (row.length.0[lane] > 0.0)) << lane;
        }
        near
    }

    /// How far at least the ends of some segments are from touching body `b`, where that is less than `gaps`.
    #[inline(always)]
    fn read_gaps(&self, b: usize, mut near: u32, to: &PointRow, gaps: &mut [f32; LANES]) {
        let (packed, obstacle) = (self.packed, &self.step.obstacles[b]);
        let (body, kept) = (&packed.free.bodies[b], &packed.kept_from[b][self.at]);
        // Nearly all that lies on a body with filled folds keeps out of those.
        let (usual, unusual) = match body.filled.as_deref() {
            Some(filled) => (filled, !kept.filled),
            None => (&*body.distance, 0),
        };
        let places = obstacle.places(usual, to);
        while near != 0 {
            let lane = next_lane(&mut near);
            let clearance = kept.clearance.0[lane];
            let distance = match &places {
                Some(places) if unusual >> lane & 1 == 0 => usual.fine_distance(places, lane),
                _ => None,
            };
            let found = match distance {
                Some(distance) => gap(distance, clearance),
                None => {
                    let (skin, clearance) = packed.kept_out_of(b, self.at, lane);
                    obstacle.gap(skin, Vec3::from(lane_of(to, lane)), clearance)
                }
            };
            gaps[lane] = gaps[lane].min(found);
        }
    }

    /// Turns a segment out of the bodies that its end touches.
    #[inline(never)]
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
        for (b, obstacle) in self.step.obstacles.iter().enumerate() {
            let (skin, clearance) = self.packed.kept_out_of(b, self.at, lane);
            let touch = Touch { from, length, clearance, was };
            going = obstacle.stop(skin, going, &touch).unwrap_or(going);
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
struct Place;

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
struct Velocities;

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
