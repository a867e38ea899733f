//! What a live view draws with, so that its hair looks like the picture's: the same fibre as plain numbers, the same lamps.

use crate::light::fibre::{Fibre, Row};
use crate::light::shade;
use crate::settings::HairLook;

pub use crate::light::fibre::{COLUMNS, GRADES, ROWS};
pub use crate::light::lamps::{Lamp, lamps, zenith};

/// Share of the sky's light scattered by hair that stays within it.
pub const SKY_DENSITY: f32 = shade::SKY_DENSITY;
/// Share of light scattered forward by hair that falls onto skin behind.
pub const ON_SKIN: f32 = crate::skin::ON_SKIN;
/// Largest deviation of a strand's tilt (rad), for a variation of 1.
pub const TILT_SPREAD: f32 = shade::TILT_SPREAD;

/// The fibre of a look of hair, for shaders. All grades of pigment follow one another, from the least to the most.
#[derive(Clone, Debug, PartialEq)]
pub struct FibreTables {
    /// For each grade [`ROWS`] x ([`COLUMNS`] + 1) entries, by the sine of the eye's inclination and the azimuth 0..pi between
    /// lamp and eye: R (one number), TT and TRT (red, green, blue each), and a 0.
    pub lobes: Vec<[f32; 8]>,
    /// For each grade [`ROWS`] entries: the part of even light that goes on forward, that which goes back, and all further
    /// bounces (red, green, blue each), with a 0 after each three.
    pub rows: Vec<[f32; 12]>,
    /// Variances along the hair of R, TT and TRT (rad^2).
    pub variances: [f32; 3],
    /// By how much less light arrives for each hair before a place, those of middling pigment (red, green, blue).
    pub decay: [f32; 3],
    /// Tilt of the scales (rad): R turns by twice that toward the root, TT by once and TRT by three times toward the tip.
    pub tilt: f32,
}

impl FibreTables {
    /// The tables of a look.
    pub fn new(look: &HairLook) -> Self {
        let fibre = Fibre::new(look);
        let flat = |row: &Row| {
            let [f, b, r] = [row.forward, row.back, row.rest];
            [f[0], f[1], f[2], 0.0, b[0], b[1], b[2], 0.0, r[0], r[1], r[2], 0.0]
        };
        Self {
            lobes: fibre.grades.iter().flat_map(|table| table.lobes_by_row().iter().copied()).collect(),
            rows: fibre.grades.iter().flat_map(|table| table.rows().iter().map(flat)).collect(),
            variances: Fibre::variances(look),
            decay: fibre.grades[GRADES / 2].medium.decay,
            tilt: fibre.tilt,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_tables_hold_what_the_renderer_shades_with() {
        let look = HairLook::default();
        let (tables, fibre) = (FibreTables::new(&look), Fibre::new(&look));
        assert_eq!(tables.lobes.len(), GRADES * ROWS * (COLUMNS + 1));
        assert_eq!(tables.rows.len(), GRADES * ROWS);
        for (grade, row, column) in [(0, 0, 0), (3, 7, 21), (GRADES - 1, ROWS - 2, COLUMNS - 1)] {
            let at = (grade * ROWS + row) * (COLUMNS + 1) + column;
            assert_eq!(tables.lobes[at], fibre.grades[grade].lobes(row as f32, column as f32));
            let of_row = fibre.grades[grade].row(row as f32);
            assert_eq!(tables.rows[grade * ROWS + row][..3], of_row.forward);
            assert_eq!(tables.rows[grade * ROWS + row][8..11], of_row.rest);
        }
    }
}
