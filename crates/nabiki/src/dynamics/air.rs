//! The air at a point, as the f64 steppers evaluate it.

use glam::{DVec3, Vec3};

use super::{ForceSpace, FrameInput};
use crate::region::FieldShares;
use crate::scalar::Vector;

/// The force in one frame.
pub(super) trait Air<S> {
    /// F(n + 1) at a point, both in head space, on a strand with these shares in the fields.
    fn force(&self, at: Vector<S>, shares: &FieldShares) -> Vector<S>;
}

/// The field of a frame, in its own space.
pub(super) struct Breeze<'a> {
    pub input: &'a FrameInput<'a>,
    pub space: ForceSpace,
}

impl Breeze<'_> {
    /// The force at a point, both in the space of the field.
    fn at(&self, point: Vec3, shares: &FieldShares) -> DVec3 {
        let FrameInput { frame, field, .. } = *self.input;
        let force = match shares.is_empty() {
            true => field.at(point, frame),
            false => field.at_shared(point, frame, &|name| shares.of(name)),
        };
        force.as_dvec3()
    }
}

impl Air<f64> for Breeze<'_> {
    fn force(&self, at: Vector<f64>, shares: &FieldShares) -> Vector<f64> {
        let pose = &self.input.pose;
        let point = at.value();
        let force = match self.space {
            ForceSpace::Head => self.at(point.as_vec3(), shares),
            ForceSpace::World => {
                let rotation = pose.rotation.as_dquat();
                let in_world = rotation * point + pose.position_cm.as_dvec3();
                rotation.inverse() * self.at(in_world.as_vec3(), shares)
            }
        };
        force.into()
    }
}
