//! Signed distance to the skin of any head: exact near and far, read from samples where it is asked for most.
//!
//! The mesh may be open at the neck, have holes and several overlapping parts. Its rims are closed by fans, the
//! distance is that to the nearest triangle (a bounding-volume tree), and the sign comes from the winding number,
//! which a stray, doubled or missing triangle moves by a fraction only. A groom asks millions of times, so both are
//! sampled once: coarsely through a box about the head, and four times finer in the cells that the skin passes
//! through or comes near. A reading is one trilinear interpolation; beyond the box the tree answers.

mod rims;
mod tree;

use glam::{IVec3, UVec3, Vec3};
use rayon::prelude::*;

use crate::Mesh;
use tree::Tree;

/// Fine steps along one coarse cell.
const FINE: usize = 4;
/// Fine samples along one edge of a block, both ends included.
const EDGE: usize = FINE + 1;
/// Marks a coarse cell without a fine block.
const COARSE: u32 = u32::MAX;

/// Signed distance to a surface, negative inside, in the mesh's unit.
#[derive(Clone, Debug)]
pub struct SkinDistance {
    tree: Tree,
    low: Vec3,
    cell: f32,
    nodes: UVec3,
    /// Distance at the coarse nodes, x fastest.
    coarse: Vec<f32>,
    /// For each coarse cell its block in `fine`, or [`COARSE`].
    block_of: Vec<u32>,
    fine: Vec<[f32; EDGE * EDGE * EDGE]>,
}

impl SkinDistance {
    /// Samples the distance to `mesh` through the box `low..high`, with steps of `spacing` near the skin.
    ///
    /// The mesh must have triangles, all of them with finite vertices; `spacing` must be above 0.
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
            tree.signed_row(node(0, j, k), Vec3::X * cell, f32::INFINITY, samples);
        });

        let (cx, cy) = (cells.x as usize, cells.y as usize);
        let half_diagonal = 0.5 * cell * 3.0_f32.sqrt();
        let near: Vec<Option<(Vec3, f32)>> = (0..cx * cy * cells.z as usize)
            .into_par_iter()
            .map(|c| {
                let (i, j, k) = (c % cx, c / cx % cy, c / (cx * cy));
                let corner = (k * ny + j) * nx + i;
                let limit = 2.0 * half_diagonal + 2.0 * spacing;
                if coarse[corner].abs() > limit {
                    return None;
                }
                let from_center = tree.distance(node(i, j, k) + 0.5 * cell, limit);
                (from_center <= half_diagonal + 2.0 * spacing).then(|| (node(i, j, k), from_center + half_diagonal))
            })
            .collect();
        let mut block_of = vec![COARSE; near.len()];
        let mut corners = Vec::new();
        for (slot, found) in block_of.iter_mut().zip(&near) {
            if let Some(found) = found {
                *slot = corners.len() as u32;
                corners.push(*found);
            }
        }
        let fine = corners
            .par_iter()
            .map(|&(corner, limit)| {
                let mut block = [0.0; EDGE * EDGE * EDGE];
                for (row, samples) in block.chunks_mut(EDGE).enumerate() {
                    let start = corner + spacing * Vec3::new(0.0, (row % EDGE) as f32, (row / EDGE) as f32);
                    tree.signed_row(start, Vec3::X * spacing, limit * 1.001 + spacing, samples);
                }
                block
            })
            .collect();
        Self { tree, low, cell, nodes, coarse, block_of, fine }
    }

    /// Signed distance at `p`. Within two fine steps of the skin it is that of the mesh but for the interpolation's
    /// error, h^2 / 8 times the curvature; beyond the sampled box it is exact, and about a hundred times dearer.
    pub fn at(&self, p: Vec3) -> f32 {
        let q = (p - self.low) / self.cell;
        let cells = (self.nodes - 1).as_ivec3();
        let c = q.floor().as_ivec3();
        if !(q.is_finite() && c.cmpge(IVec3::ZERO).all() && c.cmplt(cells).all()) {
            return self.tree.signed(p);
        }
        let (c, t) = (c.as_uvec3(), q - c.as_vec3());
        let (i, j, k) = (c.x as usize, c.y as usize, c.z as usize);
        let block = self.block_of[(k * cells.y as usize + j) * cells.x as usize + i];
        if block == COARSE {
            let (nx, ny) = (self.nodes.x as usize, self.nodes.y as usize);
            return trilinear(&self.coarse, (k * ny + j) * nx + i, nx, nx * ny, t);
        }
        let t = t * FINE as f32;
        let f = t.floor().min(Vec3::splat((FINE - 1) as f32));
        let (i, j, k) = (f.x as usize, f.y as usize, f.z as usize);
        trilinear(&self.fine[block as usize], (k * EDGE + j) * EDGE + i, EDGE, EDGE * EDGE, t - f)
    }

    /// The gradient at `p` by central differences over one fine step: of unit length but for the sampling.
    pub fn gradient(&self, p: Vec3) -> Vec3 {
        let h = 0.5 * self.cell / FINE as f32;
        let along = |e: Vec3| self.at(p + e) - self.at(p - e);
        Vec3::new(along(Vec3::X * h), along(Vec3::Y * h), along(Vec3::Z * h)) / (2.0 * h)
    }
}

/// Interpolates between the eight samples of a cell whose first is `at`; rows and slices lie `row` and `slice` apart.
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
