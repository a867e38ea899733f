//! The paper's form through the frames.

use std::sync::Arc;

use glam::Vec3;

use super::packed::{Packed, Plan};
use super::rows::SegmentState;
use crate::dynamics::stability::{Named, unstable};
use crate::dynamics::state::{Header, Reader, Writer};
use crate::dynamics::sweep::{Pages, sweep};
use crate::dynamics::{Dynamics, FrameInput, VectorWidth};
use crate::error::SettingError;
use crate::field::Field;
use crate::strands::Strands;

/// Some hair, and the frame that it is at.
#[derive(Clone, Debug)]
pub(in crate::dynamics) struct Runner {
    /// Shared by all clones.
    packed: Arc<Packed>,
    states: Vec<SegmentState>,
}

impl Runner {
    /// Bytes of a row of sixteen segments.
    pub const BYTES_A_ROW: usize = Packed::BYTES_A_ROW;

    /// Hair at rest in the given shape, whose settings have been checked; `ids` are the strands' numbers in the set they
    /// are some of.
    pub fn new(strands: &Strands, ids: &[u32], dynamics: &Dynamics) -> Result<Self, SettingError> {
        let packed = Arc::new(Packed::new(strands, ids, dynamics)?);
        Ok(Self { states: packed.states(), packed })
    }

    /// Refuses a field under which this hair cannot be stepped; `strands` are those that it was built from, `ids` their numbers.
    pub fn check_field(&self, strands: &Strands, ids: &[u32], field: &dyn Field) -> Result<(), SettingError> {
        match self.packed.is_stable(field) {
            true => Ok(()),
            false => Err(unstable(&[Named { name: "strand", strands, ids }], self.dynamics(), field)),
        }
    }

    pub fn dynamics(&self) -> &Dynamics {
        self.packed.dynamics()
    }

    /// The strongest force under which this hair can be stepped.
    pub fn strongest_force(&self) -> f32 {
        self.packed.strongest_force()
    }

    /// Whether both share everything that does not change from frame to frame.
    pub fn is_clone_of(&self, of: &Self) -> bool {
        Arc::ptr_eq(&self.packed, &of.packed)
    }

    /// Takes the state of the same hair.
    pub fn set_state(&mut self, of: &Self) {
        self.states.copy_from_slice(&of.states);
    }

    /// Identifies what it holds the state of.
    pub fn header(&self) -> Header {
        let numbers = (self.states.len() * SegmentState::NUMBERS) as u64;
        Header { is_free: false, numbers, hair: self.packed.identity(), ..Header::default() }
    }

    /// Writes its state.
    pub fn write(&self, writer: &mut Writer) {
        writer.rows(self.states.iter().flat_map(SegmentState::rows));
    }

    /// Takes a written state of the same hair.
    pub fn read(&mut self, reader: &mut Reader) {
        reader.rows(self.states.iter_mut().flat_map(SegmentState::rows_mut));
    }

    /// Puts the hair back to rest.
    pub fn rewind(&mut self, width: VectorWidth, page: &mut [Vec3]) {
        sweep(&*self.packed, &[self.packed.rest()], width, &mut self.states, Pages::Last(page));
    }

    /// Moves the hair by one frame.
    pub fn step(&mut self, input: &FrameInput, width: VectorWidth, page: &mut [Vec3]) {
        let plan = self.packed.plan(input);
        sweep(&*self.packed, &[plan], width, &mut self.states, Pages::Last(page));
    }

    /// Moves the hair through many frames, the first of them rest if `from_rest`.
    pub fn run(&mut self, from_rest: bool, inputs: &[FrameInput], width: VectorWidth, pages: Pages) {
        let steps = inputs.iter().map(|input| self.packed.plan(input));
        let plans: Vec<Plan> = from_rest.then(|| self.packed.rest()).into_iter().chain(steps).collect();
        sweep(&*self.packed, &plans, width, &mut self.states, pages);
    }
}
