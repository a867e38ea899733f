//! A fan: wind in a cone, such as that of a hair dryer or a wind machine.

use glam::Vec3;
use serde::{Deserialize, Serialize};

use super::falloff::{self, EnvelopeKey, Falloff};
use super::lanes::{self, Lanes, get, set};
use super::local::{self, check_place, unit};
use super::sine::cos_turns;
use super::{Field, VectorRow};
use crate::error::{SettingError, check_range};
use crate::vector::{dot, scale, subtract};

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
#[derive(Clone, Debug)]
pub struct FanField {
    name: String,
    settings: Fan,
    direction: [f32; 3],
    cos_spread: f32,
}

impl FanField {
    /// The field of a fan that is called `name` in refusals.
    ///
    /// # Errors
    /// As [`Fan::check`].
    pub fn new(settings: &Fan, name: &str) -> Result<Self, SettingError> {
        settings.check(name)?;
        let direction = unit(name, "direction", settings.direction)?.to_array();
        let cos_spread = cos_turns(f64::from(settings.spread) / 360.0) as f32;
        Ok(Self { name: name.to_owned(), settings: settings.clone(), direction, cos_spread })
    }

    fn in_frame(&self, frame: u32) -> InFrame {
        let Fan { position, strength, falloff, envelope, .. } = &self.settings;
        let core = Falloff::CORE * falloff.radius;
        InFrame {
            position: position.to_array(),
            direction: self.direction,
            cos_spread: self.cos_spread,
            sharpness: (1.0 - self.cos_spread).recip(),
            strength: strength * falloff::envelope(envelope, frame),
            falloff: *falloff,
            core_squared: core * core,
        }
    }
}

struct InFrame {
    position: [f32; 3],
    direction: [f32; 3],
    cos_spread: f32,
    /// 1 / (1 - cos spread).
    sharpness: f32,
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
            let r = subtract(get(points, lane), self.position);
            squares[lane] = dot(r, r);
            set(&mut forces, lane, r);
        }
        let parts = self.falloff.at_roots(&squares);
        for lane in 0..N {
            let r = get(&forces, lane);
            let inverse = (squares[lane] + self.core_squared).sqrt().recip();
            let cos = inverse * dot(r, self.direction);
            let short = (1.0 - (cos - self.cos_spread) * self.sharpness).clamp(0.0, 1.0);
            let cone = 1.0 - (short * short) * (short * short);
            set(&mut forces, lane, scale(self.strength * parts[lane] * cone * inverse, r));
        }
        forces
    }
}

impl Field for FanField {
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
