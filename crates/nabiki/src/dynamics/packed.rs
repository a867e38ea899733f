//! Hair packed into blocks, and the pass of all blocks through any number of frames, on all cores.

use glam::Vec3;
use pulp::NullaryFnOnce;

use super::angles::direction_turns;
use super::block::Block;
use super::gain::{SegmentShape, Stability, segment_shapes};
use super::kernel::{LANES, Row, SegmentState, ShapeRow};
use super::polar::PolarAxis;
use super::wind::{AnyWind, Surroundings, Wind};
use super::{Dynamics, FrameInput, VectorWidth};
use crate::disturbance::Part;
use crate::error::SettingError;
use crate::field::Field;
use crate::strands::Strands;

/// Blocks a core takes at a time where they go through one frame: enough to hide the hand-over, few enough to share
/// 300 strands.
const GRAIN: usize = 8;

/// Everything about hair that no frame changes.
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
    rest: Vec<SegmentState>,
}

impl Packed {
    /// Packs hair at rest in the given shape; `ids` are the strands' numbers in the set they are some of.
    pub fn new(strands: &Strands, ids: &[u32], dynamics: &Dynamics) -> Result<Self, SettingError> {
        assert_eq!(ids.len(), strands.len(), "one id for each strand");
        dynamics.check()?;
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
            rest: Vec::new(),
        };
        for first in (0..strands.len()).step_by(LANES) {
            packed.pack(strands, first..strands.len().min(first + LANES), &axis)?;
        }
        Ok(packed)
    }

    fn pack(&mut self, strands: &Strands, range: std::ops::Range<usize>, axis: &PolarAxis) -> Result<(), SettingError> {
        let shapes: Vec<Vec<SegmentShape>> =
            range.clone().map(|s| segment_shapes(&self.dynamics, strands.strand(s), s)).collect::<Result<_, _>>()?;
        let roots: Vec<Vec3> = range.clone().map(|s| strands.strand(s)[0]).collect();
        let block = Block::pack(range.start, &roots, &shapes, &mut self.shapes, &mut self.along);
        self.rest.resize(self.shapes.len(), SegmentState::default());
        for (lane, s) in range.enumerate() {
            for (state, w) in self.rest[block.rows()].iter_mut().zip(strands.strand(s).windows(2)) {
                let direction = axis.polar_from_head() * (w[1].as_dvec3() - w[0].as_dvec3());
                let [theta, phi] = direction_turns(direction);
                state.theta.set(lane, theta.map(|value| value as f32));
                state.phi.set(lane, phi.map(|value| value as f32));
            }
        }
        self.blocks.push(block);
        Ok(())
    }

    /// Refuses a field under which this hair cannot be stepped.
    pub fn check_field(&self, field: &dyn Field) -> Result<(), SettingError> {
        self.stability.check(field)
    }

    pub fn dynamics(&self) -> &Dynamics {
        &self.dynamics
    }

    pub fn ids(&self) -> &[u32] {
        &self.ids
    }

    /// Room for the state of every segment.
    pub fn states(&self) -> Vec<SegmentState> {
        self.rest.clone()
    }

    /// What a frame does to every block.
    pub fn plan<'a>(&self, input: &FrameInput<'a>) -> Plan<'a> {
        let wind = AnyWind::new(input, self.dynamics.motion.force_space, &self.surroundings);
        let disturbance = self.dynamics.disturbance.as_ref().and_then(|d| d.part(input.frame));
        Plan::Step { wind, disturbance }
    }

    /// Takes every block through all `plans`, one block after another, so that its states stay in the nearest cache.
    pub fn sweep(&self, plans: &[Plan], width: VectorWidth, states: &mut [SegmentState], pages: Pages) {
        let grain = (GRAIN / plans.len().max(1)).max(1);
        Sweep { packed: self, plans, width, grain }.split(&self.blocks, states, pages);
    }
}

/// What becomes of the hair in one frame.
#[derive(Clone, Copy, Debug)]
pub(super) enum Plan<'a> {
    /// It is put back to rest.
    Rest,
    /// It moves.
    Step { wind: AnyWind<'a>, disturbance: Option<Part> },
}

/// Where points go to.
pub(super) enum Pages<'a> {
    /// Those of the last frame, and of no other.
    Last(&'a mut [Vec3]),
    /// Those of each frame.
    All(Vec<&'a mut [Vec3]>),
}

impl<'a> Pages<'a> {
    /// The first `points` points of each page, and the others.
    fn split(self, points: usize) -> (Self, Self) {
        match self {
            Self::Last(page) => {
                let (near, far) = page.split_at_mut(points);
                (Self::Last(near), Self::Last(far))
            }
            Self::All(pages) => {
                let (near, far) = pages.into_iter().map(|page| page.split_at_mut(points)).unzip();
                (Self::All(near), Self::All(far))
            }
        }
    }

    /// Some points of frame `n` of `count`, if they are wanted.
    #[inline(always)]
    fn page(&mut self, n: usize, count: usize, points: std::ops::Range<usize>) -> Option<&mut [Vec3]> {
        match self {
            Self::Last(page) if n + 1 == count => Some(&mut page[points]),
            Self::Last(_) => None,
            Self::All(pages) => Some(&mut pages[n][points]),
        }
    }
}

/// One pass over all blocks, halved between cores until a piece is small.
#[derive(Clone, Copy)]
struct Sweep<'a> {
    packed: &'a Packed,
    plans: &'a [Plan<'a>],
    width: VectorWidth,
    grain: usize,
}

