//! Where skin is among the cells.

use glam::{IVec3, Vec3};
use nabiki::Mesh;

/// Optical depth of skin, for each full crossing of a cell.
pub(super) const SKIN: f32 = 4.0;

/// A cell that the surface of a head or body passes through.
#[derive(Clone, Copy, PartialEq)]
pub struct SkinCell {
    /// Its place on the lattice through the origin.
    pub cell: IVec3,
    /// Optical depth of the skin in it.
    pub depth: f32,
    /// Mean place and unit normal of the skin (head space, cm).
    pub place: Vec3,
    pub normal: Vec3,
    /// The head's is 0, the bodies' follow.
    pub solid: u16,
}

/// Cells of edge `cell` that a surface passes through.
pub fn skin_cells(mesh: &Mesh, cell: f32, solid: u16) -> Vec<SkinCell> {
    // Of each bit of the surface: its cell, its share of a cell's face, its place and normal times that.
    let mut shares: Vec<([i32; 3], f32, Vec3, Vec3)> = Vec::new();
    for triangle in &mesh.triangles {
        let [a, b, c] = triangle.map(|v| mesh.positions[v as usize]);
        let across = (b - a).cross(c - a);
        let (area, normal) = (0.5 * across.length(), across.normalize_or_zero());
        let longest = a.distance(b).max(b.distance(c)).max(c.distance(a));
        let steps = (2.0 * longest / cell).ceil().clamp(1.0, 64.0) as usize;
        let share = area / (steps * steps) as f32 / (cell * cell);
        for i in 0..steps {
            for j in 0..steps {
                // Points of a lattice on the unit square, folded onto the triangle.
                let (mut u, mut v) = ((i as f32 + 0.5) / steps as f32, (j as f32 + 0.5) / steps as f32);
                if u + v > 1.0 {
                    (u, v) = (1.0 - u, 1.0 - v);
                }
                let p = a + (b - a) * u + (c - a) * v;
                shares.push(((p / cell).floor().as_ivec3().to_array(), share, share * p, share * normal));
            }
        }
    }
    // Stable, so that the shares of a cell are always added in one order.
    shares.sort_by_key(|share| share.0);
    let of_cells = shares.chunk_by(|a, b| a.0 == b.0);
    of_cells
        .map(|of_cell| {
            let marked: f32 = of_cell.iter().map(|share| share.1).sum();
            let place = of_cell.iter().map(|share| share.2).sum::<Vec3>() / marked.max(1e-12);
            let normal = of_cell.iter().map(|share| share.3).sum::<Vec3>().normalize_or_zero();
            SkinCell { cell: IVec3::from(of_cell[0].0), depth: SKIN * marked.min(1.5), place, normal, solid }
        })
        .collect()
}
