//! Which numbers a stored type is made of.

use super::{Rep, types};
use half::f16;

/// Kinds of numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scalar {
    /// One byte.
    U8,
    /// Signed, four bytes.
    I32,
    /// Unsigned, four bytes.
    U32,
    /// Signed, eight bytes.
    I64,
    /// Unsigned, eight bytes.
    U64,
    /// Half a float.
    F16,
    /// IEEE single.
    F32,
    /// IEEE double.
    F64,
}

impl Scalar {
    /// Bytes of one number.
    pub fn size(self) -> usize {
        match self {
            Self::U8 => 1,
            Self::F16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::I64 | Self::U64 | Self::F64 => 8,
        }
    }

    /// Numbers stored one after another.
    pub fn numbers(self, bytes: &[u8]) -> Vec<f64> {
        fn each<const N: usize>(bytes: &[u8], number: impl Fn([u8; N]) -> f64) -> Vec<f64> {
            bytes.as_chunks::<N>().0.iter().map(|&b| number(b)).collect()
        }
        match self {
            Self::U8 => bytes.iter().map(|&b| f64::from(b)).collect(),
            Self::I32 => each(bytes, |b| f64::from(i32::from_le_bytes(b))),
            Self::U32 => each(bytes, |b| f64::from(u32::from_le_bytes(b))),
            Self::I64 => each(bytes, |b| i64::from_le_bytes(b) as f64),
            Self::U64 => each(bytes, |b| u64::from_le_bytes(b) as f64),
            Self::F16 => each(bytes, |b| f16::from_le_bytes(b).to_f64()),
            Self::F32 => each(bytes, |b| f64::from(f32::from_le_bytes(b))),
            Self::F64 => each(bytes, f64::from_le_bytes),
        }
    }
}

/// Kind of number and how many make a value of a type; `None` for types that are not numbers.
pub fn shape(kind: u8) -> Option<(Scalar, usize)> {
    use Scalar::{F16, F32, F64, I32, I64, U8, U32, U64};
    Some(match kind {
        types::BOOL | types::UCHAR => (U8, 1),
        types::INT => (I32, 1),
        types::UINT => (U32, 1),
        types::INT64 => (I64, 1),
        types::UINT64 => (U64, 1),
        types::HALF => (F16, 1),
        types::FLOAT => (F32, 1),
        types::DOUBLE | types::DOUBLE_VECTOR => (F64, 1),
        types::MATRIX2D => (F64, 4),
        types::MATRIX3D => (F64, 9),
        types::MATRIX4D => (F64, 16),
        types::VEC2I => (I32, 2),
        types::VEC3I => (I32, 3),
        types::VEC4I => (I32, 4),
        types::QUATD | types::VEC4D => (F64, 4),
        types::QUATF | types::VEC4F => (F32, 4),
        types::QUATH | types::VEC4H => (F16, 4),
        types::VEC2D => (F64, 2),
        types::VEC2F => (F32, 2),
        types::VEC2H => (F16, 2),
        types::VEC3D => (F64, 3),
        types::VEC3F => (F32, 3),
        types::VEC3H => (F16, 3),
        _ => return None,
    })
}

/// A value that is its own payload: up to four bytes of it, or one byte for each component.
pub fn inlined(rep: Rep, scalar: Scalar, extent: usize) -> Vec<f64> {
    let bits = rep.payload() as u32;
    let component = |i: usize| f64::from(bits.to_le_bytes()[i] as i8);
    if let types::MATRIX2D..=types::MATRIX4D = rep.kind() {
        let side = usize::from(rep.kind() - types::MATRIX2D) + 2;
        return (0..extent).map(|i| if i % (side + 1) == 0 { component(i / (side + 1)) } else { 0.0 }).collect();
    }
    if extent > 1 {
        return (0..extent).map(component).collect();
    }
    vec![match scalar {
        Scalar::U8 => f64::from(bits as u8),
        Scalar::I32 | Scalar::I64 => f64::from(bits as i32),
        Scalar::U32 | Scalar::U64 => f64::from(bits),
        Scalar::F16 => f16::from_bits(bits as u16).to_f64(),
        Scalar::F32 | Scalar::F64 => f64::from(f32::from_bits(bits)),
    }]
}
