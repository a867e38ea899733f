//! Hair in the way of a lamp: how many fibres the light has crossed before it arrives.
//!
//! In the spirit of deep opacity maps (Yuksel and Keyser 2008), but without layers: everything is sorted by its distance from
//! the lamp, then taken in that order. Each node first reads, from a map of the lamp's view, how much fibre was laid down
//! there so far, then lays down its own. Long pieces are cut into parts, which each lie at their own distance. Reading and laying are
//! both spread over 2 x 2 cells in proportion, so neither cells nor layers show.

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
/// Side of a cell (cm) for a lamp that is a point: a few hairs. Where cells are wider than the way to the next layer of hair, hair that
/// faces the lamp at a grazing angle lies in its own shadow.
const CELL: f32 = 0.05;
/// Pieces are cut into parts that reach no farther into depth than this, and are no longer (cm): each lies at one distance.
const DEEPEST: f32 = 0.5;
const LONGEST: f32 = 1.0;
const MOST_CUTS: f32 = 32.0;
/// How far behind a part (cm) what is spread over cells beside it still counts as the same layer, at most.
const SPREAD_BEHIND: f32 = 0.1;
/// Skin reads this many cells about its place to each side, lest single hairs streak it.
const AROUND: usize = 2;
/// Most steps in which a part's fibre is laid down.
const MOST_STEPS: i32 = 12;
/// Nodes whose parts one task looks at.
const CHUNK: usize = 8192;
/// The receiver of what reads nothing.
const NOBODY: u32 = u32::MAX;
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

/// What the lamp sees: nodes that lay down fibre, and places on the skin that only read.
pub struct Scene<'a> {
    pub nodes: &'a [CurveNode],
    /// Half thickness of the hair at each node (cm).
    pub radius: &'a [f32],
    pub skin: &'a [Vec3],
    /// Thickness of the hair at its thickest (cm).
    pub width: f32,
    /// Lowest and highest corner of the box about the nodes.
    pub bounds: [Vec3; 2],
}

impl Scene<'_> {
    /// From node `i` to the next of its strand; nothing from the last.
    #[inline(always)]
    fn way(&self, i: usize) -> Vec3 {
        let next = self.nodes.get(i + 1).filter(|next| next.strand == self.nodes[i].strand);
        next.map_or(Vec3::ZERO, |next| next.position - self.nodes[i].position)
    }
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
#[derive(Clone, Copy, Default)]
struct Place {
    slab: u16,
    first_row: u16,
    last_row: u16,
}

/// What one strip of the map holds, in the order of distance; kept from frame to frame.
#[derive(Default)]
struct Strip {
    /// The rows of which it serves the receivers, and those that it holds: what they read lies around them.
    rows: std::ops::Range<usize>,
    held: std::ops::Range<usize>,
    starts: Vec<u32>,
    seen: Vec<Seen>,
    cells: Vec<f32>,
}

/// Working memory of one lamp.
#[derive(Default)]
pub struct Sweep {
    /// Into how many parts the piece that begins at each node is cut; none after the last of a strand.
    cuts: Vec<u8>,
    places: Vec<Place>,
    strips: Vec<Strip>,
    pub crossings: Crossings,
}

