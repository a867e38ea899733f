//! A surface with filled folds, so that hair slides over an ear and is not caught behind it.

use std::sync::OnceLock;

use glam::{UVec3, Vec3};
use rayon::prelude::*;

use super::{COARSE, EDGE, FINE, Samples, SkinDistance};
use crate::Mesh;

/// Depth inside and height outside the filled surface that are sampled finely (cm). At four times the step, a distance
/// of 4 cm would be too large by a twentieth where the surface bends around a ball of 2 cm.
const FINE_WITHIN: std::ops::RangeInclusive<f32> = -1.0..=4.0;

/// Sweeps in all eight directions; the second only corrects what came around a corner.
const ROUNDS: usize = 2;

impl SkinDistance {
    /// The same surface with the folds filled that a ball of this radius does not reach (its closing by the ball),
    /// sampled with steps of `spacing` in the same box. It never lies inside the original surface. Where that is
    /// convex, it lies up to 40 % of a step outside.
    ///
    /// The distance to the points that the ball's centre can reach solves the eikonal equation, which is swept over the
    /// samples (H. Zhao, "A fast sweeping method for eikonal equations", 2005).
    pub fn filled(&self, radius: f32, spacing: f32) -> Self {
        let [low, high] = self.sampled_box();
        let cells = ((high - low) / (FINE as f32 * spacing)).floor().as_uvec3().max(UVec3::ONE);
        let nodes = FINE as u32 * cells + 1;
        let [nx, ny, nz] = nodes.to_array().map(|n| n as usize);
        let distance = |node: usize| {
            let place = [node % nx, node / nx % ny, node / (nx * ny)].map(|index| index as f32);
            // Slightly inside the box, where rounding may put the last samples.
            self.at((low + spacing * Vec3::from(place)).min(high - 1e-3))
        };
        let distances: Vec<f32> = (0..nx * ny * nz).into_par_iter().with_min_len(4096).map(distance).collect();
        // Distance to the places where a centre may be; negative there.
        let mut way: Vec<f32> =
            distances.iter().map(|&d| if d >= radius { radius - d } else { f32::INFINITY }).collect();
        for _ in 0..ROUNDS {
            for direction in 0..8 {
                sweep(&mut way, &distances, radius, spacing, [nx, ny, nz], direction);
            }
        }
        let mut filled: Vec<f32> = distances.iter().zip(&way).map(|(&d, &way)| d.min(radius - way)).collect();
        self.enclose(&mut filled, low, spacing, [nx, ny, nz]);
        Self { tree: OnceLock::new(), mesh: Mesh::default(), samples: in_two_steps(&filled, low, spacing, cells) }
    }

    /// Lowers samples so that interpolated values never lie inside this surface: by what interpolation cuts off in the
    /// middle of each cell near the skin, and in the middles of its faces and edges.
    fn enclose(&self, samples: &mut [f32], low: Vec3, step: f32, [nx, ny, nz]: [usize; 3]) {
        let before = &*samples;
        let near = 1.5 * step;
        let corner = |node: usize, c: usize| node + ((c >> 2) * ny + (c >> 1 & 1)) * nx + (c & 1);
        let cut_off = |node: usize| {
            let place = [node % nx, node / nx % ny, node / (nx * ny)];
            if place[0] + 1 == nx || place[1] + 1 == ny || place[2] + 1 == nz {
                return None;
            }
            let values: [f32; 8] = std::array::from_fn(|c| before[corner(node, c)]);
            if values.iter().all(|v| v.abs() > near) {
                return None;
            }
            let mut cut = 0.0_f32;
            for within in 0..27 {
                let t = [within % 3, within / 3 % 3, within / 9].map(|half| 0.5 * half as f32);
                let weight = |c: usize| {
                    (0..3).map(|axis| if c >> axis & 1 == 1 { t[axis] } else { 1.0 - t[axis] }).product::<f32>()
                };
                let read: f32 = (0..8).map(|c| weight(c) * values[c]).sum();
                let p = low + step * (Vec3::from(place.map(|index| index as f32)) + Vec3::from(t));
                cut = cut.max(read - self.at(p));
            }
            Some((node, values.map(|value| value - cut)))
        };
        let nodes = (0..samples.len()).into_par_iter().with_min_len(4096);
        let lowered: Vec<(usize, [f32; 8])> = nodes.filter_map(cut_off).collect();
        for (node, values) in lowered {
            for (c, value) in values.into_iter().enumerate() {
                let sample = &mut samples[corner(node, c)];
                *sample = sample.min(value);
            }
        }
    }
}

