//! Advice about a scene before it is drawn, with settings that fix it.

use std::fmt;

/// A piece of advice: an observation, and settings that may fix it.
#[derive(Clone, Debug, PartialEq)]
pub struct Advice {
    /// The observation.
    pub seen: String,
    /// Settings that together fix or improve it. Empty if no setting can.
    pub fixes: Vec<Fix>,
}

impl Advice {
    /// Advice that no single setting fixes.
    pub(crate) fn new(seen: impl Into<String>) -> Self {
        Self { seen: seen.into(), fixes: Vec::new() }
    }

    /// Whether it suggests another unit for a file.
    pub(crate) fn is_of_unit(&self) -> bool {
        self.fixes.iter().any(|fix| fix.key.ends_with(".unit"))
    }
}

/// A setting and its suggested value.
#[derive(Clone, Debug, PartialEq)]
pub struct Fix {
    /// The setting, `head.unit`.
    pub key: &'static str,
    /// The value, in TOML.
    pub value: String,
}

impl fmt::Display for Advice {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.seen)?;
        for (i, Fix { key, value }) in self.fixes.iter().enumerate() {
            write!(f, "{} {key} = {value}", if i == 0 { ": give" } else { " and" })?;
        }
        Ok(())
    }
}
