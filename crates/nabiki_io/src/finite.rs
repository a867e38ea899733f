//! Refuses NaN and infinities in what a file brings, naming the strand or the entry.

use nabiki::{Strands, strands::not_finite};

use crate::error::{Error, Result};

/// Points, named by strand and point, both counted from 0.
pub(crate) fn points(strands: &Strands) -> Result<()> {
    let Some(bad) = not_finite(strands.points()) else { return Ok(()) };
    let s = strands.starts().partition_point(|&start| start as usize <= bad) - 1;
    let (p, point) = (bad - strands.range(s).start, strands.points()[bad]);
    Err(Error::new(format!(
        "strand {s}, point {p}: ({}, {}, {}) is not a place: coordinates must be finite",
        point.x, point.y, point.z
    )))
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
