//! Hair packed into blocks for the free form, and the effect of a frame on all of it.

use std::ops::Range;

use glam::Vec3;

use super::aimed::AimedBlock;
use super::contact::PlacedBody;
use super::grid::Crowd;
use super::head_frame::{HeadFrame, HeadWay};
use super::kernel::{AirRow, FreeRow, FreeState, ends};
use super::own::{OwnRow, SharesRow};
use super::pulls::weight;
use super::segment::{FreeSegment, free_segments};
use crate::body::{Body, BodyWay, Surface};
use crate::dynamics::block::Block;
use crate::dynamics::field_frame::FieldFrame;
use crate::dynamics::paper::Surroundings;
use crate::dynamics::ride::SkinStep;
use crate::dynamics::row::{LANES, PointRow, Row, lane as lane_of, set_lane};
use crate::dynamics::stability::Stability;
use crate::dynamics::state::Identity;
use crate::dynamics::sweep::{Pages, sweep};
use crate::dynamics::{Dynamics, FrameInput, VectorWidth};
use crate::error::SettingError;
use crate::field::Field;
use crate::free_form::{FreeForm, FreeMotion};
use crate::skin::{SkinFrame, SkinPlace};
use crate::strands::{Strands, bounds};
use crate::vector::scale;

/// A mesh feeds many numbers to the hash, and states are compared often: compute it only once.
fn shapes(bodies: &[Body]) -> u64 {
    let mut identity = Identity::new();
    for body in bodies {
        body.shape.obstacle().identify(&mut |numbers| identity.numbers(numbers));
    }
    identity.get()
}

/// Everything about hair that does not change from frame to frame.
#[derive(Clone, Debug)]
pub(super) struct Packed {
    pub dynamics: Dynamics,
    pub free: FreeMotion,
    stability: Stability,
    pub blocks: Vec<Block>,
    pub rows: Vec<FreeRow>,
    /// One per row, or a single one if all are alike.
    airs: Vec<AirRow>,
    /// For every block, the points by which the head carries its strands: their roots, or the last nodes that a tie holds.
    pub anchors: Vec<PointRow>,
    /// The places of the skin that carry the strands; empty without skin that moves.
    places: Vec<SkinPlace>,
    /// How strands modify the wind, block by block; empty if all are alike.
    own: Vec<OwnRow>,
    /// Names of the fields that strands feel in shares of their own.
    pub shared: Vec<String>,
    /// These shares, block by block; empty if there are none.
    shares: Vec<SharesRow>,
    /// Factors on the weight, block by block; empty if it is that of the settings.
    weights: Vec<Row>,
    /// The aims that lead strands, block by block; empty without aims.
    aimed: Vec<Option<AimedBlock>>,
    /// eps_i, where the scene has a pseudo-force.
    pub weakening: Option<(Surroundings, Vec<Row>)>,
    /// For each body, the surface that the ends of the segments are kept out of.
    pub kept_from: Vec<KeptFrom>,
    /// Identifies the shapes of the bodies.
    shapes: u64,
    pub at_rest: Vec<FreeState>,
    weight_at_rest: [f32; 3],
    pub most_drag: f32,
    most_margin: f32,
    /// A ball that hair does not leave (head space, cm), and the length of the longest strand.
    center: Vec3,
    radius: f32,
    pub longest: f32,
}

impl Packed {
    /// Bytes of a row of sixteen segments, including its moving state.
    pub const BYTES_A_ROW: usize = size_of::<FreeRow>() + size_of::<AirRow>() + 2 * size_of::<FreeState>();

