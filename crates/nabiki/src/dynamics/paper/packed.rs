//! Hair packed into blocks for the paper's form, and the effect of a frame on a block.

use std::ops::Range;

use glam::Vec3;

use super::angles::direction_turns;
use super::force_source::{AnySource, ForceSource};
use super::kernel::{disturb_segment, step_segment};
use super::polar::PolarAxis;
use super::rows::{SegmentState, ShapeRow, extend};
use super::surroundings::Surroundings;
use crate::disturbance::Part;
use crate::dynamics::block::{Block, Pass};
use crate::dynamics::gain::{SegmentShape, segment_shapes};
use crate::dynamics::ride::skin_frames;
use crate::dynamics::row::{LANES, PointRow, Row, set_lane};
use crate::dynamics::stability::Stability;
use crate::dynamics::state::Identity;
use crate::dynamics::sweep::Swept;
use crate::dynamics::{Dynamics, FrameInput};
use crate::error::SettingError;
use crate::field::Field;
use crate::skin::{SkinFrame, SkinPlace};
use crate::strands::Strands;

/// Everything about hair that does not change from frame to frame.
#[derive(Clone, Debug)]
pub(super) struct Packed {
    dynamics: Dynamics,
    ids: Vec<u32>,
    surroundings: Surroundings,
    tilted: bool,
    stability: Stability,
    blocks: Vec<Block>,
    shapes: Vec<ShapeRow>,
    along: Vec<Row>,
    /// The places of the skin that carry the strands; empty without skin that moves.
    places: Vec<SkinPlace>,
    at_rest: Vec<SegmentState>,
}

impl Packed {
    /// Bytes of a row of sixteen segments, including its moving state.
    pub const BYTES_A_ROW: usize = size_of::<ShapeRow>() + size_of::<Row>() + 2 * size_of::<SegmentState>();

    /// Packs hair at rest in the given shape; `ids` are the strands' numbers in the set they are some of.
    pub fn new(strands: &Strands, ids: &[u32], dynamics: &Dynamics) -> Result<Self, SettingError> {
        let stability = Stability::of(strands, dynamics)?;
        let axis = PolarAxis::new(dynamics.polar_axis);
        let mut packed = Self {
            dynamics: dynamics.clone(),
            ids: ids.to_vec(),
            surroundings: Surroundings::new(dynamics, &axis),
            tilted: axis.is_tilted(),
            stability,
            blocks: Vec::with_capacity(strands.len().div_ceil(LANES)),
            shapes: Vec::new(),
            along: Vec::new(),
            places: Vec::new(),
            at_rest: Vec::new(),
        };
        for first in (0..strands.len()).step_by(LANES) {
            packed.pack(strands, first..strands.len().min(first + LANES), &axis)?;
        }
        if let Some(skin) = &dynamics.skin {
            packed.places = skin.places(strands.iter().map(|strand| strand[0]));
        }
        Ok(packed)
    }

    fn pack(&mut self, strands: &Strands, range: Range<usize>, axis: &PolarAxis) -> Result<(), SettingError> {
        let shapes: Vec<Vec<SegmentShape>> =
            range.clone().map(|s| segment_shapes(&self.dynamics, strands.strand(s), s, 0)).collect::<Result<_, _>>()?;
        let of_block = range.clone().zip(&shapes).map(|(s, shapes)| (strands.strand(s)[0], shapes.len()));
        let block = Block::new(range.start, self.shapes.len(), of_block);
        let rows = block.rows();
        self.shapes.resize(rows.end, ShapeRow::default());
        self.along.resize(rows.end, Row::default());
        self.at_rest.resize(rows.end, SegmentState::default());
        for (lane, (s, shapes)) in range.zip(&shapes).enumerate() {
            for (row, (shape, w)) in rows.clone().zip(shapes.iter().zip(strands.strand(s).windows(2))) {
                self.shapes[row].set(lane, shape);
                self.along[row].0[lane] = shape.along as f32;
                let direction = axis.polar_from_head() * (w[1].as_dvec3() - w[0].as_dvec3());
                let [theta, phi] = direction_turns(direction);
                self.at_rest[row].theta.set(lane, theta.map(|value| value as f32));
                self.at_rest[row].phi.set(lane, phi.map(|value| value as f32));
            }
        }
        self.blocks.push(block);
        Ok(())
    }

    /// Identifies this hair at rest, whatever moves it.
    pub fn identity(&self) -> u64 {
        let mut identity = Identity::new();
        self.blocks.iter().for_each(|block| block.identify(&mut identity));
        self.shapes.iter().for_each(|shape| identity.numbers(&shape.length.0));
        self.at_rest.iter().flat_map(SegmentState::rows).for_each(|row| identity.numbers(&row.0));
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
    pub fn states(&self) -> Vec<SegmentState> {
        self.at_rest.clone()
    }

    /// The effect of a frame on every block.
    pub fn plan<'a>(&'a self, input: &FrameInput<'a>) -> Plan<'a> {
        let source = AnySource::new(input, self.dynamics.motion.force_space, &self.surroundings);
        let disturbance = self.dynamics.disturbance.as_ref().and_then(|d| d.part(input.frame));
        let skin = skin_frames(&self.dynamics, input).map(|[now, before, _]| [now, before]);
        Plan::Step { source, disturbance, skin }
    }

    /// Puts every block to rest, as the skin is in frame 0.
    pub fn rest(&self) -> Plan<'_> {
        Plan::Rest(self.dynamics.skin.as_ref().map(|skin| skin.at(0)))
    }

