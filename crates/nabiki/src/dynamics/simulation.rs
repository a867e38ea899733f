//! The fast stepper: f32, blocks of sixteen strands, the widest vectors of the machine, all cores.

use glam::Vec3;
use pulp::NullaryFnOnce;

use super::angles::from_direction;
use super::block::{Block, ShapeTable};
use super::gain::{SegmentShape, check_stability, segment_shapes};
use super::kernel::{LANES, SegmentState, Wind};
use super::{Dynamics, Stepper};
use crate::error::SettingError;
use crate::strands::Strands;

/// Blocks a core takes at a time: enough to hide the hand-over, few enough to share 300 strands.
const GRAIN: usize = 8;

/// Vectors to step with; the bits are the same with any.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum VectorWidth {
    /// The widest this machine has.
    #[default]
    Widest,
    /// At most 256 bits (AVX2 with fused multiply-add, on x86-64).
    Medium,
    /// What every machine of the target has. Slow on x86-64, where fused multiply-adds are then computed in software.
    Baseline,
}

/// The fast stepper, twin of [`Reference`](super::Reference).
///
/// Nothing is allocated in a step. Threads are those of the rayon pool that calls.
#[derive(Clone)]
pub struct Simulation {
    dynamics: Dynamics,
    /// The parts of each strand's length at which its segments end; empty without a disturbance.
    along: Vec<f32>,
    ids: Vec<u32>,
    blocks: Vec<Block>,
    table: ShapeTable,
    states: Vec<SegmentState>,
    width: VectorWidth,
    frame: u32,
    strands: Strands,
}

impl Simulation {
    /// Hair at rest in the given shape, at frame 0.
    ///
    /// # Errors
    /// Settings out of range, no strands, strands without a direction in each segment, and a field too strong for
    /// the step: c_i |F| must stay below 4.
    pub fn new(strands: &Strands, dynamics: &Dynamics) -> Result<Self, SettingError> {
        let ids: Vec<u32> = (0..strands.len() as u32).collect();
        Self::with_ids(strands, &ids, dynamics)
    }

    /// As [`new`](Self::new), for strands that are some of a larger set: `ids` are their numbers in it, so that
    /// they are disturbed as they are there.
    ///
    /// # Errors
    /// As [`new`](Self::new).
    ///
    /// # Panics
    /// If there are not as many ids as strands.
    pub fn with_ids(strands: &Strands, ids: &[u32], dynamics: &Dynamics) -> Result<Self, SettingError> {
        assert_eq!(ids.len(), strands.len(), "one id for each strand");
        dynamics.check()?;
        if strands.is_empty() {
            return Err(SettingError::new("hair", "0 strands", "there is nothing to move; give at least one strand"));
        }
        check_stability(strands, dynamics)?;
        let mut simulation = Self {
            dynamics: dynamics.clone(),
            along: Vec::new(),
            ids: ids.to_vec(),
            blocks: Vec::with_capacity(strands.len().div_ceil(LANES)),
            table: ShapeTable::default(),
            states: Vec::new(),
            width: VectorWidth::default(),
            frame: 0,
            strands: strands.clone(),
        };
        for first in (0..strands.len()).step_by(LANES) {
            simulation.pack(first..strands.len().min(first + LANES))?;
        }
        simulation.place();
        Ok(simulation)
    }

    /// The same simulation with vectors of another width.
    pub fn with_vector_width(mut self, width: VectorWidth) -> Self {
        self.width = width;
        self
    }

