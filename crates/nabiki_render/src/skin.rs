//! Head and bodies on the picture: where they show, and how they are lit.

mod light;
mod lit;
mod solids;
mod surface;

pub use light::{FromLamp, ON_SKIN, Reached, SkinLight};
pub use lit::LitSkin;
pub use solids::{Solids, placed};
pub use surface::{SkinPixel, SkinView};
