//! Settings of the hair's look: `[picture.hair]`.

use nabiki::SettingError;
use nabiki::error::check_range;
use serde::{Deserialize, Serialize};

use super::check_colour;

/// How light is reflected by a hair.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Shading {
    /// A dielectric fibre with pigment inside: surface reflection, transmission, internal reflection.
    #[default]
    Fibre,
    /// The cylinder model of Kajiya and Kay (1989), as in the paper.
    KajiyaKay,
}

/// The colour of hair: a name, amounts of pigment, or the colour that a mass of it shows.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, Serialize)]
#[serde(
    rename_all = "kebab-case",
    rename_all_fields = "kebab-case",
    expecting = "a name, as \"brown\", or { melanin = { eumelanin = 1.3, pheomelanin = 0.2 } } or { rgb = [r, g, b] }"
)]
pub enum HairColour {
    /// `colour = "black"`
    Black,
    /// `colour = "brown"`, the default.
    Brown,
    /// `colour = "blond"`
    Blond,
    /// `colour = "red"`
    Red,
    /// `colour = "grey"`
    Grey,
    /// `colour = { melanin = { eumelanin = 1.3, pheomelanin = 0.2 } }`: concentrations as in d'Eon et al. (2011), relative
    /// to the fibre's radius. Eumelanin 8 is black, 1 brown, 0.1 blond; pheomelanin reddens.
    Melanin {
        /// Brown-black pigment, 0..100.
        eumelanin: f32,
        /// Yellow-red pigment, 0..100.
        #[serde(default)]
        pheomelanin: f32,
    },
    /// `colour = { rgb = [0.3, 0.1, 0.05] }`: the colour in sRGB (0..1) that a thick mass shows in even light.
    Rgb([f32; 3]),
}

impl HairColour {
    /// Eumelanin and pheomelanin of the named colours, and those given; none of a colour that is given as it looks.
    pub fn melanin(self) -> Option<[f32; 2]> {
        match self {
            Self::Black => Some([8.0, 0.0]),
            Self::Brown => Some([1.1, 0.6]),
            Self::Blond => Some([0.03, 0.2]),
            Self::Red => Some([0.0, 1.9]),
            Self::Grey => Some([0.06, 0.0]),
            Self::Melanin { eumelanin, pheomelanin } => Some([eumelanin, pheomelanin]),
            Self::Rgb(_) => None,
        }
    }
}

/// `[picture.hair]`.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields, default)]
pub struct HairLook {
    /// Thickness of a hair at its root (diameter, cm), 1e-5..5. Default 0.014: a real hair of 0.007 cm made thicker
    /// because twenty thousand stand for a hundred thousand.
    pub width: f32,
    /// Thickness at the tip as a part of that at the root, 0..1. Default 0.3.
    pub tip: f32,
    /// Part of the length over which the hair thins to its tip, 0..1. Default 0.4.
    pub taper: f32,
    /// A name (`"black"`, `"brown"`, `"blond"`, `"red"`, `"grey"`), `{ melanin = .. }` or `{ rgb = .. }`.
    pub colour: HairColour,
    /// How much hairs differ in pigment and tilt of their scales, 0..1. Default 0.25.
    pub variation: f32,
    /// `"fibre"` (default) or `"kajiya-kay"`.
    pub shading: Shading,
    /// Roughness along the hair: the width of the highlight's band (degrees, 2..40). Default 5.
    pub roughness: f32,
    /// Roughness around the hair, 0.05..1: small sharpens the light through the fibre. Default 0.35.
    pub azimuthal_roughness: f32,
    /// Tilt of the scales of the cuticle (degrees, -10..10): shifts the white highlight toward the root and the coloured one
    /// toward the tip. Default 2.5.
    pub scale_tilt: f32,
    /// Refractive index of the fibre, 1.1..2.5. Default 1.55.
    pub refraction: f32,
    /// Whether a curve is drawn through the nodes rather than straight segments. Default true.
    pub smooth: bool,
}

impl Default for HairLook {
    fn default() -> Self {
        Self {
            width: 0.014,
            tip: 0.3,
            taper: 0.4,
            colour: HairColour::Brown,
            variation: 0.25,
            shading: Shading::Fibre,
            roughness: 5.0,
            azimuthal_roughness: 0.35,
            scale_tilt: 2.5,
            refraction: 1.55,
            smooth: true,
        }
    }
}

impl HairLook {
    pub(crate) fn check(&self) -> Result<(), SettingError> {
        check_range("picture.hair.width", self.width, 1e-5, 5.0)?;
        check_range("picture.hair.tip", self.tip, 0.0, 1.0)?;
        check_range("picture.hair.taper", self.taper, 0.0, 1.0)?;
        check_range("picture.hair.variation", self.variation, 0.0, 1.0)?;
        check_range("picture.hair.roughness", self.roughness, 2.0, 40.0)?;
        check_range("picture.hair.azimuthal_roughness", self.azimuthal_roughness, 0.05, 1.0)?;
        check_range("picture.hair.scale_tilt", self.scale_tilt, -10.0, 10.0)?;
        check_range("picture.hair.refraction", self.refraction, 1.1, 2.5)?;
        match self.colour {
            HairColour::Melanin { eumelanin, pheomelanin } => {
                check_range("picture.hair.colour.melanin.eumelanin", eumelanin, 0.0, 100.0)?;
                check_range("picture.hair.colour.melanin.pheomelanin", pheomelanin, 0.0, 100.0)
            }
            HairColour::Rgb(rgb) => check_colour("picture.hair.colour.rgb", rgb, 1.0),
            _ => Ok(()),
        }
    }
}