    /// Packs hair at rest in the given shape, with checked settings. `known`: the same hair, packed with other
    /// settings; what these do not change is taken from there.
    pub fn new(
        strands: &Strands,
        dynamics: &Dynamics,
        free: &FreeMotion,
        known: Option<&Self>,
    ) -> Result<Self, SettingError> {
        let stability = Stability::of(strands, dynamics)?;
        let [mut low, mut high] = bounds(strands.points());
        if let Some([from, to]) = dynamics.skin.as_ref().and_then(|skin| skin.bounds()) {
            (low, high) = (low.min(from), high.max(to));
        }
        let longest = strands.lengths().fold(0.0, f32::max);
        let weakens =
            dynamics.weakening().is_some_and(|weakening| weakening.coefficients.iter().any(|&eps| eps != 1.0));
        let mut packed = Self {
            weakening: weakens.then(|| (Surroundings::upright(dynamics), Vec::new())),
            dynamics: dynamics.clone(),
            free: free.clone(),
            stability,
            blocks: Vec::with_capacity(strands.len().div_ceil(LANES)),
            rows: Vec::new(),
            airs: Vec::new(),
            anchors: Vec::new(),
            places: Vec::new(),
            own: Vec::new(),
            shared: free.form.shared().into_iter().map(str::to_owned).collect(),
            shares: Vec::new(),
            weights: Vec::new(),
            aimed: Vec::new(),
            kept_from: Vec::new(),
            shapes: 0,
            at_rest: Vec::new(),
            weight_at_rest: weight::on_head(&free.rest_pose, f64::from(free.form.gravity)).as_vec3().to_array(),
            most_drag: free.form.most_drag(),
            most_margin: free.form.most_margin(),
            center: 0.5 * (low + high),
            radius: 0.5 * low.distance(high) + 2.0 * longest,
            longest,
        };
        for first in (0..strands.len()).step_by(LANES) {
            packed.pack(strands, first..strands.len().min(first + LANES))?;
        }
        if packed.airs.iter().all(|air| *air == packed.airs[0]) {
            packed.airs.truncate(1);
        }
        packed.take_rest();
        if let Some(skin) = &dynamics.skin {
            packed.places = skin.places(strands.iter().map(|strand| strand[0]));
        }
        let margins = |form: &FreeForm| form.regions.iter().any(|region| region.margin != 1.0);
        let same_margins = |known: &Self| !margins(&known.free.form) && !margins(&free.form);
        match known {
            Some(known)
                if known.free.bodies == free.bodies
                    && known.free.rest_pose == free.rest_pose
                    && same_margins(known) =>
            {
                (packed.kept_from, packed.shapes) = (known.kept_from.clone(), known.shapes);
            }
            _ => {
                packed.kept_from = free.bodies.iter().map(|body| packed.kept_from(body, strands)).collect();
                packed.shapes = shapes(&free.bodies);
            }
        }
        Ok(packed)
    }

    fn pack(&mut self, strands: &Strands, range: Range<usize>) -> Result<(), SettingError> {
        let segments: Vec<Vec<FreeSegment>> = range
            .clone()
            .map(|s| free_segments(&self.dynamics, &self.free, strands.strand(s), s))
            .collect::<Result<_, _>>()?;
        let of_block = range.clone().zip(&segments).map(|(s, segments)| (strands.strand(s)[0], segments.len()));
        let block = Block::new(range.start, self.rows.len(), of_block);
        let rows = block.rows();
        self.rows.resize(rows.end, FreeRow::default());
        self.airs.resize(rows.end, AirRow::of(&self.free.form, self.dynamics.motion.slow.into()));
        self.at_rest.resize(rows.end, FreeState::default());
        if let Some((_, eps)) = &mut self.weakening {
            eps.resize(rows.end, Row::default());
        }
        if self.free.form.wind_differs() {
            let own = range.clone().map(|s| self.free.own(strands.strand(s)));
            self.own.push(OwnRow::of(own));
        }
        if !self.shared.is_empty() {
            let shares = range.clone().map(|s| self.free.shares(strands.strand(s)[0]));
            self.shares.push(SharesRow::of(shares, self.shared.len()));
        }
        if self.free.form.regions.iter().any(|region| region.gravity != 1.0) {
            let mut weights = Row([1.0; LANES]);
            let of_strands = range.clone().map(|s| self.free.own(strands.strand(s)).weight as f32);
            weights.0.iter_mut().zip(of_strands).for_each(|(row, weight)| *row = weight);
            self.weights.push(weights);
        }
        if !self.free.aims.is_empty() {
            let skin = self.dynamics.skin.as_deref();
            self.aimed.push(AimedBlock::of(&self.free, strands, range.start, &segments, rows.len(), skin));
        }
        let mut anchors = block.roots;
        for (lane, (s, segments)) in range.zip(&segments).enumerate() {
            let held = segments.iter().take_while(|segment| segment.lightness == 0.0).count();
            set_lane(&mut anchors, lane, strands.strand(s)[held].to_array());
            for (row, segment) in rows.clone().zip(segments) {
                self.rows[row].set(lane, segment);
                self.airs[row].set(lane, segment);
                self.at_rest[row].direction = self.rows[row].rest;
                if let Some((_, eps)) = &mut self.weakening {
                    eps[row].0[lane] = segment.shape.eps() as f32;
                }
            }
        }
        self.anchors.push(anchors);
        self.blocks.push(block);
        Ok(())
    }

