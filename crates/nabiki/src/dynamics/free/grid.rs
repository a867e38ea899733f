//! Hair against hair: what the carriers write to a grid, and what every strand reads from it.

#[cfg(test)]
mod tests;

use std::ops::Range;

use glam::{DVec3, UVec3, Vec3, Vec4};

use crate::distance::whole;
use crate::dynamics::row::{LANES, PointRow};
use crate::error::SettingError;
use crate::free_form::{NeighbourForces, Neighbours};
use crate::strands::bounds;

/// Most nodes of a grid: 128 in each direction.
const MOST_NODES: u64 = 128 * 128 * 128;

/// The carriers' hair in one frame, as a field: a force, and a drag against the hair's own motion.
#[derive(Clone, Debug)]
pub(in crate::dynamics) struct Crowd {
    forces: NeighbourForces,
    cells_per_cm: f32,
    /// The first node (head space, cm).
    low: Vec3,
    nodes: UVec3,
    /// The nodes with hair around them, first and last along each axis, and those of the frame before.
    filled: [[UVec3; 2]; 2],
    /// For every point of the carriers, the length of hair that it represents (cm).
    masses: Vec<f32>,
    /// For every node, the density at rest, relative to the mean where there is hair.
    rest: Vec<f32>,
    /// 1 / the mean mass of a node, weighted by mass (1 / cm): the unit of density.
    unit: f32,
    /// For every node, momentum and mass of the hair around it.
    content: Vec<Vec4>,
    /// For every node, the excess over the density at rest.
    excess: Vec<f32>,
    /// For every node, a force (x, y, z), and in w the drag in the unit of the force per cm per frame.
    pull: Vec<[f32; 4]>,
}

impl Crowd {
    /// The grid of carriers at rest: no force. `points`: theirs at rest, as the stepper computes them. `slow`: in slow
    /// motion hair moves fewer cm per frame, and the drag is as firm.
    ///
    /// # Errors
    /// Cells so small beside the hair's reach that the grid would not fit.
    pub fn new(neighbours: &Neighbours, slow: f32, points: &[Vec3]) -> Result<Self, SettingError> {
        let Neighbours { forces, carriers } = neighbours;
        let [low, high] = bounds(points);
        // From any root to the length of any carrier, however it swings, plus a cell.
        let longest = carriers.lengths().fold(0.0, f32::max);
        let roots: Vec<Vec3> = carriers.iter().map(|strand| strand[0]).collect();
        let [low_root, high_root] = bounds(&roots);
        let reach = longest + 2.0 * forces.cell;
        let (low, high) = (low.min(low_root - reach), high.max(high_root + reach));
        let nodes = ((high - low) / forces.cell).ceil() + 1.0;
        let count = nodes.as_dvec3().element_product();
        if count > MOST_NODES as f64 {
            let remedy = format!(
                "hair that can reach over {:.0} cm needs {count:.0} cells of this size, but at most {MOST_NODES} are \
                 allowed: make them larger",
                (high - low).max_element()
            );
            return Err(SettingError::new("neighbours.cell", forces.cell, remedy));
        }
        let nodes = nodes.as_uvec3();
        let count = nodes.element_product() as usize;
        let mut crowd = Self {
            forces: NeighbourForces { cohesion: slow * forces.cohesion, ..forces.clone() },
            cells_per_cm: 1.0 / forces.cell,
            low,
            nodes,
            filled: [[UVec3::ZERO, nodes - 1]; 2],
            masses: carriers.iter().flat_map(masses).collect(),
            rest: vec![0.0; count],
            unit: 1.0,
            content: vec![Vec4::ZERO; count],
            excess: vec![0.0; count],
            pull: vec![[0.0; 4]; count],
        };
        crowd.settle(points);
        Ok(crowd)
    }

    /// Takes the density of the hair at rest; only an excess over it pushes.
    fn settle(&mut self, points: &[Vec3]) {
        let still = vec![Vec3::ZERO; points.len()];
        self.splat(points, &still);
        let (sum, squares) = (self.content.iter())
            .fold((0.0_f64, 0.0_f64), |(sum, squares), c| (sum + f64::from(c.w), squares + f64::from(c.w).powi(2)));
        self.unit = (sum / squares) as f32;
        for (rest, content) in self.rest.iter_mut().zip(&self.content) {
            *rest = content.w * self.unit;
        }
        self.pull();
    }

    /// Reads the current carriers: `points` (cm) and `velocities` (cm per frame) of every point.
    pub fn fill(&mut self, points: &[Vec3], velocities: &[Vec3]) {
        self.splat(points, velocities);
        self.pull();
    }

