//! Samples as the numbers they stand for.

use crate::Problem;
use crate::layout::{Kind, Pod};
use half::f16;

/// All numbers of a sample as doubles, whatever they are stored as.
pub fn doubles(kind: Kind, bytes: &[u8]) -> Result<Vec<f64>, Problem> {
    fn each<const N: usize>(bytes: &[u8], number: impl Fn([u8; N]) -> f64) -> Vec<f64> {
        bytes.as_chunks::<N>().0.iter().map(|&b| number(b)).collect()
    }
    Ok(match kind.pod {
        Pod::Bool | Pod::U8 => bytes.iter().map(|&b| f64::from(b)).collect(),
        Pod::I8 => bytes.iter().map(|&b| f64::from(b as i8)).collect(),
        Pod::U16 => each(bytes, |b| f64::from(u16::from_le_bytes(b))),
        Pod::I16 => each(bytes, |b| f64::from(i16::from_le_bytes(b))),
        Pod::U32 => each(bytes, |b| f64::from(u32::from_le_bytes(b))),
        Pod::I32 => each(bytes, |b| f64::from(i32::from_le_bytes(b))),
        Pod::U64 => each(bytes, |b| u64::from_le_bytes(b) as f64),
        Pod::I64 => each(bytes, |b| i64::from_le_bytes(b) as f64),
        Pod::F16 => each(bytes, |b| f16::from_le_bytes(b).to_f64()),
        Pod::F32 => each(bytes, |b| f64::from(f32::from_le_bytes(b))),
        Pod::F64 => each(bytes, f64::from_le_bytes),
        Pod::Text | Pod::WideText => return Err(Problem::new("has text where numbers should be")),
    })
}

/// All numbers of a sample as singles; the common case is copied.
pub fn singles(kind: Kind, bytes: &[u8]) -> Result<Vec<f32>, Problem> {
    if kind.pod == Pod::F32 {
        return Ok(bytes.as_chunks::<4>().0.iter().map(|&b| f32::from_le_bytes(b)).collect());
    }
    Ok(doubles(kind, bytes)?.into_iter().map(|x| x as f32).collect())
}

/// All numbers of a sample as integers.
pub fn integers(kind: Kind, bytes: &[u8]) -> Result<Vec<i64>, Problem> {
    match kind.pod {
        Pod::I32 => Ok(bytes.as_chunks::<4>().0.iter().map(|&b| i64::from(i32::from_le_bytes(b))).collect()),
        // Unsigned ones from 2^63 on keep their bits.
        Pod::I64 | Pod::U64 => Ok(bytes.as_chunks::<8>().0.iter().map(|&b| i64::from_le_bytes(b)).collect()),
        _ => Ok(doubles(kind, bytes)?.into_iter().map(|x| x as i64).collect()),
    }
}

/// The words of a sample of text.
pub fn words(kind: Kind, bytes: &[u8]) -> Vec<String> {
    if kind.pod != Pod::Text {
        return Vec::new();
    }
    let mut words: Vec<String> = bytes.split(|&b| b == 0).map(|w| String::from_utf8_lossy(w).into_owned()).collect();
    words.pop();
    words
}