    /// The roots of a block on skin of this shape.
    fn roots(&self, block: &Block, skin: Option<&SkinFrame>) -> PointRow {
        let mut roots = block.roots;
        if let Some(skin) = skin {
            let places = self.places.iter().skip(block.first_strand as usize).take(LANES);
            places
                .enumerate()
                .for_each(|(lane, place)| set_lane(&mut roots, lane, place.root(skin).as_vec3().to_array()));
        }
        roots
    }
}

/// The mode of a frame.
#[derive(Clone, Copy, Debug)]
pub(super) enum Plan<'a> {
    /// Hair is put back to rest, on skin of this shape.
    Rest(Option<&'a SkinFrame>),
    /// Hair moves, on skin of these shapes in this frame and in the frame before.
    Step { source: AnySource<'a>, disturbance: Option<Part>, skin: Option<[&'a SkinFrame; 2]> },
}

impl Swept for Packed {
    type State = SegmentState;
    type Plan<'a> = Plan<'a>;

    fn blocks(&self) -> &[Block] {
        &self.blocks
    }

    #[inline(always)]
    fn frame(&self, block: &Block, plan: &Plan<'_>, states: &mut [SegmentState], page: Option<&mut [Vec3]>) {
        if self.tilted {
            self.frame_about::<true>(block, plan, states, page);
        } else {
            self.frame_about::<false>(block, plan, states, page);
        }
    }
}

impl Packed {
    /// `TILTED`: whether the polar axis is not y.
    #[inline(always)]
    fn frame_about<const TILTED: bool>(
        &self,
        block: &Block,
        plan: &Plan,
        states: &mut [SegmentState],
        mut page: Option<&mut [Vec3]>,
    ) {
        match plan {
            Plan::Rest(skin) => {
                states.copy_from_slice(&self.at_rest[block.rows()]);
                if let Some(page) = page {
                    self.place::<TILTED>(block, &self.roots(block, *skin), states, page);
                }
            }
            Plan::Step { source, disturbance, skin } => {
                let roots = [0, 1].map(|back| self.roots(block, skin.map(|frames| frames[back])));
                let undisturbed = page.as_deref_mut().filter(|_| disturbance.is_none());
                match source {
                    AnySource::Uniform(source) => self.step::<TILTED>(block, &roots, source, states, undisturbed),
                    AnySource::Local(source) => self.step::<TILTED>(block, &roots, source, states, undisturbed),
                }
                if let Some(part) = disturbance {
                    self.disturb(block, part, states);
                    if let Some(page) = page {
                        self.place::<TILTED>(block, &roots[0], states, page);
                    }
                }
            }
        }
    }

    /// Moves a block by one frame, and writes its points where the caller wants them. `roots`: of this frame and of the frame before.
    #[inline(always)]
    fn step<const TILTED: bool>(
        &self,
        block: &Block,
        roots: &[PointRow; 2],
        source: &impl ForceSource,
        states: &mut [SegmentState],
        page: Option<&mut [Vec3]>,
    ) {
        // Local copies, so that they need not be read again at every segment.
        let (surroundings, source, before) = (self.surroundings, *source, roots[1]);
        block.walk(
            &roots[0],
            states,
            &self.shapes[block.rows()],
            page,
            Step::<TILTED, _> { surroundings, source, before },
        );
    }

    /// Turns every strand by its own angles (rad at the tip, less toward the root).
    #[inline(always)]
    fn disturb(&self, block: &Block, part: &Part, states: &mut [SegmentState]) {
        let Some(disturbance) = &self.dynamics.disturbance else { return };
        let (mut theta, mut phi) = (Row::default(), Row::default());
        for (lane, &id) in self.ids.iter().skip(block.first_strand as usize).take(LANES).enumerate() {
            [theta.0[lane], phi.0[lane]] = disturbance.turn(id, part);
        }
        for (state, along) in states.iter_mut().zip(&self.along[block.rows()]) {
            disturb_segment(state, &theta, &phi, along);
        }
    }

    /// Writes the points of the current angles.
    #[inline(always)]
    fn place<const TILTED: bool>(
        &self,
        block: &Block,
        roots: &PointRow,
        states: &mut [SegmentState],
        page: &mut [Vec3],
    ) {
        let surroundings = &self.surroundings;
        block.walk(roots, states, &self.shapes[block.rows()], Some(page), Place::<TILTED> { surroundings });
    }
}

struct Step<const TILTED: bool, W> {
    surroundings: Surroundings,
    source: W,
    before: PointRow,
}

impl<const TILTED: bool, W: ForceSource> Pass<SegmentState, ShapeRow> for Step<TILTED, W> {
    #[inline(always)]
    fn segment(
        &mut self,
        state: &mut SegmentState,
        shape: &ShapeRow,
        _: Option<(&SegmentState, &ShapeRow)>,
        from: &PointRow,
        to: &mut PointRow,
    ) {
        step_segment::<TILTED>(state, shape, &self.surroundings, &self.source, &mut self.before, from, to);
    }
}

struct Place<'a, const TILTED: bool> {
    surroundings: &'a Surroundings,
}

impl<const TILTED: bool> Pass<SegmentState, ShapeRow> for Place<'_, TILTED> {
    #[inline(always)]
    fn segment(
        &mut self,
        state: &mut SegmentState,
        shape: &ShapeRow,
        _: Option<(&SegmentState, &ShapeRow)>,
        from: &PointRow,
        to: &mut PointRow,
    ) {
        extend::<TILTED>(from, to, state, shape, self.surroundings);
    }
}
