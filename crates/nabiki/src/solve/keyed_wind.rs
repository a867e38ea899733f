//! The wind to solve for, and the fields around it.

use std::fmt::Debug;
use std::sync::Arc;

use glam::Vec3;

use crate::error::SettingError;
use crate::field::{Ease, Field, FieldSum, Gust, GustField, Keyframe, KeyframedField};

/// The wind whose vectors, borders and gusts may be unknown: keyframes, their ease and gusts.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct KeyedWind {
    /// The intervals. If empty, there is no wind yet; see [`with_interval`].
    pub keyframes: Vec<Keyframe>,
    /// How one vector changes to the next.
    pub ease: Ease,
    /// Gusts on all intervals.
    pub gust: Option<Gust>,
}

impl KeyedWind {
    /// The field of this wind, as in a scene. `frame_rate` is in frames per second.
    ///
    /// # Errors
    /// Keyframes out of order, and numbers that are not finite. No keyframes are allowed: there is no wind then.
    pub fn field(&self, frame_rate: f64) -> Result<Arc<dyn Field>, SettingError> {
        if self.keyframes.is_empty() {
            return Ok(Arc::new(FieldSum::default()));
        }
        let keyframed = Arc::new(KeyframedField::new(&self.keyframes)?.eased(self.ease));
        match &self.gust {
            None => Ok(keyframed),
            Some(gust) => Ok(Arc::new(GustField::new(gust, keyframed, frame_rate)?)),
        }
    }
}

/// Builds the complete field from a wind that is uniform in space.
pub trait Surroundings: Debug + Send + Sync {
    /// The complete field with this wind.
    ///
    /// # Errors
    /// A wind that cannot be used.
    fn field(&self, wind: Arc<dyn Field>) -> Result<Arc<dyn Field>, SettingError>;

    /// The part of the field that is linear in the wind: the wind itself, or its flow around the head. Everything else
    /// that depends on the wind, such as the drift of turbulence, is held constant while derivatives are taken.
    ///
    /// # Errors
    /// As for [`field`](Self::field).
    fn of_wind(&self, wind: Arc<dyn Field>) -> Result<Arc<dyn Field>, SettingError>;
}

/// Only the wind.
#[derive(Clone, Copy, Debug, Default)]
pub struct OpenAir;

impl Surroundings for OpenAir {
    fn field(&self, wind: Arc<dyn Field>) -> Result<Arc<dyn Field>, SettingError> {
        Ok(wind)
    }

    fn of_wind(&self, wind: Arc<dyn Field>) -> Result<Arc<dyn Field>, SettingError> {
        Ok(wind)
    }
}

/// Adds an interval from frame `from` to `through`, both included, and returns the keyframes and its index. It starts
/// with the vector at its first frame, or 0 if there is none, so with a stepped ease hair moves as before until you
/// change a vector. Intervals that it covers completely are removed.
///
/// # Panics
/// If `from` is 0 or after `through`.
pub fn with_interval(keyframes: &[Keyframe], from: u32, through: u32) -> (Vec<Keyframe>, usize) {
    assert!(0 < from && from <= through, "frames {from} to {through}");
    let at = |frame: u32| {
        let j = keyframes.partition_point(|key| key.through < frame);
        keyframes.get(j).or(keyframes.last()).map_or(Vec3::ZERO, |key| key.vector)
    };
    let mut cut: Vec<Keyframe> = keyframes.iter().copied().filter(|key| key.through < from).collect();
    if from > 1 && cut.last().is_none_or(|key| key.through < from - 1) {
        cut.push(Keyframe { through: from - 1, vector: at(from - 1) });
    }
    let new = cut.len();
    cut.push(Keyframe { through, vector: at(from) });
    cut.extend(keyframes.iter().copied().filter(|key| key.through > through));
    if cut.len() == new + 1 && through < u32::MAX {
        // The wind that held after the last interval continues.
        cut.push(Keyframe { through: through + 1, vector: at(through + 1) });
    }
    (cut, new)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn key(through: u32, x: f32) -> Keyframe {
        Keyframe { through, vector: Vec3::new(x, 0.0, 0.0) }
    }

    #[test]
    fn a_new_interval_changes_no_frame() {
        let lists = [vec![key(10, 1.0), key(20, 2.0), key(30, 3.0)], vec![key(5, 4.0)], Vec::new()];
        for keys in &lists {
            for (from, through) in [(1, 3), (1, 30), (4, 12), (11, 20), (15, 40), (31, 50), (6, 6), (20, 21)] {
                let (cut, new) = with_interval(keys, from, through);
                let first = new.checked_sub(1).map_or(1, |before| cut[before].through + 1);
                assert_eq!((first, cut[new].through), (from, through), "{keys:?}");
                let before = |n| match keys.is_empty() {
                    true => Vec3::ZERO,
                    false => KeyframedField::new(keys).unwrap().vector(n),
                };
                let after = KeyframedField::new(&cut).unwrap();
                for n in (1..60).filter(|n| !(from..=through).contains(n)) {
                    assert_eq!(after.vector(n), before(n), "{keys:?} {from} {through} frame {n}");
                }
                assert!((from..=through).all(|n| after.vector(n) == before(from)));
            }
        }
    }
}
