//! The common part of point, vortex and fan.

use std::fmt::Debug;

use glam::Vec3;

use super::falloff::{self, EnvelopeKey, Falloff};
use super::lanes::{self, Lanes, get, set};
use super::{Field, VectorRow};
use crate::error::SettingError;
use crate::setting::{Key, Place};
use crate::vector::{dot, scale, subtract};

#[cfg(test)]
mod tests;

/// Largest coordinate of a local field along an axis (cm), so that squares of distances fit in f32.
pub(super) const FARTHEST: f64 = 1e6;

/// A direction of length 1.
///
/// # Errors
/// Names `at`, where it has none.
pub(super) fn unit(at: &Place, direction: Vec3) -> Result<Vec3, SettingError> {
    let unit = direction.as_dvec3().try_normalize().map(|unit| unit.as_vec3());
    unit.ok_or_else(|| SettingError::new(Key::from(at), direction, "must be a direction, not (0, 0, 0)"))
}

/// The shape of a local field.
pub trait Shape: Copy + Debug + Send + Sync {
    /// A vector along F at a point `from_place` away from the field's position. Its length is the distance for the
    /// falloff.
    fn along(&self, from_place: [f32; 3]) -> [f32; 3];

    /// The factor on the strength there, 0..1. It takes `along` and 1 over its length, which goes to 0 at the core.
    fn part(&self, along: [f32; 3], inverse: f32) -> f32;
}

/// A force around a position: F = strength falloff(r) part(r^) r^.
#[derive(Clone, Debug)]
pub struct LocalField<S> {
    pub(super) name: String,
    pub(super) position: Vec3,
    pub(super) strength: f32,
    pub(super) falloff: Falloff,
    pub(super) envelope: Vec<EnvelopeKey>,
    pub(super) shape: S,
}

impl<S: Shape> LocalField<S> {
    fn in_frame(&self, frame: u32) -> InFrame<S> {
        let core = Falloff::CORE * self.falloff.radius;
        InFrame {
            position: self.position.to_array(),
            strength: self.strength * falloff::envelope(&self.envelope, frame),
            falloff: self.falloff,
            // Above 0 for any radius: at the centre of a smaller one F would be 0 times infinity.
            core_squared: (core * core).max(f32::MIN_POSITIVE),
            shape: self.shape,
        }
    }
}

struct InFrame<S> {
    position: [f32; 3],
    strength: f32,
    falloff: Falloff,
    core_squared: f32,
    shape: S,
}

impl<S: Shape> Lanes for InFrame<S> {
    #[allow(clippy::needless_range_loop, reason = "a loop over lanes, as in the kernel")]
    #[inline(always)]
    fn forces<const N: usize>(&self, points: &[[f32; N]; 3]) -> [[f32; N]; 3] {
        let mut forces = [[0.0; N]; 3];
        let mut squares = [0.0; N];
        for lane in 0..N {
            let along = self.shape.along(subtract(get(points, lane), self.position));
            squares[lane] = dot(along, along);
            set(&mut forces, lane, along);
        }
        let parts = self.falloff.at_roots(&squares);
        for lane in 0..N {
            let along = get(&forces, lane);
            let inverse = (squares[lane] + self.core_squared).sqrt().recip();
            let size = self.strength * parts[lane] * self.shape.part(along, inverse) * inverse;
            set(&mut forces, lane, scale(size, along));
        }
        forces
    }
}

impl<S: Shape> Field for LocalField<S> {
    fn at(&self, point: Vec3, frame: u32) -> Vec3 {
        lanes::at(&self.in_frame(frame), point)
    }

    fn at_row(&self, points: &VectorRow, frame: u32, forces: &mut VectorRow) {
        lanes::at_row(&self.in_frame(frame), points, forces);
    }

    fn strongest(&self) -> f32 {
        // A little more, for the rounding of r^.
        self.strength.abs() * falloff::largest(&self.envelope) * (1.0 + 1e-6)
    }

    fn first_above(&self, limit: f64) -> Option<(String, String)> {
        let above = f64::from(self.strongest()) > limit;
        above.then(|| (format!("{}.strength", self.name), self.strength.to_string()))
    }

    fn uniform(&self, frame: u32) -> Option<Vec3> {
        (self.in_frame(frame).strength == 0.0).then_some(Vec3::ZERO)
    }
}
