//! Distance and gradient in one lookup, for collisions.

use glam::{Mat3, Vec3};

use super::{COARSE, EDGE, FINE, Samples, SkinDistance};
use crate::obstacle::{Obstacle, Reading};

/// 1.5 times 2^23: adding it rounds a number to an integer, which the lowest bits of the sum then hold.
const ROUNDS: f32 = 12_582_912.0;

impl SkinDistance {
    /// Positions of some points among the fine samples.
    #[allow(clippy::needless_range_loop, reason = "a loop over lanes, as in the kernels")]
    #[inline(always)]
    pub(crate) fn places<const N: usize>(&self, [xs, ys, zs]: [&[f32; N]; 3]) -> Places<N> {
        let Samples { low, cell, nodes, mirrored, .. } = &self.samples;
        let (cells, fine, steps) = (*nodes - 1, FINE as f32 / *cell, FINE as u32);
        let counts = FINE as f32 * cells.as_vec3();
        let mut places = Places { cells: [0; N], first: [0; N], t: [[0.0; N]; 3] };
        for n in 0..N {
            let z = if *mirrored { zs[n].abs() } else { zs[n] };
            let (x, y, z) = ((xs[n] - low.x) * fine, (ys[n] - low.y) * fine, (z - low.z) * fine);
            let above = (x >= 0.0) & (y >= 0.0) & (z >= 0.0);
            let inside = above & (x < counts.x) & (y < counts.y) & (z < counts.z);
            let ((i, x), (j, y), (k, z)) = (whole(x), whole(y), whole(z));
            let at = ((k / steps) * cells.y + j / steps) * cells.x + i / steps;
            places.cells[n] = if inside { at } else { u32::MAX };
            places.first[n] = ((k % steps) * EDGE as u32 + j % steps) * EDGE as u32 + i % steps;
            (places.t[0][n], places.t[1][n], places.t[2][n]) = (x, y, z);
        }
        places
    }

    /// The distance at one of them, bit for bit as [`read`](Obstacle::read) gives it; `None` if it was not sampled finely.
    #[inline(always)]
    pub(crate) fn fine_distance<const N: usize>(&self, places: &Places<N>, n: usize) -> Option<f32> {
        let block = *self.samples.block_of.get(places.cells[n] as usize)?;
        let corners = block_corners(self.samples.fine.get(block as usize)?, places.first[n] as usize)?;
        Some(interpolated(corners, Vec3::new(places.t[0][n], places.t[1][n], places.t[2][n])))
    }

    /// The corners of the sampled box.
    pub fn sampled_box(&self) -> [Vec3; 2] {
        let Samples { low, cell, nodes, mirrored, .. } = &self.samples;
        let high = *low + *cell * (*nodes - 1).as_vec3();
        [if *mirrored { low.with_z(-high.z) } else { *low }, high]
    }
}

impl Obstacle for SkinDistance {
    fn reach(&self) -> [Vec3; 2] {
        self.sampled_box()
    }

    /// Its gradient is that of the interpolation: of unit length up to sampling error, with jumps of that size between
    /// cells.
    #[inline(always)]
    fn read(&self, p: Vec3, _: u32) -> Option<Reading> {
        let cell = self.samples.cell(p)?;
        Some(Reading { distance: cell.distance(), gradient: cell.gradient(), hessian: cell.hessian() })
    }

    fn identify(&self, hand_on: &mut dyn FnMut(&[f32])) {
        hand_on(&self.samples.coarse);
    }
}

/// Positions of some points among the fine samples: their cells, [`u32::MAX`] outside the sampled box; the first sample
/// there in a block; and the place between samples.
pub(crate) struct Places<const N: usize> {
    cells: [u32; N],
    first: [u32; N],
    t: [[f32; N]; 3],
}

/// The samples around a point.
struct Cell {
    /// Those at the corners, x fastest.
    corners: [f32; 8],
    /// Position of the point in the cell, 0..=1.
    t: Vec3,
    /// Edge of the cell.
    edge: f32,
    /// Whether they are mirrored.
    flipped: bool,
}

