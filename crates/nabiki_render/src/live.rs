//! Data for a live view whose hair looks like that of the final picture: the fibre model as plain numbers, and the
//! lamps.

use crate::light::fibre::{Fibre, Row};
use crate::light::shade;
use crate::light::streams::Medium;
use crate::settings::HairLook;

pub use crate::light::fibre::{COLUMNS, GRADES, ROWS};
pub use crate::light::lamps::{Lamp, lamps, zenith};
pub use crate::light::sky::{Carry, Direction, LENGTHS};

/// Share of the sky's light that continues in its direction at each scattering in hair.
pub const SKY_KEPT: f32 = shade::SKY_KEPT;
/// Share of the light transmitted by a fibre that continues on other paths than straight from the lamp.
pub const STRAYS: f32 = shade::STRAYS;
/// Share of the light scattered forward by hair that reaches skin behind it.
pub const ON_SKIN: f32 = crate::skin::ON_SKIN;
/// Largest deviation of a strand's tilt (rad), for a variation of 1.
pub const TILT_SPREAD: f32 = shade::TILT_SPREAD;

/// The fibre model of a look of hair, for shaders. The grades of pigment follow one another, from the least to the
/// most.
#[derive(Clone, Debug, PartialEq)]
pub struct FibreTables {
    /// For each grade, [`ROWS`] x ([`COLUMNS`] + 1) entries by the sine of the eye's inclination and the azimuth 0..pi
    /// between lamp and eye: R (one number), TT and TRT (red, green, blue each), and a 0.
    pub lobes: Vec<[f32; 8]>,
    /// For each grade, [`ROWS`] entries: the share of even light that continues forward, the share that returns, and
    /// all further bounces (red, green, blue each), with a 0 after each three.
    pub rows: Vec<[f32; 12]>,
    /// Variances along the hair of R, TT and TRT (rad^2).
    pub variances: [f32; 3],
    /// For each grade, data of a mass of such hair: the shares that each fibre transmits and returns, the share that
    /// infinitely deep hair returns, and how much less light arrives for each hair in front (red, green, blue each),
    /// with a 0 after each three.
    pub mediums: Vec<[f32; 16]>,
    /// Tilt of the scales (rad). R turns by twice that toward the root; toward the tip, TT turns by once and TRT by
    /// three times that.
    pub tilt: f32,
}

impl FibreTables {
    /// The tables for a look.
    pub fn new(look: &HairLook) -> Self {
        let fibre = Fibre::new(look);
        let flat = |row: &Row| {
            let [f, b, r] = [row.forward, row.back, row.rest];
            [f[0], f[1], f[2], 0.0, b[0], b[1], b[2], 0.0, r[0], r[1], r[2], 0.0]
        };
        let medium = |m: &Medium| {
            let mut flat = [0.0; 16];
            for (to, part) in flat.chunks_exact_mut(4).zip([m.forward, m.back, m.whole, m.decay]) {
                to[..3].copy_from_slice(&part);
            }
            flat
        };
        Self {
            lobes: fibre.grades.iter().flat_map(|table| table.lobes_by_row().iter().copied()).collect(),
            rows: fibre.grades.iter().flat_map(|table| table.rows().iter().map(flat)).collect(),
            variances: Fibre::variances(look),
            mediums: fibre.grades.iter().map(|table| medium(&table.medium)).collect(),
            tilt: fibre.tilt,
        }
    }

    /// How much less light arrives for each hair in front, for hair with medium pigment (red, green, blue).
    pub fn decay(&self) -> [f32; 3] {
        let [.., r, g, b, _] = self.mediums[GRADES / 2];
        [r, g, b]
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
        assert_eq!(tables.decay(), fibre.grades[GRADES / 2].medium.decay);
        assert_eq!(tables.mediums[3][8..11], fibre.grades[3].medium.whole);
        for (grade, row, column) in [(0, 0, 0), (3, 7, 21), (GRADES - 1, ROWS - 2, COLUMNS - 1)] {
            let at = (grade * ROWS + row) * (COLUMNS + 1) + column;
            assert_eq!(tables.lobes[at], fibre.grades[grade].lobes(row as f32, column as f32));
            let of_row = fibre.grades[grade].row(row as f32);
            assert_eq!(tables.rows[grade * ROWS + row][..3], of_row.forward);
            assert_eq!(tables.rows[grade * ROWS + row][8..11], of_row.rest);
        }
    }
}
