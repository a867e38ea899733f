//! The fast stepper: f32, blocks of sixteen strands, the widest vectors of the machine, all cores.

use glam::Vec3;
use pulp::Arch;

use super::row::LANES;
use super::runner::Runner;
use super::{Dynamics, Form, FrameInput, Stepper, free, paper};
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

impl VectorWidth {
    /// What of the machine has vectors so wide. All that is stepped is dispatched by this one, so that it is compiled once for each.
    pub(super) fn arch(self) -> Arch {
        match self {
            Self::Widest => Arch::new(),
            #[cfg(target_arch = "x86_64")]
            Self::Medium => pulp::x86::V3::try_new().map_or(Arch::Scalar, Arch::V3),
            #[cfg(not(target_arch = "x86_64"))]
            Self::Medium => Arch::new(),
            Self::Baseline => Arch::Scalar,
        }
    }
}

/// The fast stepper, twin of [`Reference`](super::Reference): one frame at a time, none of them kept.
///
/// Nothing is allocated in a step. Threads are those of the rayon pool that calls; called from outside of any, rayon's global
/// pool is started, and the caller waits for it. To hand a call to a pool from outside, as
/// [`install`](rayon::ThreadPool::install) does, too, is rayon's work, and allocates once in some forty times. An engine that
/// must not steps on threads of its pool, or on one of its own that it made a pool of one (`num_threads(1).use_current_thread()`,
/// see [`ThreadPoolBuilder`](rayon::ThreadPoolBuilder::use_current_thread)): then no other thread takes part.
///
/// A clone moves by itself. What no frame changes is shared by all clones, so that many heads of the same groom cost little more
/// than what moves, and a clone is a saved state: see [`set_state`](Self::set_state).
///
/// `crates/nabiki/examples/engine.rs` steps hair in an engine's loop, and docs/engine.md has all that such a loop should know.
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

    /// Bytes of memory that it takes at least to move this hair.
    #[must_use]
    pub fn least_bytes(strands: &Strands, dynamics: &Dynamics) -> u64 {
        let row = match dynamics.form {
            Form::Paper => paper::Runner::BYTES_A_ROW,
            Form::Free(_) => free::Runner::BYTES_A_ROW,
        };
        let rows = strands.segment_count().div_ceil(LANES);
        (rows * row + size_of_val(strands.points())) as u64
    }

    /// The same simulation with vectors of another width.
    #[must_use]
    pub fn with_vector_width(mut self, width: VectorWidth) -> Self {
        self.width = width;
        self
    }

    /// How the hair moves.
    #[must_use]
    pub fn dynamics(&self) -> &Dynamics {
        self.runner.dynamics()
    }

    /// The strongest |F| (in the unit of forces) with which the step is stable: what a field that changes at run time must not
    /// exceed, since a step does not look. Of the hair's carriers, too.
    #[must_use]
    pub fn strongest_force(&self) -> f32 {
        self.runner.strongest_force()
    }

    /// Stands where `of` stands, without an allocation: to save a state into a clone, to restore it, and to go on under other settings
    /// than those of `of`, with which this was built of the same hair. To the bit if the settings are the same. Points
    /// written by [`step_frame_into`](Self::step_frame_into) are the caller's, and not part of it.
    ///
    /// What is tied here lies as at rest from the next step on, and carriers that `of` has not begin at rest. That hair is the same
    /// takes some milliseconds to see, where neither is a clone of the other, or of the same simulation.
    ///
    /// # Errors
    /// Other hair at rest, or hair of the other form of the motion, as [`set_state_bytes`](Self::set_state_bytes) refuses it. Nothing is
    /// changed then.
    pub fn set_state(&mut self, of: &Self) -> Result<(), SettingError> {
        self.runner.set_state(&of.runner, self.width, self.strands.points_mut(), of.strands.points())?;
        self.frame = of.frame;
        Ok(())
    }

    /// Where it stands, as bytes: for a saved game, another machine, the report of a crash. Of 3,000 strands of 18 segments 2.4 MB
    /// among neighbours.
    ///
    /// They hold the frame, the points that [`strands`](Stepper::strands) shows and what moves, and neither hair nor settings.
    #[must_use]
    pub fn state_bytes(&self) -> Vec<u8> {
        self.runner.state_bytes(self.frame, self.strands.points())
    }

    /// The same for whoever steps by [`step_frame_into`](Self::step_frame_into) and has the points of this frame: what is set to these
    /// bytes shows them.
    ///
    /// # Panics
    /// If there are not just as many points.
    #[must_use]
    pub fn state_bytes_showing(&self, points: &[Vec3]) -> Vec<u8> {
        assert_eq!(points.len(), self.strands.points().len(), "a frame has every point");
        self.runner.state_bytes(self.frame, points)
    }

    /// Stands where the simulation of the same hair stood that gave these [`state_bytes`](Self::state_bytes): to the bit if its
    /// settings are the same, too. Settings may be others; what is tied then is at rest, and carriers that were not there before are.
    ///
    /// # Errors
    /// Bytes that are none of these, cut or altered; the state of other hair at rest (be it in one point or in the order of its strands),
    /// of the other form of the motion, or of another [`METHOD_VERSION`](crate::METHOD_VERSION). Nothing is changed then. Whoever can
    /// write bytes can also put hair anywhere with them: that they are whole does not say where they come from.
    pub fn set_state_bytes(&mut self, bytes: &[u8]) -> Result<(), SettingError> {
        self.frame = self.runner.set_state_bytes(bytes, self.width, self.strands.points_mut())?;
        Ok(())
    }

    /// Says that the head came at once where it is in the next step, whose [`FrameInput::before`] is that place, too. Among bodies
    /// that do not go with the head hair would else not look for contact there, until it moves; nor after a
    /// [`rewind`](Self::rewind) in such a place. It changes nothing else, and costs that step some distances.
    pub fn jumped(&mut self) {
        self.runner.jumped();
    }

    /// Puts the hair back to rest, at frame 0; [`strands`](Stepper::strands) shows it. Nothing is allocated.
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
