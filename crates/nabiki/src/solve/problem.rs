//! What is to be solved.

use std::sync::Arc;

use super::keyed_wind::{KeyedWind, Surroundings};
use super::unknowns::Unknown;
use super::wish::Wish;
use crate::dynamics::Dynamics;
use crate::error::SettingError;
use crate::pose::Pose;
use crate::strands::Strands;

/// Hair, what moves it, what may change, and what is wished for.
#[derive(Clone, Debug)]
pub struct Problem {
    /// The hair at rest (head space, cm): all of a scene's, or some. Only what wishes name is ever stepped; no answer is too
    /// strong for any of it.
    pub hair: Strands,
    /// The strands' numbers in the set they are some of.
    pub ids: Vec<u32>,
    /// How it moves.
    pub dynamics: Dynamics,
    /// Of the head in the world from frame 0 on; none for a head that stands still.
    pub poses: Vec<Pose>,
    /// The wind as it is now.
    pub wind: KeyedWind,
    /// What makes a field of it.
    pub surroundings: Arc<dyn Surroundings>,
    /// What may change.
    pub unknowns: Vec<Unknown>,
    /// What is wished for.
    pub wishes: Vec<Wish>,
    /// What is preferred where wishes leave a choice.
    pub prior: Prior,
}

/// What is preferred where wishes leave a choice: small terms beside them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Prior {
    /// A change of a vector by 100, of a border by 20 frames, of the gusts by 1, of stiffness or settling by a factor e, counts as this distance of all wishes (cm).
    pub keep: f32,
    /// So does a difference by 100 between the vectors of neighbouring intervals of which one is free (cm).
    pub alike: f32,
}

impl Default for Prior {
    fn default() -> Self {
        Self { keep: 0.02, alike: 0.01 }
    }
}

impl Prior {
    /// Refuses distances that are negative or no numbers.
    pub(super) fn check(&self) -> Result<(), SettingError> {
        for (thing, value) in [("prior.keep", self.keep), ("prior.alike", self.alike)] {
            if !(value.is_finite() && value >= 0.0) {
                return Err(SettingError::new(thing, value, "must be a finite distance of at least 0 cm"));
            }
        }
        Ok(())
    }
}
