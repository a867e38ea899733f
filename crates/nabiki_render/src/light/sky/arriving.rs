//! What arrives in each cell, as the eye's fibres need it, and where places lie among the cells.
//!
//! All numbers of a cell lie side by side: a place is between eight cells, and each is then one reading.

#![expect(clippy::needless_range_loop, reason = "lanes side by side read as vector code")]

use std::sync::atomic::{AtomicBool, Ordering};

use glam::Vec3;
use rayon::prelude::*;

use super::{CELL, SkyMap};
use crate::camera::View;
use crate::curve::CurveNode;
use crate::light::approx::exp_of_negative;
use crate::light::lamps::Lamp;

/// Means over the directions on the eye's side, and over those behind, of the light that arrives from above and from below: where all
/// is open the two of a side add up to 1.
pub const FRONT_ABOVE: usize = 0;
pub const FRONT_BELOW: usize = 1;
pub const BEHIND_ABOVE: usize = 2;
pub const BEHIND_BELOW: usize = 3;
/// The same of the light that skin sends back, in parts of what an even white surface under it would show.
pub const FRONT_GLOW: usize = 4;
pub const BEHIND_GLOW: usize = 5;
/// Those means, above and below together, as they were without hair: skin takes what it takes.
pub const FRONT_BARE: usize = 6;
pub const BEHIND_BARE: usize = 7;
/// From here on, for each lamp: how open the cell is about its direction, 0..1, and about the opposite one. Light that hair scatters strays
/// from the lamp's direction, and finds ways that are shorter than the straight one where that goes along the hair's surface; what lies
/// opposite sends it back.
pub const TOWARD_LAMPS: usize = 8;
/// So much nearer to the eye (cm) than it lies a fibre reads: what the eye sees of a cell's hair lies on its near side. Fitted.
const NEARER: f32 = 0.09;
/// And so much further (cm) to where more of the sky arrives: what shows of hair is its surface, and cells are laid with hair to half a cell
/// beyond it. Fitted.
const OUTWARD: f32 = 0.1;
/// Slopes below this are none.
const FLAT: f32 = 1e-3;
/// So many of a cell's numbers are read at once.
pub const AT_ONCE: usize = 8;
pub type Numbers = [f32; AT_ONCE];

/// Cells that are summed together.
const LANES: usize = 16;

/// Where some places lie among the cells.
pub struct Places<const N: usize> {
    /// The cell below each along all axes.
    first: [usize; N],
    /// How far into the next, 0..1, along each axis.
    beyond: [[f32; N]; 3],
}

impl SkyMap {
    /// Numbers `AT_ONCE * k` and on of what arrives at places, as the constants name them.
    #[inline(always)]
    pub fn at<const N: usize>(&self, places: &Places<N>, k: usize) -> [[f32; N]; AT_ONCE] {
        let lines = self.lines();
        let mut at = [[0.0; N]; AT_ONCE];
        for n in 0..N {
            let mut corners = [&[0.0; AT_ONCE]; 8];
            for (i, corner) in corners.iter_mut().enumerate() {
                *corner = &self.arriving[(places.first[n] + lines[i / 2] + i % 2) * self.parts + k];
            }
            let mixed = between([places.beyond[0][n], places.beyond[1][n], places.beyond[2][n]], corners);
            for (at, mixed) in at.iter_mut().zip(mixed) {
                at[n] = mixed;
            }
        }
        at
    }

    /// [`NEARER`] and [`OUTWARD`], in a draft as much larger as its cells are.
    #[inline(always)]
    fn offsets(&self) -> [f32; 2] {
        let wider = if self.least > CELL { self.cell / CELL } else { 1.0 };
        [NEARER, OUTWARD].map(|offset| wider * offset)
    }

