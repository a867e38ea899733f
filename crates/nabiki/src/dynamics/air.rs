//! The air at a point, as the f64 steppers evaluate it.

use super::{ForceSpace, FrameInput};
use crate::scalar::Vector;

/// The force in one frame.
pub(super) trait Air<S> {
    /// F(n + 1) at a point, both in head space.
    fn force(&self, at: Vector<S>) -> Vector<S>;
}

/// The field of a frame, in its own space.
pub(super) struct Breeze<'a> {
    pub input: &'a FrameInput<'a>,
    pub space: ForceSpace,
}

impl Air<f64> for Breeze<'_> {
    fn force(&self, at: Vector<f64>) -> Vector<f64> {
        let FrameInput { frame, pose, field, .. } = self.input;
        let point = at.value();
        let force = match self.space {
            ForceSpace::Head => field.at(point.as_vec3(), *frame).as_dvec3(),
            ForceSpace::World => {
                let rotation = pose.rotation.as_dquat();
                let in_world = rotation * point + pose.position_cm.as_dvec3();
                rotation.inverse() * field.at(in_world.as_vec3(), *frame).as_dvec3()
            }
        };
        force.into()
    }
}