    /// Copies the grid of the same carriers in another frame, into existing memory.
    pub fn take(&mut self, other: &Self) {
        // Both are 0 everywhere else. Hair thrown beyond the grid counts in its first cell.
        for row in rows(self.nodes, self.filled[0]) {
            self.content[row].fill(Vec4::ZERO);
        }
        for row in rows(self.nodes, self.around()) {
            self.excess[row.clone()].fill(0.0);
            self.pull[row].fill([0.0; 4]);
        }
        self.filled = other.filled;
        for row in rows(self.nodes, self.filled[0]) {
            self.content[row.clone()].copy_from_slice(&other.content[row]);
        }
        for row in rows(self.nodes, self.around()) {
            self.excess[row.clone()].copy_from_slice(&other.excess[row.clone()]);
            self.pull[row.clone()].copy_from_slice(&other.pull[row]);
        }
    }

    /// What others may read, without what its next frame is computed from: its forces, which are cheap to copy.
    pub fn left(&self) -> Self {
        let mut pull = vec![[0.0; 4]; self.pull.len()];
        for row in rows(self.nodes, self.around()) {
            pull[row.clone()].copy_from_slice(&self.pull[row]);
        }
        let forces = self.forces.clone();
        let (masses, rest, excess, content) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
        Self { forces, masses, rest, excess, content, pull, ..*self }
    }

    /// Where there is hair, or was, and one node beyond: elsewhere there are no forces. Hair does not reach the
    /// outermost nodes, so none of these needs neighbours outside.
    fn around(&self) -> [UVec3; 2] {
        let [[a, b], [c, d]] = self.filled;
        [a.min(c).max(UVec3::splat(2)) - 1, (b.max(d) + 1).min(self.nodes - 2)]
    }

    /// Spreads every point over the eight nodes around it, in sequence, so that the sums do not depend on threads.
    fn splat(&mut self, points: &[Vec3], velocities: &[Vec3]) {
        for row in rows(self.nodes, self.filled[0]) {
            self.content[row].fill(Vec4::ZERO);
        }
        let (row, slice) = self.strides();
        let (mut first_filled, mut last_filled) = (self.nodes - 1, UVec3::ZERO);
        for ((&p, &velocity), &mass) in points.iter().zip(velocities).zip(&self.masses) {
            let (first, t) = self.cell(p.to_array());
            let first = first as usize;
            let content = mass * velocity.extend(1.0);
            for (corner, weight) in [(0, 1.0 - t[2]), (slice, t[2])] {
                for (corner, weight) in [(corner, weight * (1.0 - t[1])), (corner + row, weight * t[1])] {
                    self.content[first + corner] += content * (weight * (1.0 - t[0]));
                    self.content[first + corner + 1] += content * (weight * t[0]);
                }
            }
            let cell = UVec3::new((first % row) as u32, (first % slice / row) as u32, (first / slice) as u32);
            (first_filled, last_filled) = (first_filled.min(cell), last_filled.max(cell + 1));
        }
        self.filled = [[first_filled, last_filled], self.filled[0]];
    }

    /// From density and momentum to forces, where there is or was hair and one node beyond: elsewhere both are 0.
    fn pull(&mut self) {
        let around = self.around();
        let Self { forces, nodes, rest, unit, content, excess, pull, .. } = self;
        for row in rows(*nodes, around) {
            let (content, rest) = (&content[row.clone()], &rest[row.clone()]);
            let (excess, pull) = (&mut excess[row.clone()], &mut pull[row]);
            for (((content, rest), excess), pull) in content.iter().zip(rest).zip(excess).zip(pull) {
                let density = content.w * *unit;
                let drag = forces.cohesion * density.min(1.0);
                // Momentum over mass is the mean velocity; without hair there is no drag.
                let of_momentum = if content.w > 0.0 { drag / content.w } else { 0.0 };
                *excess = (density - rest).max(0.0);
                *pull = (content.truncate() * of_momentum).extend(drag).to_array();
            }
        }
        let half = 0.5 * forces.pressure;
        let (along_y, along_z) = self.strides();
        let Self { excess, pull, nodes, .. } = self;
        for row in rows(*nodes, around) {
            for at in row {
                let [x, y, z, drag] = pull[at];
                pull[at] = [
                    x - half * (excess[at + 1] - excess[at - 1]),
                    y - half * (excess[at + along_y] - excess[at - along_y]),
                    z - half * (excess[at + along_z] - excess[at - along_z]),
                    drag,
                ];
            }
        }
    }

