//! Hair against hair: what the carriers leave in a grid, and what every strand feels of it.

use glam::{DVec3, UVec3, Vec3, Vec4};

use crate::error::SettingError;
use crate::free_form::{NeighbourForces, Neighbours};
use crate::strands::bounds;

/// The most nodes of a grid: 128 in each direction.
const MOST_NODES: u64 = 128 * 128 * 128;

/// The carriers' hair in one frame, as a field: a force, and a drag against the hair's own motion.
#[derive(Clone, Debug)]
pub(super) struct Crowd {
    forces: NeighbourForces,
    /// The first node (head space, cm).
    low: Vec3,
    nodes: UVec3,
    /// Of every point of the carriers: the length of hair that it stands for (cm).
    masses: Vec<f32>,
    /// Of every node: density at rest, in the mean of the places where there is hair.
    rest: Vec<f32>,
    /// 1 / the mean mass of a node, weighted by mass (1 / cm): what counts as a density of 1.
    unit: f32,
    /// Of every node: momentum and mass of the hair about it.
    content: Vec<Vec4>,
    /// Of every node: density above that at rest.
    excess: Vec<f32>,
    /// Of every node: a force (x, y, z), and w, the drag in the unit of the force for each cm a frame.
    pull: Vec<Vec4>,
}

impl Crowd {
    /// What carriers at rest leave: no force. `points`: theirs at rest, as the stepper puts them together.
    ///
    /// # Errors
    /// Cells so small beside the hair's reach that the grid would not fit.
    pub fn new(neighbours: &Neighbours, points: &[Vec3]) -> Result<Self, SettingError> {
        let Neighbours { forces, carriers } = neighbours;
        let [low, high] = bounds(points);
        // From any root to the length of any carrier, however it swings, and a cell about it.
        let longest = carriers.lengths().fold(0.0, f32::max);
        let roots: Vec<Vec3> = carriers.iter().map(|strand| strand[0]).collect();
        let [low_root, high_root] = bounds(&roots);
        let reach = longest + 2.0 * forces.cell;
        let (low, high) = (low.min(low_root - reach), high.max(high_root + reach));
        let nodes = ((high - low) / forces.cell).ceil() + 1.0;
        let count = nodes.as_dvec3().element_product();
        if count > MOST_NODES as f64 {
            let remedy = format!(
                "hair that reaches {:.0} cm would take {count:.0} cells of it, and {MOST_NODES} are the most: give larger ones",
                (high - low).max_element()
            );
            return Err(SettingError::new("neighbours.cell", forces.cell, remedy));
        }
        let nodes = nodes.as_uvec3();
        let count = nodes.element_product() as usize;
        let mut crowd = Self {
            forces: forces.clone(),
            low,
            nodes,
            masses: carriers.iter().flat_map(masses).collect(),
            rest: vec![0.0; count],
            unit: 1.0,
            content: vec![Vec4::ZERO; count],
            excess: vec![0.0; count],
            pull: vec![Vec4::ZERO; count],
        };
        crowd.settle(points);
        Ok(crowd)
    }

    /// Takes the density of the hair at rest, of which only an excess pushes.
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

    /// Takes the carriers as they are now. `points` (cm), `velocities` (cm a frame): of every point of every carrier.
    pub fn fill(&mut self, points: &[Vec3], velocities: &[Vec3]) {
        self.splat(points, velocities);
        self.pull();
    }

    /// Spreads every point over the eight nodes about it, one after another: the sums do not depend on threads.
    fn splat(&mut self, points: &[Vec3], velocities: &[Vec3]) {
        self.content.fill(Vec4::ZERO);
        for ((&p, &velocity), &mass) in points.iter().zip(velocities).zip(&self.masses) {
            let Some((first, t)) = self.cell(p) else { continue };
            let content = mass * velocity.extend(1.0);
            let (row, slice) = self.strides();
            for (corner, weight) in [(0, 1.0 - t.z), (slice, t.z)] {
                for (corner, weight) in [(corner, weight * (1.0 - t.y)), (corner + row, weight * t.y)] {
                    self.content[first + corner] += content * (weight * (1.0 - t.x));
                    self.content[first + corner + 1] += content * (weight * t.x);
                }
            }
        }
    }

    /// From density and momentum to forces.
    fn pull(&mut self) {
        let Self { forces, rest, unit, content, excess, pull, .. } = self;
        for (((content, rest), excess), pull) in content.iter().zip(&*rest).zip(&mut *excess).zip(&mut *pull) {
            let density = content.w * *unit;
            let drag = forces.cohesion * density.min(1.0);
            // Momentum over mass is the mean velocity; no hair, no drag.
            let of_momentum = if content.w > 0.0 { drag / content.w } else { 0.0 };
            *excess = (density - rest).max(0.0);
            *pull = (content.truncate() * of_momentum).extend(drag);
        }
        let half = 0.5 * forces.pressure;
        let (row, slice) = self.strides();
        let Self { excess, pull, nodes, .. } = self;
        // Hair does not reach the outermost nodes, so those have no neighbours to ask.
        for k in 1..nodes.z as usize - 1 {
            for j in 1..nodes.y as usize - 1 {
                let first = k * slice + j * row;
                for at in first + 1..first + nodes.x as usize - 1 {
                    let rise = |stride: usize| excess[at + stride] - excess[at - stride];
                    pull[at] -= (half * Vec3::new(rise(1), rise(row), rise(slice))).extend(0.0);
                }
            }
        }
    }

    /// The force on a point of hair and its drag (head space); none beyond the grid.
    pub fn at(&self, p: Vec3) -> Vec4 {
        let Some((first, t)) = self.cell(p) else { return Vec4::ZERO };
        let (row, slice) = self.strides();
        let along_x = |i: usize| self.pull[i] + (self.pull[i + 1] - self.pull[i]) * t.x;
        let along_y = |i: usize| {
            let (a, b) = (along_x(i), along_x(i + row));
            a + (b - a) * t.y
        };
        let (a, b) = (along_y(first), along_y(first + slice));
        a + (b - a) * t.z
    }

    /// The force on a point that goes along at `velocity` (cm a frame; head space).
    pub fn force(&self, p: DVec3, velocity: DVec3) -> DVec3 {
        let pull = self.at(p.as_vec3()).as_dvec4();
        pull.truncate() - pull.w * velocity
    }

    fn strides(&self) -> (usize, usize) {
        (self.nodes.x as usize, (self.nodes.x * self.nodes.y) as usize)
    }

    /// The first node of the cell of a point, and where in it the point lies, 0..1.
    fn cell(&self, p: Vec3) -> Option<(usize, Vec3)> {
        let q = (p - self.low) / self.forces.cell;
        let inside = q.cmpge(Vec3::ZERO).all() && q.cmplt((self.nodes - 1).as_vec3()).all();
        let c = q.as_uvec3();
        let (row, slice) = self.strides();
        inside.then(|| (c.z as usize * slice + c.y as usize * row + c.x as usize, q - c.as_vec3()))
    }
}

/// The length of hair that each point of a strand stands for: half of the segments that meet there (cm).
fn masses(strand: &[Vec3]) -> Vec<f32> {
    let mut masses = vec![0.0; strand.len()];
    for (i, w) in strand.windows(2).enumerate() {
        let half = 0.5 * w[0].distance(w[1]);
        masses[i] += half;
        masses[i + 1] += half;
    }
    masses
}
