//! The f64 stepper: the specification of either form.

use glam::DVec3;

use super::{Dynamics, Form, FrameInput, Stepper, free, paper};
use crate::error::SettingError;
use crate::field::Field;
use crate::scalar::Vector;
use crate::strands::Strands;

/// The scalar f64 stepper, twin of [`Simulation`](super::Simulation). A clone is independent, so it can serve as a
/// saved state.
#[derive(Clone, Debug)]
pub struct Reference(Twin);

#[derive(Clone, Debug)]
enum Twin {
    Paper(Box<paper::Reference>),
    Free(Box<free::Reference>),
}

impl Reference {
    /// Hair at rest in this shape, at frame 0. See [`Simulation::new`](super::Simulation::new).
    ///
    /// # Errors
    /// As for [`Simulation::new`](super::Simulation::new).
    pub fn new(strands: &Strands, dynamics: &Dynamics, field: &dyn Field) -> Result<Self, SettingError> {
        let ids: Vec<u32> = (0..strands.len() as u32).collect();
        Self::with_ids(strands, &ids, dynamics, field)
    }

    /// Like [`new`](Self::new), for a part of a larger set of strands: `ids` are their indices in that set.
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
        assert_eq!(ids.len(), strands.len(), "one id for each strand");
        dynamics.check()?;
        Ok(Self(match &dynamics.form {
            Form::Paper => Twin::Paper(Box::new(paper::Reference::new(strands, ids, dynamics, field)?)),
            Form::Free(free) => Twin::Free(Box::new(free::Reference::new(strands, dynamics, free, field)?)),
        }))
    }

    /// The points of all strands in f64, as [`Strands::points`] orders them (head space, cm).
    pub fn positions(&self) -> &[DVec3] {
        match &self.0 {
            Twin::Paper(twin) => twin.positions(),
            Twin::Free(twin) => twin.positions(),
        }
    }
}

/// Shows the state of a twin: `points` in f64, and rounded as the points of `strands`.
pub(super) fn publish<'a>(
    points: impl Iterator<Item = &'a Vector<f64>>,
    positions: &mut [DVec3],
    strands: &mut Strands,
) {
    for ((position, point), p) in positions.iter_mut().zip(strands.points_mut()).zip(points) {
        *position = p.value();
        *point = position.as_vec3();
    }
}

impl Stepper for Reference {
    fn step_frame(&mut self, input: &FrameInput) {
        match &mut self.0 {
            Twin::Paper(twin) => twin.step_frame(input),
            Twin::Free(twin) => twin.step_frame(input),
        }
    }

    fn frame(&self) -> u32 {
        match &self.0 {
            Twin::Paper(twin) => twin.frame(),
            Twin::Free(twin) => twin.frame(),
        }
    }

    fn strands(&self) -> &Strands {
        match &self.0 {
            Twin::Paper(twin) => twin.strands(),
            Twin::Free(twin) => twin.strands(),
        }
    }
}
