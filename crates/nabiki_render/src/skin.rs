//! Head and bodies on the picture: where they show, and how they are lit.

mod light;
mod solids;
mod surface;

pub use light::{ON_SKIN, SkinLight};
pub use solids::{Solids, placed};
pub use surface::{SkinPixel, SkinView};
