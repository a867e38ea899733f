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

/// Distances are told apart in slabs so thick (cm): a few fibres. Within a slab the order is that of the nodes.
const SLAB: f32 = 0.05;
const MOST_SLABS: f32 = 2048.0;
/// Hair farther than this from the origin of head space (cm) is not told apart, lest one lost strand spoil the order of all.
const FARTHEST: f32 = 200.0;
/// Most steps in which a node's fibre is laid down.
const MOST_STEPS: i32 = 8;
/// Largest side of a map (cells).
const LARGEST: f32 = 4096.0;

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

/// Length of hair that each node stands for (cm): halfway to its neighbours on both sides.
pub fn lengths(nodes: &[CurveNode], lengths: &mut Vec<f32>) {
    let half = |a: &CurveNode, b: Option<&CurveNode>| {
        b.filter(|b| b.strand == a.strand).map_or(0.0, |b| 0.5 * b.position.distance(a.position))
    };
    (0..nodes.len())
        .into_par_iter()
        .with_min_len(8192)
        .map(|i| half(&nodes[i], i.checked_sub(1).map(|j| &nodes[j])) + half(&nodes[i], nodes.get(i + 1)))
        .collect_into_vec(lengths);
}

/// What the lamp sees: nodes that lay down fibre, and places on the skin that only read.
pub struct Scene<'a> {
    pub nodes: &'a [CurveNode],
    /// Length of hair that each node stands for (cm), of [`lengths`].
    pub length: &'a [f32],
    /// Half thickness of the hair at each node (cm).
    pub radius: &'a [f32],
    pub skin: &'a [Vec3],
    /// Lowest and highest corner of the box about the nodes.
    pub bounds: [Vec3; 2],
}

/// One node or place as the lamp sees it.
#[derive(Clone, Copy, Default)]
#[repr(align(32))]
struct Seen {
    /// Place (cells right and down).
    at: [f32; 2],
    /// Extent of the fibre it stands for (cells), and how many fibres that is when spread over one cell.
    extent: [f32; 2],
    fibres: f32,
    receiver: u32,
}

/// Where a node or place belongs: its slab, and the rows of cells that it needs.
#[derive(Clone, Copy)]
struct Place {
    slab: u16,
    first_row: u16,
    last_row: u16,
}

/// What one strip of the map holds, in the order of distance; kept from frame to frame.
#[derive(Default)]
struct Strip {
    rows: std::ops::Range<usize>,
    starts: Vec<u32>,
    seen: Vec<Seen>,
    cells: Vec<f32>,
}

/// Working memory of one lamp.
#[derive(Default)]
pub struct Sweep {
    places: Vec<Place>,
    strips: Vec<Strip>,
    pub crossings: Crossings,
}

impl Sweep {
    /// Counts the fibres before every node and place. `fineness`: side of a cell (cm) for a lamp that is a point. The map is
    /// walked in `strips`, a task each: every one looks through all nodes for its own, and none changes a bit.
    pub fn run(&mut self, lamp: &Lamp, scene: &Scene, fineness: f32, strips: usize) {
        let total = scene.nodes.len() + scene.skin.len();
        self.crossings.counts.clear();
        self.crossings.counts.resize_with(total, Default::default);
        if scene.nodes.is_empty() {
            return;
        }
        let map = Map::new(lamp, scene.bounds, fineness);
        (0..total)
            .into_par_iter()
            .with_min_len(4096)
            .map(|i| map.place(&map.seen(scene, i), map.distance(position(scene, i))))
            .collect_into_vec(&mut self.places);

        let (places, counts) = (&self.places, &self.crossings.counts);
        self.strips.resize_with(strips, Strip::default);
        self.strips.par_iter_mut().enumerate().for_each(|(s, strip)| {
            strip.rows = s * map.size[1] / strips..(s + 1) * map.size[1] / strips;
            strip.sort(places, &map, scene);
            strip.sweep(map.size[0], counts);
        });
    }
}

fn position(scene: &Scene, i: usize) -> Vec3 {
    scene.nodes.get(i).map_or_else(|| scene.skin[i - scene.nodes.len()], |n| n.position)
}

/// The plane and the distances that hold hair.
struct Map {
    right: Vec3,
    up: Vec3,
    toward: Vec3,
    cells_per_cm: f32,
    /// First cell, and number of cells right and down.
    low: [f32; 2],
    size: [usize; 2],
    near: f32,
    slabs_per_cm: f32,
    slabs: usize,
}

