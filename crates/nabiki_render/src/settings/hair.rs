//! Settings of the hair's look: `[picture.hair]`.

use nabiki::setting::{Datum, Kind, Place, Range, Setting, Table, Value, Word};
use nabiki::{SettingError, settings, words};
use serde::{Deserialize, Serialize};

words! {
    /// How a hair reflects light.
    pub enum Shading = Fibre {
        /// A dielectric fibre with pigment inside: surface reflection, transmission and internal reflection.
        Fibre = "fibre",
        /// The cylinder model of Kajiya and Kay (1989), as in the paper.
        KajiyaKay = "kajiya-kay",
    }
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
    /// Eumelanin and pheomelanin of the colour, named or given. `None` for a colour given as RGB.
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

const PIGMENT: Range = Range { unit: "", above: None, least: Some(0.0), most: Some(100.0) };
const DISPLAYED: Range = Range { unit: "sRGB", above: None, least: Some(0.0), most: Some(1.0) };

/// A colour's setting that has a form of its own.
const fn part(key: &'static str, label: &'static str, help: &'static str, kind: Kind, range: Range) -> Setting {
    Setting { key, label, help, kind, range, default: || Datum::Open, must: None, open: None }
}

const MELANIN: Table = Table {
    name: "Melanin",
    help: "Amounts of pigment.",
    settings: &[
        Setting { must: Some("1.3"), ..part("eumelanin", "Eumelanin", "Brown-black pigment.", Kind::Number, PIGMENT) },
        Setting {
            default: || Datum::Number(0.0),
            ..part("pheomelanin", "Pheomelanin", "Yellow-red pigment.", Kind::Number, PIGMENT)
        },
    ],
};

impl Value for HairColour {
    const KIND: Kind = Kind::OneOf(&[
        Kind::Words(&[
            Word { word: "black", help: "" },
            Word { word: "brown", help: "" },
            Word { word: "blond", help: "" },
            Word { word: "red", help: "" },
            Word { word: "grey", help: "" },
        ]),
        Kind::Table(&Table {
            name: "MelaninColour",
            help: "Concentrations of pigment as in d'Eon et al. (2011), relative to the fibre's radius. Eumelanin 8 is black, 1 brown, \
                   0.1 blond. Pheomelanin makes hair redder.",
            settings: &[Setting {
                must: Some("{ eumelanin = 1.3, pheomelanin = 0.2 }"),
                ..part("melanin", "Pigment", MELANIN.help, Kind::Table(&MELANIN), PIGMENT)
            }],
        }),
        Kind::Table(&Table {
            name: "RgbColour",
            help: "The colour of a thick mass of hair in even light.",
            settings: &[Setting {
                must: Some("[0.3, 0.1, 0.05]"),
                ..part("rgb", "Visible colour", "Red, green and blue.", Kind::Numbers(3), DISPLAYED)
            }],
        }),
    ]);

    fn check(&self, at: &Place, _: &Range) -> Result<(), SettingError> {
        match self {
            Self::Melanin { eumelanin, pheomelanin } => {
                let at = at.key("melanin");
                eumelanin.check(&at.key("eumelanin"), &PIGMENT)?;
                pheomelanin.check(&at.key("pheomelanin"), &PIGMENT)
            }
            Self::Rgb(rgb) => rgb.check(&at.key("rgb"), &DISPLAYED),
            _ => Ok(()),
        }
    }

    fn datum(&self) -> Datum {
        let name = |name: &str| Datum::Text(name.to_owned());
        match self {
            Self::Black => name("black"),
            Self::Brown => name("brown"),
            Self::Blond => name("blond"),
            Self::Red => name("red"),
            Self::Grey => name("grey"),
            Self::Melanin { eumelanin, pheomelanin } => {
                let amounts = vec![("eumelanin", eumelanin.datum()), ("pheomelanin", pheomelanin.datum())];
                Datum::Table(vec![("melanin", Datum::Table(amounts))])
            }
            Self::Rgb(rgb) => Datum::Table(vec![("rgb", rgb.datum())]),
        }
    }
}

settings! {
    /// Width, colour and shading of the hair.
    #[derive(Copy)]
    pub struct HairLook {
        /// Diameter of a hair at its root. Real hair has about 0.007 cm; the default is larger because 20,000 strands
        /// represent 100,000. Lower it if you raise the number of strands.
        pub width: f32 = 0.014 => "Width", unit "cm", least 1e-5, most 5.0;
        /// Thickness at the tip as a share of that at the root.
        pub tip: f32 = 0.3 => "Tip", least 0.0, most 1.0;
        /// Share of the length over which the hair thins toward its tip.
        pub taper: f32 = 0.4 => "Taper", least 0.0, most 1.0;
        /// A name, amounts of pigment, or the colour of a thick mass of hair in even light.
        pub colour: HairColour = HairColour::Brown => "Colour";
        /// How much hairs differ in pigment and in the tilt of their scales.
        pub variation: f32 = 0.25 => "Variation", least 0.0, most 1.0;
        /// How a hair reflects light: a fibre with pigment, or the paper's model of 1989.
        pub shading: Shading = Shading::Fibre => "Shading";
        /// Roughness along the hair. Raise it to widen the highlight.
        pub roughness: f32 = 5.0 => "Roughness", unit "degrees", least 2.0, most 40.0;
        /// Roughness around the hair. Lower it to sharpen the light through the fibre.
        pub azimuthal_roughness: f32 = 0.35 => "Roughness around", least 0.05, most 1.0;
        /// Tilt of the scales of the cuticle. Raise it to shift the white highlight toward the root and the coloured
        /// one toward the tip.
        pub scale_tilt: f32 = 2.5 => "Scale tilt", unit "degrees", least -10.0, most 10.0;
        /// Refractive index of the fibre.
        pub refraction: f32 = 1.55 => "Refractive index", least 1.1, most 2.5;
        /// Whether to draw a curve through the nodes instead of straight segments.
        pub smooth: bool = true => "Smooth";
    }
}
