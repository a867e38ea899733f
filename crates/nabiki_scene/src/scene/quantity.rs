//! Quantities in physical units, which animators know: `"4.5 cm"`, `"0.3 g"`, `"20 km/h"`.

use std::fmt::{self, Debug, Display};
use std::marker::PhantomData;

use nabiki::SettingError;
use nabiki::setting::{Datum, Kind, Place, Range, Value, Word, refused};
use serde::de::{Error, Unexpected, Visitor};
use serde::{Deserialize, Deserializer, Serialize, Serializer};

/// A kind of quantity, with its units.
pub trait Measure: Copy + Debug + PartialEq {
    /// The units, as written after the number.
    const UNITS: &'static [&'static str];
    /// Size of each unit in the first one.
    const FACTORS: &'static [f64];
    /// A quantity in words, with an example of each unit.
    const SAID: &'static str;
    /// Description of valid text.
    const KIND: Kind = Kind::Quantity(Self::UNITS);

    /// Words for some number of the first unit.
    fn named(_: &str) -> Option<f32> {
        None
    }
}

macro_rules! measures {
    ($($(#[doc = $doc:literal])* $name:ident [$($unit:literal = $factor:expr),*] $said:literal $({ $($more:tt)* })?)*) => {$(
        $(#[doc = $doc])*
        #[derive(Clone, Copy, Debug, PartialEq)]
        pub struct $name;

        impl Measure for $name {
            const UNITS: &'static [&'static str] = &[$($unit),*];
            const FACTORS: &'static [f64] = &[$($factor),*];
            const SAID: &'static str = $said;
            $($($more)*)?
        }
    )*};
}

measures! {
    /// A length (cm).
    Length ["cm" = 1.0] "a length, \"4.5 cm\""
    /// A time (s).
    Time ["s" = 1.0] "a time, \"0.8 s\""
    /// A strength, relative to the weight of hair on earth.
    Strength ["g" = 1.0] "a part of the earth's gravity, \"0.3 g\""
    /// Gravity, relative to that of the earth.
    Weight ["g" = 1.0] "a part of the earth's, \"1 g\", or \"earth\"" {
        const KIND: Kind = Kind::OneOf(&[
            Kind::Quantity(Self::UNITS),
            Kind::Words(&[Word { word: "earth", help: "The same as 1 g." }]),
        ]);

        fn named(text: &str) -> Option<f32> {
            (text == "earth").then_some(1.0)
        }
    }
    /// A speed (cm/s).
    Speed ["cm/s" = 1.0, "m/s" = 100.0, "km/h" = 100.0 / 3.6] "a speed, \"20 km/h\", \"5 m/s\" or \"300 cm/s\""
}

/// A number with its unit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Quantity<M> {
    /// The number.
    pub number: f32,
    /// The index of its unit in the measure.
    unit: usize,
    measure: PhantomData<M>,
}

impl<M: Measure> Quantity<M> {
    /// A quantity in the measure's first unit.
    pub fn new(number: f32) -> Self {
        Self { number, unit: 0, measure: PhantomData }
    }

    /// Parses a text such as `"20 km/h"`. `None` if it is not a number with a unit of this measure.
    pub fn parse(text: &str) -> Option<Self> {
        let text = text.trim();
        let of_unit = |(unit, name): (usize, &&str)| {
            let number: f32 = text.strip_suffix(name)?.trim_end().parse().ok()?;
            number.is_finite().then_some(Self { number, unit, measure: PhantomData })
        };
        M::named(text).map(Self::new).or_else(|| M::UNITS.iter().enumerate().find_map(of_unit))
    }

    /// Another number in the same unit.
    #[must_use]
    pub fn with(self, number: f32) -> Self {
        Self { number, ..self }
    }

    /// The amount in the measure's first unit.
    pub fn amount(&self) -> f64 {
        f64::from(self.number) * M::FACTORS[self.unit]
    }

    /// Its unit.
    pub fn unit(&self) -> &'static str {
        M::UNITS[self.unit]
    }
}

impl<M: Measure> Display for Quantity<M> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} {}", self.number, self.unit())
    }
}

impl<M: Measure> Value for Quantity<M> {
    const KIND: Kind = M::KIND;

    fn check(&self, at: &Place, _: &Range) -> Result<(), SettingError> {
        if self.number >= 0.0 { Ok(()) } else { refused(at, self, "must not be below 0") }
    }

