//! Hair of either form through the frames.

use glam::Vec3;

use super::state::{Header, Reader, Writer};
use super::sweep::Pages;
use super::{Dynamics, Form, FrameInput, VectorWidth, free, paper};
use crate::error::SettingError;
use crate::field::Field;
use crate::strands::Strands;

/// Some hair, and the frame that it is at.
#[derive(Clone, Debug)]
pub(super) struct Runner {
    form: OfForm,
    ids: Vec<u32>,
}

#[derive(Clone, Debug)]
enum OfForm {
    Paper(Box<paper::Runner>),
    Free(Box<free::Runner>),
}

impl Runner {
    /// Hair at rest in the given shape; `ids` are the strands' numbers in the set they are some of.
    pub fn new(strands: &Strands, ids: &[u32], dynamics: &Dynamics, field: &dyn Field) -> Result<Self, SettingError> {
        assert_eq!(ids.len(), strands.len(), "one id for each strand");
        Self::beside(strands, ids, dynamics, field, None)
    }

    /// The same hair, at rest, with other settings; `strands` are those that it was built from.
    pub fn with_dynamics(
        &self,
        strands: &Strands,
        dynamics: &Dynamics,
        field: &dyn Field,
    ) -> Result<Self, SettingError> {
        let known = match &self.form {
            OfForm::Free(runner) => Some(&**runner),
            OfForm::Paper(_) => None,
        };
        Self::beside(strands, &self.ids, dynamics, field, known)
    }

    fn beside(
        strands: &Strands,
        ids: &[u32],
        dynamics: &Dynamics,
        field: &dyn Field,
        known: Option<&free::Runner>,
    ) -> Result<Self, SettingError> {
        dynamics.check()?;
        let form = match &dynamics.form {
            Form::Paper => OfForm::Paper(Box::new(paper::Runner::new(strands, ids, dynamics)?)),
            Form::Free(free) => OfForm::Free(Box::new(free::Runner::new(strands, dynamics, free, known)?)),
        };
        let runner = Self { form, ids: ids.to_vec() };
        runner.check_field(strands, field)?;
        Ok(runner)
    }

    /// Refuses a field under which this hair cannot be stepped; `strands` are those that it was built from.
    pub fn check_field(&self, strands: &Strands, field: &dyn Field) -> Result<(), SettingError> {
        match &self.form {
            OfForm::Paper(runner) => runner.check_field(strands, &self.ids, field),
            OfForm::Free(runner) => runner.check_field(strands, &self.ids, field),
        }
    }

    pub fn dynamics(&self) -> &Dynamics {
        match &self.form {
            OfForm::Paper(runner) => runner.dynamics(),
            OfForm::Free(runner) => runner.dynamics(),
        }
    }

    /// The strongest force under which this hair can be stepped.
    pub fn strongest_force(&self) -> f32 {
        match &self.form {
            OfForm::Paper(runner) => runner.strongest_force(),
            OfForm::Free(runner) => runner.strongest_force(),
        }
    }

    /// The carriers' grid in the current frame; none if hair feels no neighbours.
    pub fn crowd(&self) -> Option<&free::Crowd> {
        match &self.form {
            OfForm::Paper(_) => None,
            OfForm::Free(runner) => runner.crowd(),
        }
    }

    /// Takes the state of the same hair, even with other settings, and shows its points, `shown`. No change if it is refused.
    pub fn set_state(
        &mut self,
        of: &Self,
        width: VectorWidth,
        points: &mut [Vec3],
        shown: &[Vec3],
    ) -> Result<(), SettingError> {
        let are_clones = match (&self.form, &of.form) {
            (OfForm::Paper(runner), OfForm::Paper(of)) => runner.is_clone_of(of),
            (OfForm::Free(runner), OfForm::Free(of)) => runner.is_clone_of(of),
            _ => false,
        };
        let headers = (!are_clones).then(|| (self.header(points), of.header(shown)));
        if let Some((own, other)) = &headers {
            other.check(own)?;
        }
        match (&mut self.form, &of.form) {
            (OfForm::Paper(runner), OfForm::Paper(of)) => runner.set_state(of),
            (OfForm::Free(runner), OfForm::Free(of)) => runner.set_state(of, headers.as_ref(), width),
            // Already refused above.
            _ => {}
        }
        points.copy_from_slice(shown);
        Ok(())
    }

    /// Its state as bytes, with the frame and the shown points.
    pub fn state_bytes(&self, frame: u32, points: &[Vec3]) -> Vec<u8> {
        let mut writer = Writer::new(&Header { frame, ..self.header(points) });
        writer.points(points);
        match &self.form {
            OfForm::Paper(runner) => runner.write(&mut writer),
            OfForm::Free(runner) => runner.write(&mut writer),
        }
        writer.finish()
    }

    /// Takes the state from such bytes, and returns their frame. No change if they are refused.
    pub fn set_state_bytes(
        &mut self,
        bytes: &[u8],
        width: VectorWidth,
        points: &mut [Vec3],
    ) -> Result<u32, SettingError> {
        let own = self.header(points);
        let mut reader = Reader::new(bytes, &own)?;
        reader.points(points);
        match &mut self.form {
            OfForm::Paper(runner) => runner.read(&mut reader),
            OfForm::Free(runner) => runner.read(&mut reader, &own, width),
        }
        Ok(reader.header.frame)
    }

    fn header(&self, points: &[Vec3]) -> Header {
        let header = match &self.form {
            OfForm::Paper(runner) => runner.header(),
            OfForm::Free(runner) => runner.header(),
        };
        Header { points: points.len() as u32, numbers: header.numbers + 3 * points.len() as u64, ..header }
    }

    /// The head or a body jumped to where it is in the next step.
    pub fn jumped(&mut self) {
        match &mut self.form {
            // The paper's form has no bodies.
            OfForm::Paper(_) => {}
            OfForm::Free(runner) => runner.jumped(),
        }
    }

    /// Puts the hair back to rest.
    pub fn rewind(&mut self, width: VectorWidth, page: &mut [Vec3]) {
        match &mut self.form {
            OfForm::Paper(runner) => runner.rewind(width, page),
            OfForm::Free(runner) => runner.rewind(width, page),
        }
    }

    /// Moves the hair by one frame.
    pub fn step(&mut self, input: &FrameInput, width: VectorWidth, page: &mut [Vec3]) {
        match &mut self.form {
            OfForm::Paper(runner) => runner.step(input, width, page),
            OfForm::Free(runner) => runner.step(input, width, page),
        }
    }

    /// Moves the hair through many frames, the first of them rest if `from_rest`.
    pub fn run(&mut self, from_rest: bool, inputs: &[FrameInput], width: VectorWidth, pages: Pages) {
        match &mut self.form {
            OfForm::Paper(runner) => runner.run(from_rest, inputs, width, pages),
            OfForm::Free(runner) => runner.run(from_rest, inputs, width, pages),
        }
    }
}
