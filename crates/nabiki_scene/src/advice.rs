//! What deserves a look before anything is drawn, and the settings that would mend it.

use std::fmt;

/// What deserves a look: what was seen, and what may mend it.
#[derive(Clone, Debug, PartialEq)]
pub struct Advice {
    /// What was seen.
    pub seen: String,
    /// Settings that would make it right, or better, all together; none where no setting can.
    pub settings: Vec<Setting>,
}

impl Advice {
    /// Whether a file's unit is to be mended.
    pub(crate) fn is_of_unit(&self) -> bool {
        self.settings.iter().any(|setting| setting.key.ends_with(".unit"))
    }
}

/// A setting and its value.
#[derive(Clone, Debug, PartialEq)]
pub struct Setting {
    /// The setting, `head.unit`.
    pub key: &'static str,
    /// The value, in TOML.
    pub value: String,
}

impl fmt::Display for Advice {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.seen)?;
        for (i, Setting { key, value }) in self.settings.iter().enumerate() {
            write!(f, "{} {key} = {value}", if i == 0 { ": give" } else { " and" })?;
        }
        Ok(())
    }
}
