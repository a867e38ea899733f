//! Bounding boxes, spreads and guesses in the summary of a file.

use std::fmt;

use glam::Vec3;
use serde::Serialize;

use crate::short::Short;

/// A bounding box (in the file's unit).
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Box3 {
    /// Smallest x, y and z.
    pub min: [f32; 3],
    /// Largest x, y and z.
    pub max: [f32; 3],
}

impl Box3 {
    /// The bounding box of `points`; all 0 if there are none.
    pub fn of(points: &[Vec3]) -> Self {
        if points.is_empty() {
            return Self { min: [0.0; 3], max: [0.0; 3] };
        }
        let (min, max) =
            points.iter().fold((Vec3::INFINITY, Vec3::NEG_INFINITY), |(low, high), &p| (low.min(p), high.max(p)));
        Self { min: min.to_array(), max: max.to_array() }
    }

    /// Distance of its corners.
    pub(super) fn diagonal(&self) -> f32 {
        Vec3::from_array(self.max).distance(Vec3::from_array(self.min))
    }
}

impl fmt::Display for Box3 {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (i, axis) in ["x", ", y", ", z"].into_iter().enumerate() {
            write!(f, "{axis} {}..{}", Short(self.min[i]), Short(self.max[i]))?;
        }
        Ok(())
    }
}

/// Smallest, median and largest of some values.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Spread {
    /// Smallest.
    pub min: f32,
    /// Median.
    pub median: f32,
    /// Largest.
    pub max: f32,
}

impl Spread {
    /// The spread of values in any order; all 0 if there are none.
    pub fn of(mut values: Vec<f32>) -> Self {
        if values.is_empty() {
            return Self { min: 0.0, median: 0.0, max: 0.0 };
        }
        let middle = values.len() / 2;
        let (below, &mut median, above) = values.select_nth_unstable_by(middle, f32::total_cmp);
        let min = below.iter().copied().fold(median, f32::min);
        let max = above.iter().copied().fold(median, f32::max);
        Self { min, median, max }
    }
}

impl fmt::Display for Spread {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} / {} (median) / {}", Short(self.min), Short(self.median), Short(self.max))
    }
}

/// A guess, from its numbers, at what a file does not declare.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Guess {
    /// The unit in which this has the size of a person's hair or head.
    pub likely_unit: Option<&'static str>,
    /// The up axis, assuming that the hair hangs.
    pub likely_up: Option<&'static str>,
}

impl fmt::Display for Guess {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.likely_unit {
            Some(unit) => write!(f, "unit: {unit} (a guess); ")?,
            None => write!(f, "unit: unknown; ")?,
        }
        match self.likely_up {
            Some(up) => write!(f, "up: {up} (a guess: the tips lie the other way); facing: unknown"),
            None => write!(f, "up, facing: unknown"),
        }
    }
}

/// The unit in which something `size` large is most likely what it is meant to be: of `low..high` cm, and nearest, as
/// a ratio, to their geometric middle. `None` where no unit makes it so.
pub(super) fn guess_unit(size: f32, low: f32, high: f32) -> Option<&'static str> {
    let middle = (low * high).sqrt();
    let sizes = [("mm", 0.1), ("cm", 1.0), ("dm", 10.0), ("m", 100.0)].map(|(unit, cm)| (unit, size * cm));
    let fitting = sizes.into_iter().filter(|(_, cm)| (low..high).contains(cm));
    let off = |cm: f32| (cm / middle).ln().abs();
    fitting.min_by(|a, b| off(a.1).total_cmp(&off(b.1))).map(|(unit, _)| unit)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_spread_is_that_of_sorted_values() {
        let spread = Spread::of(vec![5.0, 1.0, 4.0, 2.0, 3.0]);
        assert_eq!((spread.min, spread.median, spread.max), (1.0, 3.0, 5.0));
        assert_eq!(Spread::of(Vec::new()).max, 0.0);
    }

    #[test]
    fn a_unit_is_guessed_only_where_one_fits() {
        assert_eq!(guess_unit(0.44, 15.0, 140.0), Some("m"));
        assert_eq!(guess_unit(44.0, 15.0, 140.0), Some("cm"));
        assert_eq!(guess_unit(1e6, 15.0, 140.0), None);
    }
}
