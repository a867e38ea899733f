//! The fibres that were laid down so far, in the cells of a lamp's map.

use super::item::Fibre;
use crate::light::approx::floor;

/// Skin reads this many cells about its place to each side, lest single hairs streak it.
pub const AROUND: usize = 2;
/// Lines of cells that are worked out together.
const LANES: usize = 8;
/// Shorter fibre (cells) is laid down as if it were so long.
const SHORTEST: f32 = 1e-3;
/// Parts with their middle so far outside (cells) lay nothing into the cells: they are no longer than an [`Item`](super::item::Item) can be.
const FARTHEST: f32 = 34.0;

/// Fibres laid down so far in a strip of the map, row after row. Places are counted from the corner of the whole map, so that
/// they round alike in whatever strip.
pub struct Cells<'a> {
    pub first_row: usize,
    pub width: usize,
    pub cells: &'a mut [f32],
}

impl Cells<'_> {
    /// Fibres at a place within the strip.
    #[inline(always)]
    pub fn read(&self, [x, y]: [f32; 2]) -> f32 {
        let (column, row) = (x as usize, y as usize);
        if x < 0.0 || y < 0.0 || column + 1 >= self.width || (row + 2 - self.first_row) * self.width > self.cells.len()
        {
            return 0.0;
        }
        let (u, v) = (x - column as f32, y - row as f32);
        let from = &self.cells[(row - self.first_row) * self.width + column..];
        let (upper, lower) = (&from[..2], &from[self.width..self.width + 2]);
        let upper = upper[0] + (upper[1] - upper[0]) * u;
        let lower = lower[0] + (lower[1] - lower[0]) * u;
        upper + (lower - upper) * v
    }

    /// The mean of the fibres one cell to each side of a place, along both axes: of four cells by four.
    #[inline(always)]
    pub fn around(&self, [x, y]: [f32; 2]) -> f32 {
        let (column, row) = (x as usize, y as usize);
        let rows = self.cells.len() / self.width;
        let within = x >= 1.0 && y >= 1.0 && column + 3 <= self.width && row > self.first_row;
        if !within || row + 3 > self.first_row + rows {
            let row = |dy: f32| self.read([x - 1.0, y + dy]) + self.read([x + 1.0, y + dy]);
            return 0.25 * (row(-1.0) + row(1.0));
        }
        let (u, v) = (x - column as f32, y - row as f32);
        let shares = |t: f32| [1.0 - t, t, 1.0 - t, t];
        let from = &self.cells[(row - 1 - self.first_row) * self.width + column - 1..];
        let mut sums = [0.0; 4];
        for (i, share) in shares(v).into_iter().enumerate() {
            let line = &from[i * self.width..i * self.width + 4];
            sums = std::array::from_fn(|c| sums[c] + share * line[c]);
        }
        let across = shares(u);
        0.25 * ((sums[0] * across[0] + sums[1] * across[1]) + (sums[2] * across[2] + sums[3] * across[3]))
    }

    /// Lays down the fibre of a part with its middle at a place, line after line of cells across the axis that it follows more: in each what a tent of two lines holds
    /// of it, in proportion over the two cells beside it.
    #[inline(always)]
    pub fn lay(&mut self, at: [f32; 2], n: &Fibre) {
        let rows = [self.first_row, self.first_row + self.cells.len() / self.width].map(|row| row as i32);
        let columns = [0, self.width as i32];
        let near = |place: f32, [low, high]: [i32; 2]| place > low as f32 - FARTHEST && place < high as f32 + FARTHEST;
        if !near(at[0], columns) || !near(at[1], rows) {
            return;
        }
        let major = usize::from(n.extent[1].abs() > n.extent[0].abs());
        let minor = 1 - major;
        let length = n.extent[major].abs().max(SHORTEST);
        let (half, slope) = (0.5 * length, n.extent[minor] * n.extent[major].signum() / length);
        let per_line = n.fibres / length;
        let (middle, beside) = (at[major], at[minor]);
        // Lines from the one before its beginning through the one after its end.
        let first = floor(middle - half);
        let lines = (floor(middle + half) - first + 2) as usize;
        let limits = if major == 0 { [columns, rows] } else { [rows, columns] };
        let reach = (0.5 * n.extent[minor]).abs();
        let inside = first >= limits[0][0]
            && first + lines as i32 <= limits[0][1]
            && floor(beside - reach) >= limits[1][0]
            && floor(beside + reach) + 2 <= limits[1][1];
        // From line to line, and from a cell to the next within one.
        let (along, across) = if major == 0 { (1, self.width as i32) } else { (self.width as i32, 1) };
        let corner = -(self.first_row as i32) * self.width as i32;
        for batch in (0..lines).step_by(LANES) {
            let mut shares = [[0.0_f32; 2]; LANES];
            let mut places = [0_i32; LANES];
            for lane in 0..LANES {
                let line = first + (batch + lane) as i32;
                let t = line as f32 - middle;
                let amount = per_line * (tent_up_to(half - t) - tent_up_to(-half - t));
                let c = beside + slope * t.clamp(-half, half);
                let cell = floor(c);
                let u = c - cell as f32;
                shares[lane] = [amount * (1.0 - u), amount * u];
                places[lane] = cell;
            }
            for lane in 0..LANES.min(lines - batch) {
                let (line, cell) = (first + (batch + lane) as i32, places[lane]);
                let at = corner + line * along + cell * across;
                if inside {
                    self.cells[at as usize] += shares[lane][0];
                    self.cells[(at + across) as usize] += shares[lane][1];
                } else if (limits[0][0]..limits[0][1]).contains(&line) {
                    for (next, share) in [0, 1].into_iter().zip(shares[lane]) {
                        if (limits[1][0]..limits[1][1]).contains(&(cell + next)) {
                            self.cells[(at + next * across) as usize] += share;
                        }
                    }
                }
            }
        }
    }
}

