//! The head on the picture: where it shows, and how it is lit.

mod light;
mod surface;

pub use light::SkinLight;
pub use surface::{SkinPixel, SkinView};
