//! Hair in the way of a lamp: how many fibres the light has crossed before it arrives.
//!
//! In the spirit of deep opacity maps (Yuksel and Keyser 2008), but without layers: everything is sorted by its distance from
//! the lamp, then taken in that order. Each node first reads, from a map of the lamp's view, how much fibre was laid down
//! there so far, then lays down its own. Reading and laying are both spread over 2 x 2 cells in proportion, so neither
//! cells nor layers show.

use std::sync::atomic::{AtomicU32, Ordering};

use glam::Vec3;
use rayon::prelude::*;

use super::lamps::Lamp;
use crate::curve::CurveNode;

/// Strips of a map, each walked by one task.
const STRIPS: usize = 4;
/// Nodes between one that is asked for and the one that is taken.
const AHEAD: usize = 16;
/// Bits of the distance by which nodes are sorted, in two passes.
const DIGIT: u32 = 9;

/// The fibres in front of each node and each place on the skin, as seen from one lamp.
#[derive(Default)]
pub struct Crossings {
    counts: Vec<AtomicU32>,
}

impl Crossings {
    /// Mean number of fibres between the lamp and receiver `i`: nodes first, then places on the skin.
    #[inline(always)]
    pub fn at(&self, i: usize) -> f32 {
        f32::from_bits(self.counts[i].load(Ordering::Relaxed))
    }
}

/// What the lamp sees: nodes that lay down fibre, and places on the skin that only read.
pub struct Scene<'a> {
    pub nodes: &'a [CurveNode],
    /// Length of hair that each node stands for (cm): halfway to its neighbours on both sides.
    pub length: &'a [f32],
    /// Half thickness of the hair at each node (cm).
    pub radius: &'a [f32],
    pub skin: &'a [Vec3],
}

/// One node or place as the lamp sees it.
#[derive(Clone, Copy)]
#[repr(align(32))]
struct Seen {
    /// Place (cells right and down) and distance from the lamp (cm).
    at: [f32; 2],
    distance: f32,
    /// Extent of the fibre it stands for (cells), and how many fibres that is when spread over one cell.
    extent: [f32; 2],
    fibres: f32,
}

/// A strip's order of nodes and map, kept from frame to frame.
#[derive(Default)]
pub struct Strip {
    keys: Vec<(u32, u32)>,
    spare: Vec<(u32, u32)>,
    cells: Vec<f32>,
}

/// Working memory of one lamp.
#[derive(Default)]
pub struct Sweep {
    seen: Vec<Seen>,
    strips: Vec<Strip>,
    pub crossings: Crossings,
}

impl Sweep {
    /// Counts the fibres before every node and place. `fineness`: side of a cell (cm) for a lamp that is a point.
    pub fn run(&mut self, lamp: &Lamp, scene: &Scene, fineness: f32) {
        // A wide lamp blurs what lies some centimetres behind the occluder by so much.
        let cell = fineness.max(5.0 * lamp.spread.tan());
        let right = lamp.toward.any_orthonormal_vector();
        let up = lamp.toward.cross(right);
        let total = scene.nodes.len() + scene.skin.len();
        (0..total)
            .into_par_iter()
            .with_min_len(4096)
            .map(|i| {
                let place = |p: Vec3| ([p.dot(right) / cell, p.dot(up) / cell], -p.dot(lamp.toward));
                let Some(node) = scene.nodes.get(i) else {
                    let (at, distance) = place(scene.skin[i - scene.nodes.len()]);
                    return Seen { at, distance, extent: [0.0; 2], fibres: 0.0 };
                };
                let (at, distance) = place(node.position);
                let length = scene.length[i];
                let extent = [node.tangent.dot(right) * length / cell, node.tangent.dot(up) * length / cell];
                let across = (extent[0] * extent[0] + extent[1] * extent[1]).sqrt();
                Seen { at, distance, extent, fibres: 2.0 * scene.radius[i] / cell * across }
            })
            .collect_into_vec(&mut self.seen);
        let nodes = &self.seen[..scene.nodes.len()];
        self.crossings.counts.clear();
        self.crossings.counts.resize_with(total, Default::default);
        let Some(range) = Range::of(nodes) else { return };

        let counts = &self.crossings.counts;
        let seen = &self.seen;
        self.strips.resize_with(STRIPS, Strip::default);
        self.strips.par_iter_mut().enumerate().for_each(|(s, strip)| {
            strip.sweep(s, seen, &range, counts);
        });
    }
}

/// Cells and distances that hold hair.
struct Range {
    low: [f32; 2],
    size: [usize; 2],
    near: f32,
    keys_per_cm: f32,
}

/// Largest side of a map (cells).
const LARGEST: f32 = 4096.0;