impl Map {
    fn new(lamp: &Lamp, [low, high]: [Vec3; 2], fineness: f32) -> Self {
        let toward = lamp.toward;
        let right = toward.any_orthonormal_vector();
        let up = toward.cross(right);
        // A wide lamp blurs what lies some centimetres behind the occluder by so much.
        let cells_per_cm = 1.0 / fineness.max(5.0 * lamp.spread.tan());
        // The box as the lamp sees it.
        let (middle, half) = (0.5 * (low + high), 0.5 * (high - low));
        let [x, y, z] = [cells_per_cm * right, cells_per_cm * up, -toward].map(|axis| {
            let (middle, half) = (middle.dot(axis), half.dot(axis.abs()));
            [middle - half, middle + half]
        });
        let (low, high) = (Vec3::new(x[0], y[0], z[0]), Vec3::new(x[1], y[1], z[1]));
        // Beyond the largest map, far outliers are left without shadow rather than all hair with a coarse one.
        let middle = 0.5 * (low + high);
        let side = (high - low).min(Vec3::splat(LARGEST));
        let (near, far) = (low.z.clamp(-FARTHEST, FARTHEST), high.z.clamp(-FARTHEST, FARTHEST));
        let slabs = ((far - near) / SLAB).ceil().clamp(1.0, MOST_SLABS);
        Self {
            right,
            up,
            toward,
            cells_per_cm,
            low: [middle.x - 0.5 * side.x, middle.y - 0.5 * side.y],
            size: [side.x as usize + 3, side.y as usize + 3],
            near,
            slabs_per_cm: slabs / (far - near).max(SLAB),
            slabs: slabs as usize,
        }
    }

    #[inline(always)]
    fn distance(&self, p: Vec3) -> f32 {
        -p.dot(self.toward)
    }

    #[inline(always)]
    fn seen(&self, scene: &Scene, i: usize) -> Seen {
        let place = |p: Vec3| {
            [p.dot(self.right) * self.cells_per_cm - self.low[0], p.dot(self.up) * self.cells_per_cm - self.low[1]]
        };
        let Some(node) = scene.nodes.get(i) else {
            let at = place(scene.skin[i - scene.nodes.len()]);
            return Seen { at, receiver: i as u32, ..Seen::default() };
        };
        let length = scene.length[i] * self.cells_per_cm;
        let extent = [node.tangent.dot(self.right) * length, node.tangent.dot(self.up) * length];
        let across = (extent[0] * extent[0] + extent[1] * extent[1]).sqrt();
        let fibres = 2.0 * scene.radius[i] * self.cells_per_cm * across;
        Seen { at: place(node.position), extent, fibres, receiver: i as u32 }
    }

    #[inline(always)]
    fn place(&self, seen: &Seen, distance: f32) -> Place {
        // It reads the row it lies in and the next, and lays fibre into those its extent reaches, and one about them.
        let half = 0.5 * seen.extent[1].abs() + 1.0;
        Place {
            slab: ((distance - self.near) * self.slabs_per_cm).min(self.slabs as f32 - 1.0) as u16,
            first_row: (seen.at[1] - half).clamp(0.0, 65535.0) as u16,
            last_row: (seen.at[1] + half).clamp(0.0, 65535.0) as u16,
        }
    }
}

impl Strip {
    /// Collects what touches the strip in the order of distance from the lamp, ties in the order of the nodes.
    fn sort(&mut self, places: &[Place], map: &Map, scene: &Scene) {
        // The row after the strip is its own copy: nodes between the two read it.
        let (first, last) = (self.rows.start as u16, self.rows.end as u16);
        let touches = |p: &Place| p.first_row <= last && p.last_row >= first;
        self.starts.clear();
        self.starts.resize(map.slabs, 0);
        for p in places.iter().filter(|p| touches(p)) {
            self.starts[usize::from(p.slab)] += 1;
        }
        let mut sum = 0;
        for start in &mut self.starts {
            sum += std::mem::replace(start, sum);
        }
        self.seen.resize(sum as usize, Seen::default());
        for (i, p) in places.iter().enumerate().filter(|(_, p)| touches(p)) {
            let start = &mut self.starts[usize::from(p.slab)];
            self.seen[*start as usize] = map.seen(scene, i);
            *start += 1;
        }
    }

    fn sweep(&mut self, width: usize, counts: &[AtomicU32]) {
        self.cells.clear();
        self.cells.resize((self.rows.len() + 1) * width, 0.0);
        let mut cells = Cells { first_row: self.rows.start, width, cells: &mut self.cells };
        for n in &self.seen {
            // Toward zero is down: what lies above the map is in no strip.
            if n.at[1] >= 0.0 && self.rows.contains(&(n.at[1] as usize)) {
                counts[n.receiver as usize].store(cells.read(n.at).to_bits(), Ordering::Relaxed);
            }
            if n.fibres > 0.0 {
                cells.lay(n);
            }
        }
    }
}

/// Fibres laid down so far in a strip of the map, row after row. Places are counted from the corner of the whole map, so that
/// they round alike in whatever strip.
struct Cells<'a> {
    first_row: usize,
    width: usize,
    cells: &'a mut [f32],
}