    /// Where a fibre reads at places: a little [`NEARER`] to the eye (unit vectors toward it), and a little outward.
    #[inline(always)]
    pub fn places_seen<const N: usize>(&self, places: &[[f32; N]; 3], eye: &[[f32; N]; 3]) -> Places<N> {
        let (mut seen, [nearer, outward]) = (*places, self.offsets());
        for c in 0..3 {
            for n in 0..N {
                seen[c][n] += nearer * eye[c][n];
            }
        }
        let slope = self.slope(&self.places(&seen));
        for n in 0..N {
            let steepness = (slope[0][n] * slope[0][n] + slope[1][n] * slope[1][n] + slope[2][n] * slope[2][n]).sqrt();
            for c in 0..3 {
                seen[c][n] += outward * slope[c][n] / (steepness + FLAT);
            }
        }
        self.places(&seen)
    }

    /// By how much more of the sky arrives from each cell to the next, along each axis.
    #[inline(always)]
    fn slope<const N: usize>(&self, places: &Places<N>) -> [[f32; N]; 3] {
        let lines = self.lines();
        let mut slope = [[0.0; N]; 3];
        for n in 0..N {
            let mut c = [0.0; 8];
            for (i, open) in c.iter_mut().enumerate() {
                let numbers = &self.arriving[(places.first[n] + lines[i / 2] + i % 2) * self.parts];
                *open = (numbers[FRONT_ABOVE] + numbers[FRONT_BELOW]) + (numbers[BEHIND_ABOVE] + numbers[BEHIND_BELOW]);
            }
            let [u, v, w] = [0, 1, 2].map(|axis| places.beyond[axis][n]);
            let x = [0, 2, 4, 6].map(|i| c[i + 1] - c[i]);
            let y = [0, 1, 4, 5].map(|i| c[i + 2] - c[i]);
            let z = [0, 1, 2, 3].map(|i| c[i + 4] - c[i]);
            for (slope, (of_pairs, s, t)) in slope.iter_mut().zip([(x, v, w), (y, u, w), (z, u, v)]) {
                let [a, b, c, d] = of_pairs;
                slope[n] = (1.0 - t) * (a + (b - a) * s) + t * (c + (d - c) * s);
            }
        }
        slope
    }

    /// Where places (x, y and z of all of them) lie among the cells; those outside at the border.
    #[inline(always)]
    pub fn places<const N: usize>(&self, places: &[[f32; N]; 3]) -> Places<N> {
        let (base, beyond) = self.lattice(places);
        let [_, row, slice, _] = self.lines();
        let mut first = [0; N];
        for n in 0..N {
            first[n] = base[0][n] as usize + row * base[1][n] as usize + slice * base[2][n] as usize;
        }
        Places { first, beyond }
    }

    /// The same along each axis: the cell, and how far into the next.
    #[inline(always)]
    pub(super) fn lattice<const N: usize>(&self, places: &[[f32; N]; 3]) -> ([[i32; N]; 3], [[f32; N]; 3]) {
        let last = (self.size.as_vec3() - 1.001).max(Vec3::ZERO);
        let per_cell = 1.0 / self.cell;
        let (mut base, mut beyond) = ([[0; N]; 3], [[0.0; N]; 3]);
        for axis in 0..3 {
            let (low, last) = (self.low[axis], last[axis]);
            for n in 0..N {
                let c = ((places[axis][n] - low) * per_cell - 0.5).max(0.0).min(last);
                // Toward zero is down: there is nothing below.
                base[axis][n] = c as i32;
                beyond[axis][n] = c - base[axis][n] as f32;
            }
        }
        (base, beyond)
    }

    /// Whether a place lies in the box of cells.
    pub(super) fn holds(&self, place: Vec3) -> bool {
        let c = (place - self.low) / self.cell;
        c.cmpge(Vec3::ZERO).all() && c.cmplt(self.size.as_vec3()).all()
    }

    /// From the first of the eight cells about a place to those that begin a pair along x.
    #[inline(always)]
    pub(super) fn lines(&self) -> [usize; 4] {
        let (row, slice) = (self.size.x as usize, (self.size.x * self.size.y) as usize);
        [0, row, slice, slice + row]
    }