    /// Stores the rounding error that the solve leaves at rest.
    fn take_rest(&mut self) {
        let mut states = self.at_rest.clone();
        let mut none = vec![Vec3::ZERO; self.blocks.iter().map(Block::point_count).sum()];
        sweep(&*self, &[Plan::Residual], VectorWidth::default(), &mut states, Pages::Last(&mut none));
        for (row, state) in self.rows.iter_mut().zip(&states) {
            row.residual = state.increment;
        }
    }

    /// From exactly the points that the step computes, so that hair at rest does not touch.
    fn kept_from(&self, body: &Body, strands: &Strands) -> KeptFrom {
        let margins = self.free.form.regions.iter().any(|region| region.margin != 1.0);
        let body_from_head = body.head_from_body(0, &self.free.rest_pose).inverse();
        let rows = self.rows.len();
        let mut kept = KeptFrom { clearances: vec![Row::default(); rows], filled: vec![0; rows] };
        for block in &self.blocks {
            let mut from = block.roots;
            let mut times = [1.0; LANES];
            if margins {
                let first = block.first_strand as usize;
                let strands = (first..strands.len()).map(|s| self.free.own(strands.strand(s)).margin);
                times.iter_mut().zip(strands).for_each(|(times, margin)| *times = margin);
            }
            for at in block.rows() {
                let to = ends(&self.at_rest[at], &self.rows[at], &from);
                for (lane, times) in times.into_iter().enumerate() {
                    let at_rest = body_from_head.transform_point3(Vec3::from(lane_of(&to, lane)));
                    let (surface, clearance) = body.kept_from(at_rest, times);
                    kept.clearances[at].0[lane] = clearance;
                    kept.filled[at] |= u16::from(surface == Surface::Filled) << lane;
                }
                from = to;
            }
        }
        kept
    }

    /// Identifies this hair at rest, whatever moves it.
    pub fn identity(&self) -> u64 {
        let mut identity = Identity::new();
        self.blocks.iter().for_each(|block| block.identify(&mut identity));
        for FreeRow { length, rest: [x, y, z], .. } in &self.rows {
            [length, x, y, z].into_iter().for_each(|row| identity.numbers(&row.0));
        }
        identity.get()
    }

    /// Identifies the bodies that its gaps refer to; 0 without any.
    pub fn bodies_identity(&self) -> u64 {
        if self.free.bodies.is_empty() {
            return 0;
        }
        let mut identity = Identity::new();
        [self.shapes as u32, (self.shapes >> 32) as u32].into_iter().for_each(|word| identity.word(word));
        for (body, kept) in self.free.bodies.iter().zip(&self.kept_from) {
            identity.numbers(&[body.contact.margin]);
            if let BodyWay::InWorld(poses) = &body.way {
                poses.iter().for_each(|pose| {
                    identity.numbers(&pose.position_cm.to_array());
                    identity.numbers(&pose.rotation.to_array());
                });
            }
            kept.clearances.iter().for_each(|row| identity.numbers(&row.0));
            kept.filled.iter().for_each(|&filled| identity.word(u32::from(filled)));
        }
        identity.get()
    }

