//! Meshing of the bust's field: one vertex a cell of a grid, evened out within the cells, as surface nets have it (Gibson,
//! 1998), and set onto the zero set by Newton steps.
//!
//! The grid's planes stand close together where the face and the ears are and wider elsewhere, which keeps the mesh
//! in one piece. Blocks of it that the skin cannot reach are filled without looking at each node.

use glam::Vec3;
use rayon::prelude::*;

use crate::layout::{self, POSITION, Quantised};

/// Stretches of an axis: from the first number on (cm), the second is the step (cm). The last ends the axis.
pub(crate) type Axis = &'static [(f32, f32)];
const ALONG_X: Axis = &[(-14.0, 0.4), (-4.6, 0.12), (0.4, 0.3), (4.5, 0.2), (6.9, 0.11), (10.5, 0.2), (12.0, 0.0)];
const ALONG_Y: Axis = &[
    (-33.0, 0.5),
    (-20.0, 0.4),
    (-12.4, 0.22),
    // The lips and the line between them.
    (-8.8, 0.14),
    (-7.4, 0.07),
    (-6.7, 0.14),
    // The nostrils.
    (-5.7, 0.1),
    (-4.9, 0.14),
    // The eyes.
    (-1.6, 0.06),
    (0.0, 0.12),
    (1.0, 0.14),
    (2.9, 0.4),
    (12.4, 0.0),
];
/// From the middle outward; the first plane lies as far from the middle as its mirror image.
const ALONG_Z: Axis = &[(0.06, 0.12), (5.1, 0.2), (6.9, 0.12), (9.3, 0.5), (20.6, 0.0)];
/// Times that the vertices are evened out.
const EVENED: usize = 12;
/// Nodes along a block's edge.
const BLOCK: usize = 8;
/// The field may change this many times faster than the distance.
const STEEPNESS: f32 = 2.0;

pub(crate) fn planes(axis: Axis) -> Vec<f32> {
    let mut planes = Vec::new();
    for stretch in axis.windows(2) {
        let length = stretch[1].0 - stretch[0].0;
        let steps = (length / stretch[0].1).round();
        planes.extend((0..steps as usize).map(|i| stretch[0].0 + length * i as f32 / steps));
    }
    planes
}

/// Cuts the bust out of the grid: planes, nodes inside, and a vertex on the skin in each cell that it passes.
pub(crate) fn cut(field: &(impl Fn(Vec3) -> f32 + Sync)) -> Quantised {
    let quantised = |axis| planes(axis).into_iter().map(quantum).collect();
    let planes: [Vec<i32>; 3] = [ALONG_X, ALONG_Y, ALONG_Z].map(quantised);
    let [xs, ys, zs] =
        planes.each_ref().map(|planes| planes.iter().map(|&i| i as f32 * POSITION).collect::<Vec<f32>>());
    let samples = sample(field, &xs, &ys, &zs);
    let inside: Vec<bool> = samples.iter().map(|&value| value < 0.0).collect();
    let counts = [xs.len(), ys.len(), zs.len()];
    let at_border = |at: usize| {
        let [i, j, k] = layout::place(at, counts);
        i == 0 || j == 0 || i + 1 == xs.len() || j + 1 == ys.len() || k + 1 == zs.len()
    };
    assert!(!(0..inside.len()).any(|at| inside[at] && at_border(at)), "the grid ends within the bust");
    let cells = layout::skin_cells(counts, &inside);
    let mut vertices: Vec<Vec3> = cells
        .par_iter()
        .map(|&[i, j, layer]| {
            let corner = |c: usize| {
                let (i, j) = (i + (c & 1), j + (c >> 1 & 1));
                // The innermost layer lies between the first plane and its mirror image.
                let (k, side) =
                    if layer == 0 { (0, if c < 4 { -1.0 } else { 1.0 }) } else { (layer - 1 + (c >> 2), 1.0) };
                (Vec3::new(xs[i], ys[j], side * zs[k]), samples[(k * ys.len() + j) * xs.len() + i])
            };
            onto_skin(field, middle_of_crossings(&std::array::from_fn(corner)))
        })
        .collect();
    let bounds = |cell: [usize; 3]| {
        let [i, j, layer] = cell;
        let (near, far) = if layer == 0 { (0.0, 0.0) } else { (zs[layer - 1], zs[layer]) };
        (Vec3::new(xs[i], ys[j], near), Vec3::new(xs[i + 1], ys[j + 1], far))
    };
    for _ in 0..EVENED {
        vertices =
            evened(&cells, &vertices, counts, &bounds).into_par_iter().map(|place| onto_skin(field, place)).collect();
    }
    let vertices = vertices.into_iter().map(|place| place.to_array().map(quantum)).collect();
    Quantised { planes, inside, vertices, ..Quantised::default() }
}

