//! A vortex around an axis.

use glam::Vec3;

use super::falloff::{self, EnvelopeKey, Falloff};
use super::local::{FARTHEST, LocalField, Shape, unit};
use crate::error::SettingError;
use crate::setting::Place;
use crate::settings;
use crate::vector::cross;

settings! {
    /// A vortex: a force around an axis.
    pub struct Vortex where has_an_axis {
        /// A point of the axis, in the space of the forces.
        pub position: Vec3 = Vec3::new(-20.0, 0.0, 0.0) => "Position", must "[x, y, z]", unit "cm", least -FARTHEST, most FARTHEST;
        /// Direction of the axis, of any length except 0. Hair goes around it counter-clockwise as seen from its tip.
        pub axis: Vec3 = Vec3::Y => "Axis";
        /// Strength |F| close to the axis. Negative values turn the other way.
        pub strength: f32 = 50.0 => "Strength";
        /// How the force weakens with the distance from the axis. Within a twentieth of the radius it fades to 0.
        pub falloff: Falloff = Falloff::default() => "Falloff";
        /// Keyframes of the strength: the factor follows straight lines between them. Without keyframes, the strength
        /// is constant.
        pub envelope: Vec<EnvelopeKey> = Vec::new() => "Over time";
    }
}

impl Vortex {
    fn has_an_axis(&self, at: &Place) -> Result<(), SettingError> {
        unit(&at.key("axis"), self.axis)?;
        falloff::check_order(at, &self.envelope)
    }
}

/// A vortex as a field.
pub type VortexField = LocalField<Round>;

/// The shape of a vortex: around an axis of length 1.
#[derive(Clone, Copy, Debug)]
pub struct Round {
    axis: [f32; 3],
}

impl VortexField {
    /// The field of a vortex. `name` is its name in errors.
    ///
    /// # Errors
    /// As for [`Vortex::check_at`].
    pub fn new(settings: &Vortex, name: &str) -> Result<Self, SettingError> {
        settings.check_at(name)?;
        let Vortex { position, axis, strength, falloff, envelope } = settings.clone();
        let shape = Round { axis: unit(&Place::Table(name).key("axis"), axis)?.to_array() };
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
