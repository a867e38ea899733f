//! The axis from which theta is measured.
//!
//! The paper's y is the vertical, and its head stands upright and still. Equations (1) and (2) treat that axis unlike
//! all others, so it matters what becomes of it where a head is tilted: the vertical of frame 0 is taken, and goes with
//! the head from there on. So a head that stands still has the paper's axis however it is tilted, and hair that
//! nothing pulls on is carried rigidly by a head that turns, which a vertical fixed in the world would not allow.

use glam::{DMat3, DQuat, DVec3, Vec3};

/// An axis this close to y (rad) is y: poses are f32.
const UPRIGHT: f64 = 1e-6;

/// The polar axis of the equations in head space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::dynamics) struct PolarAxis {
    polar_from_head: DMat3,
}

impl PolarAxis {
    /// `axis`: of any finite length except 0 (head space).
    pub fn new(axis: Vec3) -> Self {
        let axis = axis.as_dvec3().normalize();
        if axis.x.hypot(axis.z) <= UPRIGHT && axis.y > 0.0 {
            return Self { polar_from_head: DMat3::IDENTITY };
        }
        // Equations (1) and (2) are invariant under turns about the axis, so any rotation that takes it to y will do.
        Self { polar_from_head: DMat3::from_quat(DQuat::from_rotation_arc(axis, DVec3::Y)) }
    }

    /// The rotation from head space to the space whose y is the axis.
    pub fn polar_from_head(&self) -> DMat3 {
        self.polar_from_head
    }

    /// Whether the axis is not y.
    pub fn is_tilted(&self) -> bool {
        self.polar_from_head != DMat3::IDENTITY
    }
}