impl Samples {
    #[inline(always)]
    fn cell(&self, p: Vec3) -> Option<Cell> {
        let Self { low, cell, nodes, mirrored, coarse, block_of, fine } = self;
        let flipped = *mirrored && p.z < 0.0;
        let p = if *mirrored { p.with_z(p.z.abs()) } else { p };
        let cells = *nodes - 1;
        // In fine steps: the whole part and the rest.
        let q = (p - *low) * (FINE as f32 / *cell);
        if !(q.cmpge(Vec3::ZERO).all() && q.cmplt(FINE as f32 * cells.as_vec3()).all()) {
            return None;
        }
        let ((i, x), (j, y), (k, z)) = (whole(q.x), whole(q.y), whole(q.z));
        let (t, steps) = (Vec3::new(x, y, z), FINE as u32);
        let [ci, cj, ck] = [i / steps, j / steps, k / steps];
        let block = block_of[((ck * cells.y + cj) * cells.x + ci) as usize];
        let [i, j, k] = [i % steps, j % steps, k % steps];
        if block == COARSE {
            let (row, slice) = (nodes.x as usize, (nodes.x * nodes.y) as usize);
            let at = ck as usize * slice + cj as usize * row + ci as usize;
            let ([a, b, c, d], [e, f, g, h]) = (square(coarse, at, row), square(coarse, at + slice, row));
            let t = (Vec3::new(i as f32, j as f32, k as f32) + t) / FINE as f32;
            return Some(Cell { corners: [a, b, c, d, e, f, g, h], t, edge: *cell, flipped });
        }
        let at = ((k as usize * EDGE) + j as usize) * EDGE + i as usize;
        Some(Cell { corners: block_corners(&fine[block as usize], at)?, t, edge: *cell / FINE as f32, flipped })
    }
}

/// Stride from one layer of a block to the next.
pub(super) const SLICE: usize = EDGE * EDGE;

/// Four samples from `at` on, x fastest; `row` is the stride between rows.
#[inline(always)]
fn square(samples: &[f32], at: usize, row: usize) -> [f32; 4] {
    [samples[at], samples[at + 1], samples[at + row], samples[at + row + 1]]
}

/// The eight samples around a cell of a block, the first at `at`, x fastest.
#[inline(always)]
fn block_corners(block: &[f32; EDGE * EDGE * EDGE], at: usize) -> Option<[f32; 8]> {
    let about: &[f32; SLICE + EDGE + 2] = block.get(at..)?.first_chunk()?;
    let ([a, b, c, d], [e, f, g, h]) = (square(about, 0, EDGE), square(about, SLICE, EDGE));
    Some([a, b, c, d, e, f, g, h])
}

/// The whole part of a number from 0 to 2^21, and the rest, 0..=1. A whole number may count as the end of the cell
/// before it. Plain x86-64 has no instruction that rounds down.
#[inline(always)]
pub(crate) fn whole(x: f32) -> (u32, f32) {
    let shifted = (x - 0.5) + ROUNDS;
    (shifted.to_bits() & 0x3f_ffff, x - (shifted - ROUNDS))
}

impl Cell {
    #[inline(always)]
    fn distance(&self) -> f32 {
        interpolated(self.corners, self.t)
    }

    #[inline(always)]
    fn gradient(&self) -> Vec3 {
        let Self { corners: [a, b, c, d, e, f, g, h], t, edge, flipped } = *self;
        let along_x = between(between(b - a, d - c, t.y), between(f - e, h - g, t.y), t.z);
        let (low, high) = (between(a, b, t.x), between(c, d, t.x));
        let (far_low, far_high) = (between(e, f, t.x), between(g, h, t.x));
        let along_y = between(high - low, far_high - far_low, t.z);
        let along_z = between(far_low, far_high, t.y) - between(low, high, t.y);
        Vec3::new(along_x, along_y, if flipped { -along_z } else { along_z }) / edge
    }

    /// How the gradient changes within the cell: the second derivatives of the interpolation. Those along one axis
    /// twice are 0.
    #[inline(always)]
    fn hessian(&self) -> Mat3 {
        let Self { corners: [a, b, c, d, e, f, g, h], t, edge, flipped } = *self;
        let (low, high) = ((d - c) - (b - a), (h - g) - (f - e));
        let xy = between(low, high, t.z);
        let xz = between((f - e) - (b - a), (h - g) - (d - c), t.y);
        let yz = between((g - e) - (c - a), (h - f) - (d - b), t.x);
        let (xz, yz) = if flipped { (-xz, -yz) } else { (xz, yz) };
        Mat3::from_cols_array(&[0.0, xy, xz, xy, 0.0, yz, xz, yz, 0.0]) * (1.0 / (edge * edge))
    }
}

#[inline(always)]
fn interpolated([a, b, c, d, e, f, g, h]: [f32; 8], t: Vec3) -> f32 {
    let low = between(between(a, b, t.x), between(c, d, t.x), t.y);
    let high = between(between(e, f, t.x), between(g, h, t.x), t.y);
    between(low, high, t.z)
}

#[inline(always)]
fn between(a: f32, b: f32, t: f32) -> f32 {
    a + (b - a) * t
}