    fn pack(&mut self, range: std::ops::Range<usize>) -> Result<(), SettingError> {
        let shapes: Vec<Vec<SegmentShape>> = range
            .clone()
            .map(|s| segment_shapes(&self.dynamics, self.strands.strand(s), s))
            .collect::<Result<_, _>>()?;
        let roots: Vec<Vec3> = range.clone().map(|s| self.strands.strand(s)[0]).collect();
        let block = Block::new(&roots, &shapes, &mut self.table);
        let start = self.states.len();
        self.states.resize(start + block.segments as usize, SegmentState::default());
        for (lane, s) in range.enumerate() {
            for (i, w) in self.strands.strand(s).windows(2).enumerate() {
                let direction = w[1].as_dvec3() - w[0].as_dvec3();
                let (theta, phi) = from_direction(direction, self.dynamics.motion.straighten_rad());
                let state = &mut self.states[start + i];
                (state.theta.0[lane], state.phi.0[lane]) = (theta as f32, phi as f32);
            }
            if self.dynamics.disturbance.is_some() {
                self.along.extend(shapes[lane].iter().map(|shape| shape.along as f32));
            }
        }
        self.blocks.push(block);
        Ok(())
    }

    /// Turns every strand a little where the disturbance falls on this frame.
    fn disturb(&mut self) -> bool {
        let Some(disturbance) = self.dynamics.disturbance.as_ref().filter(|d| d.falls_on(self.frame)) else {
            return false;
        };
        let mut states = self.states.as_mut_slice();
        for (b, block) in self.blocks.iter().enumerate() {
            let (mine, others) = states.split_at_mut(block.segments as usize);
            states = others;
            for (lane, &id) in self.ids.iter().skip(b * LANES).take(LANES).enumerate() {
                let s = b * LANES + lane;
                let points = self.strands.range(s);
                let [theta, phi] = disturbance.turn(id, self.frame);
                for (state, along) in mine.iter_mut().zip(&self.along[points.start - s..points.end - s - 1]) {
                    state.theta.0[lane] += theta * along;
                    state.phi.0[lane] += phi * along;
                }
            }
        }
        true
    }

    fn place(&mut self) {
        self.sweep(None);
    }

    /// Steps every block under the wind, or only writes its points.
    fn sweep(&mut self, wind: Option<Wind>) {
        let sweep = Sweep { table: &self.table, wind, width: self.width };
        sweep.split(&self.blocks, &mut self.states, self.strands.points_mut());
    }
}

impl Stepper for Simulation {
    fn step_frame(&mut self) {
        self.step_frame_under(self.dynamics.field.at(self.frame + 1));
    }

    fn step_frame_under(&mut self, force_in_head: Vec3) {
        self.sweep(Some(Wind::new(force_in_head, &self.dynamics.gamma())));
        self.frame += 1;
        if self.disturb() {
            self.place();
        }
    }

    fn frame(&self) -> u32 {
        self.frame
    }

    fn strands(&self) -> &Strands {
        &self.strands
    }
}

/// One pass over all blocks, halved between cores until a piece is small.
#[derive(Clone, Copy)]
struct Sweep<'a> {
    table: &'a ShapeTable,
    wind: Option<Wind>,
    width: VectorWidth,
}

impl Sweep<'_> {
    fn split(self, blocks: &[Block], states: &mut [SegmentState], points: &mut [Vec3]) {
        if blocks.len() <= GRAIN {
            return self.run(Piece { sweep: self, blocks, states, points });
        }
        let (near, far) = blocks.split_at(blocks.len() / 2);
        let (near_states, far_states) = states.split_at_mut(near.iter().map(|b| b.segments as usize).sum());
        let (near_points, far_points) = points.split_at_mut(near.iter().map(Block::point_count).sum());
        rayon::join(|| self.split(near, near_states, near_points), || self.split(far, far_states, far_points));
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
    points: &'a mut [Vec3],
}

impl NullaryFnOnce for Piece<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let (mut states, mut points) = (self.states, self.points);
        for block in self.blocks {
            let (mine, other_states) = states.split_at_mut(block.segments as usize);
            let (my_points, other_points) = points.split_at_mut(block.point_count());
            match &self.sweep.wind {
                Some(wind) => block.step(mine, self.sweep.table, wind, my_points),
                None => block.place(mine, self.sweep.table, my_points),
            }
            (states, points) = (other_states, other_points);
        }
    }
}