    /// Whether this hair can be stepped under a field.
    pub fn is_stable(&self, field: &dyn Field) -> bool {
        self.stability.holds(field)
    }

    /// The strongest force under which this hair can be stepped.
    pub fn strongest_force(&self) -> f32 {
        self.stability.strongest_force()
    }

    pub fn dynamics(&self) -> &Dynamics {
        &self.dynamics
    }

    /// Room for the state of every segment.
    pub fn states(&self) -> Vec<FreeState> {
        self.at_rest.clone()
    }

    /// Puts held segments to rest: tied hair may have got here under another tie.
    pub fn hold(&self, states: &mut [FreeState]) {
        for ((state, row), rest) in states.iter_mut().zip(&self.rows).zip(&self.at_rest) {
            for lane in (0..LANES).filter(|&lane| row.lightness.0[lane] == 0.0) {
                set_lane(&mut state.direction, lane, lane_of(&rest.direction, lane));
                set_lane(&mut state.increment, lane, lane_of(&rest.increment, lane));
                (state.twist.0[lane], state.pressed.0[lane]) = (0.0, 0.0);
            }
        }
    }

    /// The bodies at the end of each step of a frame.
    pub fn bodies(&self, input: &FrameInput, bodies: &mut Vec<PlacedBody>) {
        let steps = self.free.form.steps();
        bodies.clear();
        for step in 1..=steps {
            let reach = (self.center, self.radius, self.most_margin);
            let place = |(b, body)| PlacedBody::new(b, body, input, [step, steps], reach);
            bodies.extend(self.free.bodies.iter().enumerate().map(place));
        }
    }

    /// Puts every block to rest, as the skin is in frame 0.
    pub fn rest(&self) -> Plan<'_> {
        Plan::Rest(self.dynamics.skin.as_ref().map(|skin| skin.at(0)))
    }

    /// The effect of a frame on every block. `crowd`: the carriers' grid of the frame before.
    pub fn plan<'a>(&'a self, input: &FrameInput<'a>, bodies: &'a [PlacedBody], crowd: Option<&'a Crowd>) -> Plan<'a> {
        let head = HeadFrame::new(input, &self.free.form);
        let skin = SkinStep::new(&self.dynamics, input, &head);
        let field = FieldFrame::new(input, self.dynamics.motion.force_space);
        // A field that strands feel in shares of their own is not the same for all, wherever it is.
        let uniform = field.uniform().filter(|_| self.shares.is_empty());
        let everywhere = uniform.filter(|_| crowd.is_none() && self.weakening.is_none());
        Plan::Step(Step {
            frame: input.frame,
            field,
            uniform,
            everywhere,
            turn: head.turn.map(|(axis, angle)| (axis.as_vec3().to_array(), angle as f32)),
            weight: head.weight.as_vec3().to_array(),
            way: head.way.map(RootWay::from),
            skin,
            steps: self.free.form.steps(),
            bodies,
            crowd,
        })
    }
}

/// Velocity and acceleration of the points that the head carries: columns of a matrix, and the value at the origin.
#[derive(Clone, Copy, Debug)]
pub(super) struct RootWay {
    pub velocity: ([[f32; 3]; 3], [f32; 3]),
    pub acceleration: ([[f32; 3]; 3], [f32; 3]),
}

impl From<HeadWay> for RootWay {
    fn from(way: HeadWay) -> Self {
        let [velocity, acceleration] = [way.velocity, way.acceleration]
            .map(|of| (of.matrix3.as_mat3().to_cols_array_2d(), of.translation.as_vec3().to_array()));
        Self { velocity, acceleration }
    }
}

