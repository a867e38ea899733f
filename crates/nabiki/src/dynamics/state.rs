//! Where a stepper stands, as bytes: what a saved game keeps, and what goes to another machine.
//!
//! All numbers are little-endian: a header of [`HEADER`] bytes, the points that are shown and the rows of the form, points and rows
//! of the carriers, and a checksum of all of it.

use glam::Vec3;

use super::row::Row;
use crate::METHOD_VERSION;
use crate::error::SettingError;
use crate::random::mix;

/// The first bytes of a state; the last of them is the version of the layout.
const MAGIC: [u8; 8] = *b"nabiki.\x01";
/// Magic, total length, version of the method, and [`Header`].
const HEADER: usize = 72;
const CHECKSUM: usize = 8;

/// What a state is the state of.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Header {
    /// Whether hair moves by the free form.
    pub is_free: bool,
    pub frame: u32,
    /// Points that are shown.
    pub points: u32,
    /// All numbers except those of the carriers.
    pub numbers: u64,
    pub of_carriers: u64,
    /// Identifies the hair.
    pub hair: u64,
    /// The same of the carriers; 0 without any.
    pub carriers: u64,
    /// Identifies the bodies of the stored gaps; 0 without any.
    pub bodies: u64,
}

impl Header {
    /// Whether both have the same carriers.
    pub fn has_carriers_of(&self, other: &Self) -> bool {
        (self.carriers, self.of_carriers) == (other.carriers, other.of_carriers)
    }

    /// Refuses the state of anything else.
    pub fn check(&self, own: &Self) -> Result<(), SettingError> {
        let form = |header: &Self| if header.is_free { "the free form" } else { "the paper's form" };
        if self.is_free != own.is_free {
            let remedy = format!(
                "is of {}, but this hair moves by {}: set the same motion.form, or begin from rest",
                form(self),
                form(own)
            );
            return Err(refused(String::new(), &remedy));
        }
        if (self.points, self.numbers, self.hair) != (own.points, own.numbers, own.hair) {
            let remedy = format!(
                "is of other hair, of {} points, but this hair has {}: give the strands it was saved from, or begin \
                 from rest",
                self.points, own.points
            );
            return Err(refused(String::new(), &remedy));
        }
        Ok(())
    }
}

/// A hash that depends on every word and on their order.
#[derive(Clone, Copy, Debug)]
pub(super) struct Identity(u64);

impl Identity {
    pub fn new() -> Self {
        Self(0)
    }

    /// Inputs that differ in one word never collide; others once in 2^64.
    pub fn word(&mut self, word: u32) {
        self.0 = mix(self.0 ^ u64::from(word));
    }

    pub fn numbers(&mut self, numbers: &[f32]) {
        numbers.iter().for_each(|x| self.word(x.to_bits()));
    }

    /// Never 0, which means none.
    pub fn get(self) -> u64 {
        self.0.max(1)
    }
}

/// Writes the bytes of a state.
pub(super) struct Writer(Vec<u8>);

impl Writer {
    pub fn new(header: &Header) -> Self {
        let length = HEADER + 4 * (header.numbers + header.of_carriers) as usize + CHECKSUM;
        let mut bytes = Vec::with_capacity(length);
        bytes.extend(MAGIC);
        bytes.extend((length as u64).to_le_bytes());
        for word in [METHOD_VERSION, u32::from(header.is_free), header.frame, header.points] {
            bytes.extend(word.to_le_bytes());
        }
        for long in [header.numbers, header.of_carriers, header.hair, header.carriers, header.bodies] {
            bytes.extend(long.to_le_bytes());
        }
        Self(bytes)
    }

    pub fn points(&mut self, points: &[Vec3]) {
        self.0.extend(points.iter().flat_map(|p| p.to_array()).flat_map(f32::to_le_bytes));
    }

    pub fn rows<'a>(&mut self, rows: impl Iterator<Item = &'a Row>) {
        self.0.extend(rows.flat_map(|row| row.0).flat_map(f32::to_le_bytes));
    }

    pub fn finish(mut self) -> Vec<u8> {
        let checksum = checksum(&self.0);
        self.0.extend(checksum.to_le_bytes());
        self.0
    }
}

/// Reads the bytes of a complete state.
pub(super) struct Reader<'a> {
    pub header: Header,
    numbers: &'a [[u8; 4]],
}

impl<'a> Reader<'a> {
    /// `own`: what the state must be of.
    ///
    /// # Errors
    /// Bytes that are no state, cut or altered, and the state of anything else.
    pub fn new(bytes: &'a [u8], own: &Header) -> Result<Self, SettingError> {
        let found = || format!("{} bytes", bytes.len());
        if bytes.len() < HEADER + CHECKSUM || bytes[..7] != MAGIC[..7] {
            return Err(refused(found(), "was not written by state_bytes, or is cut short"));
        }
        if bytes[7] != MAGIC[7] {
            let remedy = format!(
                "has layout {} of another version of nabiki, but this one reads layout {}: begin from rest",
                bytes[7], MAGIC[7]
            );
            return Err(refused(String::new(), &remedy));
        }
        let word = |at: usize| u32::from_le_bytes(std::array::from_fn(|i| bytes[at + i]));
        let long = |at: usize| u64::from_le_bytes(std::array::from_fn(|i| bytes[at + i]));
        if long(8) != bytes.len() as u64 {
            return Err(refused(format!("{} of {}", found(), long(8)), "is cut short, or has bytes after its end"));
        }
        let end = bytes.len() - CHECKSUM;
        if checksum(&bytes[..end]) != long(end) {
            return Err(refused(found(), "is altered: its checksum does not match"));
        }
        if word(16) != METHOD_VERSION {
            let remedy = format!(
                "has METHOD_VERSION {}, but hair moves differently in this one, {METHOD_VERSION}: begin from rest",
                word(16)
            );
            return Err(refused(String::new(), &remedy));
        }
        let header = Header {
            is_free: word(20) != 0,
            frame: word(24),
            points: word(28),
            numbers: long(32),
            of_carriers: long(40),
            hair: long(48),
            carriers: long(56),
            bodies: long(64),
        };
        header.check(own)?;
        let numbers: &[[u8; 4]] = bytes[HEADER..end].as_chunks().0;
        if header.numbers.checked_add(header.of_carriers) != Some(numbers.len() as u64) {
            return Err(refused(found(), "does not match its header"));
        }
        Ok(Self { header, numbers })
    }

    fn next(&mut self, count: usize) -> impl Iterator<Item = f32> + use<'a> {
        let (next, after) = self.numbers.split_at(count);
        self.numbers = after;
        next.iter().map(|bytes| f32::from_le_bytes(*bytes))
    }

    pub fn points(&mut self, points: &mut [Vec3]) {
        let room: &mut [f32] = bytemuck::cast_slice_mut(points);
        let numbers = self.next(room.len());
        room.iter_mut().zip(numbers).for_each(|(x, number)| *x = number);
    }

    pub fn rows<'r>(&mut self, rows: impl Iterator<Item = &'r mut Row>) {
        for row in rows {
            let numbers = self.next(row.0.len());
            row.0.iter_mut().zip(numbers).for_each(|(x, number)| *x = number);
        }
    }
}

fn refused(value: String, remedy: &str) -> SettingError {
    SettingError::new("state of hair", value, remedy)
}

fn checksum(bytes: &[u8]) -> u64 {
    let (words, rest) = bytes.as_chunks();
    debug_assert!(rest.is_empty(), "all is made of words");
    let mut identity = Identity::new();
    words.iter().for_each(|word| identity.word(u32::from_le_bytes(*word)));
    identity.get()
}