    fn datum(&self) -> Datum {
        Datum::Text(self.to_string())
    }
}

impl<M: Measure> Serialize for Quantity<M> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}

impl<'de, M: Measure> Deserialize<'de> for Quantity<M> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(OfText(PhantomData))
    }
}

/// The text form of a quantity.
struct OfText<M>(PhantomData<M>);

impl<M: Measure> Visitor<'_> for OfText<M> {
    type Value = Quantity<M>;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(M::SAID)
    }

    fn visit_str<E: Error>(self, text: &str) -> Result<Quantity<M>, E> {
        Quantity::parse(text).ok_or_else(|| E::invalid_value(Unexpected::Str(text), &self))
    }
}

/// A number in the setting's own unit, or a quantity in a physical unit that is converted to it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(untagged, bound = "")]
pub enum Amount<M: Measure> {
    /// In the setting's own unit.
    Number(f32),
    /// In a physical unit.
    World(Quantity<M>),
}

impl<M: Measure> Amount<M> {
    /// The number in the setting's own unit. `of_world` converts from the measure's first unit.
    pub fn number(&self, of_world: impl Fn(f64) -> f64) -> f32 {
        match self {
            Self::Number(number) => *number,
            Self::World(quantity) => of_world(quantity.amount()) as f32,
        }
    }

    /// The quantity, if it has a physical unit.
    pub fn quantity(&self) -> Option<&Quantity<M>> {
        match self {
            Self::Number(_) => None,
            Self::World(quantity) => Some(quantity),
        }
    }

    /// Whether it is 0, in any unit.
    pub fn is_zero(&self) -> bool {
        self.number(|amount| amount) == 0.0
    }
}

impl<M: Measure> From<f32> for Amount<M> {
    fn from(number: f32) -> Self {
        Self::Number(number)
    }
}

impl<M: Measure> Value for Amount<M> {
    const KIND: Kind = Kind::OneOf(&[Kind::Number, M::KIND]);

    fn check(&self, at: &Place, range: &Range) -> Result<(), SettingError> {
        match self {
            Self::Number(number) => number.check(at, range),
            Self::World(quantity) => quantity.check(at, range),
        }
    }

    fn datum(&self) -> Datum {
        match self {
            Self::Number(number) => number.datum(),
            Self::World(quantity) => quantity.datum(),
        }
    }
}

impl<'de, M: Measure> Deserialize<'de> for Amount<M> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(OfNumberOrText(PhantomData))
    }
}

/// The file form of an amount.
struct OfNumberOrText<M>(PhantomData<M>);

impl<M: Measure> Visitor<'_> for OfNumberOrText<M> {
    type Value = Amount<M>;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "a number, or {}", M::SAID)
    }

    fn visit_f64<E: Error>(self, number: f64) -> Result<Amount<M>, E> {
        Ok(Amount::Number(number as f32))
    }

    fn visit_i64<E: Error>(self, number: i64) -> Result<Amount<M>, E> {
        Ok(Amount::Number(number as f32))
    }

    fn visit_u64<E: Error>(self, number: u64) -> Result<Amount<M>, E> {
        Ok(Amount::Number(number as f32))
    }

    fn visit_str<E: Error>(self, text: &str) -> Result<Amount<M>, E> {
        Quantity::parse(text).map(Amount::World).ok_or_else(|| E::invalid_value(Unexpected::Str(text), &self))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_quantity_is_a_number_and_a_unit_of_its_measure() {
        for (text, cm_per_s, written) in [
            ("20 km/h", 20.0 * 100.0 / 3.6, "20 km/h"),
            ("5m/s", 500.0, "5 m/s"),
            (" 3e2 cm/s ", 300.0, "300 cm/s"),
            ("0 m/s", 0.0, "0 m/s"),
        ] {
            let speed = Quantity::<Speed>::parse(text).unwrap();
            assert_eq!((speed.amount(), speed.to_string().as_str()), (cm_per_s, written));
            assert_eq!(Quantity::parse(written), Some(speed));
        }
        for text in ["", "km/h", "20", "20 mph", "20 km/h or so", "inf m/s", "nan m/s", "1e99 m/s", "4 cm"] {
            assert_eq!(Quantity::<Speed>::parse(text), None, "{text}");
        }
        assert_eq!(Quantity::<Weight>::parse("earth"), Quantity::parse("1 g"));
        assert_eq!(Quantity::<Strength>::parse("earth"), None);
    }
}
