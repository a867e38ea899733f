//! A setting that varies along a strand.

use std::fmt;
use std::marker::PhantomData;

use serde::de::value::SeqAccessDeserializer;
use serde::de::{Error, IntoDeserializer, SeqAccess, Visitor};
use serde::{Deserialize, Deserializer, Serialize};

use crate::error::SettingError;
use crate::setting::{Datum, Kind, Place, Range, Value, refused};

/// A setting along a strand: one number, or several from root to tip, evenly spaced by length and interpolated
/// linearly. `N` is the type of the numbers.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(untagged)]
pub enum Profile<N = f32> {
    /// The same from root to tip.
    Even(N),
    /// The first applies at the root, the last at the tip.
    RootToTip(Vec<N>),
}

impl Profile {
    /// Largest number of values in a list.
    pub const MOST: usize = 64;

    /// The value at a fraction of the strand's length: 0 at the root, 1 at the tip.
    pub fn at(&self, along: f64) -> f64 {
        let values = self.values();
        let place = along.clamp(0.0, 1.0) * (values.len() - 1) as f64;
        let before = (place as usize).min(values.len().saturating_sub(2));
        let after = (before + 1).min(values.len() - 1);
        let (a, b) = (f64::from(values[before]), f64::from(values[after]));
        a + (b - a) * (place - before as f64)
    }

    /// The mean over the strand.
    pub fn mean(&self) -> f64 {
        match self.values() {
            [one] => f64::from(*one),
            values => {
                let between = values.windows(2).map(|pair| 0.5 * (f64::from(pair[0]) + f64::from(pair[1])));
                between.sum::<f64>() / (values.len() - 1) as f64
            }
        }
    }

    /// All its numbers times `factor`.
    #[must_use]
    pub(crate) fn times(&self, factor: f64) -> Self {
        self.map(|&value| (f64::from(value) * factor) as f32)
    }

    /// The largest number.
    pub fn largest(&self) -> f32 {
        self.values().iter().copied().fold(f32::NEG_INFINITY, f32::max)
    }
}

impl<N> Profile<N> {
    /// All its numbers, root first.
    pub fn values(&self) -> &[N] {
        match self {
            Self::Even(value) => std::slice::from_ref(value),
            Self::RootToTip(values) => values,
        }
    }

    /// The profile with `number` applied to each value.
    pub fn map<M>(&self, number: impl FnMut(&N) -> M) -> Profile<M> {
        match self {
            Self::Even(value) => Profile::Even({ number }(value)),
            Self::RootToTip(values) => Profile::RootToTip(values.iter().map(number).collect()),
        }
    }
}

impl<'de, N: Deserialize<'de>> Deserialize<'de> for Profile<N> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(Given(PhantomData))
    }
}

/// What a profile is read from.
struct Given<N>(PhantomData<N>);

impl<'de, N: Deserialize<'de>> Visitor<'de> for Given<N> {
    type Value = Profile<N>;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a number, or a list of numbers from root to tip")
    }

    fn visit_f64<E: Error>(self, number: f64) -> Result<Profile<N>, E> {
        N::deserialize(number.into_deserializer()).map(Profile::Even)
    }

    fn visit_i64<E: Error>(self, number: i64) -> Result<Profile<N>, E> {
        N::deserialize(number.into_deserializer()).map(Profile::Even)
    }

    fn visit_u64<E: Error>(self, number: u64) -> Result<Profile<N>, E> {
        N::deserialize(number.into_deserializer()).map(Profile::Even)
    }

    fn visit_str<E: Error>(self, text: &str) -> Result<Profile<N>, E> {
        N::deserialize(text.into_deserializer()).map(Profile::Even)
    }

    fn visit_seq<A: SeqAccess<'de>>(self, numbers: A) -> Result<Profile<N>, A::Error> {
        Vec::deserialize(SeqAccessDeserializer::new(numbers)).map(Profile::RootToTip)
    }
}

impl<N: Value> Value for Profile<N> {
    const KIND: Kind = Kind::OneOf(&[N::KIND, Kind::List(&N::KIND)]);

    fn check(&self, at: &Place, range: &Range) -> Result<(), SettingError> {
        match self {
            Self::Even(value) => value.check(at, range),
            Self::RootToTip(values) if (1..=Profile::MOST).contains(&values.len()) => values.check(at, range),
            Self::RootToTip(values) => {
                let remedy = format!("give one number, or 2 to {} from root to tip", Profile::MOST);
                refused(at, format!("a list of {}", values.len()), remedy)
            }
        }
    }

    fn datum(&self) -> Datum {
        match self {
            Self::Even(value) => value.datum(),
            Self::RootToTip(values) => values.datum(),
        }
    }
}

impl From<f32> for Profile {
    fn from(value: f32) -> Self {
        Self::Even(value)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LEAST_0: Range = Range { unit: "", above: None, least: Some(0.0), most: None };

    #[test]
    fn numbers_are_spread_from_root_to_tip() {
        let list = Profile::RootToTip(vec![4.0, 2.0, 8.0]);
        for (along, value) in [(0.0, 4.0), (0.25, 3.0), (0.5, 2.0), (0.75, 5.0), (1.0, 8.0), (1.5, 8.0)] {
            assert_eq!(list.at(along), value, "{along}");
        }
        assert_eq!(list.largest(), 8.0);
        // With straight lines the mean is that of the middles: (3 + 5) / 2.
        assert_eq!(list.mean(), 4.0);
        assert_eq!(Profile::from(3.0).mean(), 3.0);
        assert_eq!(Profile::from(3.0).at(0.7), 3.0);
        assert_eq!(Profile::RootToTip(vec![3.0]).at(0.7), 3.0);
    }

    #[test]
    fn lists_of_nothing_and_negative_strengths_are_refused_by_place() {
        let refused = |profile: Profile| profile.check(&Place::Table("free.hold"), &LEAST_0).unwrap_err().thing;
        assert_eq!(refused(Profile::RootToTip(Vec::new())), "free.hold");
        assert_eq!(refused(Profile::RootToTip(vec![1.0; 65])), "free.hold");
        assert_eq!(refused(Profile::RootToTip(vec![1.0, f32::NAN])), "free.hold[1]");
        assert_eq!(refused(Profile::Even(-1.0)), "free.hold");
        assert!(Profile::RootToTip(vec![0.0, 1.0]).check(&Place::Table("free.hold"), &LEAST_0).is_ok());
    }
}
