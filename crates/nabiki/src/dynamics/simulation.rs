//! The fast stepper: f32, blocks of sixteen strands, the widest vectors of the machine, all cores.

use glam::Vec3;
use pulp::Arch;

use super::row::LANES;
use super::runner::Runner;
use super::{Dynamics, Form, FrameInput, Stepper, free, paper};
use crate::error::SettingError;
use crate::field::Field;
use crate::strands::Strands;

/// Width of the SIMD vectors. The results are the same, bit by bit, with any width.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum VectorWidth {
    /// The widest vectors of this machine.
    #[default]
    Widest,
    /// At most 256 bits (AVX2 with fused multiply-add on x86-64).
    Medium,
    /// The vectors that every machine of the target has. Slow on x86-64, where fused multiply-adds are then computed in
    /// software.
    Baseline,
}

impl VectorWidth {
    /// CPU features for vectors of this width. All stepping is dispatched here, so it is compiled once for each.
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

/// The fast stepper, twin of [`Reference`](super::Reference). It computes one frame at a time and keeps none.
///
/// A step allocates nothing. It runs on the rayon pool of the calling thread. If you call it from outside a pool, rayon
/// starts its global pool and the caller waits. Handing a call to a pool from outside, as
/// [`install`](rayon::ThreadPool::install) also does, is rayon's work, and allocates about once in 40 calls. An engine
/// that must never allocate can step on a thread of its pool, or make one of its threads a pool of one
/// (`num_threads(1).use_current_thread()`, see [`ThreadPoolBuilder`](rayon::ThreadPoolBuilder::use_current_thread)):
/// then no other thread takes part.
///
/// A clone is independent. Clones share everything that no frame changes, so many heads with the same groom need little
/// more memory than their moving state. A clone can also serve as a saved state: see [`set_state`](Self::set_state).
///
/// `crates/nabiki/examples/engine.rs` steps hair in the loop of an engine. docs/engine.md explains what such a loop
/// must do.
#[derive(Clone, Debug)]
pub struct Simulation {
    runner: Runner,
    width: VectorWidth,
    frame: u32,
    strands: Strands,
}

impl Simulation {
    /// Hair at rest in this shape, at frame 0, to be moved by `field`.
    ///
    /// # Errors
    /// Settings out of range, no strands, strands with a segment that has no direction, and a field too strong for the
    /// step: c_i |F| must stay below 4.
    pub fn new(strands: &Strands, dynamics: &Dynamics, field: &dyn Field) -> Result<Self, SettingError> {
        let ids: Vec<u32> = (0..strands.len() as u32).collect();
        Self::with_ids(strands, &ids, dynamics, field)
    }

    /// Like [`new`](Self::new), for a part of a larger set of strands. `ids` are their indices in that set; they get
    /// the same disturbances as there.
    ///
    /// # Errors
    /// As for [`new`](Self::new).
    ///
    /// # Panics
    /// If the number of ids is not the number of strands.
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

    /// The least memory for moving this hair (bytes).
    #[must_use]
    pub fn least_bytes(strands: &Strands, dynamics: &Dynamics) -> u64 {
        let row = match &dynamics.form {
            Form::Paper => paper::Runner::BYTES_A_ROW,
            Form::Free(free) => free::Runner::bytes_a_row(free.aims.len()),
        };
        let rows = strands.segment_count().div_ceil(LANES);
        (rows * row + size_of_val(strands.points())) as u64
    }

    /// The same simulation with another vector width.
    #[must_use]
    pub fn with_vector_width(mut self, width: VectorWidth) -> Self {
        self.width = width;
        self
    }

    /// The settings of the motion.
    #[must_use]
    pub fn dynamics(&self) -> &Dynamics {
        self.runner.dynamics()
    }

    /// The largest |F| with which the step is stable, for the hair and its carriers. A field that changes at run time
    /// must not exceed it, because a step does not check.
    #[must_use]
    pub fn strongest_force(&self) -> f32 {
        self.runner.strongest_force()
    }

    /// Copies the state of `of` without allocating: to save a state into a clone, to restore it, or to continue under
    /// other settings than those of `of`, if this simulation was built with them from the same hair. With the same
    /// settings, the state is the same bit by bit. Points written by [`step_frame_into`](Self::step_frame_into) belong
    /// to the caller and are not copied.
    ///
    /// Hair that is tied only here is at rest from the next step on. Carriers that `of` does not have start at rest.
    /// Unless one is a clone of the other, or both are clones of the same simulation, comparing the hair takes some
    /// milliseconds.
    ///
    /// # Errors
    /// If the hair at rest or the form of the motion differs, as in [`set_state_bytes`](Self::set_state_bytes). Nothing
    /// is changed then.
    pub fn set_state(&mut self, of: &Self) -> Result<(), SettingError> {
        self.runner.set_state(&of.runner, self.width, self.strands.points_mut(), of.strands.points())?;
        self.frame = of.frame;
        Ok(())
    }

    /// The state as bytes: for a saved game, another machine, or a crash report. For 3,000 strands of 18 segments with
    /// neighbour forces it is 2.4 MB.
    ///
    /// The bytes contain the frame, the points of [`strands`](Stepper::strands) and the moving state, but neither hair
    /// nor settings.
    #[must_use]
    pub fn state_bytes(&self) -> Vec<u8> {
        self.runner.state_bytes(self.frame, self.strands.points())
    }

    /// Like [`state_bytes`](Self::state_bytes), if you step with [`step_frame_into`](Self::step_frame_into) and hold
    /// the points of this frame. A simulation that is set to these bytes shows them.
    ///
    /// # Panics
    /// If the number of points is wrong.
    #[must_use]
    pub fn state_bytes_showing(&self, points: &[Vec3]) -> Vec<u8> {
        assert_eq!(points.len(), self.strands.points().len(), "a frame has every point");
        self.runner.state_bytes(self.frame, points)
    }

    /// Restores [`state_bytes`](Self::state_bytes) of a simulation of the same hair, bit by bit if its settings are the
    /// same, too. Settings may differ: hair that is newly tied, and carriers that are new, then start at rest.
    ///
    /// # Errors
    /// Bytes that are no state, truncated or altered; the state of other hair at rest (if one point or the order of
    /// strands differs), of the other form of the motion, or of another [`METHOD_VERSION`](crate::METHOD_VERSION).
    /// Nothing is changed then. The checksum detects damage, not forgery: somebody who can write the bytes can move the
    /// hair anywhere.
    pub fn set_state_bytes(&mut self, bytes: &[u8]) -> Result<(), SettingError> {
        self.frame = self.runner.set_state_bytes(bytes, self.width, self.strands.points_mut())?;
        Ok(())
    }

    /// Call this before a step in which the head jumps, with [`FrameInput::before`] set to the new pose as well. Near
    /// bodies that do not move with the head, the hair would otherwise not test contact there until it moves. Also call
    /// it after a [`rewind`](Self::rewind) in such a place. It changes nothing else. The next step takes slightly
    /// longer.
    pub fn jumped(&mut self) {
        self.runner.jumped();
    }

    /// Puts the hair back to rest, at frame 0, without allocating. [`strands`](Stepper::strands) then shows it.
    pub fn rewind(&mut self) {
        self.runner.rewind(self.width, self.strands.points_mut());
        self.frame = 0;
    }

    /// Advances by one step, to the frame of `input`, and writes the points to the caller's storage in the order of
    /// [`Strands::points`], so that you can pass frames on without a copy. [`strands`](Stepper::strands) keeps showing
    /// the earlier points.
    ///
    /// # Panics
    /// If the number of points is wrong.
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
