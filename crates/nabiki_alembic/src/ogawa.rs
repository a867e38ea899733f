//! Ogawa: the container of an Alembic archive, a tree of groups and of data.
//!
//! A file is the word `Ogawa`, a byte that is 0xff once it is whole, a 16-bit version, the place of the root group,
//! then groups and data in any order. A group is a count and as many places, each marked as group or data by its
//! highest bit; data is a length and as many bytes. Place 0 stands for an empty group or empty data. All numbers
//! are little-endian.

pub mod read;
pub mod write;

/// Marks the place of data among a group's children.
pub const DATA: u64 = 1 << 63;

/// What a whole file begins with: name, 0xff, version 1.
pub const HEADER: [u8; 8] = *b"Ogawa\xff\x00\x01";
