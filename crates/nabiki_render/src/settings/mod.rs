//! The scene's `[picture]` table: every setting of a picture, with its unit and default.

mod camera;
mod hair;
mod light;
mod surroundings;

pub use camera::{Camera, CameraKey, Projection};
pub use hair::{HairColour, HairLook, Shading};
pub use light::{Light, LightSpace, Sky, SkySpace};
pub use surroundings::{Background, BodyLook, HeadLook, ToneCurve, Video};

use nabiki::SettingError;
use nabiki::error::check_range;
use serde::{Deserialize, Serialize};

/// Largest picture side (pixels).
pub const LARGEST_SIDE: u32 = 16_384;

/// How a hair gets its share of a pixel.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Antialiasing {
    /// The exact share of each of a pixel's 4 x 4 cells, composited front to back: smooth for any width.
    #[default]
    Coverage,
    /// The paper's own way (section 4.4): opaque lines against a depth buffer, `samples` x `samples` points a pixel.
    Oversample,
}

/// The scene's `[picture]` table.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields, default)]
pub struct Picture {
    /// Width and height (pixels). Default 960 x 540.
    pub size: [u32; 2],
    /// `"coverage"` (default) or `"oversample"`.
    pub antialiasing: Antialiasing,
    /// Points along each side of a pixel when oversampling, 1..32. Default 4.
    pub samples: u32,
    /// Where the picture is taken from.
    pub camera: Camera,
    /// Width, colour and shading of the hair.
    pub hair: HairLook,
    /// The lamps: an array of tables, `[[picture.lights]]`. Default: key, fill and two kickers.
    pub lights: Vec<Light>,
    /// The light that comes from all around.
    pub sky: Sky,
    /// Whether hair, head and bodies cast shadows. Default true.
    pub shadows: bool,
    /// Colour of the head, or none.
    pub head: HeadLook,
    /// What is behind it all.
    pub background: Background,
    /// Brightness in photographic stops: each is a factor of 2. Default 0.
    pub exposure: f32,
    /// How scene light becomes display light in 8 and 16 bit pictures and in video. Default `"filmic"`.
    pub tone_mapping: ToneCurve,
    /// Part of the frame interval during which the shutter is open, 0..1: 0 (default) is a sharp picture, 0.5 a
    /// film camera's 180 degrees.
    pub shutter: f32,
    /// The movie.
    pub video: Video,
}

impl Default for Picture {
    fn default() -> Self {
        Self {
            size: [960, 540],
            antialiasing: Antialiasing::Coverage,
            samples: 4,
            camera: Camera::default(),
            hair: HairLook::default(),
            lights: Light::studio(),
            sky: Sky::default(),
            shadows: true,
            head: HeadLook::default(),
            background: Background::default(),
            exposure: 0.0,
            tone_mapping: ToneCurve::default(),
            shutter: 0.0,
            video: Video::default(),
        }
    }
}

impl Picture {
    /// Refuses settings that cannot be drawn, naming the scene key.
    pub fn check(&self) -> Result<(), SettingError> {
        if self.size.iter().any(|s| !(1..=LARGEST_SIDE).contains(s)) {
            return Err(SettingError::new(
                "picture.size",
                format!("{} x {}", self.size[0], self.size[1]),
                format!("each side must be 1 to {LARGEST_SIDE} pixels"),
            ));
        }
        if !(1..=32).contains(&self.samples) {
            return Err(SettingError::new("picture.samples", self.samples, "must lie in 1..32"));
        }
        self.camera.check()?;
        self.hair.check()?;
        for (i, light) in self.lights.iter().enumerate() {
            light.check(&format!("picture.lights[{i}]"))?;
        }
        if self.lights.len() > 16 {
            return Err(SettingError::new("picture.lights", self.lights.len(), "at most 16 lights"));
        }
        self.sky.check()?;
        self.head.check()?;
        self.background.check()?;
        check_range("picture.exposure", self.exposure, -20.0, 20.0)?;
        check_range("picture.shutter", self.shutter, 0.0, 1.0)?;
        if self.shutter > 0.0 && self.antialiasing == Antialiasing::Oversample {
            let way_out = "motion blur needs antialiasing = \"coverage\"; use that, or shutter = 0";
            return Err(SettingError::new("picture.shutter", self.shutter, way_out));
        }
        if let (Some(f_stop), Antialiasing::Oversample) = (self.camera.f_stop, self.antialiasing) {
            let way_out = "depth of field needs antialiasing = \"coverage\"; use that, or leave f_stop out";
            return Err(SettingError::new("picture.camera.f_stop", f_stop, way_out));
        }
        self.video.check()
    }
}

/// Refuses colours with a channel that is not a number in 0..`most`.
pub(crate) fn check_colour(thing: &str, rgb: [f32; 3], most: f32) -> Result<(), SettingError> {
    if rgb.iter().all(|c| (0.0..=most).contains(c)) {
        Ok(())
    } else {
        Err(SettingError::new(thing, format!("{rgb:?}"), format!("each of red, green and blue must lie in 0..{most}")))
    }
}
