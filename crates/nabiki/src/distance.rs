//! Signed distance to the skin of any head. Queries near the head read precomputed samples; distant ones are exact.
//!
//! The mesh may be open at the neck and may have holes and overlapping parts. Fans of triangles close its open rims.
//! The distance is that to the nearest triangle (a bounding-volume tree). The sign is that of the winding number, which
//! a stray, doubled or missing triangle changes only slightly. Both are sampled once: coarsely in a box around the
//! head, and four times finer in cells at or near the skin. A query is one trilinear interpolation. Outside the box,
//! queries use the tree.

mod bending;
mod filled;
mod nearest;
pub(crate) mod rims;
mod sample;
mod stored;
mod tree;

use std::sync::OnceLock;

use glam::{UVec3, Vec3};
use rayon::prelude::*;

pub use self::bending::BendingSkin;
pub use self::nearest::Surface;
pub(crate) use self::nearest::{Nearest, weights};
use self::sample::SLICE;
pub(crate) use self::sample::{Places, whole};
pub use self::stored::Samples;
use crate::Mesh;
use tree::Tree;

/// Fine steps along one coarse cell.
const FINE: usize = 4;
/// Fine samples along one edge of a block, both ends included: a coarse cell is four fine steps long.
pub const EDGE: usize = FINE + 1;
/// Largest relative error of a distance far from the skin.
const SLACK: f32 = 0.05;
/// Marks a coarse cell without a block of fine samples.
pub const COARSE: u32 = u32::MAX;

/// Signed distance to a surface, negative inside, in the mesh's unit.
#[derive(Clone, Debug)]
pub struct SkinDistance {
    /// Built on first use; sampled distances do not need it.
    tree: OnceLock<Tree>,
    /// What it is built from.
    mesh: Mesh,
    samples: Samples,
}

impl SkinDistance {
    /// Samples the distance to `mesh` in the box `low..high`, with steps of `spacing` near the skin.
    ///
    /// Every vertex must be finite, at least one triangle must have three distinct corners, and `spacing` must be above
    /// 0.
    pub fn new(mesh: &Mesh, low: Vec3, high: Vec3, spacing: f32) -> Self {
        let tree = Tree::new(&rims::closed(mesh));
        let cell = spacing * FINE as f32;
        let cells = ((high - low) / cell).ceil().as_uvec3().max(UVec3::ONE);
        let nodes = cells + 1;
        let (nx, ny) = (nodes.x as usize, nodes.y as usize);
        let node = |i: usize, j: usize, k: usize| low + cell * Vec3::new(i as f32, j as f32, k as f32);

        let mut coarse = vec![0.0_f32; nx * ny * nodes.z as usize];
        coarse.par_chunks_mut(nx).enumerate().for_each(|(row, samples)| {
            let (j, k) = (row % ny, row / ny);
            let mut nearest = 0;
            samples[0] = tree.signed(node(0, j, k));
            for i in 1..nx {
                samples[i] = tree.signed_beside(node(i, j, k), samples[i - 1], cell, SLACK, &mut nearest);
            }
        });

        let (cx, cy) = (cells.x as usize, cells.y as usize);
        let half_diagonal = 0.5 * cell * 3.0_f32.sqrt();
        // Cells farther from the skin than two fine steps at every point need no block.
        let near: Vec<bool> = (0..cx * cy * cells.z as usize)
            .into_par_iter()
            .map(|c| {
                let (i, j, k) = (c % cx, c / cx % cy, c / (cx * cy));
                let (known, limit) = (coarse[(k * ny + j) * nx + i].abs(), half_diagonal + 2.0 * spacing);
                known <= (limit + half_diagonal) * (1.0 + SLACK)
                    && tree.distance(node(i, j, k) + 0.5 * cell, limit, 0.0, &mut 0) < limit
            })
            .collect();
        let with_block: Vec<usize> = (0..near.len()).filter(|&c| near[c]).collect();
        let mut block_of = vec![COARSE; near.len()];
        for (block, &c) in with_block.iter().enumerate() {
            block_of[c] = block as u32;
        }

        let place = |c: usize, i: usize, j: usize, k: usize| {
            let corner = node(c % cx, c / cx % cy, c / (cx * cy));
            corner + spacing * Vec3::new(i as f32, j as f32, k as f32)
        };
        // The samples of each block; those on its three far faces belong to the next blocks.
        let own: Vec<[f32; FINE * FINE * FINE]> = with_block
            .par_iter()
            .map(|&c| {
                let (i, j, k) = (c % cx, c / cx % cy, c / (cx * cy));
                let (mut block, mut nearest) = ([0.0; FINE * FINE * FINE], 0);
                block[0] = tree.signed_beside(place(c, 0, 0, 0), coarse[(k * ny + j) * nx + i], 0.0, 0.0, &mut nearest);
                for at in 1..block.len() {
                    let (i, j, k) = (at % FINE, at / FINE % FINE, at / (FINE * FINE));
                    let before = if i > 0 {
                        1
                    } else if j > 0 {
                        FINE
                    } else {
                        FINE * FINE
                    };
                    block[at] = tree.signed_beside(place(c, i, j, k), block[at - before], spacing, 0.0, &mut nearest);
                }
                block
            })
            .collect();
        let fine = (with_block.par_iter().zip(&own))
            .map(|(&c, own_of_c)| {
                let corner = UVec3::new((c % cx) as u32, (c / cx % cy) as u32, (c / (cx * cy)) as u32);
                let (mut block, mut nearest) = ([0.0; EDGE * EDGE * EDGE], 0);
                for (at, sample) in block.iter_mut().enumerate() {
                    let (i, j, k) = (at % EDGE, at / EDGE % EDGE, at / (EDGE * EDGE));
                    let inner = |i: usize, j: usize, k: usize| (k * FINE + j) * FINE + i;
                    let beyond = UVec3::new((i / FINE) as u32, (j / FINE) as u32, (k / FINE) as u32);
                    let next = corner + beyond;
                    let next_block = if next.cmplt(cells).all() {
                        block_of[(next.z as usize * cy + next.y as usize) * cx + next.x as usize]
                    } else {
                        COARSE
                    };
                    *sample = if next_block != COARSE {
                        own[next_block as usize][inner(i % FINE, j % FINE, k % FINE)]
                    } else {
                        let last = FINE - 1;
                        let beside = own_of_c[inner(i.min(last), j.min(last), k.min(last))];
                        let away = spacing * beyond.as_vec3().length();
                        tree.signed_beside(place(c, i, j, k), beside, away, 0.0, &mut nearest)
                    };
                }
                block
            })
            .collect();
        let samples = Samples { low, cell, nodes, mirrored: false, coarse, block_of, fine };
        Self { tree: OnceLock::from(tree), mesh: Mesh::default(), samples }
    }

