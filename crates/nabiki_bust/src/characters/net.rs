//! A character's field as triangles: surface nets on a grid, then fewer triangles, then all vertices back on the skin.

use std::collections::HashMap;

use glam::Vec3;
use rayon::prelude::*;

use super::fewer;
use crate::grid::{self, Axis};

/// Times that the vertices are evened out after the triangles have become fewer.
const EVENED: usize = 3;

/// Triangles and the vertices that they share (cm).
#[derive(Clone, Debug, Default)]
pub(super) struct Skin {
    pub places: Vec<Vec3>,
    pub triangles: Vec<[u32; 3]>,
}

/// The zero set of `field` in about `wanted` vertices. `care` says how many times as closely as elsewhere the mesh
/// follows it at a place.
pub(super) fn mesh(
    field: &(impl Fn(Vec3) -> f32 + Sync),
    [along_x, along_y, along_z]: [Axis; 3],
    wanted: usize,
    care: &dyn Fn(Vec3) -> f32,
) -> Skin {
    let fine = net(field, &[along_x, along_y, along_z].map(grid::planes));
    let mut skin = fewer::triangles(&fine, wanted, care);
    for _ in 0..EVENED {
        let even = evened(&skin);
        skin.places = even.into_par_iter().map(|p| grid::onto_skin(field, p)).collect();
    }
    skin
}

/// One vertex a cell that the skin passes, and two triangles an edge of the grid that it cuts.
fn net(field: &(impl Fn(Vec3) -> f32 + Sync), [xs, ys, zs]: &[Vec<f32>; 3]) -> Skin {
    let (nx, ny, nz) = (xs.len(), ys.len(), zs.len());
    let samples = grid::sample(field, xs, ys, zs);
    let node = |i: usize, j: usize, k: usize| (k * ny + j) * nx + i;
    let inside = |at: usize| samples[at] < 0.0;
    let mut vertex_of: HashMap<usize, u32> = HashMap::new();
    let mut cells = Vec::new();
    for k in 0..nz - 1 {
        for j in 0..ny - 1 {
            for i in 0..nx - 1 {
                let corner = |c: usize| inside(node(i + (c & 1), j + (c >> 1 & 1), k + (c >> 2)));
                let count = (0..8).filter(|&c| corner(c)).count();
                if count != 0 && count != 8 {
                    vertex_of.insert(node(i, j, k), cells.len() as u32);
                    cells.push([i, j, k]);
                }
            }
        }
    }
    let places = cells
        .par_iter()
        .map(|&[i, j, k]| {
            let corner = |c: usize| {
                let (i, j, k) = (i + (c & 1), j + (c >> 1 & 1), k + (c >> 2));
                (Vec3::new(xs[i], ys[j], zs[k]), samples[node(i, j, k)])
            };
            grid::onto_skin(field, grid::middle_of_crossings(&std::array::from_fn(corner)))
        })
        .collect();
    let mut triangles = Vec::new();
    for k in 1..nz - 1 {
        for j in 1..ny - 1 {
            for i in 1..nx - 1 {
                let at = [i, j, k];
                let from = inside(node(i, j, k));
                for axis in 0..3 {
                    let along = |n: usize| at[n] + usize::from(n == axis);
                    if from == inside(node(along(0), along(1), along(2))) {
                        continue;
                    }
                    // The four cells about the edge, counter-clockwise as seen from its far end.
                    let (b, c) = ((axis + 1) % 3, (axis + 2) % 3);
                    let mut quad = [(1, 1), (0, 1), (0, 0), (1, 0)].map(|(back_b, back_c)| {
                        let mut cell = at;
                        cell[b] -= back_b;
                        cell[c] -= back_c;
                        vertex_of[&node(cell[0], cell[1], cell[2])]
                    });
                    if !from {
                        quad.reverse();
                    }
                    triangles.push([quad[0], quad[1], quad[2]]);
                    triangles.push([quad[0], quad[2], quad[3]]);
                }
            }
        }
    }
    Skin { places, triangles }
}

impl Skin {
    /// The outward normal of each vertex, of unit length.
    pub fn normals(&self) -> Vec<Vec3> {
        let mut normals = vec![Vec3::ZERO; self.places.len()];
        for triangle in &self.triangles {
            let [a, b, c] = triangle.map(|v| self.places[v as usize]);
            for v in triangle {
                normals[*v as usize] += (b - a).cross(c - a);
            }
        }
        normals.into_iter().map(Vec3::normalize_or_zero).collect()
    }
}

/// Each vertex a third of the way toward the mean of those beside it, along the skin.
fn evened(skin: &Skin) -> Vec<Vec3> {
    let mut sums = vec![(Vec3::ZERO, 0.0); skin.places.len()];
    for &[a, b, c] in &skin.triangles {
        for (v, w) in [(a, b), (b, c), (c, a)] {
            let sum = &mut sums[v as usize];
            *sum = (sum.0 + skin.places[w as usize], sum.1 + 1.0);
        }
    }
    let normals = skin.normals();
    let moved = |((&p, (sum, count)), n): ((&Vec3, (Vec3, f32)), Vec3)| {
        let way = (sum / count.max(1.0) - p) / 3.0;
        p + way - n * way.dot(n)
    };
    skin.places.iter().zip(sums).zip(normals).map(moved).collect()
}
