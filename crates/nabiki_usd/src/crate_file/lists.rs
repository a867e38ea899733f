//! Lists by which a prim or a relationship names others, as layers add to them and take away.

use std::io::{Read, Seek};

use super::read::CrateReader;
use super::tables::number;
use super::{Rep, types};
use crate::Problem;

/// Items of a list that are looked at: many prims may share one list, and those that matter stand first.
const MOST_ITEMS: u64 = 256;

impl<R: Read + Seek> CrateReader<R> {
    /// Whether what names other content names any.
    pub fn holds_any(&mut self, rep: u64) -> Result<bool, Problem> {
        let rep = Rep(rep);
        match rep.kind() {
            // Flags come first: those of lists that are set, or that items are added, prepended or appended to.
            types::TOKEN_LIST..=types::REFERENCE_LIST | types::PAYLOAD_LIST => {
                Ok(self.bytes(rep.payload(), 1)?[0] & 0b0110_0110 != 0)
            }
            types::STRING_VECTOR => Ok(number(&self.bytes(rep.payload(), 8)?) != 0),
            _ => Ok(true),
        }
    }

    /// The prims that a relationship's value names; `None` for what is no prim of the layer.
    pub fn targets(&mut self, rep: u64) -> Result<Vec<Option<usize>>, Problem> {
        let paths = self.list_items(rep)?;
        Ok(paths.into_iter().map(|path| self.prim_of_path.get(&(path as usize)).copied()).collect())
    }

    /// The first of what a list of tokens or paths sets, or of what items it adds, by their numbers.
    pub(super) fn list_items(&mut self, rep: u64) -> Result<Vec<u32>, Problem> {
        let rep = Rep(rep);
        if !matches!(rep.kind(), types::TOKEN_LIST | types::PATH_LIST) {
            return Ok(Vec::new());
        }
        let flags = self.bytes(rep.payload(), 1)?[0];
        let (mut place, mut items) = (rep.payload() + 1, Vec::new());
        // Set, added, prepended, appended; what is taken away comes behind them.
        for flag in [2, 4, 32, 64] {
            if flags & flag != 0 {
                let count = number(&self.bytes(place, 8)?);
                let bytes = self.bytes(place + 8, 4 * count.min(MOST_ITEMS))?;
                items.extend(bytes.as_chunks::<4>().0.iter().map(|&b| u32::from_le_bytes(b)));
                place = place.saturating_add(8).saturating_add(count.saturating_mul(4));
            }
        }
        Ok(items)
    }
}