    /// Marks the stretches of cells from which the nodes read that are `asked` for: at their place, and as far about it as
    /// [`SkyMap::places_seen`] goes.
    pub(super) fn mark(&mut self, nodes: &[CurveNode], asked: &[bool], view: &View) {
        let mut read = std::mem::take(&mut self.read);
        let (size, per_line) = (self.size.as_ivec3(), self.stretches());
        read.clear();
        read.resize_with((size.y * size.z) as usize * per_line, AtomicBool::default);
        let (this, [nearer_by, outward]) = (&*self, self.offsets());
        nodes.par_iter().zip(asked).with_min_len(8192).filter(|(_, asked)| **asked).for_each(|(node, _)| {
            let (place, nearer) = (node.position, node.position + nearer_by * view.toward_eye(node.position));
            let (low, high) = (place.min(nearer) - outward, place.max(nearer) + outward);
            let (base, _) = this.lattice(&[0, 1, 2].map(|axis| [low[axis], high[axis]]));
            for (z, y) in (base[2][0]..=base[2][1] + 1).flat_map(|z| (base[1][0]..=base[1][1] + 1).map(move |y| (z, y)))
            {
                let line = (y + size.y * z) as usize;
                for x in [base[0][0], base[0][1] + 1] {
                    let read = &read[line * per_line + x as usize / LANES];
                    // Most are marked already, and a line of memory that is only read is both cores'.
                    if !read.load(Ordering::Relaxed) {
                        read.store(true, Ordering::Relaxed);
                    }
                }
            }
        });
        self.read = read;
    }

    /// Stretches of cells in a line that are summed together.
    fn stretches(&self) -> usize {
        (self.size.x as usize).div_ceil(LANES)
    }

    /// Sums what arrives in each cell that is read from over the directions, as its eye and lamps see it.
    pub(super) fn sum(&mut self, view: &View, lamps: &[Lamp]) {
        self.parts = (TOWARD_LAMPS + 2 * lamps.len()).div_ceil(AT_ONCE);
        let mut arriving = std::mem::take(&mut self.arriving);
        arriving.resize(self.taken.len() * self.parts, Numbers::default());
        // By the square of the cosine, of the directions on the lamp's side.
        let shares: Vec<Vec<f32>> = lamps
            .iter()
            .flat_map(|lamp| [lamp.toward, -lamp.toward])
            .map(|toward| {
                let shares = || self.directions.iter().map(|d| d.weight * d.from.dot(toward).max(0.0).powi(2));
                let all: f32 = shares().sum();
                shares().map(|share| share / all).collect()
            })
            .collect();
        let (this, row) = (&*self, self.size.x as usize);
        arriving.par_chunks_mut(row * this.parts).enumerate().for_each(|(line, arriving)| {
            pulp::Arch::new().dispatch(Sum { map: this, line, view, lamps: &shares, arriving });
        });
        self.arriving = arriving;
    }
}

/// One line of cells, compiled for each width of vectors that machines have; one is chosen at run time.
struct Sum<'a> {
    map: &'a SkyMap,
    line: usize,
    view: &'a View,
    /// For each lamp, how much each direction counts, and then for the opposite one.
    lamps: &'a [Vec<f32>],
    arriving: &'a mut [Numbers],
}