/// The part of a tent about 0, of half width 1 and content 1, that lies below `x`.
#[inline(always)]
fn tent_up_to(x: f32) -> f32 {
    let x = x.clamp(-1.0, 1.0);
    0.5 + x - 0.5 * x * x.abs()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const WIDTH: usize = 48;

    fn laid(at: [f32; 2], fibre: &Fibre, rows: std::ops::Range<usize>) -> Vec<f32> {
        let mut cells = vec![0.0; rows.len() * WIDTH];
        Cells { first_row: rows.start, width: WIDTH, cells: &mut cells }.lay(at, fibre);
        cells
    }

    proptest! {
        #[test]
        fn all_of_a_fibre_is_laid_down_about_its_middle(
            at in [16.0_f32..32.0, 16.0_f32..32.0],
            extent in [-20.0_f32..20.0, -20.0_f32..20.0],
        ) {
            let cells = laid(at, &Fibre { extent, fibres: 1.0 }, 0..WIDTH);
            let moment = |weight: &dyn Fn(f32, f32) -> f32| -> f64 {
                cells
                    .iter()
                    .enumerate()
                    .map(|(i, &c)| f64::from(c * weight((i % WIDTH) as f32, (i / WIDTH) as f32)))
                    .sum()
            };
            // Roundings of about 50 shares: each is the difference of two numbers up to 1, over a length that may be 1e-3.
            let rounding = 50.0 * 1e-7 * 48.0 / f64::from(extent[0].abs().max(extent[1].abs()).max(SHORTEST));
            prop_assert!((moment(&|_, _| 1.0) - 1.0).abs() < rounding);
            // Of its ends more lies in the line about them than the fibre holds there, so that the line's cells are
            // up to a slope of 1 times a third of a line aside.
            let longer = extent[0].abs().max(extent[1].abs());
            let aside = 0.34 / longer.max(1.0) + 1e-3;
            prop_assert!((moment(&|x, _| x) - f64::from(at[0])).abs() < rounding + f64::from(aside));
            prop_assert!((moment(&|_, y| y) - f64::from(at[1])).abs() < rounding + f64::from(aside));
        }

        #[test]
        fn what_is_laid_into_some_rows_does_not_depend_on_which_others_are_held(
            at in [-70.0_f32..120.0, -70.0_f32..120.0],
            extent in [-20.0_f32..20.0, -20.0_f32..20.0],
            first in 0_usize..40,
        ) {
            let fibre = Fibre { extent, fibres: 0.3 };
            let part = laid(at, &fibre, first..first + 8);
            let whole = laid(at, &fibre, 0..WIDTH);
            prop_assert_eq!(&part[..], &whole[first * WIDTH..(first + 8) * WIDTH]);
        }

        #[test]
        fn the_mean_about_a_place_is_that_of_four_readings(at in [-2.0_f32..50.0, -2.0_f32..50.0]) {
            let mut values: Vec<f32> = (0..WIDTH * WIDTH).map(|i| (i * i % 97) as f32).collect();
            let cells = Cells { first_row: 0, width: WIDTH, cells: &mut values };
            let read = |dx: f32, dy: f32| cells.read([at[0] + dx, at[1] + dy]);
            let mean = 0.25 * (read(-1.0, -1.0) + read(1.0, -1.0) + read(-1.0, 1.0) + read(1.0, 1.0));
            // Places are rounded to 4e-6 of a cell, values differ by up to 97 from cell to cell.
            prop_assert!((cells.around(at) - mean).abs() < 4.0 * 97.0 * 4e-6);
        }
    }
}
