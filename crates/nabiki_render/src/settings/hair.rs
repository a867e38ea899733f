//! Settings of the hair's look: `[picture.hair]`.

use nabiki::setting::{Datum, Kind, Place, Range, Setting, Table, Value, Word};
use nabiki::{SettingError, settings, words};
use serde::{Deserialize, Serialize};

words! {
    /// How light is reflected by a hair.
    pub enum Shading = Fibre {
        /// A dielectric fibre with pigment inside: surface reflection, transmission, internal reflection.
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
                   0.1 blond; pheomelanin reddens.",
            settings: &[Setting {
                must: Some("{ eumelanin = 1.3, pheomelanin = 0.2 }"),
                ..part("melanin", "Pigment", MELANIN.help, Kind::Table(&MELANIN), PIGMENT)
            }],
        }),
        Kind::Table(&Table {
            name: "RgbColour",
            help: "The colour that a thick mass shows in even light.",
            settings: &[Setting {
                must: Some("[0.3, 0.1, 0.05]"),
                ..part("rgb", "As it looks", "Red, green and blue.", Kind::Numbers(3), DISPLAYED)
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
        /// Thickness of a hair at its root: its diameter. A real hair of 0.007 cm is made thicker because twenty thousand stand for a
        /// hundred thousand.
        pub width: f32 = 0.014 => "Width", unit "cm", least 1e-5, most 5.0;
        /// Thickness at the tip as a part of that at the root.
        pub tip: f32 = 0.3 => "Tip", least 0.0, most 1.0;
        /// Part of the length over which the hair thins to its tip.
        pub taper: f32 = 0.4 => "Taper", least 0.0, most 1.0;
        /// A name, amounts of pigment, or the colour that a thick mass shows in even light.
        pub colour: HairColour = HairColour::Brown => "Colour";
        /// How much hairs differ in pigment and tilt of their scales.
        pub variation: f32 = 0.25 => "Variation", least 0.0, most 1.0;
        /// A fibre with pigment inside, or the model of 1989, as in the paper.
        pub shading: Shading = Shading::Fibre => "Shading";
        /// Roughness along the hair: the width of the highlight's band.
        pub roughness: f32 = 5.0 => "Roughness", unit "degrees", least 2.0, most 40.0;
        /// Roughness around the hair: small sharpens the light through the fibre.
        pub azimuthal_roughness: f32 = 0.35 => "Around", least 0.05, most 1.0;
        /// Tilt of the scales of the cuticle: shifts the white highlight toward the root and the coloured one toward the tip.
        pub scale_tilt: f32 = 2.5 => "Scales", unit "degrees", least -10.0, most 10.0;
        /// Refractive index of the fibre.
        pub refraction: f32 = 1.55 => "Refraction", least 1.1, most 2.5;
        /// Whether a curve is drawn through the nodes rather than straight segments.
        pub smooth: bool = true => "Smooth";
    }
}
