//! Which ends of strands grow on a mesh, in the file's own space.

use glam::Vec3;
use nabiki::{Mesh, Strands};

use crate::size::spread;

/// Number of roots to check whether they are on a mesh.
const JUDGED: usize = 100;

/// Whether roots are on a mesh: half of them are near one of its vertices.
pub(super) fn grow_on(roots: &[Vec3], mesh: &Mesh) -> bool {
    let step = roots.len().div_ceil(JUDGED).max(1);
    let judged: Vec<Vec3> = roots.iter().copied().step_by(step).collect();
    let within = near(roots);
    2 * judged.iter().filter(|root| is_near(**root, mesh, within)).count() >= judged.len()
}

/// The first points of strands, or a sample of the actual roots if many strands have their last point, and not the
/// first, on the mesh.
pub(super) fn likely_roots(strands: &Strands, mesh: &Mesh) -> Vec<Vec3> {
    // A smaller number may touch the skin with their tips, as on a shoulder.
    const MANY: f32 = 0.2;
    let firsts: Vec<Vec3> = strands.iter().map(|strand| strand[0]).collect();
    let within = near(&firsts);
    let judged = strands.iter().step_by(strands.len().div_ceil(JUDGED).max(1));
    let root = |strand: &[Vec3]| {
        let (first, last) = (strand[0], strand[strand.len() - 1]);
        let tip_first = !is_near(first, mesh, within) && is_near(last, mesh, within);
        (if tip_first { last } else { first }, tip_first)
    };
    let (roots, tip_first): (Vec<Vec3>, Vec<bool>) = judged.map(root).unzip();
    let count = tip_first.iter().filter(|&&tip_first| tip_first).count();
    if count as f32 >= MANY * roots.len() as f32 && count > 0 { roots } else { firsts }
}

/// Largest distance from a vertex on a mesh, relative to the spread of the roots: in a coarse mesh, vertices are a
/// tenth of a scalp apart, with roots between them.
fn near(roots: &[Vec3]) -> f32 {
    0.15 * spread(roots)
}

fn is_near(place: Vec3, mesh: &Mesh, within: f32) -> bool {
    mesh.positions.iter().any(|p| p.distance_squared(place) <= within * within)
}
