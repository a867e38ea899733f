//! Checksums of bytes, for detecting damage.

use std::hash::Hasher;
use std::io::{self, Read, Write};

use twox_hash::XxHash3_64;

use crate::error::Result;

/// Bytes that are read at a time: few, since they lie on the stack.
const CHUNK: usize = 1 << 14;

/// XXH3 of 64 bits, without a seed, of bytes in whatever portions they come.
#[derive(Clone, Default)]
pub(crate) struct Sum(XxHash3_64);

impl Sum {
    /// Adds the next bytes.
    pub fn add(&mut self, bytes: &[u8]) {
        self.0.write(bytes);
    }

    /// The checksum of everything added.
    pub fn value(&self) -> u64 {
        self.0.finish()
    }

    /// The checksum of the next `length` bytes of a source.
    pub fn of(source: &mut dyn Read, length: u64) -> Result<u64> {
        let (mut sum, mut left) = (Self::default(), length);
        let mut chunk = [0; CHUNK];
        while left > 0 {
            let room = usize::try_from(left).map_or(CHUNK, |left| left.min(CHUNK));
            source.read_exact(&mut chunk[..room])?;
            sum.add(&chunk[..room]);
            left -= room as u64;
        }
        Ok(sum.value())
    }
}

/// Writes, and sums up what is written.
pub(crate) struct Summing<'a> {
    pub out: &'a mut dyn Write,
    pub sum: &'a mut Sum,
}

impl Write for Summing<'_> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let written = self.out.write(bytes)?;
        self.sum.add(&bytes[..written]);
        Ok(written)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.out.flush()
    }
}