impl pulp::NullaryFnOnce for Sum<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let Self { map, line, view, lamps, arriving } = self;
        let (row, slice) = (map.size.x as usize, (map.size.x * map.size.y) as usize);
        let first = line * row;
        let start = map.low + map.cell * (Vec3::new(0.0, (first % slice / row) as f32, (first / slice) as f32) + 0.5);
        let read = &map.read[line * map.stretches()..];
        for (batch, arriving) in arriving.chunks_mut(LANES * map.parts).enumerate() {
            if !read[batch].load(Ordering::Relaxed) {
                continue;
            }
            let skipped = batch * LANES;
            let mut eye = [[0.0_f32; LANES]; 3];
            for lane in 0..LANES {
                let toward = view.toward_eye(start + Vec3::X * map.cell * (skipped + lane) as f32);
                (eye[0][lane], eye[1][lane], eye[2][lane]) = toward.into();
            }
            let mut sums = [[0.0_f32; LANES]; TOWARD_LAMPS];
            for (((d, light), glow), bare) in map.directions.iter().zip(&map.carried).zip(&map.glow).zip(&map.bare) {
                let [above, below] = d.halves.map(|half| d.weight * half);
                let [light, glow, bare] = [light, glow, bare].map(|values| lanes(values, first + skipped));
                for lane in 0..LANES {
                    let (l, g, s) = (light[lane], glow[lane], bare[lane]);
                    let aside = eye[0][lane] * d.from.x + eye[1][lane] * d.from.y + eye[2][lane] * d.from.z;
                    // Each of mean 1 over all directions. What passes through a fibre goes on nearly straight.
                    let away = (1.0 - aside) * (1.0 - aside);
                    let (before, after) = (1.0 + aside, away * away * (1.0 / 3.2));
                    let (front, behind) = (l * before, l * after);
                    sums[FRONT_GLOW][lane] += d.weight * g * before;
                    sums[BEHIND_GLOW][lane] += d.weight * g * after;
                    sums[FRONT_BARE][lane] += d.weight * s * before;
                    sums[BEHIND_BARE][lane] += d.weight * s * after;
                    sums[FRONT_ABOVE][lane] += above * front;
                    sums[FRONT_BELOW][lane] += below * front;
                    sums[BEHIND_ABOVE][lane] += above * behind;
                    sums[BEHIND_BELOW][lane] += below * behind;
                }
            }
            // What the eye sees of a cell lies on its near side: what comes from behind has to cross all of it.
            let [taken, hair, skin] = [&map.taken, &map.hair, &map.skin_depth].map(|of| lanes(of, first + skipped));
            for lane in 0..LANES {
                sums[BEHIND_GLOW][lane] *= exp_of_negative(-hair[lane]);
                sums[BEHIND_BARE][lane] *= exp_of_negative(-skin[lane]);
                let own = exp_of_negative(-taken[lane]);
                sums[BEHIND_ABOVE][lane] *= own;
                sums[BEHIND_BELOW][lane] *= own;
            }
            for (lane, cell) in arriving.chunks_exact_mut(map.parts).enumerate() {
                for (number, sum) in sums.iter().enumerate() {
                    cell[0][number] = sum[lane];
                }
            }
            for (l, shares) in lamps.iter().enumerate() {
                let mut open = [0.0_f32; LANES];
                for (share, light) in shares.iter().zip(&map.carried).filter(|(share, _)| **share > 0.0) {
                    let light = lanes(light, first + skipped);
                    for lane in 0..LANES {
                        open[lane] += share * light[lane];
                    }
                }
                let number = TOWARD_LAMPS + l;
                for (cell, open) in arriving.chunks_exact_mut(map.parts).zip(open) {
                    cell[number / AT_ONCE][number % AT_ONCE] = open;
                }
            }
        }
    }
}

/// Between the values at the eight cells about a place, in proportion.
#[inline(always)]
pub(super) fn between<const N: usize>([u, v, w]: [f32; 3], c: [&[f32; N]; 8]) -> [f32; N] {
    let near = mixed(&mixed(c[0], c[1], u), &mixed(c[2], c[3], u), v);
    let far = mixed(&mixed(c[4], c[5], u), &mixed(c[6], c[7], u), v);
    mixed(&near, &far, w)
}

#[inline(always)]
fn mixed<const N: usize>(a: &[f32; N], b: &[f32; N], t: f32) -> [f32; N] {
    let mut mixed = [0.0; N];
    for i in 0..N {
        mixed[i] = a[i] + (b[i] - a[i]) * t;
    }
    mixed
}

/// The values from one on; nothing beyond the last.
#[inline(always)]
fn lanes(values: &[f32], first: usize) -> [f32; LANES] {
    let values = &values[first..];
    match values.first_chunk() {
        Some(whole) => *whole,
        None => {
            let mut lanes = [0.0; LANES];
            lanes[..values.len()].copy_from_slice(values);
            lanes
        }
    }
}
