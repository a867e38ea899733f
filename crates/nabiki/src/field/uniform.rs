//! One force everywhere: wind that a game can set before each step.

use glam::Vec3;

use super::Field;

/// The same force at every point and in every frame, until you change it.
///
/// A stepper uses the value at the time it is built as the bound. Later values must stay within
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
