//! A whirl about an axis.

use glam::Vec3;
use serde::{Deserialize, Serialize};

use super::falloff::{EnvelopeKey, Falloff};
use super::local::{self, LocalField, Shape, check_place, unit};
use crate::error::SettingError;
use crate::vector::cross;

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
pub type VortexField = LocalField<Round>;

/// Round an axis, of length 1.
#[derive(Clone, Copy, Debug)]
pub struct Round {
    axis: [f32; 3],
}

impl VortexField {
    /// The field of a vortex that is called `name` in refusals.
    ///
    /// # Errors
    /// As [`Vortex::check`].
    pub fn new(settings: &Vortex, name: &str) -> Result<Self, SettingError> {
        settings.check(name)?;
        let Vortex { position, axis, strength, falloff, envelope } = settings.clone();
        let shape = Round { axis: unit(name, "axis", axis)?.to_array() };
        Ok(Self { name: name.to_owned(), position, strength, falloff, envelope, shape })
    }
}

impl Shape for Round {
    /// As long as the distance from the axis, and across it.
    #[inline(always)]
    fn along(&self, from_place: [f32; 3]) -> [f32; 3] {
        cross(self.axis, from_place)
    }

    #[inline(always)]
    fn part(&self, _: [f32; 3], _: f32) -> f32 {
        1.0
    }
}
