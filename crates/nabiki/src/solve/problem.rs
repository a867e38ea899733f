//! The problem to solve.

use std::sync::Arc;

use super::keyed_wind::{KeyedWind, Surroundings};
use super::unknowns::Unknown;
use super::wish::Wish;
use crate::dynamics::Dynamics;
use crate::error::SettingError;
use crate::pose::Pose;
use crate::strands::Strands;

/// The hair, what moves it, what may change, and the wishes.
#[derive(Clone, Debug)]
pub struct Problem {
    /// The hair at rest (head space, cm): all strands of a scene, or some. Only the strands in wishes are stepped, but
    /// the answer is stable for all of them.
    pub hair: Strands,
    /// The strands' indices in the complete set.
    pub ids: Vec<u32>,
    /// The settings of the motion.
    pub dynamics: Dynamics,
    /// World poses of the head from frame 0 on. Empty for a head that does not move.
    pub poses: Vec<Pose>,
    /// The current wind.
    pub wind: KeyedWind,
    /// Builds the complete field from the wind.
    pub surroundings: Arc<dyn Surroundings>,
    /// What may change.
    pub unknowns: Vec<Unknown>,
    /// The wishes.
    pub wishes: Vec<Wish>,
    /// Preferences among solutions that meet the wishes equally well.
    pub prior: Prior,
}

/// Preferences among solutions that meet the wishes equally well. They are small terms added to the wishes.
#[derive(Clone, Copy, Debug, PartialEq, serde::Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Prior {
    /// Cost of changes, as a distance of all wishes (cm). It applies to a change of a vector by 100, of a border by 20
    /// frames, of the gusts by 1, or of stiffness or settling by a factor of e.
    pub keep: f32,
    /// Cost of a difference of 100 between the vectors of adjacent intervals, of which one may change (cm).
    pub alike: f32,
}

impl Default for Prior {
    fn default() -> Self {
        Self { keep: 0.02, alike: 0.01 }
    }
}

impl Prior {
    /// Refuses distances that are negative or not numbers.
    pub(super) fn check(&self) -> Result<(), SettingError> {
        for (thing, value) in [("prior.keep", self.keep), ("prior.alike", self.alike)] {
            if !(value.is_finite() && value >= 0.0) {
                return Err(SettingError::new(thing, value, "must be a finite distance of at least 0 cm"));
            }
        }
        Ok(())
    }
}
