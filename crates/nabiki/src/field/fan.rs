//! A fan: wind in a cone, such as that of a hair dryer or a wind machine.

use glam::Vec3;

use super::falloff::{self, EnvelopeKey, Falloff};
use super::local::{FARTHEST, LocalField, Shape, unit};
use super::sine::cos_turns;
use crate::error::SettingError;
use crate::setting::Place;
use crate::settings;
use crate::vector::dot;

settings! {
    /// A wind in a cone.
    pub struct Fan where blows_somewhere {
        /// Tip of the cone, in the space of the forces.
        pub position: Vec3 = Vec3::new(40.0, 0.0, 0.0) => "Position", must "[x, y, z]", unit "cm", least -FARTHEST, most FARTHEST;
        /// Direction of the wind. Any length except 0.
        pub direction: Vec3 = Vec3::NEG_X => "Direction", must "[x, y, z]";
        /// Strength |F| on the axis, close to the fan. Negative values draw air in.
        pub strength: f32 = 50.0 => "Strength";
        /// Angle between the axis and the edge of the cone.
        pub spread: f32 = 30.0 => "Spread", unit "degrees", least 1.0, most 90.0;
        /// How the force weakens with the distance. Within a twentieth of the radius it fades to 0.
        pub falloff: Falloff = Falloff::default() => "Falloff";
        /// Keyframes of the strength: the factor follows straight lines between them. Without keyframes, the strength
        /// is constant.
        pub envelope: Vec<EnvelopeKey> = Vec::new() => "Over time";
    }
}

impl Fan {
    fn blows_somewhere(&self, at: &Place) -> Result<(), SettingError> {
        unit(&at.key("direction"), self.direction)?;
        falloff::check_order(at, &self.envelope)
    }
}

/// A fan as a field.
pub type FanField = LocalField<Cone>;

/// The shape of a fan: away from the tip of a cone, and only within the cone.
#[derive(Clone, Copy, Debug)]
pub struct Cone {
    /// Of length 1.
    direction: [f32; 3],
    cos_spread: f32,
    /// 1 / (1 - cos spread).
    sharpness: f32,
}

impl FanField {
    /// The field of a fan. `name` is its name in errors.
    ///
    /// # Errors
    /// As for [`Fan::check_at`].
    pub fn new(settings: &Fan, name: &str) -> Result<Self, SettingError> {
        settings.check_at(name)?;
        let Fan { position, direction, strength, spread, falloff, envelope } = settings.clone();
        let cos_spread = cos_turns(f64::from(spread) / 360.0) as f32;
        let direction = unit(&Place::Table(name).key("direction"), direction)?.to_array();
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
