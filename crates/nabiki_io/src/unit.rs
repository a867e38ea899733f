//! Length units of files, by name or in centimetres.

use std::{fmt, str::FromStr};

use nabiki::SettingError;
use nabiki::setting::{Datum, Kind, Place, Range, Value, Word};
use serde::{Deserialize, Serialize};

use crate::short::Short;

/// A file's length unit: a name, `"mm"`, `"cm"`, `"dm"`, `"m"`, `"in"`, `"ft"`, or the number of centimetres in it.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, Serialize)]
#[serde(try_from = "UnitText", into = "f32")]
pub struct Unit {
    /// Centimetres in one file unit.
    pub cm: f32,
}

impl Unit {
    /// Metres in one unit, from the shortest decimal representation of its centimetres: 2.54 cm give 0.0254 m, instead
    /// of the metres of the f32 nearest to 2.54.
    pub fn metres(self) -> f64 {
        format!("{}e-2", self.cm).parse().unwrap_or(f64::from(self.cm) / 100.0)
    }
}

impl Default for Unit {
    fn default() -> Self {
        Self { cm: 1.0 }
    }
}

impl From<Unit> for f32 {
    fn from(unit: Unit) -> Self {
        unit.cm
    }
}

/// A unit as a scene spells it.
#[derive(Deserialize)]
#[serde(untagged, expecting = "a unit: \"mm\", \"cm\", \"dm\", \"m\", \"in\", \"ft\" or a number of centimetres")]
enum UnitText {
    Cm(f32),
    Name(String),
}

impl TryFrom<UnitText> for Unit {
    type Error = String;

    fn try_from(text: UnitText) -> Result<Self, String> {
        match text {
            UnitText::Cm(cm) => Ok(Self { cm }),
            UnitText::Name(name) => name.parse(),
        }
    }
}

impl Value for Unit {
    const KIND: Kind = Kind::OneOf(&[
        Kind::Words(&[
            Word { word: "mm", help: "" },
            Word { word: "cm", help: "" },
            Word { word: "dm", help: "" },
            Word { word: "m", help: "" },
            Word { word: "in", help: "" },
            Word { word: "ft", help: "" },
        ]),
        Kind::Number,
    ]);

    fn check(&self, at: &Place, range: &Range) -> Result<(), SettingError> {
        self.cm.check(at, range)
    }

    fn datum(&self) -> Datum {
        self.cm.datum()
    }
}

/// The units that have a name, and their centimetres.
const NAMED: [(&str, f32); 6] = [("mm", 0.1), ("cm", 1.0), ("dm", 10.0), ("m", 100.0), ("in", 2.54), ("ft", 30.48)];

impl FromStr for Unit {
    type Err = String;

    fn from_str(name: &str) -> Result<Self, String> {
        if let Some((_, cm)) = NAMED.iter().find(|(known, _)| *known == name) {
            return Ok(Self { cm: *cm });
        }
        name.parse().map(|cm| Self { cm }).map_err(|_| {
            let known = "write \"mm\", \"cm\", \"dm\", \"m\", \"in\", \"ft\" or a number of centimetres";
            format!("\"{name}\" is not a unit: {known}")
        })
    }
}

/// Its name, or a length in centimetres where it has none: `m`, `5.644 cm`.
impl fmt::Display for Unit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        // Files state units in metres or in f64: the last bit of an f32 may differ.
        let same = |cm: f32| (self.cm - cm).abs() <= f32::EPSILON * cm;
        match NAMED.iter().find(|&&(_, cm)| same(cm)) {
            Some((name, _)) => f.write_str(name),
            None => write!(f, "{} cm", Short(self.cm)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_name_stands_for_its_length() {
        for (name, cm) in
            [("mm", 0.1), ("cm", 1.0), ("dm", 10.0), ("m", 100.0), ("in", 2.54), ("ft", 30.48), ("7.5", 7.5)]
        {
            assert_eq!(name.parse(), Ok(Unit { cm }), "{name}");
        }
    }

    #[test]
    fn a_unit_that_has_a_name_is_called_by_it() {
        for (name, cm) in NAMED {
            assert_eq!(Unit { cm }.to_string(), name);
            assert_eq!(name.parse(), Ok(Unit { cm }));
            // As USD has it: metres in f64.
            assert_eq!(Unit { cm: (f64::from(cm) / 100.0 * 100.0) as f32 }.to_string(), name);
        }
        assert_eq!(Unit { cm: (0.0254_f64 * 100.0) as f32 }.to_string(), "in");
        assert_eq!(Unit { cm: 2.54 / 0.45 }.to_string(), "5.644 cm");
        for metres in [1.0, 0.01, 0.001, 0.0254, 0.3048, 0.9144, 1e-9, 1e6] {
            assert_eq!(Unit { cm: (metres * 100.0) as f32 }.metres(), metres);
        }
        assert!("mile".parse::<Unit>().unwrap_err().contains("is not a unit"));
    }
}
