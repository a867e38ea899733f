//! Binary input whose every length is checked against the file before room is made for it.
//!
//! All formats read here are little-endian. Arrays go from the file straight into their final memory.

use std::{
    fs::File,
    io::{Read, Seek, SeekFrom, Write},
    path::Path,
};

use bytemuck::{AnyBitPattern, NoUninit};

use crate::error::{Error, Result};
use crate::input;
use crate::sum::Sum;

/// A number, or a small array of them, as it stands in a little-endian file.
pub(crate) trait Scalar: AnyBitPattern + NoUninit {
    /// The type whose bytes are turned round on a big-endian machine.
    const WORD: usize;
}

macro_rules! scalars {
    ($($t:ty: $word:expr),*) => { $(impl Scalar for $t { const WORD: usize = $word; })* };
}
scalars!(u8: 1, u16: 2, u32: 4, i32: 4, f32: 4, i64: 8, u64: 8, f64: 8, [u32; 3]: 4, [u8; 4]: 1, [u8; 8]: 1, [u8; 16]: 1, [u32; 4]: 4, [u32; 6]: 4, [f32; 2]: 4, [f32; 3]: 4, [f32; 4]: 4, glam::Vec3: 4);

/// Turns native values into little-endian ones and back: nothing on most machines.
pub(crate) fn swap_if_big_endian<T: Scalar>(values: &mut [T]) {
    if cfg!(target_endian = "big") && T::WORD > 1 {
        bytemuck::cast_slice_mut::<T, u8>(values).chunks_exact_mut(T::WORD).for_each(<[u8]>::reverse);
    }
}

/// A source of known length, read in order or by offset.
pub(crate) struct Bytes<R> {
    reader: R,
    len: u64,
    at: u64,
    /// Of what is read, where that is wanted.
    sum: Option<Sum>,
}

impl Bytes<File> {
    /// Opens a regular file.
    pub fn open(path: &Path) -> Result<Self> {
        let file = input::open(path)?;
        let len = file.metadata().map_err(|e| Error::from(e).in_file(path))?.len();
        Ok(Self { reader: file, len, at: 0, sum: None })
    }
}

impl<'a> Bytes<std::io::Cursor<&'a [u8]>> {
    /// Reads from memory.
    pub fn from_slice(bytes: &'a [u8]) -> Self {
        Self { reader: std::io::Cursor::new(bytes), len: bytes.len() as u64, at: 0, sum: None }
    }
}

impl<R: Read + Seek> Bytes<R> {
    /// Length of the whole source (bytes).
    pub fn len(&self) -> u64 {
        self.len
    }

    /// Offset of the current place (bytes).
    pub fn at(&self) -> u64 {
        self.at
    }

    /// Bytes after the current place.
    pub fn remaining(&self) -> u64 {
        self.len.saturating_sub(self.at)
    }

    /// Goes on at `offset` (bytes from the start); beyond the end nothing can be read.
    pub fn seek(&mut self, offset: u64) -> Result<()> {
        self.reader.seek(SeekFrom::Start(offset))?;
        self.at = offset;
        Ok(())
    }

    /// Refuses, before any room is made, what the source cannot hold.
    pub fn expect(&self, bytes: u64, what: &str) -> Result<()> {
        if bytes > self.remaining() {
            let (at, found) = (self.at, self.remaining());
            return Err(Error::new(format!(
                "{what}: {bytes} bytes expected at offset {at}, {found} found: the file is cut short or its counts are wrong"
            )));
        }
        Ok(())
    }

    /// `count` values into memory of their own.
    pub fn array<T: Scalar>(&mut self, count: usize, what: &str) -> Result<Vec<T>> {
        self.expect((count as u64).saturating_mul(size_of::<T>() as u64), what)?;
        let mut values = bytemuck::zeroed_vec(count);
        self.fill(&mut values, what)?;
        Ok(values)
    }

    /// As many values as `values` has room for.
    pub fn fill<T: Scalar>(&mut self, values: &mut [T], what: &str) -> Result<()> {
        let bytes: &mut [u8] = bytemuck::cast_slice_mut(values);
        self.expect(bytes.len() as u64, what)?;
        self.reader.read_exact(bytes)?;
        self.at += bytes.len() as u64;
        if let Some(sum) = &mut self.sum {
            sum.add(bytes);
        }
        swap_if_big_endian(values);
        Ok(())
    }

    /// Sums up what is read from here on.
    pub fn begin_sum(&mut self) {
        self.sum = Some(Sum::default());
    }

    /// The sum of what was read since it began.
    pub fn end_sum(&mut self) -> Option<u64> {
        self.sum.take().map(|sum| sum.value())
    }

    /// The sum of the next `length` bytes.
    pub fn sum_of(&mut self, length: u64, what: &str) -> Result<u64> {
        self.expect(length, what)?;
        let sum = Sum::of(&mut self.reader, length)?;
        self.at += length;
        Ok(sum)
    }

    /// One value.
    pub fn value<T: Scalar>(&mut self, what: &str) -> Result<T> {
        let mut value = [T::zeroed()];
        self.fill(&mut value, what)?;
        Ok(value[0])
    }
}

/// `a * b` strands or points, or a refusal when no file could hold so many.
pub(crate) fn product(a: u32, b: u32, what: &str) -> Result<usize> {
    let n = u64::from(a) * u64::from(b);
    match u32::try_from(n) {
        Ok(n) => Ok(n as usize),
        Err(_) => Err(Error::new(format!("{what}: {a} x {b} is more than 2^32 - 1"))),
    }
}

/// Writes values in little-endian order.
pub(crate) fn put<T: Scalar>(out: &mut dyn Write, values: &[T]) -> Result<()> {
    if cfg!(target_endian = "big") {
        let mut values = values.to_vec();
        swap_if_big_endian(&mut values);
        out.write_all(bytemuck::cast_slice(&values))?;
    } else {
        out.write_all(bytemuck::cast_slice(values))?;
    }
    Ok(())
}