/// What the ends of segments are kept out of for one body, row by row.
#[derive(Clone, Debug)]
pub(super) struct KeptFrom {
    /// How far from it they are kept (cm).
    pub clearances: Vec<Row>,
    /// A bit for each strand: whether that is the skin with its folds filled.
    pub filled: Vec<u16>,
}

/// The mode of a frame.
#[derive(Clone, Copy, Debug)]
#[expect(clippy::large_enum_variant, reason = "there is one for each frame")]
pub(super) enum Plan<'a> {
    /// Hair is put back to rest, on skin of this shape.
    Rest(Option<&'a SkinFrame>),
    /// Hair moves.
    Step(Step<'a>),
    /// Hair stays; the points are what the increments alone move them by (cm per frame).
    Velocities,
    /// Hair is at rest; increments become what drives them there, which is rounding error.
    Residual,
}

/// The effect of a frame on every block.
#[derive(Clone, Copy, Debug)]
pub(super) struct Step<'a> {
    /// Number of the frame to compute.
    pub frame: u32,
    pub field: FieldFrame<'a>,
    /// The field's force, if it is the same everywhere (head space).
    pub uniform: Option<[f32; 3]>,
    /// All forces by position.
    pub everywhere: Option<[f32; 3]>,
    /// The head's turn: axis and angle (rad).
    pub turn: Option<([f32; 3], f32)>,
    /// The weight's force (head space).
    pub weight: [f32; 3],
    /// How the head carries the roots; none if it does not move.
    pub way: Option<RootWay>,
    /// None without skin that carries roots.
    pub skin: Option<SkinStep<'a>>,
    /// Number of steps in the frame.
    pub steps: u32,
    /// All bodies at the end of the first step, then at the end of the next, and so on.
    pub bodies: &'a [PlacedBody],
    pub crowd: Option<&'a Crowd>,
}

impl Packed {
    /// The surface of body `b` that keeps the end of a segment of row `at` out, and at what distance (cm).
    #[inline(always)]
    pub fn kept_out_of(&self, b: usize, at: usize, lane: usize) -> (Surface, f32) {
        let kept = &self.kept_from[b];
        let surface = if kept.filled[at] >> lane & 1 == 1 { Surface::Filled } else { Surface::Skin };
        (surface, kept.clearances[at].0[lane])
    }

    /// How the strands of a block modify the wind; none if all are alike.
    #[inline(always)]
    pub fn own(&self, block: usize) -> Option<&OwnRow> {
        self.own.get(block)
    }

    /// The shares of the strands of a block in the fields; none if all feel all of them.
    #[inline(always)]
    pub fn shares(&self, block: usize) -> Option<&SharesRow> {
        self.shares.get(block)
    }

    /// The force of the weight on the strands of a block, by that of the settings.
    #[inline(always)]
    pub fn weight(&self, block: usize, of_settings: [f32; 3]) -> PointRow {
        let mut weight = of_settings.map(|along| Row([along; LANES]));
        if let Some(times) = self.weights.get(block) {
            for lane in 0..LANES {
                let of_strand = scale(times.0[lane], of_settings);
                set_lane(&mut weight, lane, of_strand);
            }
        }
        weight
    }

    /// That of the weight at rest.
    #[inline(always)]
    pub fn weight_at_rest(&self, block: usize) -> PointRow {
        self.weight(block, self.weight_at_rest)
    }

    /// The aims that act on strands of a block in a frame; none if there are none.
    #[inline(always)]
    pub fn aimed(&self, block: usize, frame: u32) -> Option<&AimedBlock> {
        self.aimed.get(block)?.as_ref().filter(|aimed| aimed.acts(frame))
    }

    /// The places of the skin that carry the strands of a block; none without skin that moves.
    #[inline(always)]
    pub fn places(&self, block: &Block) -> &[SkinPlace] {
        let first = (block.first_strand as usize).min(self.places.len());
        &self.places[first..self.places.len().min(first + LANES)]
    }

    #[inline(always)]
    pub fn air(&self, at: usize) -> &AirRow {
        &self.airs[if self.airs.len() == 1 { 0 } else { at }]
    }
}
