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
    /// Its colour (sRGB, 0..1). Default a neutral skin, dull enough to leave the eye to the hair.
    pub colour: [f32; 3],
    /// How far light creeps past the terminator, as in skin, 0..1. Default 0.35.
    pub softness: f32,
    /// Strength of its sheen, 0..1. Default 0.25.
    pub sheen: f32,
    /// Hair too short to be drawn: its length for each root (cm, as thick as the hair), 0..100. It tints the scalp as dense as
    /// the roots stand, so that partings do not gleam. Default 2; 0 shows bare skin.
    pub stubble: f32,
}

impl Default for HeadLook {
    fn default() -> Self {
        Self { visible: true, colour: [0.56, 0.44, 0.37], softness: 0.35, sheen: 0.25, stubble: 2.0 }
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

/// `[picture.background]`: a vertical gradient, or nothing.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields, default)]
pub struct Background {
    /// Colour at the top edge (sRGB as displayed, 0..1).
    pub top: [f32; 3],
    /// Colour at the bottom edge (sRGB as displayed, 0..1).
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
    /// Straight up to half of white, then a shoulder that rolls highlights off softly.
    #[default]
    Filmic,
}

/// `[picture.video]`; how many frames a second are shown is the motion's to say (`motion.frame_rate`).
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields, default)]
pub struct Video {
    /// 0 (small file) .. 1 (large, near lossless). Default 0.75.
    pub quality: f32,
}

impl Default for Video {
    fn default() -> Self {
        Self { quality: 0.75 }
    }
}

impl Video {
    pub(crate) fn check(&self) -> Result<(), SettingError> {
        check_range("picture.video.quality", self.quality, 0.0, 1.0)
    }
}
