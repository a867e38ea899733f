//! How Alembic lays properties and objects out in Ogawa's groups: the numbers shared by writer and reader.
//!
//! An object is a group: its properties, its child objects, then data with the names of those. Compound properties
//! are groups of the same kind. An array property is a group with two children a sample: 16 bytes of digest before
//! the values, and the dimensions (left empty for one-dimensional arrays of numbers); a scalar property has the
//! former only.

use nabiki::hair::Stored;

/// Kind of one number of a sample, as a header stores it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pod {
    /// One byte, 0 or 1.
    Bool = 0,
    /// Unsigned byte.
    U8 = 1,
    /// Signed byte.
    I8 = 2,
    /// Unsigned, two bytes.
    U16 = 3,
    /// Signed, two bytes.
    I16 = 4,
    /// Unsigned, four bytes.
    U32 = 5,
    /// Signed, four bytes.
    I32 = 6,
    /// Unsigned, eight bytes.
    U64 = 7,
    /// Signed, eight bytes.
    I64 = 8,
    /// Half a float.
    F16 = 9,
    /// IEEE single.
    F32 = 10,
    /// IEEE double.
    F64 = 11,
    /// Bytes up to a 0.
    Text = 12,
    /// 32-bit characters up to a 0.
    WideText = 13,
}

impl Pod {
    /// The kind stored as `code`.
    pub fn from_code(code: u32) -> Option<Self> {
        use Pod::*;
        [Bool, U8, I8, U16, I16, U32, I32, U64, I64, F16, F32, F64, Text, WideText].get(code as usize).copied()
    }

    /// Bytes of one number; 1 for text.
    pub fn size(self) -> usize {
        match self {
            Self::Bool | Self::U8 | Self::I8 | Self::Text => 1,
            Self::U16 | Self::I16 | Self::F16 => 2,
            Self::U32 | Self::I32 | Self::F32 | Self::WideText => 4,
            Self::U64 | Self::I64 | Self::F64 => 8,
        }
    }

    /// Its name in metadata.
    pub fn name(self) -> &'static str {
        match self {
            Self::Bool => "bool_t",
            Self::U8 => "uint8_t",
            Self::I8 => "int8_t",
            Self::U16 => "uint16_t",
            Self::I16 => "int16_t",
            Self::U32 => "uint32_t",
            Self::I32 => "int32_t",
            Self::U64 => "uint64_t",
            Self::I64 => "int64_t",
            Self::F16 => "float16_t",
            Self::F32 => "float32_t",
            Self::F64 => "float64_t",
            Self::Text => "string",
            Self::WideText => "wstring",
        }
    }
}

/// Kinds as an attribute that is passed on knows them.
const KINDS: [(Pod, Stored); 13] = [
    (Pod::Bool, Stored::Bool),
    (Pod::U8, Stored::U8),
    (Pod::I8, Stored::I8),
    (Pod::U16, Stored::U16),
    (Pod::I16, Stored::I16),
    (Pod::U32, Stored::U32),
    (Pod::I32, Stored::I32),
    (Pod::U64, Stored::U64),
    (Pod::I64, Stored::I64),
    (Pod::F16, Stored::F16),
    (Pod::F32, Stored::F32),
    (Pod::F64, Stored::F64),
    (Pod::Text, Stored::Text),
];

/// What a kind of number or text is to an attribute that is passed on.
pub fn stored(pod: Pod) -> Stored {
    KINDS.iter().find(|(known, _)| *known == pod).map_or(Stored::Text, |&(_, stored)| stored)
}

/// The kind that stores it; tokens are text here.
pub fn pod(stored: Stored) -> Pod {
    KINDS.iter().find(|(_, known)| *known == stored).map_or(Pod::Text, |&(pod, _)| pod)
}

/// Type of numbers and how many make one value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Kind {
    /// Kind of a number.
    pub pod: Pod,
    /// Numbers in a value: 3 for a point.
    pub extent: u8,
}

/// A property's header: 32 bits of flags, then numbers of a width that the flags say, then its name.
pub mod flags {
    /// 0 compound, 1 scalar, 2 array, 3 array of one value.
    pub const TYPE: u32 = 0x3;
    /// 0, 1 or 2 for numbers of 1, 2 or 4 bytes.
    pub const WIDTH_SHIFT: u32 = 2;
    /// [`Pod`](super::Pod).
    pub const POD_SHIFT: u32 = 4;
    /// The number of a time sampling follows.
    pub const TIMED: u32 = 0x100;
    /// First and last changed sample follow.
    pub const CHANGES: u32 = 0x200;
    /// All samples have the same number of values.
    pub const HOMOGENEOUS: u32 = 0x400;
    /// All samples are equal.
    pub const CONSTANT: u32 = 0x800;
    /// Extent, 8 bits.
    pub const EXTENT_SHIFT: u32 = 12;
    /// Place of the metadata in the archive's table, 8 bits; 255 if it follows instead.
    pub const METADATA_SHIFT: u32 = 20;
}

/// Metadata that follows its header rather than standing in the table.
pub const INLINE_METADATA: u8 = 255;
