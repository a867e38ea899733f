//! Plain tables of poses: t_s, then position, then quaternion, in any order of columns.

use glam::{DQuat, DVec3};

use super::track::{Sample, Track};
use crate::error::{Error, Result};

/// What a row gives: time (s), position, quaternion.
const WANTED: [&str; 8] = ["t_s", "px", "py", "pz", "qx", "qy", "qz", "qw"];

/// Endings of the position's columns, and the centimetres in their unit.
const UNITS: [(&str, f64); 3] = [("_m", 100.0), ("_cm", 1.0), ("_mm", 0.1)];

/// Columns that a table may have.
const MOST_COLUMNS: usize = 10_000;

/// Reads the table. The header names the columns `t_s`, `qx`, `qy`, `qz`, `qw` and `px`, `py`, `pz` with the unit
/// behind them, `_m`, `_cm` or `_mm`; other columns are left alone.
pub(super) fn track(text: &str) -> Result<Track> {
    // Spreadsheets put a mark before the first character.
    let text = text.trim_start_matches('\u{feff}');
    let mut lines = text.lines().enumerate().map(|(i, line)| (i + 1, line));
    let mut lines = lines.by_ref().filter(|(_, line)| !line.trim().is_empty() && !line.starts_with('#'));
    let (number, header) = lines.next().ok_or_else(|| Error::new("is empty: a header and rows of poses are needed"))?;
    let columns = Columns::of(header).map_err(|e| e.at_line(Some(number)))?;
    let unit_cm = Some(columns.unit_cm);
    let mut track = Track { what: "table of poses".to_owned(), unit_cm, ..Track::default() };
    for (number, line) in lines {
        let (time, sample) = columns.row(line).map_err(|e| e.at_line(Some(number)))?;
        track.times.push(time);
        track.samples.push(sample);
    }
    Ok(track)
}

/// The cells of a line. Quotes hold one cell together, and are no part of it.
fn cells(line: &str) -> Vec<&str> {
    let mut quoted = false;
    let cells = line.split(|c| {
        quoted ^= c == '"';
        c == ',' && !quoted
    });
    // One more shows that they are too many.
    cells.map(|cell| cell.trim().trim_matches('"').trim()).take(MOST_COLUMNS + 1).collect()
}

/// Where in a row the wanted numbers stand.
struct Columns<'a> {
    /// Names of all columns.
    names: Vec<&'a str>,
    /// Column of each that is wanted, in the order of [`WANTED`].
    places: [usize; 8],
    /// Length of the positions' unit (cm).
    unit_cm: f64,
}

impl<'a> Columns<'a> {
    fn of(header: &'a str) -> Result<Self> {
        let names: Vec<&str> = cells(header);
        if names.len() > MOST_COLUMNS {
            return Err(Error::new(format!(
                "names more than {MOST_COLUMNS} columns, but a pose needs only eight: remove others"
            )));
        }
        if let Some(separator) = [(';', "semicolons"), ('\t', "tabs")].iter().find(|(c, _)| header.contains(*c)) {
            return Err(Error::new(format!("columns are separated by {}: save the table with commas", separator.1)));
        }
        let place = |name: &str| names.iter().position(|found| *found == name);
        let lacks = |name: &str| {
            let all = "t_s, px_m, py_m, pz_m (or _cm, _mm), qx, qy, qz, qw";
            Error::new(format!("no column {name} in \"{header:.80}\": a header must name {all}"))
        };
        let in_unit = |name: &str| UNITS.into_iter().find(|(ending, _)| place(&format!("{name}{ending}")).is_some());
        let (ending, unit_cm) = in_unit("px").ok_or_else(|| lacks("px_m, px_cm or px_mm"))?;
        let mut places = [0; 8];
        for (found, name) in places.iter_mut().zip(WANTED) {
            let full = if name.starts_with('p') { format!("{name}{ending}") } else { name.to_owned() };
            *found = match place(&full) {
                Some(place) => place,
                None => {
                    return Err(match in_unit(name).filter(|_| name.starts_with('p')) {
                        Some((other, _)) => {
                            let way = "positions must share a unit: convert and rename one column";
                            Error::new(format!("column {name}{other} beside px{ending}: {way}"))
                        }
                        None => lacks(&full),
                    });
                }
            };
            if names.iter().filter(|other| **other == full).count() > 1 {
                return Err(Error::new(format!("column {full} occurs twice: remove or rename one")));
            }
        }
        Ok(Self { names, places, unit_cm })
    }

