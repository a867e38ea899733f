//! The error for a setting that cannot be simulated.

use std::fmt::{self, Display};

use crate::key::Key;

/// A setting that was refused before the simulation started: its name, its value, and what it may be.
///
/// It displays as one line, `motion.time_step = -0.1: must be a number above 0`. A front end adds the file. `Debug` is
/// the same line, because that is what a `main` that returns the error prints.
#[derive(Clone, PartialEq, thiserror::Error)]
pub struct SettingError {
    /// The setting's name in a scene file, such as `motion.time_step`.
    pub thing: Key,
    /// The value; empty where there is none, and the remedy then continues the name.
    pub value: String,
    /// The allowed range, or how to fix it: a phrase that follows a colon.
    pub remedy: String,
}

impl SettingError {
    /// An error about `thing` and its `value`.
    pub fn new(thing: impl Into<Key>, value: impl Display, remedy: impl Into<String>) -> Self {
        Self { thing: thing.into(), value: value.to_string(), remedy: remedy.into() }
    }
}

impl fmt::Display for SettingError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.value.is_empty() {
            return write!(f, "{} {}", self.thing, self.remedy);
        }
        write!(f, "{} = {}: {}", self.thing, self.value, self.remedy)
    }
}

impl fmt::Debug for SettingError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, f)
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
