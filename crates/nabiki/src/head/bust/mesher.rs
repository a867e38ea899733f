//! Meshing of the bust's field: surface nets on a grid, then Newton steps onto the zero set.

use fast_surface_nets::ndshape::{RuntimeShape, Shape};
use fast_surface_nets::{SurfaceNetsBuffer, surface_nets};
use glam::Vec3;
use rayon::prelude::*;

use crate::Mesh;

/// The box that holds the bust (cm).
const LOW: Vec3 = Vec3::new(-16.0, -32.5, -21.0);
const HIGH: Vec3 = Vec3::new(13.0, 13.0, 21.0);
/// Grid step (cm).
const STEP: f32 = 0.3;

pub(super) fn mesh(field: &(impl Fn(Vec3) -> f32 + Sync)) -> Mesh {
    let size = ((HIGH - LOW) / STEP).ceil().as_uvec3() + 1;
    let shape = RuntimeShape::<u32, 3>::new(size.to_array());
    let place = |x: f32, y: f32, z: f32| LOW + STEP * Vec3::new(x, y, z);
    let mut samples = vec![0.0_f32; shape.usize()];
    samples.par_chunks_mut(size.x as usize).enumerate().for_each(|(row, samples)| {
        let (j, k) = (row % size.y as usize, row / size.y as usize);
        for (i, sample) in samples.iter_mut().enumerate() {
            *sample = field(place(i as f32, j as f32, k as f32));
        }
    });
    let mut net = SurfaceNetsBuffer::default();
    surface_nets(&samples, &shape, [0; 3], (size - 1).to_array(), &mut net);
    let positions = net
        .positions
        .par_iter()
        .map(|&[x, y, z]| {
            let mut p = place(x, y, z);
            for _ in 0..4 {
                let slope = gradient(field, p);
                let step = field(p) * slope / slope.length_squared().max(1e-6);
                p -= step.clamp_length_max(0.5 * STEP);
            }
            p
        })
        .collect();
    let triangles = net.indices.chunks_exact(3).map(|t| [t[0], t[1], t[2]]).collect();
    Mesh { positions, triangles }
}

fn gradient(field: &impl Fn(Vec3) -> f32, p: Vec3) -> Vec3 {
    let h = 0.01;
    let along = |e: Vec3| (field(p + e) - field(p - e)) / (2.0 * h);
    Vec3::new(along(Vec3::X * h), along(Vec3::Y * h), along(Vec3::Z * h))
}
