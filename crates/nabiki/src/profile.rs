//! A strength along a strand.

use serde::{Deserialize, Serialize};

use crate::error::SettingError;
use crate::setting::{Datum, Kind, Place, Range, Value, refused};

/// A setting along a strand: one number, or a few from root to tip, evenly spread over the strand's length and joined by
/// straight lines.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[serde(untagged, expecting = "must be a number, or a list of numbers from root to tip")]
pub enum Profile {
    /// The same from root to tip.
    Even(f32),
    /// The first at the root, the last at the tip.
    RootToTip(Vec<f32>),
}

impl Profile {
    /// The most numbers that a list may have.
    pub const MOST: usize = 64;

    /// The value at a part of the strand's length, 0 at the root and 1 at the tip.
    pub fn at(&self, along: f64) -> f64 {
        let values = self.values();
        let place = along.clamp(0.0, 1.0) * (values.len() - 1) as f64;
        let before = (place as usize).min(values.len().saturating_sub(2));
        let after = (before + 1).min(values.len() - 1);
        let (a, b) = (f64::from(values[before]), f64::from(values[after]));
        a + (b - a) * (place - before as f64)
    }

    /// All its numbers, root first.
    pub fn values(&self) -> &[f32] {
        match self {
            Self::Even(value) => std::slice::from_ref(value),
            Self::RootToTip(values) => values,
        }
    }

    /// All its numbers times `factor`.
    #[must_use]
    pub(crate) fn times(&self, factor: f64) -> Self {
        let times = |value: f32| (f64::from(value) * factor) as f32;
        match self {
            Self::Even(value) => Self::Even(times(*value)),
            Self::RootToTip(values) => Self::RootToTip(values.iter().copied().map(times).collect()),
        }
    }

    /// The largest of its numbers.
    pub fn largest(&self) -> f32 {
        self.values().iter().copied().fold(f32::NEG_INFINITY, f32::max)
    }
}

impl Value for Profile {
    const KIND: Kind = Kind::OneOf(&[Kind::Number, Kind::List(&Kind::Number)]);

    fn check(&self, at: &Place, range: &Range) -> Result<(), SettingError> {
        match self {
            Self::Even(value) => value.check(at, range),
            Self::RootToTip(values) if (1..=Self::MOST).contains(&values.len()) => values.check(at, range),
            Self::RootToTip(values) => {
                let remedy = format!("give one number, or 2 to {} from root to tip", Self::MOST);
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
