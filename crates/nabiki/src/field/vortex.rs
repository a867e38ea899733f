//! A whirl about an axis.

use glam::Vec3;
use serde::{Deserialize, Serialize};

use super::falloff::{self, EnvelopeKey, Falloff};
use super::lanes::{self, Lanes, get, set};
use super::local::{self, check_place, unit};
use super::{Field, VectorRow};
use crate::error::SettingError;
use crate::vector::{cross, dot, scale, subtract};

/// The settings of a vortex: F = strength falloff(r) (axis x r^), where r leads from the axis to the point.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Vortex {
    /// A point of the axis (cm; the space of the forces).
    pub position: Vec3,
    /// Along the axis, of any length but 0 (default y): hair goes round it counter-clockwise as seen from its tip.
    #[serde(default = "local::up")]
    pub axis: Vec3,
    /// |F| beside the axis; negative goes round the other way (default 50).
    #[serde(default = "local::strength")]
    pub strength: f32,
    /// How it weakens with the distance from the axis. Within a twentieth of its radius it is let go to 0.
    #[serde(default)]
    pub falloff: Falloff,
    /// Parts of the strength over time (default: all of it always).
    #[serde(default)]
    pub envelope: Vec<EnvelopeKey>,
}

impl Vortex {
    /// Refuses what is out of its range. `name` is what the vortex is called.
    ///
    /// # Errors
    /// Names the first such setting.
    pub fn check(&self, name: &str) -> Result<(), SettingError> {
        check_place(name, self.position, self.strength, &self.falloff, &self.envelope)?;
        unit(name, "axis", self.axis).map(drop)
    }
}

/// A vortex as a field.
#[derive(Clone, Debug)]
pub struct VortexField {
    name: String,
    settings: Vortex,
    axis: [f32; 3],
}

impl VortexField {
    /// The field of a vortex that is called `name` in refusals.
    ///
    /// # Errors
    /// As [`Vortex::check`].
    pub fn new(settings: &Vortex, name: &str) -> Result<Self, SettingError> {
        settings.check(name)?;
        let axis = unit(name, "axis", settings.axis)?;
        Ok(Self { name: name.to_owned(), settings: settings.clone(), axis: axis.to_array() })
    }

    fn in_frame(&self, frame: u32) -> InFrame {
        let Vortex { position, strength, falloff, envelope, .. } = &self.settings;
        let core = Falloff::CORE * falloff.radius;
        InFrame {
            position: position.to_array(),
            axis: self.axis,
            strength: strength * falloff::envelope(envelope, frame),
            falloff: *falloff,
            core_squared: core * core,
        }
    }
}

struct InFrame {
    position: [f32; 3],
    axis: [f32; 3],
    strength: f32,
    falloff: Falloff,
    core_squared: f32,
}

impl Lanes for InFrame {
    #[allow(clippy::needless_range_loop, reason = "a loop over lanes, as in the kernel")]
    #[inline(always)]
    fn forces<const N: usize>(&self, points: &[[f32; N]; 3]) -> [[f32; N]; 3] {
        let mut forces = [[0.0; N]; 3];
        let mut squares = [0.0; N];
        for lane in 0..N {
            // As long as the distance from the axis, and across it.
            let round = cross(self.axis, subtract(get(points, lane), self.position));
            squares[lane] = dot(round, round);
            set(&mut forces, lane, round);
        }
        let parts = self.falloff.at_roots(&squares);
        for lane in 0..N {
            let size = self.strength * parts[lane] / (squares[lane] + self.core_squared).sqrt();
            let force = scale(size, get(&forces, lane));
            set(&mut forces, lane, force);
        }
        forces
    }
}

impl Field for VortexField {
    fn at(&self, point: Vec3, frame: u32) -> Vec3 {
        lanes::at(&self.in_frame(frame), point)
    }

    fn at_row(&self, points: &VectorRow, frame: u32, forces: &mut VectorRow) {
        lanes::at_row(&self.in_frame(frame), points, forces);
    }

    fn strongest(&self) -> f32 {
        local::strongest(self.settings.strength, &self.settings.envelope)
    }

    fn first_above(&self, limit: f64) -> Option<(String, String)> {
        local::first_above(&self.name, self.settings.strength, &self.settings.envelope, limit)
    }

    fn uniform(&self, frame: u32) -> Option<Vec3> {
        (self.in_frame(frame).strength == 0.0).then_some(Vec3::ZERO)
    }
}