    /// The forces on sixteen points, and their drag (head space); 0 beyond the grid.
    #[allow(clippy::needless_range_loop, reason = "a loop over lanes, as in the kernels")]
    #[inline(always)]
    pub fn at_row(&self, points: &PointRow, pulls: &mut [[f32; 4]; LANES]) {
        let (mut firsts, mut places) = ([0; LANES], [[0.0; LANES]; 3]);
        for lane in 0..LANES {
            let (first, t) = self.cell([points[0].0[lane], points[1].0[lane], points[2].0[lane]]);
            firsts[lane] = first;
            (places[0][lane], places[1][lane], places[2][lane]) = (t[0], t[1], t[2]);
        }
        for lane in 0..LANES {
            pulls[lane] =
                self.between::<true>(firsts[lane] as usize, [places[0][lane], places[1][lane], places[2][lane]]);
        }
    }

    /// The force on a point of the cell of this first node, and its drag. `FUSED`: multiplied and added in one
    /// operation, as the fast step does. Without vector code, that would be a call for every number.
    #[allow(clippy::needless_range_loop, reason = "one vector of four numbers")]
    #[inline(always)]
    fn between<const FUSED: bool>(&self, first: usize, [x, y, z]: [f32; 3]) -> [f32; 4] {
        let (row, slice) = self.strides();
        let (a, b) = (self.pair(first), self.pair(first + row));
        let (c, d) = (self.pair(first + slice), self.pair(first + slice + row));
        let pair = lerp::<FUSED>(lerp::<FUSED>(a, b, y), lerp::<FUSED>(c, d, y), z);
        let ([low, high], mut pull) = (pair, [0.0; 4]);
        for i in 0..4 {
            pull[i] = toward::<FUSED>(low[i], high[i], x);
        }
        pull
    }

    /// The values at a node and at the next one along x.
    #[inline(always)]
    fn pair(&self, at: usize) -> [[f32; 4]; 2] {
        let pull = &self.pull[at..at + 2];
        [pull[0], pull[1]]
    }

    /// The force on a point at rest (head space), and the drag on its velocity.
    pub fn at(&self, p: DVec3) -> (DVec3, f64) {
        let (first, t) = self.cell(p.as_vec3().to_array());
        let [x, y, z, drag] = self.between::<false>(first as usize, t).map(f64::from);
        (DVec3::new(x, y, z), drag)
    }

    #[inline(always)]
    fn strides(&self) -> (usize, usize) {
        (self.nodes.x as usize, (self.nodes.x * self.nodes.y) as usize)
    }

    /// The first node of the cell of a point, and the place of the point in it, 0..=1. Points beyond the grid get a
    /// cell that no hair reaches.
    #[inline(always)]
    fn cell(&self, p: [f32; 3]) -> (u32, [f32; 3]) {
        let (size, nodes) = (self.cells_per_cm, self.nodes);
        let q = [(p[0] - self.low.x) * size, (p[1] - self.low.y) * size, (p[2] - self.low.z) * size];
        let cells = [(nodes.x - 1) as f32, (nodes.y - 1) as f32, (nodes.z - 1) as f32];
        let above = (q[0] >= 0.0) & (q[1] >= 0.0) & (q[2] >= 0.0);
        let inside = above & (q[0] < cells[0]) & (q[1] < cells[1]) & (q[2] < cells[2]);
        let q = if inside { q } else { [0.5; 3] };
        let ((i, x), (j, y), (k, z)) = (whole(q[0]), whole(q[1]), whole(q[2]));
        ((k * nodes.y + j) * nodes.x + i, [x, y, z])
    }
}

#[inline(always)]
fn lerp<const FUSED: bool>(a: [[f32; 4]; 2], b: [[f32; 4]; 2], t: f32) -> [[f32; 4]; 2] {
    let mut sum = [[0.0; 4]; 2];
    for i in 0..2 {
        for j in 0..4 {
            sum[i][j] = toward::<FUSED>(a[i][j], b[i][j], t);
        }
    }
    sum
}

#[inline(always)]
fn toward<const FUSED: bool>(a: f32, b: f32, t: f32) -> f32 {
    if FUSED { (b - a).mul_add(t, a) } else { (b - a) * t + a }
}

/// The rows of a box of nodes of the grid, from the first to the last along each axis.
fn rows(nodes: UVec3, [first, last]: [UVec3; 2]) -> impl Iterator<Item = Range<usize>> {
    let rows = (first.z..=last.z).flat_map(move |k| (first.y..=last.y).map(move |j| (k * nodes.y + j) * nodes.x));
    rows.map(move |row| (row + first.x) as usize..(row + last.x + 1) as usize)
}

/// The length of hair that each point of a strand represents: half of the segments that meet there (cm).
fn masses(strand: &[Vec3]) -> Vec<f32> {
    let mut masses = vec![0.0; strand.len()];
    for (i, w) in strand.windows(2).enumerate() {
        let half = 0.5 * w[0].distance(w[1]);
        masses[i] += half;
        masses[i + 1] += half;
    }
    masses
}
