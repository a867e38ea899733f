//! Settings of what surrounds the hair: head, background, tone mapping and movie.

use nabiki::SettingError;
use nabiki::error::check_range;
use serde::{Deserialize, Serialize};

use super::check_colour;

/// `[picture.head]`.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields, default)]
pub struct HeadLook {
    /// Whether the head is drawn; it hides hair behind it and throws shadows all the same. Default true.
    pub visible: bool,
    /// Its colour (sRGB, 0..1). Default `[0.56, 0.44, 0.37]`, a neutral skin, dull enough to leave the eye to the hair.
    pub colour: [f32; 3],
    /// How far light creeps past the terminator, as in skin, 0..1. Default 0.2.
    pub softness: f32,
    /// Strength of its sheen, 0..1. Default 0.25.
    pub sheen: f32,
    /// Hair too short to be drawn: its length for each root (cm, as thick as the hair), 0..100. It tints the scalp as dense as
    /// the roots stand, so that partings do not gleam. Default 2; 0 shows bare skin.
    pub stubble: f32,
    /// Whether the built-in head has brows, lashes and lips of their colours; other heads have what their mesh has, one colour.
    /// Default true.
    pub face: bool,
}

impl Default for HeadLook {
    fn default() -> Self {
        Self { visible: true, colour: [0.56, 0.44, 0.37], softness: 0.2, sheen: 0.25, stubble: 2.0, face: true }
    }
}

impl HeadLook {
    pub(crate) fn check(&self) -> Result<(), SettingError> {
        check_colour("picture.head.colour", self.colour, 1.0)?;
        check_range("picture.head.softness", self.softness, 0.0, 1.0)?;
        check_range("picture.head.sheen", self.sheen, 0.0, 1.0)?;
        check_range("picture.head.stubble", self.stubble, 0.0, 100.0)
    }
}

/// How a body besides the head is drawn: `shown` and `colour` of a `[[body]]`.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields, default)]
pub struct BodyLook {
    /// Whether it is drawn. What is not shown hides nothing and throws no shadow. Default true.
    pub shown: bool,
    /// Its colour (sRGB, 0..1). Default `[0.42, 0.46, 0.5]`, a grey that is no skin.
    pub colour: [f32; 3],
}

impl Default for BodyLook {
    fn default() -> Self {
        Self { shown: true, colour: [0.42, 0.46, 0.50] }
    }
}

impl BodyLook {
    /// Refuses a colour out of its range; `name` is what the body is called.
    ///
    /// # Errors
    /// Names the setting.
    pub fn check(&self, name: &str) -> Result<(), SettingError> {
        check_colour(&format!("{name}.colour"), self.colour, 1.0)
    }
}

/// `[picture.background]`: a vertical gradient, or nothing.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields, default)]
pub struct Background {
    /// Colour at the top edge (sRGB as displayed, 0..1). Default `[0.36, 0.38, 0.41]`.
    pub top: [f32; 3],
    /// Colour at the bottom edge (sRGB as displayed, 0..1). Default `[0.2, 0.21, 0.23]`.
    pub bottom: [f32; 3],
    /// Leave it out: alpha 0 where there is neither hair nor head. Default false.
    pub transparent: bool,
}

impl Default for Background {
    fn default() -> Self {
        Self { top: [0.36, 0.38, 0.41], bottom: [0.20, 0.21, 0.23], transparent: false }
    }
}

impl Background {
    pub(crate) fn check(&self) -> Result<(), SettingError> {
        check_colour("picture.background.top", self.top, 1.0)?;
        check_colour("picture.background.bottom", self.bottom, 1.0)
    }
}

/// The curve of the tone mapping: how scene light becomes display light.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum ToneCurve {
    /// Clipped at white.
    Linear,
    /// Straight up to half of white, then a shoulder that rolls highlights off softly, by way of their own hue.
    #[default]
    Filmic,
}

/// `[picture.video]`
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields, default)]
pub struct Video {
    /// 0 (small file) .. 1 (large, near lossless). Default 0.75.
    pub quality: f32,
    /// Frames a second that the movie is played with, 1..240: fewer than `motion.frame_rate` is slow motion. Default that rate.
    pub frame_rate: Option<f64>,
}

impl Default for Video {
    fn default() -> Self {
        Self { quality: 0.75, frame_rate: None }
    }
}

impl Video {
    pub(crate) fn check(&self) -> Result<(), SettingError> {
        check_range("picture.video.quality", self.quality, 0.0, 1.0)?;
        self.frame_rate.map_or(Ok(()), |rate| check_range("picture.video.frame_rate", rate as f32, 1.0, 240.0))
    }
}
