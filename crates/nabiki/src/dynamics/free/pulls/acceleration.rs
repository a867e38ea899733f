//! Acceleration of the head, felt as a force the other way that hangs on the place alone: nothing for the check of stability.

use glam::{DAffine3, Vec3};

use super::at::At;
use crate::dynamics::row::rotate;
use crate::scalar::{Scalar, Vector};
use crate::vector::add;

#[inline(always)]
pub fn force<S: Scalar>(at: &At<S>) -> Vector<S> {
    match &at.head.felt {
        Some(felt) => at.end.taken_by(felt),
        None => Vector::zero(),
    }
}

/// The force at a point: columns of a matrix, and what it has in the origin.
#[derive(Clone, Copy, Debug)]
pub struct Felt {
    columns: [[f32; 3]; 3],
    constant: [f32; 3],
}

impl From<DAffine3> for Felt {
    fn from(felt: DAffine3) -> Self {
        let constant: Vec3 = felt.translation.as_vec3();
        Self { columns: felt.matrix3.as_mat3().to_cols_array_2d(), constant: constant.to_array() }
    }
}

impl Felt {
    /// The force on one lane.
    #[inline(always)]
    pub fn force_lane(&self, p: [f32; 3]) -> [f32; 3] {
        add(rotate(&self.columns, p), self.constant)
    }
}
