//! A hash of everything that determines how a scene's hair moves.

use std::{fmt, ops::Range};

use nabiki::Strands;
use serde::{Serialize, Serializer};
use toml::Value;
use twox_hash::XxHash3_128;

use crate::error::{Error, Result};

/// A 128-bit hash (XXH3) of everything that determines how a scene's hair moves.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SceneId(pub u128);

impl SceneId {
    /// The identity of settings with the strands that they move.
    pub fn of(settings: Self, strands: StrandSum) -> Self {
        let mut digest = Digest::new();
        digest.bytes("settings", &settings.0.to_le_bytes());
        digest.bytes("strands", &strands.0.to_le_bytes());
        digest.finish()
    }
}

/// The contribution of strands at rest to an identity: a sum over strands. The sum of the pieces is therefore that of
/// the complete hair.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct StrandSum(pub u128);

impl StrandSum {
    /// The contribution of strands with these `places` in the complete hair. `ids` are their persistent numbers, if
    /// these influence how they move.
    ///
    /// # Panics
    /// If the number of places or ids is not the number of strands.
    pub fn of(strands: &Strands, places: Range<usize>, ids: Option<&[u32]>) -> Self {
        assert_eq!(places.len(), strands.len(), "a place for each strand");
        let mut bytes = Vec::new();
        let sum = places.enumerate().map(|(s, place)| {
            bytes.clear();
            bytes.extend((place as u64).to_le_bytes());
            bytes.extend(ids.map_or(0, |ids| ids[s]).to_le_bytes());
            bytes.extend(strands.strand(s).iter().flat_map(|p| p.to_array()).flat_map(f32::to_le_bytes));
            XxHash3_128::oneshot(&bytes)
        });
        Self(sum.fold(0, u128::wrapping_add))
    }

    /// The sum of both.
    #[must_use]
    pub fn and(self, further: Self) -> Self {
        Self(self.0.wrapping_add(further.0))
    }
}

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

/// Collects the parts of an identity, each with a name.
pub struct Digest(XxHash3_128);

impl Default for Digest {
    fn default() -> Self {
        Self::new()
    }
}

impl Digest {
    /// An identity with only the version of the method, because the same settings may move differently in another
    /// version.
    pub fn new() -> Self {
        Self::of_method(nabiki::METHOD_VERSION)
    }

    fn of_method(version: u32) -> Self {
        let mut digest = Self(XxHash3_128::default());
        digest.bytes("method", &version.to_le_bytes());
        digest
    }

    /// Adds settings with their defaults filled in. Only the values count, not the spelling in a scene.
    ///
    /// # Errors
    /// Settings that TOML cannot hold.
    pub fn settings(&mut self, name: &str, settings: &impl Serialize) -> Result<()> {
        let value = Value::try_from(settings).map_err(|e| Error::new(format!("{name}: {e}")))?;
        self.bytes(name, b"");
        self.value(&value);
        Ok(())
    }

    /// Adds bytes, such as those of a file.
    pub fn bytes(&mut self, name: &str, bytes: &[u8]) {
        self.part(b'n', name.as_bytes());
        self.part(b'b', bytes);
    }

    /// The identity of everything added.
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
    use glam::Vec3;

    use super::*;

    fn five_strands(change: f32) -> Strands {
        let mut strands = Strands::default();
        for s in 0..5_u8 {
            strands.push((0..3 + s % 2).map(|p| Vec3::new(f32::from(s), f32::from(p), change)));
        }
        strands
    }

    #[test]
    fn the_sums_of_pieces_are_that_of_the_whole() {
        let (whole, ids) = (five_strands(0.5), [4, 3, 2, 1, 0]);
        let all = StrandSum::of(&whole, 0..5, Some(&ids));
        for cut in 0..=5 {
            let part = |range: Range<usize>| {
                let strands = whole.select(&range.clone().collect::<Vec<_>>());
                StrandSum::of(&strands, range.clone(), Some(&ids[range]))
            };
            assert_eq!(part(cut..5).and(part(0..cut)), all, "{cut}");
        }
        assert_ne!(StrandSum::of(&whole, 0..5, None), all);
        assert_ne!(StrandSum::of(&whole, 1..6, Some(&ids)), all);
        assert_ne!(StrandSum::of(&five_strands(0.25), 0..5, Some(&ids)), all);
    }

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