    /// Approximate number of samples that [`new`](Self::new) takes: coarse nodes, and blocks on both sides of the
    /// triangles.
    pub fn count_samples(mesh: &Mesh, low: Vec3, high: Vec3, spacing: f32) -> f64 {
        let cell = f64::from(spacing) * FINE as f64;
        let coarse = ((high - low).as_dvec3() / cell + 2.0).element_product();
        let areas = mesh.triangles.iter().map(|corners| {
            let [a, b, c] = corners.map(|v| mesh.positions[v as usize].as_dvec3());
            0.5 * (b - a).cross(c - a).length()
        });
        // A cell has a block if its middle is within half a diagonal and two steps.
        let layers = 2.0 * (0.5 * 3.0_f64.sqrt() + 2.0 / FINE as f64);
        coarse + layers * areas.sum::<f64>() / (cell * cell) * (EDGE * EDGE * EDGE) as f64
    }

    /// The step between samples near the skin.
    pub fn spacing(&self) -> f32 {
        self.samples.cell / FINE as f32
    }

    /// Signed distance at `p`, computed from the mesh. About 100 times slower than [`at`](Self::at).
    pub fn exact(&self, p: Vec3) -> f32 {
        self.tree().signed(p)
    }

    fn tree(&self) -> &Tree {
        self.tree.get_or_init(|| Tree::new(&rims::closed(&self.mesh)))
    }

    /// Signed distance at `p`. Within two fine steps h of the skin, its error is that of the interpolation: h^2 / 8
    /// times the sum of the curvatures. Farther away it may be up to 5 % too large. Outside the sampled box it is
    /// exact, and about 100 times slower.
    pub fn at(&self, p: Vec3) -> f32 {
        let Samples { low, cell, nodes, mirrored, coarse, block_of, fine } = &self.samples;
        let p = if *mirrored { p.with_z(p.z.abs()) } else { p };
        let q = (p - low) / cell;
        let cells = nodes - 1;
        if !(q.cmpge(Vec3::ZERO).all() && q.cmplt(cells.as_vec3()).all()) {
            return self.exact(p);
        }
        // From here on, rounding toward zero is rounding down. Plain x86-64 has no instruction for rounding down.
        let c = q.as_uvec3();
        let t = q - c.as_vec3();
        let (i, j, k) = (c.x as usize, c.y as usize, c.z as usize);
        let block = block_of[(k * cells.y as usize + j) * cells.x as usize + i];
        if block == COARSE {
            let (nx, ny) = (nodes.x as usize, nodes.y as usize);
            return trilinear(coarse, (k * ny + j) * nx + i, nx, nx * ny, t);
        }
        let t = t * FINE as f32;
        let f = t.as_uvec3().min(UVec3::splat(FINE as u32 - 1));
        let (i, j, k) = (f.x as usize, f.y as usize, f.z as usize);
        trilinear(&fine[block as usize], (k * EDGE + j) * EDGE + i, EDGE, EDGE * EDGE, t - f.as_vec3())
    }

    /// The gradient at `p`, from central differences over one fine step. Its length is 1 up to the error of the
    /// sampling.
    pub fn gradient(&self, p: Vec3) -> Vec3 {
        let h = 0.5 * self.samples.cell / FINE as f32;
        let along = |e: Vec3| self.at(p + e) - self.at(p - e);
        Vec3::new(along(Vec3::X * h), along(Vec3::Y * h), along(Vec3::Z * h)) / (2.0 * h)
    }
}

/// Interpolates between the eight samples of a cell, the first at `at`. `row` and `slice` are the strides.
fn trilinear(samples: &[f32], at: usize, row: usize, slice: usize, t: Vec3) -> f32 {
    let along_x = |i: usize| samples[i] + (samples[i + 1] - samples[i]) * t.x;
    let along_y = |i: usize| {
        let (a, b) = (along_x(i), along_x(i + row));
        a + (b - a) * t.y
    };
    let (a, b) = (along_y(at), along_y(at + slice));
    a + (b - a) * t.z
}

#[cfg(test)]
mod tests;
