//! The wind that is solved for, and what stands around it.

use std::fmt::Debug;
use std::sync::Arc;

use glam::Vec3;

use crate::error::SettingError;
use crate::field::{Ease, Field, FieldSum, Gust, GustField, Keyframe, KeyframedField};

/// The wind whose vectors, borders and gusts may be unknown: keyframes, eased or not, and the gusts on them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct KeyedWind {
    /// The intervals. None: no wind yet; see [`with_interval`].
    pub keyframes: Vec<Keyframe>,
    /// From one vector to the next.
    pub ease: Ease,
    /// A random factor on all of them.
    pub gust: Option<Gust>,
}

impl KeyedWind {
    /// The field of it, as a scene has it. `frame_rate`: frames a second.
    ///
    /// # Errors
    /// Keyframes out of order and numbers that are none, but for no keyframes: those are no wind.
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

/// What makes of a wind, uniform in space, all that pushes the hair.
pub trait Surroundings: Debug + Send + Sync {
    /// All that pushes where this is the wind.
    ///
    /// # Errors
    /// A wind that cannot be made a field of.
    fn field(&self, wind: Arc<dyn Field>) -> Result<Arc<dyn Field>, SettingError>;

    /// The part of it that is linear in the wind, for this wind: the wind itself, or its way round the head. What else
    /// depends on the wind, as the drift of swirls, is held while tangents are taken.
    ///
    /// # Errors
    /// As [`field`](Self::field).
    fn of_wind(&self, wind: Arc<dyn Field>) -> Result<Arc<dyn Field>, SettingError>;
}

/// Nothing but the wind.
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

/// The same keyframes with an interval of its own from frame `from` to `through`, both included, and its number. It
/// begins with the vector that was there at its first frame, or none: stepped, hair moves as before until a vector is
/// changed. Intervals that it covers wholly are gone.
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
        // What held for good goes on.
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
