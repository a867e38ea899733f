//! One force everywhere: wind that a game sets from step to step.

use glam::Vec3;

use super::Field;

/// The same force at every point and in every frame, until it is set anew.
///
/// A stepper that it is given when it is built bounds it by what it is then; what it is set to later is to stay within
/// [`Simulation::strongest_force`](crate::dynamics::Simulation::strongest_force).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct UniformField(pub Vec3);

impl Field for UniformField {
    fn at(&self, _point: Vec3, _frame: u32) -> Vec3 {
        self.0
    }

    fn strongest(&self) -> f32 {
        self.0.length()
    }

    fn uniform(&self, _frame: u32) -> Option<Vec3> {
        Some(self.0)
    }
}
