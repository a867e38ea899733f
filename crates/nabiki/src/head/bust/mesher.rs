//! Meshing of the bust's field: surface nets on a grid, then Newton steps onto the zero set.
//!
//! The grid's planes stand close together where the face and the ears are and wider elsewhere, which keeps the mesh
//! in one piece. Blocks of it that the skin cannot reach are filled without looking at each node.

use fast_surface_nets::ndshape::RuntimeShape;
use fast_surface_nets::{SurfaceNetsBuffer, surface_nets};
use glam::Vec3;
use rayon::prelude::*;

use crate::Mesh;

/// Stretches of an axis: from the first number on (cm), the second is the step (cm). The last ends the axis.
type Axis = &'static [(f32, f32)];
const ALONG_X: Axis = &[(-14.0, 0.4), (-5.0, 0.25), (0.5, 0.35), (4.5, 0.2), (8.0, 0.13), (10.5, 0.2), (12.0, 0.0)];
const ALONG_Y: Axis = &[
    (-33.0, 0.5),
    (-20.0, 0.4),
    (-12.4, 0.22),
    // The lips and the line between them.
    (-8.8, 0.15),
    (-7.9, 0.08),
    (-7.1, 0.14),
    (-6.4, 0.17),
    // The nostrils.
    (-5.9, 0.1),
    (-5.1, 0.2),
    // The line of the lids.
    (-2.2, 0.13),
    (-1.8, 0.08),
    (-0.7, 0.13),
    (0.4, 0.17),
    (2.9, 0.4),
    (12.4, 0.0),
];
/// From the middle outward, on both sides.
const ALONG_Z: Axis = &[(0.09, 0.18), (5.4, 0.26), (10.0, 0.5), (20.6, 0.0)];
/// Nodes along a block's edge.
const BLOCK: usize = 8;
/// The field may change this many times faster than the distance.
const STEEPNESS: f32 = 2.0;

fn planes(axis: Axis) -> Vec<f32> {
    let mut planes = Vec::new();
    for stretch in axis.windows(2) {
        let length = stretch[1].0 - stretch[0].0;
        let steps = (length / stretch[0].1).round();
        planes.extend((0..steps as usize).map(|i| stretch[0].0 + length * i as f32 / steps));
    }
    planes
}

pub(super) fn mesh(field: &(impl Fn(Vec3) -> f32 + Sync)) -> Mesh {
    let (xs, ys, right) = (planes(ALONG_X), planes(ALONG_Y), planes(ALONG_Z));
    let zs: Vec<f32> = right.iter().rev().map(|z| -z).chain(right.iter().copied()).collect();
    let samples = sample(field, &xs, &ys, &zs);
    let shape = RuntimeShape::<u32, 3>::new([xs.len() as u32, ys.len() as u32, zs.len() as u32]);
    let mut net = SurfaceNetsBuffer::default();
    let last = [xs.len() as u32 - 1, ys.len() as u32 - 1, zs.len() as u32 - 1];
    surface_nets(&samples, &shape, [0; 3], last, &mut net);
    let between = |planes: &[f32], at: f32| {
        let i = (at as usize).min(planes.len() - 2);
        planes[i] + (planes[i + 1] - planes[i]) * (at - i as f32)
    };
    let positions = net
        .positions
        .par_iter()
        .map(|&[x, y, z]| onto_skin(field, Vec3::new(between(&xs, x), between(&ys, y), between(&zs, z))))
        .collect();
    let triangles = net.indices.chunks_exact(3).map(|t| [t[0], t[1], t[2]]).collect();
    Mesh { positions, triangles }
}

/// The field at every node, x fastest; where a block is out of the skin's reach, its middle stands for all of it.
fn sample(field: &(impl Fn(Vec3) -> f32 + Sync), xs: &[f32], ys: &[f32], zs: &[f32]) -> Vec<f32> {
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

fn onto_skin(field: &impl Fn(Vec3) -> f32, start: Vec3) -> Vec3 {
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