impl Sweep {
    /// Counts the fibres before every node and place. The map is
    /// walked in `strips`, a task each: every one looks through all nodes for its own, and none changes a bit.
    pub fn run(&mut self, lamp: &Lamp, scene: &Scene, strips: usize) {
        let total = scene.nodes.len() + scene.skin.len();
        self.crossings.counts.clear();
        self.crossings.counts.resize_with(total, Default::default);
        if scene.nodes.is_empty() {
            return;
        }
        let map = Map::new(lamp, scene);
        (0..scene.nodes.len())
            .into_par_iter()
            .with_min_len(8192)
            .map(|i| map.cuts(scene, i))
            .collect_into_vec(&mut self.cuts);
        // To each chunk of nodes its own stretch of places, in the order of the nodes; the skin's come last.
        let cuts = &self.cuts;
        let parts: Vec<usize> = cuts.par_chunks(CHUNK).map(|c| c.iter().map(|&c| 1 + usize::from(c)).sum()).collect();
        self.places.resize(parts.iter().sum::<usize>() + scene.skin.len(), Place::default());
        let mut rest = &mut self.places[..];
        let mut stretches = Vec::with_capacity(parts.len());
        for length in parts {
            let (stretch, after) = std::mem::take(&mut rest).split_at_mut(length);
            stretches.push(stretch);
            rest = after;
        }
        rest.par_iter_mut().with_min_len(4096).enumerate().for_each(|(i, place)| {
            let (seen, distance) = map.skin(scene, i);
            *place = map.place(&seen, distance);
        });
        stretches.into_par_iter().enumerate().for_each(|(chunk, stretch)| {
            let mut places = stretch.iter_mut();
            for (i, &cuts) in cuts.iter().enumerate().skip(chunk * CHUNK).take(CHUNK) {
                map.parts(scene, cuts, i, |seen, distance| {
                    if let Some(place) = places.next() {
                        *place = map.place(&seen, distance);
                    }
                });
            }
        });

        let (places, counts) = (&self.places, &self.crossings.counts);
        self.strips.resize_with(strips, Strip::default);
        self.strips.par_iter_mut().enumerate().for_each(|(s, strip)| {
            strip.rows = s * map.size[1] / strips..(s + 1) * map.size[1] / strips;
            strip.held = strip.rows.start.saturating_sub(AROUND)..strip.rows.end + AROUND + 1;
            strip.sort(places, cuts, &map, scene);
            strip.sweep(map.size[0], cuts.len() as u32, counts);
        });
    }
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
    fn new(lamp: &Lamp, scene: &Scene) -> Self {
        let [low, high] = scene.bounds;
        let toward = lamp.toward;
        let right = toward.any_orthonormal_vector();
        let up = toward.cross(right);
        // A wide lamp blurs what lies a centimetre behind the occluder by so much.
        let cells_per_cm = 1.0 / CELL.max(1.25 * lamp.spread.tan()).max(scene.width);
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

    /// A place as the lamp sees it: cells right and down, and distance (cm).
    #[inline(always)]
    fn project(&self, p: Vec3) -> Vec3 {
        let cells = self.cells_per_cm;
        Vec3::new(p.dot(self.right) * cells - self.low[0], p.dot(self.up) * cells - self.low[1], -p.dot(self.toward))
    }

    /// Into how many parts the piece from node `i` to the next is cut, so that each lies at one distance.
    #[inline(always)]
    fn cuts(&self, scene: &Scene, i: usize) -> u8 {
        let way = scene.way(i);
        let wanted = (way.dot(self.toward).abs() * (1.0 / DEEPEST)).max(way.length() * (1.0 / LONGEST));
        wanted.ceil().min(MOST_CUTS) as u8
    }

    /// Node `i`, which reads, and the parts of the piece that begins at it, which are laid down.
    #[inline(always)]
    fn parts(&self, scene: &Scene, cuts: u8, i: usize, mut each: impl FnMut(Seen, f32)) {
        let here = self.project(scene.nodes[i].position);
        each(Seen { at: [here.x, here.y], receiver: i as u32, ..Seen::default() }, here.z);
        if cuts == 0 {
            return;
        }
        let way = self.project(scene.nodes[i + 1].position) - here;
        let part = way * (1.0 / f32::from(cuts));
        let across = (part.x * part.x + part.y * part.y).sqrt();
        let fibres = (scene.radius[i] + scene.radius[i + 1]) * self.cells_per_cm * across;
        // Hair beside it is not in its shadow: it counts for what lies behind its far half, and behind half of a cell beyond.
        let deep = part.z.abs();
        let behind = 0.25 * deep + (0.5 * deep / across.max(1e-6)).min(SPREAD_BEHIND);
        for k in 0..cuts {
            let at = here + part * (f32::from(k) + 0.5);
            each(Seen { at: [at.x, at.y], extent: [part.x, part.y], fibres, receiver: NOBODY }, at.z + behind);
        }
    }

    /// Place `i` on the skin.
    #[inline(always)]
    fn skin(&self, scene: &Scene, i: usize) -> (Seen, f32) {
        let at = self.project(scene.skin[i]);
        (Seen { at: [at.x, at.y], receiver: (scene.nodes.len() + i) as u32, ..Seen::default() }, at.z)
    }

    #[inline(always)]
    fn place(&self, seen: &Seen, distance: f32) -> Place {
        // It lays fibre into the rows its extent reaches, and one about them.
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
    fn sort(&mut self, places: &[Place], cuts: &[u8], map: &Map, scene: &Scene) {
        // Rows that two strips hold are there twice.
        let (first, last) = (self.held.start as u16, self.held.end as u16 - 1);
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
        let mut places = places.iter();
        let mut put = |seen: Seen| {
            if let Some(p) = places.next().filter(|p| touches(p)) {
                let start = &mut self.starts[usize::from(p.slab)];
                self.seen[*start as usize] = seen;
                *start += 1;
            }
        };
        for (i, &cuts) in cuts.iter().enumerate() {
            map.parts(scene, cuts, i, |seen, _| put(seen));
        }
        for i in 0..scene.skin.len() {
            put(map.skin(scene, i).0);
        }
    }

    fn sweep(&mut self, width: usize, first_on_skin: u32, counts: &[AtomicU32]) {
        self.cells.clear();
        self.cells.resize(self.held.len() * width, 0.0);
        let mut cells = Cells { first_row: self.held.start, width, cells: &mut self.cells };
        for n in &self.seen {
            // Toward zero is down: what lies above the map is in no strip.
            if n.receiver != NOBODY && n.at[1] >= 0.0 && self.rows.contains(&(n.at[1] as usize)) {
                let fibres = if n.receiver < first_on_skin { cells.read(n.at) } else { cells.around(n.at) };
                counts[n.receiver as usize].store(fibres.to_bits(), Ordering::Relaxed);
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
    /// Fibres at a place within the strip, or [`AROUND`] it.
    #[inline(always)]
    fn read(&self, [x, y]: [f32; 2]) -> f32 {
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

    /// The mean of fibres over four cells by four about a place.
    fn around(&self, [x, y]: [f32; 2]) -> f32 {
        let row = |dy: f32| self.read([x - 1.0, y + dy]) + self.read([x + 1.0, y + dy]);
        0.25 * (row(-1.0) + row(1.0))
    }

    /// Lays down a part's fibre, in steps of a cell at most.
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
                let strand = i / 10;
                let turn = crate::camera::direction(strand as f32 * 137.508, strand as f32 * 0.6 - 90.0);
                let position = (4.0 + 0.02 * strand as f32) * turn + 1.3 * (i % 10) as f32 * Vec3::NEG_Y;
                CurveNode { position, tangent: Vec3::NEG_Y, strand, ..CurveNode::default() }
            })
            .collect();
        let lamp = Lamp { toward: crate::camera::direction(30.0, 42.0), strength: [1.0; 3], spread: 0.03 };
        let skin = [Vec3::ZERO, Vec3::new(0.3, -20.0, 0.1)];
        let radius = vec![0.05; nodes.len()];
        let scene = Scene { nodes: &nodes, radius: &radius, skin: &skin, width: 0.1, bounds: bounds(&nodes) };
        let counted = |strips: usize| -> Vec<u32> {
            let mut sweep = Sweep::default();
            sweep.run(&lamp, &scene, strips);
            (0..nodes.len() + skin.len()).map(|i| sweep.crossings.at(i).to_bits()).collect()
        };
        let whole = counted(1);
        assert!(whole.iter().filter(|&&bits| bits != 0).count() > nodes.len() / 2);
        for strips in [2, 3, 7] {
            assert_eq!(counted(strips), whole, "{strips} strips");
        }
    }

    #[test]
    fn hair_that_faces_the_lamp_aslant_does_not_lie_in_its_own_shadow() {
        // One layer of long straight hairs side by side.
        let spacing = 0.02;
        let nodes: Vec<CurveNode> = (0..4000_u32)
            .map(|i| {
                let (strand, k) = (i / 8, i % 8);
                let position = Vec3::new(2.0 * k as f32 + 0.3 * (strand % 7) as f32, 0.0, spacing * strand as f32);
                CurveNode { position, tangent: Vec3::X, strand, ..CurveNode::default() }
            })
            .collect();
        let radius = vec![0.007; nodes.len()];
        let scene = Scene { nodes: &nodes, radius: &radius, skin: &[], width: 0.014, bounds: bounds(&nodes) };
        for elevation in [15.0, 40.0, 75.0] {
            let lamp = Lamp { toward: crate::camera::direction(0.0, elevation), strength: [1.0; 3], spread: 0.03 };
            let mut sweep = Sweep::default();
            sweep.run(&lamp, &scene, 1);
            let mean = (0..nodes.len()).map(|i| sweep.crossings.at(i)).sum::<f32>() / nodes.len() as f32;
            // Light crosses the layer once. Of hair beside it, what is nearer by less than half a part's depth is not before it.
            assert!(mean < 0.25 * 2.0 * 0.007 / spacing, "{elevation}: {mean}");
        }
    }
}