impl Cells<'_> {
    /// Fibres at a place within the strip.
    #[inline(always)]
    fn read(&self, [x, y]: [f32; 2]) -> f32 {
        let (column, row) = (x as usize, y as usize);
        if x < 0.0 || column + 1 >= self.width {
            return 0.0;
        }
        let (u, v) = (x - column as f32, y - row as f32);
        let from = &self.cells[(row - self.first_row) * self.width + column..];
        let (upper, lower) = (&from[..2], &from[self.width..self.width + 2]);
        let upper = upper[0] + (upper[1] - upper[0]) * u;
        let lower = lower[0] + (lower[1] - lower[0]) * u;
        upper + (lower - upper) * v
    }

    /// Lays down a node's fibre, in steps of a cell at most.
    #[inline(always)]
    fn lay(&mut self, n: &Seen) {
        let longer = n.extent[0].abs().max(n.extent[1].abs());
        let steps = (longer as i32).min(MOST_STEPS - 1) + 1;
        let part = 1.0 / steps as f32;
        let share = n.fibres * part;
        // One cell more, so that rounding toward zero is rounding down within the border.
        let middle = n.at.map(|c| c + 1.0);
        let last_row = self.first_row + self.cells.len() / self.width;
        let within = |axis: usize, first: usize, end: usize| {
            let half = 0.5 * n.extent[axis].abs();
            middle[axis] - half >= first as f32 && middle[axis] + half < end as f32
        };
        if within(0, 1, self.width) && within(1, self.first_row + 1, last_row) {
            for k in 0..steps {
                let (column, row, shares) = spread(middle, n.extent, (k as f32 + 0.5) * part - 0.5, share);
                let at = (row - 1 - self.first_row) * self.width + column - 1;
                let [a, b, c, d] = shares;
                let from = &mut self.cells[at..at + self.width + 2];
                from[0] += a;
                from[1] += b;
                from[self.width] += c;
                from[self.width + 1] += d;
            }
        } else {
            for k in 0..steps {
                let t = (k as f32 + 0.5) * part - 0.5;
                let (x, y) = (middle[0] + n.extent[0] * t, middle[1] + n.extent[1] * t);
                if x >= 1.0 && x < self.width as f32 && y >= 0.0 {
                    let (column, row, shares) = spread(middle, n.extent, t, share);
                    for (row, pair) in [(row.checked_sub(1), &shares[..2]), (Some(row), &shares[2..])] {
                        let own = row.and_then(|row| row.checked_sub(self.first_row));
                        if let Some(row) = own.filter(|row| row * self.width < self.cells.len()) {
                            self.cells[row * self.width + column - 1] += pair[0];
                            self.cells[row * self.width + column] += pair[1];
                        }
                    }
                }
            }
        }
    }
}

/// The part of a node's fibre that lies `t` of its extent from the middle, in proportion over four cells: the column and row
/// of the last of them, and their shares.
#[inline(always)]
fn spread(middle: [f32; 2], extent: [f32; 2], t: f32, share: f32) -> (usize, usize, [f32; 4]) {
    let (x, y) = (middle[0] + extent[0] * t, middle[1] + extent[1] * t);
    let (column, row) = (x as i32, y as i32);
    let (u, v) = (x - column as f32, y - row as f32);
    let (left, right) = (share * (1.0 - u), share * u);
    (column as usize, row as usize, [left * (1.0 - v), right * (1.0 - v), left * v, right * v])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::curve::bounds;

    #[test]
    fn the_bits_do_not_depend_on_the_number_of_strips() {
        let nodes: Vec<CurveNode> = (0..3000_u32)
            .map(|i| {
                let turn = crate::camera::direction(i as f32 * 137.508, i as f32 * 0.06 - 90.0);
                let position = (4.0 + 0.002 * i as f32) * turn;
                CurveNode { position, tangent: turn.cross(Vec3::X).normalize_or(Vec3::Y), ..CurveNode::default() }
            })
            .collect();
        let lamp = Lamp { toward: crate::camera::direction(30.0, 42.0), strength: [1.0; 3], spread: 0.03 };
        let skin = [Vec3::ZERO, Vec3::new(0.3, -20.0, 0.1)];
        let (length, radius) = (vec![1.3; nodes.len()], vec![0.05; nodes.len()]);
        let scene = Scene { nodes: &nodes, length: &length, radius: &radius, skin: &skin, bounds: bounds(&nodes) };
        let counted = |strips: usize| -> Vec<u32> {
            let mut sweep = Sweep::default();
            sweep.run(&lamp, &scene, 0.2, strips);
            (0..nodes.len() + skin.len()).map(|i| sweep.crossings.at(i).to_bits()).collect()
        };
        let whole = counted(1);
        assert!(whole.iter().filter(|&&bits| bits != 0).count() > nodes.len() / 2);
        for strips in [2, 3, 7] {
            assert_eq!(counted(strips), whole, "{strips} strips");
        }
    }
}
