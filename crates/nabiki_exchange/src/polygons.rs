//! Polygons as files store them, cut into the triangles of a mesh.

use glam::{Affine3A, Vec3};
use nabiki::Mesh;

use crate::Problem;
use crate::curves::checked_counts;

/// Appends polygons to `mesh`, cut into triangles from their first corners.
///
/// `positions`: in the polygons' own space, which `to` takes to the mesh's. `counts`: corners of each; `corners`:
/// indices into `positions`, polygon after polygon; `clockwise`: how they run, seen from outside. A `to` that mirrors
/// turns them round.
///
/// # Errors
/// Counts that do not fit the corners, a corner past the positions.
pub fn add_polygons(
    mesh: &mut Mesh,
    positions: &[Vec3],
    counts: &[i64],
    corners: &[i64],
    clockwise: bool,
    to: &Affine3A,
) -> Result<(), Problem> {
    let (base, own) = (mesh.positions.len(), positions.len());
    let turned = clockwise != (to.matrix3.determinant() < 0.0);
    let mut rest = corners;
    for count in checked_counts(counts, corners.len())? {
        let (polygon, after) = rest.split_at(count);
        rest = after;
        let corner = |&c: &i64| match usize::try_from(c) {
            Ok(i) if i < own => Ok((base + i) as u32),
            _ => Err(Problem(format!("corner {c} of {own} vertices"))),
        };
        let polygon = polygon.iter().map(corner).collect::<Result<Vec<u32>, _>>()?;
        mesh.triangles.extend((2..count).map(|k| {
            let (b, c) = if turned { (k, k - 1) } else { (k - 1, k) };
            [polygon[0], polygon[b], polygon[c]]
        }));
    }
    mesh.positions.extend(positions.iter().map(|&p| to.transform_point3(p)));
    Ok(())
}