impl Range {
    fn of(nodes: &[Seen]) -> Option<Self> {
        let none = ([f32::INFINITY; 3], [f32::NEG_INFINITY; 3]);
        let (low, high) = nodes
            .par_iter()
            .with_min_len(8192)
            .fold(
                || none,
                |(low, high), n| {
                    let c = [n.at[0], n.at[1], n.distance];
                    (std::array::from_fn(|i| low[i].min(c[i])), std::array::from_fn(|i| high[i].max(c[i])))
                },
            )
            .reduce(
                || none,
                |a, b| {
                    (
                        std::array::from_fn(|i: usize| a.0[i].min(b.0[i])),
                        std::array::from_fn(|i: usize| a.1[i].max(b.1[i])),
                    )
                },
            );
        if low[0] > high[0] {
            return None;
        }
        // Beyond the largest map, far outliers are left without shadow rather than all hair with a coarse one.
        let middle = [0, 1].map(|i| 0.5 * (low[i] + high[i]));
        let side = [0, 1].map(|i| (high[i] - low[i]).min(LARGEST));
        let keys = (1_u32 << (2 * DIGIT)) - 1;
        Some(Self {
            low: [0, 1].map(|i| middle[i] - 0.5 * side[i]),
            size: side.map(|s| s as usize + 3),
            near: low[2],
            keys_per_cm: keys as f32 / (high[2] - low[2]).max(1e-6),
        })
    }
}

impl Strip {
    fn sweep(&mut self, s: usize, seen: &[Seen], range: &Range, counts: &[AtomicU32]) {
        let [width, height] = range.size;
        let (first, end) = (s * height / STRIPS, (s + 1) * height / STRIPS);
        // Reading needs one row more than the strip owns; laying from a node may reach two cells around it.
        let rows = end + 1 - first;
        let halo = 3.0;
        let most = (1_u32 << (2 * DIGIT)) - 1;
        self.keys.clear();
        for (i, n) in seen.iter().enumerate() {
            let y = n.at[1] - range.low[1];
            if y >= first as f32 - halo && y < end as f32 + halo {
                let key = ((n.distance - range.near) * range.keys_per_cm) as u32;
                self.keys.push((key.min(most), i as u32));
            }
        }
        self.sort();
        self.cells.clear();
        self.cells.resize(rows * width, 0.0);
        let top = first as f32;
        let keys = std::mem::take(&mut self.keys);
        for (k, &(_, i)) in keys.iter().enumerate() {
            // They come from all over memory: asking for later ones now hides most of the wait.
            std::hint::black_box(seen[keys[(k + AHEAD).min(keys.len() - 1)].1 as usize].distance);
            let i = i as usize;
            let n = &seen[i];
            let (x, y) = (n.at[0] - range.low[0], n.at[1] - range.low[1]);
            if y >= top && y < end as f32 {
                let count = self.read(x, y - top, width, rows);
                counts[i].store(count.to_bits(), Ordering::Relaxed);
            }
            if n.fibres > 0.0 {
                self.lay(n, [x, y - top], width, rows);
            }
        }
        self.keys = keys;
    }

    #[inline(always)]
    fn read(&self, x: f32, y: f32, width: usize, rows: usize) -> f32 {
        let (column, row) = (x as i32, y as i32);
        if x < 0.0 || y < 0.0 || column as usize + 1 >= width || row as usize + 1 >= rows {
            return 0.0;
        }
        let (u, v) = (x - column as f32, y - row as f32);
        let at = row as usize * width + column as usize;
        let upper = self.cells[at] + (self.cells[at + 1] - self.cells[at]) * u;
        let lower = self.cells[at + width] + (self.cells[at + width + 1] - self.cells[at + width]) * u;
        upper + (lower - upper) * v
    }

    /// Lays down a node's fibre, in steps of a cell at most.
    #[inline(always)]
    fn lay(&mut self, n: &Seen, at: [f32; 2], width: usize, rows: usize) {
        let longer = n.extent[0].abs().max(n.extent[1].abs());
        let steps = (longer as usize).min(7) + 1;
        let part = 1.0 / steps as f32;
        let share = n.fibres * part;
        for k in 0..steps {
            let t = (k as f32 + 0.5) * part - 0.5;
            // One cell more, so that rounding toward zero is rounding down within the border.
            let (x, y) = (at[0] + n.extent[0] * t + 1.0, at[1] + n.extent[1] * t + 1.0);
            if !(x >= 1.0 && x < width as f32 && y >= 0.0 && y < rows as f32 + 1.0) {
                continue;
            }
            let (column, row) = (x as usize, y as usize);
            let (u, v) = (x - column as f32, y - row as f32);
            if row >= 1 {
                let at = (row - 1) * width + column - 1;
                self.cells[at] += share * (1.0 - u) * (1.0 - v);
                self.cells[at + 1] += share * u * (1.0 - v);
            }
            if row < rows {
                let at = row * width + column - 1;
                self.cells[at] += share * (1.0 - u) * v;
                self.cells[at + 1] += share * u * v;
            }
        }
    }

    /// Sorts by key, ties in order.
    fn sort(&mut self) {
        const SIZE: usize = 1 << DIGIT;
        self.spare.resize(self.keys.len(), (0, 0));
        for shift in [0, DIGIT] {
            let mut places = [0_u32; SIZE];
            let digit = |key: u32| (key >> shift) as usize & (SIZE - 1);
            self.keys.iter().for_each(|k| places[digit(k.0)] += 1);
            let mut sum = 0;
            for place in &mut places {
                sum += std::mem::replace(place, sum);
            }
            for &k in &self.keys {
                let place = &mut places[digit(k.0)];
                self.spare[*place as usize] = k;
                *place += 1;
            }
            std::mem::swap(&mut self.keys, &mut self.spare);
        }
    }
}
