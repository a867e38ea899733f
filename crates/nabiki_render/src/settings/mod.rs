//! The scene's `[picture]` table: every setting of a picture, with its unit and default.

mod camera;
mod hair;
mod light;
mod surroundings;

pub use camera::{Camera, CameraKey, NEAR, Projection};
pub use hair::{HairColour, HairLook, Shading};
pub use light::{Light, LightSpace, Sky, SkySpace};
pub use surroundings::{Background, BodyLook, HeadLook, ToneCurve, Video};

use nabiki::setting::{Place, refused};
use nabiki::{SettingError, settings, words};

/// Largest picture side (pixels).
pub const LARGEST_SIDE: u32 = 16_384;

words! {
    /// How a hair gets its share of a pixel.
    pub enum Antialiasing = Coverage {
        /// The exact share of each of a pixel's 4 x 4 cells, composited front to back. Smooth at any width.
        Coverage = "coverage",
        /// The paper's method (section 4.4): opaque lines with a depth buffer, `samples` x `samples` points per pixel.
        Oversample = "oversample",
    }
}

settings! {
    /// How pictures are drawn.
    pub struct Picture in "picture" where can_be_drawn {
        /// Width and height of the picture.
        pub size: [u32; 2] = [960, 540] => "Size", unit "pixels", least 1.0, most LARGEST_SIDE as f64;
        /// How a hair gets its share of a pixel: exact coverage, or points as in the paper.
        pub antialiasing: Antialiasing = Antialiasing::Coverage => "Antialiasing";
        /// Points along each side of a pixel when oversampling. More give smoother edges and take longer.
        pub samples: u32 = 4 => "Samples", least 1.0, most 32.0;
        /// The camera.
        pub camera: Camera = Camera::default() => "Camera";
        /// Width, colour and shading of the hair.
        pub hair: HairLook = HairLook::default() => "Hair";
        /// The lamps, at most 16. By default a warm key light, a weak fill light and two kickers.
        pub lights: Vec<Light> = Light::studio() => "Lights";
        /// The light from all directions.
        pub sky: Sky = Sky::default() => "Sky";
        /// Whether hair, head and bodies cast shadows.
        pub shadows: bool = true => "Shadows";
        /// How the head is drawn.
        pub head: HeadLook = HeadLook::default() => "Head";
        /// What is behind hair and head.
        pub background: Background = Background::default() => "Background";
        /// Brightness in photographic stops. Each stop is a factor of 2.
        pub exposure: f32 = 0.0 => "Exposure", unit "stops", least -20.0, most 20.0;
        /// How scene light becomes display light in 8 and 16 bit pictures and in movies.
        pub tone_mapping: ToneCurve = ToneCurve::Filmic => "Tone mapping";
        /// Share of the frame interval during which the shutter is open. 0 gives a sharp picture, 0.5 the motion blur
        /// of a film camera with 180 degrees.
        pub shutter: f32 = 0.0 => "Shutter", least 0.0, most 1.0;
        /// The movie.
        pub video: Video = Video::default() => "Movie";
    }
}

impl Picture {
    fn can_be_drawn(&self, at: &Place) -> Result<(), SettingError> {
        if self.lights.len() > 16 {
            return refused(&at.key("lights"), self.lights.len(), "at most 16 lights");
        }
        if self.antialiasing == Antialiasing::Coverage {
            return Ok(());
        }
        if self.shutter > 0.0 {
            let way_out = "motion blur needs antialiasing = \"coverage\"; use that, or shutter = 0";
            return refused(&at.key("shutter"), self.shutter, way_out);
        }
        match self.camera.f_stop {
            Some(f_stop) => {
                let way_out = "depth of field needs antialiasing = \"coverage\"; use that, or leave f_stop out";
                refused(&at.key("camera").key("f_stop"), f_stop, way_out)
            }
            None => Ok(()),
        }
    }
}
