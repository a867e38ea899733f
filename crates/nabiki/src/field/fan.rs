//! A fan: wind in a cone, such as that of a hair dryer or a wind machine.

use glam::Vec3;
use serde::{Deserialize, Serialize};

use super::falloff::{EnvelopeKey, Falloff};
use super::local::{self, LocalField, Shape, check_place, unit};
use super::sine::cos_turns;
use crate::error::{SettingError, check_range};
use crate::vector::dot;

/// The settings of a fan: F = strength falloff(r) cone(angle) r^, away from it and only within its cone.
///
/// With c = (cos angle - cos spread) / (1 - cos spread), 1 on the axis and 0 at the edge, cone is 1 - (1 - c)^4 of it: nearly
/// all of the strength over the inner half of the cone, and none beyond its edge.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Fan {
    /// The tip of the cone (cm; the space of the forces).
    pub position: Vec3,
    /// Where it blows, of any length but 0.
    pub direction: Vec3,
    /// |F| on the axis beside the fan; negative draws in (default 50).
    #[serde(default = "local::strength")]
    pub strength: f32,
    /// Angle between the axis and the edge of the cone (degrees), 1..90 (default 30).
    #[serde(default = "spread")]
    pub spread: f32,
    /// How it weakens with the distance. Within a twentieth of its radius it is let go to 0.
    #[serde(default)]
    pub falloff: Falloff,
    /// Parts of the strength over time (default: all of it always).
    #[serde(default)]
    pub envelope: Vec<EnvelopeKey>,
}

fn spread() -> f32 {
    30.0
}

impl Fan {
    /// Refuses what is out of its range. `name` is what the fan is called.
    ///
    /// # Errors
    /// Names the first such setting.
    pub fn check(&self, name: &str) -> Result<(), SettingError> {
        check_place(name, self.position, self.strength, &self.falloff, &self.envelope)?;
        unit(name, "direction", self.direction)?;
        check_range(&format!("{name}.spread"), self.spread, 1.0, 90.0)
    }
}

/// A fan as a field.
pub type FanField = LocalField<Cone>;

/// Away from the tip of a cone, and only within it.
#[derive(Clone, Copy, Debug)]
pub struct Cone {
    /// Of length 1.
    direction: [f32; 3],
    cos_spread: f32,
    /// 1 / (1 - cos spread).
    sharpness: f32,
}

impl FanField {
    /// The field of a fan that is called `name` in refusals.
    ///
    /// # Errors
    /// As [`Fan::check`].
    pub fn new(settings: &Fan, name: &str) -> Result<Self, SettingError> {
        settings.check(name)?;
        let Fan { position, direction, strength, spread, falloff, envelope } = settings.clone();
        let cos_spread = cos_turns(f64::from(spread) / 360.0) as f32;
        let direction = unit(name, "direction", direction)?.to_array();
        let shape = Cone { direction, cos_spread, sharpness: (1.0 - cos_spread).recip() };
        Ok(Self { name: name.to_owned(), position, strength, falloff, envelope, shape })
    }
}

impl Shape for Cone {
    #[inline(always)]
    fn along(&self, from_place: [f32; 3]) -> [f32; 3] {
        from_place
    }

    #[inline(always)]
    fn part(&self, along: [f32; 3], inverse: f32) -> f32 {
        let cos = inverse * dot(along, self.direction);
        let short = (1.0 - (cos - self.cos_spread) * self.sharpness).clamp(0.0, 1.0);
        1.0 - (short * short) * (short * short)
    }
}
