//! A setting that cannot be simulated.

use std::fmt::{self, Display};

use crate::key::Key;

/// A setting refused before anything is stepped: which one, what it was, and what it may be.
///
/// Its text is one line, `motion.time_step = -0.1: must be a number above 0`, to which a front end adds the file.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub struct SettingError {
    /// The setting's name as a scene file spells it, `motion.time_step`.
    pub thing: Key,
    /// The value found.
    pub value: String,
    /// The range allowed, or the way out: a phrase that reads after a colon.
    pub remedy: String,
}

impl SettingError {
    /// Names `thing`, the `value` it has, and what to do about it.
    pub fn new(thing: impl Into<Key>, value: impl Display, remedy: impl Into<String>) -> Self {
        Self { thing: thing.into(), value: value.to_string(), remedy: remedy.into() }
    }
}

impl fmt::Display for SettingError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} = {}: {}", self.thing, self.value, self.remedy)
    }
}

/// Refuses anything but a finite number above 0.
pub fn check_positive(thing: &str, value: f32) -> Result<(), SettingError> {
    if value.is_finite() && value > 0.0 {
        Ok(())
    } else {
        Err(SettingError::new(thing, value, "must be a finite number above 0"))
    }
}

/// Refuses NaN, infinities and anything outside `low..=high`.
pub fn check_range(thing: &str, value: f32, low: f32, high: f32) -> Result<(), SettingError> {
    if (low..=high).contains(&value) {
        Ok(())
    } else {
        Err(SettingError::new(thing, value, format!("must lie in {low}..{high}")))
    }
}
