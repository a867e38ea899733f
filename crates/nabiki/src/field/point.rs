//! A point that pushes hair away or pulls it in.

use glam::Vec3;

use super::falloff::{self, EnvelopeKey, Falloff};
use super::local::{FARTHEST, LocalField, Shape};
use crate::error::SettingError;
use crate::setting::Place;
use crate::settings;

settings! {
    /// A point that pushes or pulls.
    pub struct Point where comes_in_order {
        /// Position, in the space of the forces.
        pub position: Vec3 = Vec3::new(-30.0, 0.0, 0.0) => "Position", must "[x, y, z]", unit "cm", least -FARTHEST, most FARTHEST;
        /// Strength |F| close to the point. Negative values pull.
        pub strength: f32 = 50.0 => "Strength";
        /// How the force weakens with the distance. Within a twentieth of the radius it fades to 0, since it has no
        /// direction at the centre.
        pub falloff: Falloff = Falloff::default() => "Falloff";
        /// Keyframes of the strength: the factor follows straight lines between them. Without keyframes, the strength
        /// is constant.
        pub envelope: Vec<EnvelopeKey> = Vec::new() => "Over time";
    }
}

impl Point {
    fn comes_in_order(&self, at: &Place) -> Result<(), SettingError> {
        falloff::check_order(at, &self.envelope)
    }
}

/// A point as a field.
pub type PointField = LocalField<Away>;

/// The shape of a point: straight away from it.
#[derive(Clone, Copy, Debug)]
pub struct Away;

impl PointField {
    /// The field of a point. `name` is its name in errors.
    ///
    /// # Errors
    /// As for [`Point::check_at`].
    pub fn new(settings: &Point, name: &str) -> Result<Self, SettingError> {
        settings.check_at(name)?;
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
