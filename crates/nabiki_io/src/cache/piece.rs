//! Caches with a part of a motion's strands, computed separately.

use std::{fmt, ops::Range, str::FromStr};

use crate::{
    bytes::put,
    error::{Error, Result},
    identity::{Digest, SceneId, StrandSum},
};

pub(super) const TAG: &[u8; 8] = b"shard   ";

/// Bytes of the block before its text.
const FIXED: usize = 72;

/// Shard K of N: one of N ranges of strands of nearly equal size, which together are all strands.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Shard {
    number: u32,
    of: u32,
}

impl Shard {
    /// Shard `number`, 1 to `of`.
    ///
    /// # Errors
    /// If `number` is not in 1..=`of`.
    pub fn new(number: u32, of: u32) -> Result<Self> {
        if number == 0 || number > of {
            let line = match of {
                0 => "there must be at least one shard: 1/1 is everything".to_owned(),
                _ => format!("shards are counted from 1/{of} to {of}/{of}"),
            };
            return Err(Error::new(format!("shard {number}/{of}: {line}")));
        }
        Ok(Self { number, of })
    }

    /// K.
    pub fn number(self) -> u32 {
        self.number
    }

    /// N.
    pub fn of(self) -> u32 {
        self.of
    }

    /// Its range of the strands. Empty only if there are fewer strands than shards.
    pub fn range(self, strands: usize) -> Range<usize> {
        let cut = |shards: u32| (strands as u128 * u128::from(shards) / u128::from(self.of)) as usize;
        cut(self.number - 1)..cut(self.number)
    }
}

impl fmt::Display for Shard {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}/{}", self.number, self.of)
    }
}

impl FromStr for Shard {
    type Err = Error;

    fn from_str(text: &str) -> Result<Self> {
        let parts = text.split_once('/').and_then(|(k, n)| Some((k.parse().ok()?, n.parse().ok()?)));
        match parts {
            Some((number, of)) => Self::new(number, of),
            None => Err(Error::new(format!("shard {text}: write two whole numbers, K/N, as in 2/7"))),
        }
    }
}

/// What a piece stores about the complete motion.
#[derive(Clone, Debug, PartialEq)]
pub struct Piece {
    /// The shard.
    pub shard: Shard,
    /// Total number of strands.
    pub strands: u64,
    /// The identity of the settings, without the strands.
    pub settings: SceneId,
    /// The identity of the complete groom.
    pub groom: SceneId,
    /// The contribution of these strands to the identity of the complete motion.
    pub sum: StrandSum,
    /// Whether the f64 twin computed it.
    pub reference: bool,
    /// The command that made it, without shard and file, for a message about a missing piece.
    pub command: String,
}

impl Piece {
    /// What the cache itself is marked with, so that it is not taken for the whole.
    pub(super) fn identity(&self) -> SceneId {
        let mut digest = Digest::new();
        digest.bytes("shard", self.shard.to_string().as_bytes());
        SceneId::of(SceneId::of(self.settings, self.sum), StrandSum(digest.finish().0))
    }

    pub(super) fn bytes(&self) -> Result<Vec<u8>> {
        let mut out = Vec::new();
        put(&mut out, &[self.shard.number, self.shard.of])?;
        put(&mut out, &[self.strands])?;
        out.extend([self.settings.0, self.groom.0, self.sum.0].into_iter().flat_map(u128::to_le_bytes));
        let length =
            u32::try_from(self.command.len()).map_err(|_| Error::new("shard: its command has 4 GiB or more"))?;
        put(&mut out, &[u32::from(self.reference), length])?;
        out.extend_from_slice(self.command.as_bytes());
        Ok(out)
    }

    pub(super) fn from_bytes(bytes: &[u8]) -> Result<Self> {
        let damaged = || Error::new("attribute shard: does not fill its block: the file is damaged");
        let (fixed, text) = bytes.split_first_chunk::<FIXED>().ok_or_else(damaged)?;
        let word = |at: usize| u32::from_le_bytes(std::array::from_fn(|i| fixed[at + i]));
        let number = |at: usize| u128::from_le_bytes(std::array::from_fn(|i| fixed[at + i]));
        if word(68) as usize != text.len() {
            return Err(damaged());
        }
        Ok(Self {
            shard: Shard::new(word(0), word(4)).map_err(|e| Error::new(format!("{}: the file is damaged", e.what)))?,
            strands: u64::from_le_bytes(std::array::from_fn(|i| fixed[8 + i])),
            settings: SceneId(number(16)),
            groom: SceneId(number(32)),
            sum: StrandSum(number(48)),
            reference: word(64) != 0,
            command: std::str::from_utf8(text).map_err(|_| damaged())?.to_owned(),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shards_are_all_strands_each_once_and_nearly_alike() {
        for strands in [1_usize, 2, 7, 100, 19_330, u32::MAX as usize] {
            for of in [1, 2, 3, 7, 64, 1000] {
                let mut next = 0;
                for number in 1..=of {
                    let range = Shard::new(number, of).unwrap().range(strands);
                    assert_eq!(range.start, next);
                    let even = strands / of as usize;
                    assert!((even..=even + 1).contains(&range.len()), "{number}/{of} of {strands}");
                    next = range.end;
                }
                assert_eq!(next, strands);
            }
        }
    }

    #[test]
    fn what_names_no_shard_is_refused() {
        for (text, why) in [
            ("0/3", "shards are counted from 1/3 to 3/3"),
            ("4/3", "shards are counted from 1/3 to 3/3"),
            ("3/0", "1/1 is everything"),
            ("a/b", "K/N"),
            ("3", "K/N"),
            ("1/2/3", "K/N"),
            ("-1/3", "K/N"),
            ("1/99999999999", "K/N"),
            ("", "K/N"),
        ] {
            let line = text.parse::<Shard>().unwrap_err().to_string();
            assert!(line.starts_with(&format!("shard {text}: ")) && line.contains(why), "{line}");
        }
        assert_eq!("2/7".parse::<Shard>().unwrap().to_string(), "2/7");
    }

    #[test]
    fn a_piece_comes_back_and_a_damaged_one_is_refused() {
        let piece = Piece {
            shard: Shard::new(2, 7).unwrap(),
            strands: 1 << 40,
            settings: SceneId(0x0123_4567_89ab_cdef << 60),
            groom: SceneId(7),
            sum: StrandSum(u128::MAX),
            reference: true,
            command: "nabiki simulate '\u{30d2}.toml'".to_owned(),
        };
        let bytes = piece.bytes().unwrap();
        assert_eq!(Piece::from_bytes(&bytes).unwrap(), piece);
        for length in 0..bytes.len() {
            assert!(Piece::from_bytes(&bytes[..length]).is_err(), "{length} bytes");
        }
        let mut nowhere = bytes;
        nowhere[0] = 8;
        assert!(Piece::from_bytes(&nowhere).unwrap_err().to_string().contains("8/7"));
    }
}