    /// Time (s) and pose of a row; of several wrong cells the first one is named.
    fn row(&self, line: &str) -> Result<(f64, Sample)> {
        let cells: Vec<&str> = cells(line);
        let (found, wanted) = (cells.len(), self.names.len());
        // Some programs end rows with a comma.
        if found < wanted || cells[wanted..].iter().any(|cell| !cell.is_empty()) {
            let what = format!("{found} cells, but the header names {wanted} columns: is a comma missing or extra?");
            return Err(Error::new(what));
        }
        let mut values = [0.0; 8];
        let mut in_order: Vec<usize> = (0..8).collect();
        in_order.sort_unstable_by_key(|&which| self.places[which]);
        for which in in_order {
            let place = self.places[which];
            values[which] = match cells[place].parse::<f64>() {
                Ok(x) if x.is_finite() => x,
                _ => {
                    let (name, cell) = (self.names[place], cells[place]);
                    return Err(Error::new(format!("{name} = \"{cell:.40}\": must be a finite number")));
                }
            };
        }
        let [time, px, py, pz, qx, qy, qz, qw] = values;
        let rotation = DQuat::from_xyzw(qx, qy, qz, qw);
        // Tables are rounded to some digits; a length further off than that is another mistake.
        if (rotation.length() - 1.0).abs() > 1e-2 {
            let length = rotation.length();
            let what = format!("qx, qy, qz, qw = {qx}, {qy}, {qz}, {qw}: a quaternion of length {length}");
            return Err(Error::new(format!("{what}, but only 1 is a rotation: divide by its length")));
        }
        Ok((time, Sample { position: DVec3::new(px, py, pz), rotation: rotation.normalize() }))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const HEADER: &str = "t_s,px_cm,py_cm,pz_cm,qx,qy,qz,qw";

    fn refused(text: &str) -> (Option<usize>, String) {
        let refused = track(text).unwrap_err();
        (refused.line, refused.what)
    }

    #[test]
    fn a_wrong_cell_is_blamed_on_its_own_column() {
        let names: Vec<&str> = HEADER.split(',').collect();
        for wrong in ["", "abc", "nan", "inf", "1e999", "1 2"] {
            for (column, name) in names.iter().enumerate() {
                let mut cells = ["0", "1", "2", "3", "0", "0", "0", "1"];
                cells[column] = wrong;
                // The columns in this order, and in the reverse.
                let (row, mut backwards) = (cells.join(","), cells);
                backwards.reverse();
                let header = names.iter().rev().copied().collect::<Vec<_>>().join(",");
                for (header, row) in [(HEADER.to_owned(), row), (header, backwards.join(","))] {
                    let text = format!("# a comment\n\n{header}\n{row}\n");
                    let said = format!("{name} = \"{wrong}\": must be a finite number");
                    assert_eq!(refused(&text), (Some(4), said));
                }
            }
        }
    }

    #[test]
    fn of_two_wrong_cells_the_first_is_named() {
        assert!(refused(&format!("{HEADER}\n0,1,x,3,0,0,0,y\n")).1.starts_with("py_cm = \"x\""));
        assert!(refused(&format!("other,{HEADER}\nfree text,u,1,x,3,0,0,0,y\n")).1.starts_with("t_s = \"u\""));
    }

    #[test]
    fn any_cell_may_be_quoted() {
        let quoted = |line: &str| line.split(',').map(|cell| format!("\"{cell}\"")).collect::<Vec<_>>().join(",");
        let row = "0,1,2,3,0,0,0,1";
        let read = |header: &str, row: &str| {
            let track = track(&format!("{header}\n{row}\n")).unwrap();
            (track.times, track.samples)
        };
        let plain = read(HEADER, row);
        assert_eq!(read(&quoted(HEADER), row), plain);
        assert_eq!(read(&quoted(HEADER), &quoted(row)), plain);
        assert_eq!(read(HEADER, &row.replace("1", "\" 1\" ")), plain);
        assert_eq!(read(&format!("note,{HEADER}"), &format!("\"one, \"\"two\"\"\",{row}")), plain);
        let (_, said) = refused(&format!("{HEADER}\n\"0,5\",1,2,3,0,0,0,1\n"));
        assert_eq!(said, "t_s = \"0,5\": must be a finite number");
    }

    #[test]
    fn a_missing_column_is_named_and_so_is_one_too_many() {
        for name in HEADER.split(',') {
            let header: Vec<&str> = HEADER.split(',').filter(|other| *other != name).collect();
            let (line, said) = refused(&format!("{}\n0,0,0,0,0,0,1\n", header.join(",")));
            let named = if name == "px_cm" { "px_m, px_cm or px_mm" } else { name };
            assert!(line == Some(1) && said.starts_with(&format!("no column {named} in ")), "{said}");
            let (_, said) = refused(&format!("{HEADER},{name}\n0,1,2,3,0,0,0,1,9\n"));
            assert_eq!(said, format!("column {name} occurs twice: remove or rename one"));
        }
        let (_, said) = refused(&format!("{}\n", HEADER.replace("py_cm", "py_m")));
        assert_eq!(said, "column py_m beside px_cm: positions must share a unit: convert and rename one column");
        let (_, said) = refused(&format!("{}\n", HEADER.replace(',', ";")));
        assert_eq!(said, "columns are separated by semicolons: save the table with commas");
    }

    #[test]
    fn a_shifted_row_is_not_blamed_on_a_column() {
        // Decimal commas make two cells of a number.
        for row in ["0,5,1,2,3,0,0,0,1", "0,1,2,3,0,0,0"] {
            let (line, said) = refused(&format!("{HEADER}\n{row}\n"));
            let cells = row.split(',').count();
            assert_eq!(line, Some(2));
            assert!(said.starts_with(&format!("{cells} cells, but the header names 8 columns")), "{said}");
        }
        let read = track(&format!("\u{feff}{HEADER}\n0,1,2,3,0,0,0,1,\n")).unwrap();
        assert_eq!((read.samples[0].position, read.unit_cm), (DVec3::new(1.0, 2.0, 3.0), Some(1.0)));
    }

    #[test]
    fn columns_are_what_their_names_say() {
        for (ending, cm) in [("_m", 100.0), ("_cm", 1.0), ("_mm", 0.1)] {
            let header = HEADER.replace("_cm", ending);
            let read = track(&format!("{header}\n0.5,1,2,3,0.1,0.5,0.7,-0.5\n")).unwrap();
            assert_eq!(
                (read.unit_cm, read.times[0], read.samples[0].position),
                (Some(cm), 0.5, DVec3::new(1.0, 2.0, 3.0))
            );
            let turn = DQuat::from_xyzw(0.1, 0.5, 0.7, -0.5);
            assert!((read.samples[0].rotation - turn).length() < 1e-15, "{:?}", read.samples[0].rotation);
        }
    }

    #[test]
    fn what_is_no_rotation_is_shown_whole() {
        let (_, said) = refused(&format!("{HEADER}\n0,1,2,3,0,0,0,2\n"));
        assert_eq!(
            said,
            "qx, qy, qz, qw = 0, 0, 0, 2: a quaternion of length 2, but only 1 is a rotation: divide by its length"
        );
    }
}
