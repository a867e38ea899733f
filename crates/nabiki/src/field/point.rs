//! A point that blows hair away from itself, or draws it in.

use glam::Vec3;

use super::falloff::{self, EnvelopeKey, Falloff};
use super::local::{FARTHEST, LocalField, Shape};
use crate::error::SettingError;
use crate::setting::Place;
use crate::settings;

settings! {
    /// A point that blows or draws.
    pub struct Point where comes_in_order {
        /// Where it is, in the space of the forces.
        pub position: Vec3 = Vec3::new(-30.0, 0.0, 0.0) => "Position", must "[x, y, z]", unit "cm", least -FARTHEST, most FARTHEST;
        /// |F| beside the point; negative draws in.
        pub strength: f32 = 50.0 => "Strength";
        /// How it weakens with the distance. Within a twentieth of its radius the direction, which has no meaning at the
        /// centre, is let go to 0.
        pub falloff: Falloff = Falloff::default() => "Falloff";
        /// Parts of the strength over frames, on straight lines from key to key; all of it always without keys.
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

/// Straight away from the place.
#[derive(Clone, Copy, Debug)]
pub struct Away;

impl PointField {
    /// The field of a point that is called `name` in refusals.
    ///
    /// # Errors
    /// As [`Point::check_at`].
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
