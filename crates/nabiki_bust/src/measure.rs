//! The signed distance to the bust on the grid that the head samples it on.

use glam::Vec3;
use nabiki::{Ellipsoid, Head, Mesh};
use rayon::prelude::*;

use crate::layout::{self, CELL, COARSE_DISTANCE, DISTANCE, FINE, Quantised};

/// Air about the bust in which the distance is sampled (cm): most of what hair is blown to.
const MARGIN: f32 = 6.5;
/// Any that the mesh's distance can be asked with; it is not part of what is measured.
const ELLIPSOID: Ellipsoid = Ellipsoid { center: Vec3::ZERO, half_axes: Vec3::splat(9.0) };
/// Coarse cells farther from the skin than this many fine steps have no fine samples.
const NEAR: f32 = 2.0;

/// Measures the distance to `mesh`, both halves of the bust, into the numbers of `bust`.
pub(crate) fn distance(bust: &mut Quantised, mesh: Mesh) {
    let low = mesh.positions.iter().copied().fold(Vec3::INFINITY, Vec3::min) - MARGIN;
    let high = mesh.positions.iter().copied().fold(Vec3::NEG_INFINITY, Vec3::max) + MARGIN;
    let low_cell = (low / CELL).floor();
    let cells = ((high / CELL).ceil() - low_cell.with_z(0.0)).as_ivec3();
    (bust.low, bust.cells) = ([low_cell.x as i32, low_cell.y as i32], cells.to_array());
    let corner = CELL * low_cell.with_z(0.0);
    let head = Head::from_mesh(mesh, Some(ELLIPSOID)).expect("the bust is a head");
    let exact = |counts: [usize; 3], at: usize, step: f32| {
        head.exact_distance(corner + step * Vec3::from_array(layout::place(at, counts).map(|i| i as f32)))
    };
    let whole = |distance: f32, unit: f32| (distance / unit).round() as i32;

    let cells = bust.cells.map(|cells| cells as usize);
    let (nodes, fine_nodes) = (cells.map(|cells| cells + 1), cells.map(|cells| cells * FINE + 1));
    bust.coarse = (0..nodes.iter().product::<usize>())
        .into_par_iter()
        .map(|at| whole(exact(nodes, at, CELL), COARSE_DISTANCE))
        .collect();
    let step = CELL / FINE as f32;
    let limit = 0.5 * CELL * 3.0_f32.sqrt() + NEAR * step;
    bust.near = (0..cells.iter().product::<usize>())
        .into_par_iter()
        .map(|at| {
            let middle = Vec3::from_array(layout::place(at, cells).map(|i| i as f32 + 0.5));
            head.exact_distance(corner + CELL * middle).abs() < limit
        })
        .collect();
    let mut wanted = vec![false; fine_nodes.iter().product()];
    for cell in (0..bust.near.len()).filter(|&cell| bust.near[cell]) {
        let corner = layout::place(cell, cells);
        for at in 0..(FINE + 1).pow(3) {
            let inner = layout::place(at, [FINE + 1; 3]);
            let [i, j, k] = std::array::from_fn(|axis| corner[axis] * FINE + inner[axis]);
            wanted[(k * fine_nodes[1] + j) * fine_nodes[0] + i] = true;
        }
    }
    bust.fine = wanted
        .into_par_iter()
        .enumerate()
        .map(|(at, wanted)| if wanted { whole(exact(fine_nodes, at, step), DISTANCE) } else { 0 })
        .collect();
}
