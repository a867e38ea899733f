//! Refuses NaN and infinities in what a file brings, naming the strand or the entry.

use nabiki::Strands;

use crate::error::{Error, Result};

/// Points, named by strand and point, both counted from 0.
pub(crate) fn points(strands: &Strands) -> Result<()> {
    if all_finite(bytemuck::cast_slice(strands.points())) {
        return Ok(());
    }
    let all = strands.iter().enumerate();
    let mut bad = all.flat_map(|(s, strand)| strand.iter().enumerate().map(move |(p, point)| (s, p, point)));
    match bad.find(|(_, _, point)| !point.is_finite()) {
        Some((s, p, point)) => Err(Error::new(format!(
            "strand {s}, point {p}: ({}, {}, {}) is not a place: coordinates must be finite",
            point.x, point.y, point.z
        ))),
        None => Ok(()),
    }
}

/// Whether no number is NaN or infinite: no exponent is all ones. A greatest value without a branch, so that it keeps
/// up with the memory.
pub(crate) fn all_finite(values: &[f32]) -> bool {
    values.iter().fold(0, |greatest, v| (v.to_bits() & 0x7FFF_FFFF).max(greatest)) < 0x7F80_0000
}

/// Numbers by strand or point.
pub(crate) fn values(name: &str, values: Vec<f32>) -> Result<Vec<f32>> {
    match values.iter().position(|v| !v.is_finite()) {
        Some(i) => Err(Error::new(format!("{name}: entry {i} is {}: must be finite", values[i]))),
        None => Ok(values),
    }
}

/// Diameters by strand or point.
pub(crate) fn widths(name: &str, widths: Vec<f32>) -> Result<Vec<f32>> {
    match widths.iter().position(|&w| !(w.is_finite() && w >= 0.0)) {
        Some(i) => Err(Error::new(format!("{name}: entry {i} is {}: must be a finite number, 0 or more", widths[i]))),
        None => Ok(widths),
    }
}

/// Tuples by strand or point.
pub(crate) fn tuples<const N: usize>(name: &str, tuples: Vec<[f32; N]>) -> Result<Vec<[f32; N]>> {
    match tuples.iter().position(|t| t.iter().any(|v| !v.is_finite())) {
        Some(i) => Err(Error::new(format!("{name}: entry {i} is {:?}: must be finite", tuples[i]))),
        None => Ok(tuples),
    }
}
