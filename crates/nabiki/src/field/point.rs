//! A point that blows hair away from itself, or draws it in.

use glam::Vec3;
use serde::{Deserialize, Serialize};

use super::falloff::{EnvelopeKey, Falloff};
use super::local::{self, LocalField, Shape, check_place};
use crate::error::SettingError;

/// The settings of a point: F = strength falloff(r) r^, away from it.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Point {
    /// Where it is (cm; the space of the forces).
    pub position: Vec3,
    /// |F| beside the point; negative draws in (default 50).
    #[serde(default = "local::strength")]
    pub strength: f32,
    /// How it weakens with the distance. Within a twentieth of its radius the direction, which has no meaning at the
    /// centre, is let go to 0.
    #[serde(default)]
    pub falloff: Falloff,
    /// Parts of the strength over time (default: all of it always).
    #[serde(default)]
    pub envelope: Vec<EnvelopeKey>,
}

impl Point {
    /// Refuses what is out of its range. `name` is what the point is called.
    ///
    /// # Errors
    /// Names the first such setting.
    pub fn check(&self, name: &str) -> Result<(), SettingError> {
        check_place(name, self.position, self.strength, &self.falloff, &self.envelope)
    }
}

/// A point as a field.
pub type PointField = LocalField<Away>;

/// Straight away from the place.
#[derive(Clone, Copy, Debug)]
pub struct Away;

impl PointField {
    /// The field of a point that is called `name` in refusals.
    ///
    /// # Errors
    /// As [`Point::check`].
    pub fn new(settings: &Point, name: &str) -> Result<Self, SettingError> {
        settings.check(name)?;
        let Point { position, strength, falloff, envelope } = settings.clone();
        Ok(Self { name: name.to_owned(), position, strength, falloff, envelope, shape: Away })
    }
}

impl Shape for Away {
    #[inline(always)]
    fn along(&self, from_place: [f32; 3]) -> [f32; 3] {
        from_place
    }

    #[inline(always)]
    fn part(&self, _: [f32; 3], _: f32) -> f32 {
        1.0
    }
}
