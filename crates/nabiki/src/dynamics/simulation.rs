//! The fast stepper: f32, blocks of sixteen strands, the widest vectors of the machine, all cores.

use glam::Vec3;

use super::runner::Runner;
use super::{Dynamics, FrameInput, Stepper};
use crate::error::SettingError;
use crate::field::Field;
use crate::strands::Strands;

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

/// The fast stepper, twin of [`Reference`](super::Reference): one frame at a time, none of them kept.
///
/// Nothing is allocated in a step. Threads are those of the rayon pool that calls.
#[derive(Clone, Debug)]
pub struct Simulation {
    runner: Runner,
    width: VectorWidth,
    frame: u32,
    strands: Strands,
}

impl Simulation {
    /// Hair at rest in the given shape, at frame 0, that `field` will move.
    ///
    /// # Errors
    /// Settings out of range, no strands, strands without a direction in each segment, and a field too strong for
    /// the step: c_i |F| must stay below 4.
    pub fn new(strands: &Strands, dynamics: &Dynamics, field: &dyn Field) -> Result<Self, SettingError> {
        let ids: Vec<u32> = (0..strands.len() as u32).collect();
        Self::with_ids(strands, &ids, dynamics, field)
    }

    /// As [`new`](Self::new), for strands that are some of a larger set: `ids` are their numbers in it, so that
    /// they are disturbed as they are there.
    ///
    /// # Errors
    /// As [`new`](Self::new).
    ///
    /// # Panics
    /// If there are not as many ids as strands.
    pub fn with_ids(
        strands: &Strands,
        ids: &[u32],
        dynamics: &Dynamics,
        field: &dyn Field,
    ) -> Result<Self, SettingError> {
        let runner = Runner::new(strands, ids, dynamics, field)?;
        let mut simulation = Self { runner, width: VectorWidth::default(), frame: 0, strands: strands.clone() };
        simulation.rewind();
        Ok(simulation)
    }

    /// The same simulation with vectors of another width.
    pub fn with_vector_width(mut self, width: VectorWidth) -> Self {
        self.width = width;
        self
    }

    /// Puts the hair back to rest, at frame 0.
    pub fn rewind(&mut self) {
        self.runner.rewind(self.width, self.strands.points_mut());
        self.frame = 0;
    }

    /// Advances by one step, to the frame of `input`, and writes the points into storage of the caller's, as
    /// [`Strands::points`] orders them: for frames that are handed on without a copy. [`strands`](Stepper::strands) goes on
    /// showing what it showed.
    ///
    /// # Panics
    /// If there is not room for just these points.
    pub fn step_frame_into(&mut self, input: &FrameInput, points: &mut [Vec3]) {
        assert_eq!(points.len(), self.strands.points().len(), "a frame has room for every point");
        self.runner.step(input, self.width, points);
        self.frame = input.frame;
    }
}

impl Stepper for Simulation {
    fn step_frame(&mut self, input: &FrameInput) {
        self.runner.step(input, self.width, self.strands.points_mut());
        self.frame = input.frame;
    }

    fn frame(&self) -> u32 {
        self.frame
    }

    fn strands(&self) -> &Strands {
        &self.strands
    }
}
