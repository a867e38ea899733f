//! From rows of sixteen strands to strands: the points of a block as [`Strands`](crate::Strands) orders them.
//!
//! Written number by number, this takes as long as the step itself. Four rows by four lanes are turned at once.

use glam::{Mat4, Vec3, Vec4};

use super::row::{LANES, PointRow, Row};

/// Strands transposed at once.
const FOUR: usize = 4;

/// Writes rows of points, the first of them point number `first` of every strand, to `points`, strand after strand,
/// each with as many as `counts` gives.
#[inline(always)]
pub(super) fn write_points(rows: &[PointRow], first: usize, counts: &[u32; LANES], points: &mut [Vec3]) {
    let rows: &[Row] = rows.as_flattened();
    let mut rest: &mut [f32] = bytemuck::cast_slice_mut(points);
    for (group, counts) in counts.as_chunks::<FOUR>().0.iter().enumerate() {
        let mut strands: [&mut [f32]; FOUR] = Default::default();
        for (strand, &count) in strands.iter_mut().zip(counts) {
            let (mine, others) = std::mem::take(&mut rest).split_at_mut(3 * count as usize);
            let wanted = mine.len().min(3 * first)..mine.len().min(3 * first + rows.len());
            *strand = &mut mine[wanted];
            rest = others;
        }
        let [a, b, c, d] = &strands;
        let shared = a.len().min(b.len()).min(c.len()).min(d.len());
        write_squares(&rows[..shared / FOUR * FOUR], group * FOUR, &mut strands);
        let mut done = shared / FOUR * FOUR;
        if done > 0 && done < shared {
            // Writes again some numbers that the last square wrote: fewer writes than one by one.
            let last = shared - FOUR..shared;
            write_squares(&rows[last.clone()], group * FOUR, &mut strands.each_mut().map(|s| &mut s[last.clone()]));
            done = shared;
        }
        for (lane, strand) in strands.into_iter().enumerate() {
            let (strand, rows) = (&mut strand[done..], &rows[done..]);
            for (number, row) in strand.iter_mut().zip(rows) {
                *number = row.0[group * FOUR + lane];
            }
        }
    }
}

/// Writes the first numbers of four strands, which lie in `rows` from `lane` on: four of each at a time.
#[allow(clippy::needless_range_loop, reason = "five iterators in one another are not inlined")]
#[inline(always)]
fn write_squares(rows: &[Row], lane: usize, strands: &mut [&mut [f32]; FOUR]) {
    let rows = rows.as_chunks::<FOUR>().0;
    let [a, b, c, d] = strands;
    let a = &mut a.as_chunks_mut::<FOUR>().0[..rows.len()];
    let b = &mut b.as_chunks_mut::<FOUR>().0[..rows.len()];
    let c = &mut c.as_chunks_mut::<FOUR>().0[..rows.len()];
    let d = &mut d.as_chunks_mut::<FOUR>().0[..rows.len()];
    for i in 0..rows.len() {
        let [x, y, z, w] = &rows[i];
        let square = Mat4::from_cols(four(x, lane), four(y, lane), four(z, lane), four(w, lane)).transpose();
        a[i] = square.x_axis.to_array();
        b[i] = square.y_axis.to_array();
        c[i] = square.z_axis.to_array();
        d[i] = square.w_axis.to_array();
    }
}

#[inline(always)]
fn four(row: &Row, lane: usize) -> Vec4 {
    Vec4::from_slice(&row.0[lane..lane + FOUR])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_number_goes_to_its_strand() {
        let number = |strand: usize, k: usize| (1000 * strand + k) as f32;
        let counts: [u32; LANES] = [9, 9, 9, 9, 2, 20, 20, 5, 0, 17, 8, 8, 16, 1, 0, 0];
        let mut points = vec![Vec3::NAN; counts.iter().sum::<u32>() as usize];
        for (first, filled) in [(0, 8), (8, 8), (16, 4)] {
            let row = |i: usize, axis: usize| Row(std::array::from_fn(|s| number(s, 3 * (first + i) + axis)));
            let rows: Vec<PointRow> = (0..filled).map(|i| [row(i, 0), row(i, 1), row(i, 2)]).collect();
            write_points(&rows, first, &counts, &mut points);
        }
        let mut found = points.iter();
        for (s, &count) in counts.iter().enumerate() {
            for i in 0..count as usize {
                let expected = [0, 1, 2].map(|axis| number(s, 3 * i + axis));
                assert_eq!(found.next().unwrap().to_array(), expected, "strand {s}, point {i}");
            }
        }
    }
}
