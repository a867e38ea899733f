//! Settings of the light: `[[picture.lights]]` and `[picture.sky]`.

use nabiki::SettingError;
use nabiki::error::check_range;
use serde::{Deserialize, Serialize};

use super::check_colour;

/// What a lamp's direction is relative to.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum LightSpace {
    /// The camera: azimuth 0 comes from where the camera stands, and a moving camera carries its lamps with it. They stay
    /// in the world when the head turns.
    #[default]
    Camera,
    /// The world: azimuth 0 is the world's +x, before the face of a head that has not turned.
    World,
    /// The head: azimuth 0 comes from before the face, and the lamps turn with the head.
    Head,
}

/// What the sky is fixed to.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum SkySpace {
    /// The world: it stays above when the head turns.
    #[default]
    World,
    /// The head: it turns with the head.
    Head,
}

/// One lamp, far away: an element of `[[picture.lights]]`.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields, default)]
pub struct Light {
    /// Where the light comes from, about the vertical (degrees), counted as the camera's azimuth. Default 0.
    pub azimuth: f32,
    /// Where it comes from, above the horizon (degrees, -90..90). Default 40.
    pub elevation: f32,
    /// Its strength: a white surface facing it is as bright as this. 0..1000, default 1.
    pub strength: f32,
    /// Its colour (linear red, green, blue; 0..1). Default white.
    pub colour: [f32; 3],
    /// How far the lamp spreads as seen from the hair (degrees, 0..45): wide lamps throw soft shadows. Default 4.
    pub spread: f32,
    /// `"camera"` (default), `"world"` or `"head"`.
    pub space: LightSpace,
}

impl Default for Light {
    fn default() -> Self {
        Self { azimuth: 0.0, elevation: 40.0, strength: 1.0, colour: [1.0; 3], spread: 4.0, space: LightSpace::Camera }
    }
}

impl Light {
    /// A portrait photographer's four lamps: a warm key from above, a weak cool fill, and two kickers from behind that edge the hair.
    pub fn studio() -> Vec<Self> {
        let lamp = |azimuth, elevation, strength, colour, spread| Self {
            azimuth,
            elevation,
            strength,
            colour,
            spread,
            ..Self::default()
        };
        vec![
            lamp(32.0, 48.0, 3.1, [1.0, 0.96, 0.91], 6.0),
            lamp(-50.0, 14.0, 0.5, [0.92, 0.96, 1.0], 20.0),
            lamp(168.0, 40.0, 1.0, [1.0, 0.97, 0.94], 9.0),
            lamp(-130.0, 28.0, 0.85, [0.92, 0.96, 1.0], 9.0),
        ]
    }

    pub(crate) fn check(&self, table: &str) -> Result<(), SettingError> {
        check_range(&format!("{table}.azimuth"), self.azimuth, -3600.0, 3600.0)?;
        check_range(&format!("{table}.elevation"), self.elevation, -90.0, 90.0)?;
        check_range(&format!("{table}.strength"), self.strength, 0.0, 1000.0)?;
        check_range(&format!("{table}.spread"), self.spread, 0.0, 45.0)?;
        check_colour(&format!("{table}.colour"), self.colour, 1.0)
    }
}

/// `[picture.sky]`: light from all around, dimmed where hair or head hide it.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields, default)]
pub struct Sky {
    /// Strength: an unhidden white surface is as bright as this, 0..1000. Default 0.24.
    pub strength: f32,
    /// Colour of the light from straight above (linear, 0..1). Default `[0.93, 0.97, 1]`.
    pub above: [f32; 3],
    /// Colour of the light from straight below (linear, 0..1). Default `[0.55, 0.5, 0.47]`.
    pub below: [f32; 3],
    /// Whether hair and head hide the sky from what lies within. Default true.
    pub occlusion: bool,
    /// `"world"` (default) or `"head"`.
    pub space: SkySpace,
}

impl Default for Sky {
    fn default() -> Self {
        Self {
            strength: 0.24,
            above: [0.93, 0.97, 1.0],
            below: [0.55, 0.5, 0.47],
            occlusion: true,
            space: SkySpace::World,
        }
    }
}

impl Sky {
    /// Whether hair and head hide it. The light that they throw on one another is found with it, also where the sky is dark.
    pub(crate) fn is_occluded(&self) -> bool {
        self.occlusion
    }

    pub(crate) fn check(&self) -> Result<(), SettingError> {
        check_range("picture.sky.strength", self.strength, 0.0, 1000.0)?;
        check_colour("picture.sky.above", self.above, 1.0)?;
        check_colour("picture.sky.below", self.below, 1.0)
    }
}
