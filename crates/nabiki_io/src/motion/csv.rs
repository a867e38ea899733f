//! Plain tables of poses: t_s, then position, then quaternion, in any order of columns.

use glam::{DQuat, DVec3};

use super::{Sample, Track};
use crate::error::{Error, Result};

/// Reads the table. The header names the columns `t_s`, `qx`, `qy`, `qz`, `qw` and `px`, `py`, `pz` with the unit
/// behind them, `_m`, `_cm` or `_mm`; other columns are left alone.
pub(super) fn track(text: &str) -> Result<Track> {
    let mut lines = text.lines().enumerate().filter(|(_, line)| !line.trim().is_empty() && !line.starts_with('#'));
    let (_, header) = lines.next().ok_or_else(|| Error::new("is empty: a header and rows of poses are needed"))?;
    let names: Vec<&str> = header.split(',').map(str::trim).collect();
    let column = |name: &str| {
        names
            .iter()
            .position(|n| *n == name)
            .ok_or_else(|| Error::new(format!("line 1: no column {name} in \"{header:.80}\"")))
    };
    let (suffix, unit_cm) = [("_m", 100.0), ("_cm", 1.0), ("_mm", 0.1)]
        .into_iter()
        .find(|(suffix, _)| names.contains(&format!("px{suffix}").as_str()))
        .ok_or_else(|| Error::new(format!("line 1: no column px_m, px_cm or px_mm in \"{header:.80}\"")))?;
    let time = column("t_s")?;
    let mut columns = [0; 7];
    for (slot, name) in columns.iter_mut().zip(["px", "py", "pz", "qx", "qy", "qz", "qw"]) {
        *slot = if name.starts_with('p') { column(&format!("{name}{suffix}"))? } else { column(name)? };
    }
    let mut track = Track { what: "table of poses".to_owned(), unit_cm: Some(unit_cm), ..Track::default() };
    for (number, line) in lines {
        let cells: Vec<&str> = line.split(',').map(str::trim).collect();
        let value = |column: usize| -> Result<f64> {
            let cell = cells.get(column).copied().unwrap_or_default();
            match cell.parse::<f64>() {
                Ok(x) if x.is_finite() => Ok(x),
                _ => Err(Error::new(format!(
                    "line {}: {} = \"{cell:.40}\" is not a finite number",
                    number + 1,
                    names[column]
                ))),
            }
        };
        let mut v = [0.0; 7];
        for (v, &column) in v.iter_mut().zip(&columns) {
            *v = value(column)?;
        }
        let rotation = DQuat::from_xyzw(v[3], v[4], v[5], v[6]);
        // Tables are rounded to some digits; a length further off than that is another mistake.
        if (rotation.length() - 1.0).abs() > 1e-2 {
            let length = rotation.length();
            return Err(Error::new(format!(
                "line {}: quaternion of length {length}, but only 1 is a rotation",
                number + 1
            )));
        }
        track.times.push(value(time)?);
        track.samples.push(Sample { position: DVec3::new(v[0], v[1], v[2]), rotation: rotation.normalize() });
    }
    Ok(track)
}
