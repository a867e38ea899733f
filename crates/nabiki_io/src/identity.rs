//! A short name for all that decides how a scene's hair moves.

use std::fmt;

use serde::{Serialize, Serializer};
use toml::Value;
use twox_hash::XxHash3_128;

use crate::error::{Error, Result};

/// 128 bits (XXH3) of everything that decides how a scene's hair moves.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SceneId(pub u128);

impl fmt::Display for SceneId {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:032x}", self.0)
    }
}

impl Serialize for SceneId {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}

/// Collects what an identity is made of, each part under its name.
pub struct Digest(XxHash3_128);

impl Default for Digest {
    fn default() -> Self {
        Self::new()
    }
}

impl Digest {
    /// Of nothing yet but the version of the method: the same settings may move otherwise in another.
    pub fn new() -> Self {
        Self::of_method(nabiki::METHOD_VERSION)
    }

    fn of_method(version: u32) -> Self {
        let mut digest = Self(XxHash3_128::default());
        digest.bytes("method", &version.to_le_bytes());
        digest
    }

    /// Settings with their defaults filled in: it is their values that count, not how a scene spells them.
    ///
    /// # Errors
    /// Settings that TOML cannot hold.
    pub fn settings(&mut self, name: &str, settings: &impl Serialize) -> Result<()> {
        let value = Value::try_from(settings).map_err(|e| Error::new(format!("{name}: {e}")))?;
        self.bytes(name, b"");
        self.value(&value);
        Ok(())
    }

    /// Any bytes, a file's for instance.
    pub fn bytes(&mut self, name: &str, bytes: &[u8]) {
        self.part(b'n', name.as_bytes());
        self.part(b'b', bytes);
    }

    /// The identity of all that was collected.
    pub fn finish(&self) -> SceneId {
        SceneId(self.0.finish_128())
    }

    /// Kind and length before content, so that no two different trees give the same bytes.
    fn part(&mut self, kind: u8, bytes: &[u8]) {
        self.0.write(&[kind]);
        self.0.write(&(bytes.len() as u64).to_le_bytes());
        self.0.write(bytes);
    }

    fn value(&mut self, value: &Value) {
        match value {
            Value::String(text) => self.part(b's', text.as_bytes()),
            Value::Integer(number) => self.part(b'i', &number.to_le_bytes()),
            // 0 and -0 are one setting.
            Value::Float(number) => self.part(b'f', &(number + 0.0).to_le_bytes()),
            Value::Boolean(flag) => self.part(b'l', &[u8::from(*flag)]),
            Value::Datetime(date) => self.part(b'd', date.to_string().as_bytes()),
            Value::Array(values) => {
                self.part(b'a', &(values.len() as u64).to_le_bytes());
                values.iter().for_each(|value| self.value(value));
            }
            Value::Table(table) => {
                self.part(b't', &(table.len() as u64).to_le_bytes());
                let mut entries: Vec<_> = table.iter().collect();
                entries.sort_by_key(|(key, _)| *key);
                for (key, value) in entries {
                    self.part(b'k', key.as_bytes());
                    self.value(value);
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn another_version_of_the_method_is_another_identity() {
        let of = |mut digest: Digest| {
            digest.bytes("points", b"the same");
            digest.finish()
        };
        let now = nabiki::METHOD_VERSION;
        assert_eq!(of(Digest::new()), of(Digest::of_method(now)));
        assert_ne!(of(Digest::new()), of(Digest::of_method(now + 1)));
    }
}