/// Each vertex halfway toward the mean of those in the cells beside its own, but within that: triangles of like size,
/// whose normals say what the skin's are.
fn evened(
    cells: &[[usize; 3]],
    vertices: &[Vec3],
    counts: [usize; 3],
    bounds: &(impl Fn([usize; 3]) -> (Vec3, Vec3) + Sync),
) -> Vec<Vec3> {
    let [nx, ny, nz] = counts;
    let mut vertex_in = vec![u32::MAX; nx * ny * nz];
    let index = |[i, j, layer]: [usize; 3]| (layer * ny + j) * nx + i;
    for (vertex, &cell) in cells.iter().enumerate() {
        vertex_in[index(cell)] = vertex as u32;
    }
    let beside = |cell: [usize; 3], axis: usize, forward: bool| {
        let mut other = cell;
        let mut side = Vec3::ONE;
        match (forward, cell[axis]) {
            (true, at) => other[axis] = at + 1,
            // Across the middle lies the mirror image of the layer above it.
            (false, 0) if axis == 2 => {
                other[axis] = 1;
                side.z = -1.0;
            }
            (false, at) => other[axis] = at.checked_sub(1)?,
        }
        let found = *vertex_in.get(index(other))?;
        (found != u32::MAX).then(|| side * vertices[found as usize])
    };
    cells
        .par_iter()
        .zip(vertices)
        .map(|(&cell, &place)| {
            let around = (0..3).flat_map(|axis| [(axis, false), (axis, true)]);
            let (mut sum, mut count) = (Vec3::ZERO, 0.0);
            for place in around.filter_map(|(axis, forward)| beside(cell, axis, forward)) {
                sum += place;
                count += 1.0;
            }
            let (low, high) = bounds(cell);
            place.lerp(sum / count, 0.5).clamp(low, high)
        })
        .collect()
}

fn quantum(cm: f32) -> i32 {
    (cm / POSITION).round() as i32
}

/// The mean of the places where the edges of a cell, from its eight corners with the field there, pass the skin.
pub(crate) fn middle_of_crossings(corners: &[(Vec3, f32); 8]) -> Vec3 {
    let (mut sum, mut count) = (Vec3::ZERO, 0.0);
    for from in 0..8 {
        for to in [1, 2, 4].map(|axis| from | axis).into_iter().filter(|&to| to != from) {
            let ((p, a), (q, b)) = (corners[from], corners[to]);
            if (a < 0.0) != (b < 0.0) {
                sum += p.lerp(q, a / (a - b));
                count += 1.0;
            }
        }
    }
    sum / count
}

/// The field at every node, x fastest; where a block is out of the skin's reach, its middle stands for all of it.
pub(crate) fn sample(field: &(impl Fn(Vec3) -> f32 + Sync), xs: &[f32], ys: &[f32], zs: &[f32]) -> Vec<f32> {
    let (nx, ny) = (xs.len(), ys.len());
    let mut samples = vec![0.0_f32; nx * ny * zs.len()];
    samples.par_chunks_mut(nx * ny * BLOCK).enumerate().for_each(|(slab, samples)| {
        let ks = slab * BLOCK..(slab * BLOCK + BLOCK).min(zs.len());
        for j0 in (0..ny).step_by(BLOCK) {
            let js = j0..(j0 + BLOCK).min(ny);
            for i0 in (0..nx).step_by(BLOCK) {
                let is = i0..(i0 + BLOCK).min(nx);
                let low = Vec3::new(xs[is.start], ys[js.start], zs[ks.start]);
                let high = Vec3::new(xs[is.end - 1], ys[js.end - 1], zs[ks.end - 1]);
                let middle = field(0.5 * (low + high));
                let out_of_reach = middle.abs() > STEEPNESS * 0.5 * (high - low).length();
                for k in ks.clone() {
                    for j in js.clone() {
                        for i in is.clone() {
                            let value = if out_of_reach { middle } else { field(Vec3::new(xs[i], ys[j], zs[k])) };
                            samples[((k - ks.start) * ny + j) * nx + i] = value;
                        }
                    }
                }
            }
        }
    });
    samples
}

pub(crate) fn onto_skin(field: &impl Fn(Vec3) -> f32, start: Vec3) -> Vec3 {
    let mut p = start;
    for _ in 0..4 {
        let slope = gradient(field, p);
        let step = field(p) * slope / slope.length_squared().max(0.25);
        p -= step.clamp_length_max(0.1);
    }
    p
}

fn gradient(field: &impl Fn(Vec3) -> f32, p: Vec3) -> Vec3 {
    let h = 0.005;
    let along = |e: Vec3| (field(p + e) - field(p - e)) / (2.0 * h);
    Vec3::new(along(Vec3::X * h), along(Vec3::Y * h), along(Vec3::Z * h))
}
