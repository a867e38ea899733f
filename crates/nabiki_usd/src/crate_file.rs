//! Binary layers (.usdc): what writer and reader share of the format that USD calls a crate file.
//!
//! A file is a header, values in any order, six tables and a list of those. Tables of integers are coded as
//! differences of 0 (the commonest), 1, 2 or 4 bytes and packed with LZ4. A value is named by 64 bits: three flags,
//! its type, and either itself, if small, or its place. This writes version 0.8.0, which every USD since 2020 reads.

pub mod integers;
pub mod lists;
pub mod numbers;
pub mod read;
pub mod tables;
pub mod write;

/// What a file begins with.
pub const MAGIC: &[u8; 8] = b"PXR-USDC";
/// Bytes of the header: magic, version, place of the list of tables, reserve.
pub const HEADER: usize = 88;
/// Ends a set of fields.
pub const END_OF_SET: u32 = u32::MAX;

/// Types of values, as stored.
pub mod types {
    #![allow(missing_docs)]
    pub const BOOL: u8 = 1;
    pub const UCHAR: u8 = 2;
    pub const INT: u8 = 3;
    pub const UINT: u8 = 4;
    pub const INT64: u8 = 5;
    pub const UINT64: u8 = 6;
    pub const HALF: u8 = 7;
    pub const FLOAT: u8 = 8;
    pub const DOUBLE: u8 = 9;
    pub const STRING: u8 = 10;
    pub const TOKEN: u8 = 11;
    pub const MATRIX2D: u8 = 13;
    pub const MATRIX3D: u8 = 14;
    pub const MATRIX4D: u8 = 15;
    pub const QUATD: u8 = 16;
    pub const QUATF: u8 = 17;
    pub const QUATH: u8 = 18;
    pub const VEC2D: u8 = 19;
    pub const VEC2F: u8 = 20;
    pub const VEC2H: u8 = 21;
    pub const VEC2I: u8 = 22;
    pub const VEC3D: u8 = 23;
    pub const VEC3F: u8 = 24;
    pub const VEC3H: u8 = 25;
    pub const VEC3I: u8 = 26;
    pub const VEC4D: u8 = 27;
    pub const VEC4F: u8 = 28;
    pub const VEC4H: u8 = 29;
    pub const VEC4I: u8 = 30;
    pub const TOKEN_LIST: u8 = 32;
    pub const PATH_LIST: u8 = 34;
    pub const REFERENCE_LIST: u8 = 35;
    pub const TOKEN_VECTOR: u8 = 41;
    pub const SPECIFIER: u8 = 42;
    pub const VARIABILITY: u8 = 44;
    pub const TIME_SAMPLES: u8 = 46;
    pub const DOUBLE_VECTOR: u8 = 48;
    pub const STRING_VECTOR: u8 = 50;
    pub const VALUE_BLOCK: u8 = 51;
    pub const PAYLOAD_LIST: u8 = 55;
}

/// What a path names.
pub mod specs {
    /// A property with values.
    pub const ATTRIBUTE: u32 = 1;
    /// A prim.
    pub const PRIM: u32 = 6;
    /// The layer itself.
    pub const LAYER: u32 = 7;
    /// A property that names other prims.
    pub const RELATIONSHIP: u32 = 8;
}

/// A value: itself or its place.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Rep(pub u64);

impl Rep {
    const ARRAY: u64 = 1 << 63;
    const INLINED: u64 = 1 << 62;
    const COMPRESSED: u64 = 1 << 61;
    const PAYLOAD: u64 = (1 << 48) - 1;

    /// A small value itself.
    pub fn inlined(kind: u8, payload: u32) -> Self {
        Self(Self::INLINED | u64::from(kind) << 48 | u64::from(payload))
    }

    /// A value at a place.
    pub fn at(kind: u8, place: u64) -> Self {
        Self(u64::from(kind) << 48 | place)
    }

    /// An array at a place; 0 for an empty one.
    pub fn array(kind: u8, place: u64) -> Self {
        Self(Self::ARRAY | u64::from(kind) << 48 | place)
    }

    /// The type.
    pub fn kind(self) -> u8 {
        (self.0 >> 48) as u8
    }

    /// Whether it is an array.
    pub fn is_array(self) -> bool {
        self.0 & Self::ARRAY != 0
    }

    /// Whether the payload is the value.
    pub fn is_inlined(self) -> bool {
        self.0 & Self::INLINED != 0
    }

    /// Whether the array is packed.
    pub fn is_compressed(self) -> bool {
        self.0 & Self::COMPRESSED != 0
    }

    /// The value or its place.
    pub fn payload(self) -> u64 {
        self.0 & Self::PAYLOAD
    }
}