/// Samples throughout the box, all of them near the surface and every fourth along each axis elsewhere: few enough to
/// stay in cache.
fn in_two_steps(samples: &[f32], low: Vec3, spacing: f32, cells: UVec3) -> Samples {
    let all = FINE as u32 * cells + 1;
    let sample = |at: UVec3| samples[((at.z * all.y + at.y) * all.x + at.x) as usize];
    let places = |counts: UVec3| {
        let [nx, ny, nz] = counts.to_array();
        (0..nz).flat_map(move |k| (0..ny).flat_map(move |j| (0..nx).map(move |i| UVec3::new(i, j, k))))
    };
    let nodes = cells + 1;
    let coarse = places(nodes).map(|node| sample(FINE as u32 * node)).collect();
    let (mut block_of, mut fine) = (Vec::new(), Vec::new());
    for cell in places(cells) {
        let mut block = [0.0; EDGE * EDGE * EDGE];
        for (value, place) in block.iter_mut().zip(places(UVec3::splat(EDGE as u32))) {
            *value = sample(FINE as u32 * cell + place);
        }
        let near = block.iter().any(|distance| FINE_WITHIN.contains(distance));
        block_of.push(if near { fine.len() as u32 } else { COARSE });
        if near {
            fine.push(block);
        }
    }
    Samples { low, cell: FINE as f32 * spacing, nodes, mirrored: false, coarse, block_of, fine }
}

/// One sweep through all nodes. Bits 0, 1 and 2 of `direction` reverse the axes.
fn sweep(way: &mut [f32], distances: &[f32], radius: f32, step: f32, counts: [usize; 3], direction: usize) {
    let [nx, ny, nz] = counts;
    let at = |index: usize, count: usize, bit: usize| if direction >> bit & 1 == 0 { index } else { count - 1 - index };
    for k in 0..nz {
        for j in 0..ny {
            for i in 0..nx {
                let (i, j, k) = (at(i, nx, 0), at(j, ny, 1), at(k, nz, 2));
                let node = (k * ny + j) * nx + i;
                if distances[node] >= radius {
                    continue;
                }
                let nearest = |index: usize, count: usize, stride: usize| {
                    let before = if index > 0 { way[node - stride] } else { f32::INFINITY };
                    let after = if index + 1 < count { way[node + stride] } else { f32::INFINITY };
                    before.min(after)
                };
                let around = [nearest(i, nx, 1), nearest(j, ny, nx), nearest(k, nz, nx * ny)];
                way[node] = way[node].min(upwind(around, step));
            }
        }
    }
}

/// The solution of the eikonal equation at a node from its nearest neighbours along each axis (Godunov's scheme).
fn upwind(mut around: [f32; 3], step: f32) -> f32 {
    around.sort_by(f32::total_cmp);
    let [a, b, c] = around;
    let one = a + step;
    if one <= b {
        return one;
    }
    let two = 0.5 * (a + b + (2.0 * step * step - (a - b).powi(2)).max(0.0).sqrt());
    if two <= c {
        return two;
    }
    let (sum, squares) = (a + b + c, a * a + b * b + c * c);
    (sum + (sum * sum - 3.0 * (squares - step * step)).max(0.0).sqrt()) / 3.0
}