impl Sweep<'_> {
    fn split(self, blocks: &[Block], states: &mut [SegmentState], pages: Pages) {
        if blocks.len() <= self.grain {
            return self.run(Piece { sweep: self, blocks, states, pages });
        }
        let (near, far) = blocks.split_at(blocks.len() / 2);
        let (near_states, far_states) = states.split_at_mut(near.iter().map(|b| b.segments as usize).sum());
        let (near_pages, far_pages) = pages.split(near.iter().map(Block::point_count).sum());
        rayon::join(|| self.split(near, near_states, near_pages), || self.split(far, far_states, far_pages));
    }

    fn run(self, piece: Piece) {
        match self.width {
            VectorWidth::Widest => pulp::Arch::new().dispatch(piece),
            #[cfg(target_arch = "x86_64")]
            VectorWidth::Medium => match pulp::x86::V3::try_new() {
                Some(simd) => simd.vectorize(piece),
                None => piece.call(),
            },
            #[cfg(not(target_arch = "x86_64"))]
            VectorWidth::Medium => pulp::Arch::new().dispatch(piece),
            VectorWidth::Baseline => piece.call(),
        }
    }
}

/// Some blocks with their states and points, for one core.
struct Piece<'a> {
    sweep: Sweep<'a>,
    blocks: &'a [Block],
    states: &'a mut [SegmentState],
    pages: Pages<'a>,
}

impl NullaryFnOnce for Piece<'_> {
    type Output = ();

    #[inline(always)]
    fn call(mut self) {
        let plans = self.sweep.plans;
        let (mut states, mut first_point) = (self.states, 0);
        for block in self.blocks {
            let (mine, others) = states.split_at_mut(block.segments as usize);
            let points = first_point..first_point + block.point_count();
            (states, first_point) = (others, points.end);
            for (n, plan) in plans.iter().enumerate() {
                let page = self.pages.page(n, plans.len(), points.clone());
                if self.sweep.packed.tilted {
                    self.sweep.frame::<true>(block, plan, mine, page);
                } else {
                    self.sweep.frame::<false>(block, plan, mine, page);
                }
            }
        }
    }
}

impl Sweep<'_> {
    /// Takes one block through one frame.
    #[inline(always)]
    fn frame<const TILTED: bool>(
        &self,
        block: &Block,
        plan: &Plan,
        states: &mut [SegmentState],
        mut page: Option<&mut [Vec3]>,
    ) {
        let packed = self.packed;
        match plan {
            Plan::Rest => {
                states.copy_from_slice(&packed.rest[block.rows()]);
                if let Some(page) = page {
                    block.place::<TILTED>(states, &packed.shapes[block.rows()], &packed.surroundings, page);
                }
            }
            Plan::Step { wind, disturbance } => {
                let undisturbed = page.as_deref_mut().filter(|_| disturbance.is_none());
                match wind {
                    AnyWind::Uniform(wind) => self.step::<TILTED>(block, wind, states, undisturbed),
                    AnyWind::Local(wind) => self.step::<TILTED>(block, wind, states, undisturbed),
                }
                if let Some(part) = disturbance {
                    self.disturb::<TILTED>(block, part, states, page);
                }
            }
        }
    }

    #[inline(always)]
    fn step<const TILTED: bool>(
        &self,
        block: &Block,
        wind: &impl Wind,
        states: &mut [SegmentState],
        page: Option<&mut [Vec3]>,
    ) {
        let packed = self.packed;
        block.step::<TILTED>(states, &packed.shapes[block.rows()], &packed.surroundings, wind, page);
    }

    #[inline(always)]
    fn disturb<const TILTED: bool>(
        &self,
        block: &Block,
        part: &Part,
        states: &mut [SegmentState],
        page: Option<&mut [Vec3]>,
    ) {
        let packed = self.packed;
        if let Some(disturbance) = &packed.dynamics.disturbance {
            let ids = packed.ids.iter().skip(block.first_strand as usize);
            block.disturb(states, &packed.along[block.rows()], ids.map(|&id| disturbance.turn(id, part)));
        }
        if let Some(page) = page {
            block.place::<TILTED>(states, &packed.shapes[block.rows()], &packed.surroundings, page);
        }
    }
}
