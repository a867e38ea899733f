//! Divides polygons from files into the triangles of a mesh.

use glam::{Affine3A, Vec2, Vec3};
use nabiki::Mesh;

use crate::Problem;
use crate::curves::checked_counts;

/// Polygons as stored in a file.
#[derive(Clone, Debug)]
pub struct Polygons<'a> {
    /// Vertices, in the polygons' own space.
    pub positions: &'a [Vec3],
    /// Corners of each polygon.
    pub counts: &'a [i64],
    /// Indices into `positions`, polygon after polygon.
    pub corners: &'a [i64],
    /// Whether they are clockwise, seen from outside.
    pub clockwise: bool,
    /// Texture coordinates, v upward, if there are any.
    pub uvs: Option<Uvs>,
}

/// Texture coordinates, and what they belong to.
#[derive(Clone, Debug)]
pub enum Uvs {
    /// One per position.
    OfVertices(Vec<[f32; 2]>),
    /// One per corner.
    OfCorners(Vec<[f32; 2]>),
}

impl Uvs {
    /// Why they cannot be those of so many positions and corners, if they cannot: their number, or one that is not finite.
    fn misfit(&self, positions: usize, corners: usize) -> Option<String> {
        let (all, what, expected) = match self {
            Self::OfVertices(all) => (all, "vertices", positions),
            Self::OfCorners(all) => (all, "corners", corners),
        };
        if all.len() != expected {
            return Some(format!("{} for {expected} {what}", all.len()));
        }
        let odd = all.iter().position(|uv| !(uv[0].is_finite() && uv[1].is_finite()))?;
        Some(format!("number {odd} is ({}, {}), which is not finite", all[odd][0], all[odd][1]))
    }

    /// Those of each corner.
    fn at_corners(&self, corners: &[i64]) -> Vec<Vec2> {
        match self {
            Self::OfCorners(all) => all.iter().map(|&uv| uv.into()).collect(),
            // A corner past the positions is refused with the polygons.
            Self::OfVertices(all) => corners
                .iter()
                .map(|&c| usize::try_from(c).ok().and_then(|c| all.get(c)).map_or(Vec2::ZERO, |&uv| uv.into()))
                .collect(),
        }
    }
}

/// Appends polygons to `mesh`, divided into triangles from their first corners. `to` is the transform to the mesh's
/// space; if it mirrors, triangles are reversed. If any polygons have no texture coordinates, the mesh has none.
/// Texture coordinates that are not finite, or fit neither positions nor corners, are left out; the result gives the
/// reason.
///
/// # Errors
/// Counts that do not match the corners, or a corner out of range.
pub fn add_polygons(
    mesh: &mut Mesh,
    Polygons { positions, counts, corners, clockwise, uvs }: Polygons<'_>,
    to: &Affine3A,
) -> Result<Option<String>, Problem> {
    let misfit = uvs.as_ref().and_then(|uvs| uvs.misfit(positions.len(), corners.len()));
    let uvs = uvs.filter(|_| misfit.is_none()).map(|uvs| uvs.at_corners(corners));
    let (base, own) = (mesh.positions.len(), positions.len());
    let turned = clockwise != (to.matrix3.determinant() < 0.0);
    let mut first = 0;
    for count in checked_counts(counts, corners.len())? {
        let these = first..first + count;
        first += count;
        let corner = |&c: &i64| match usize::try_from(c) {
            Ok(i) if i < own => Ok((base + i) as u32),
            _ => Err(Problem(format!("a corner names vertex {c}, but there are {own} vertices"))),
        };
        let polygon = corners[these.clone()].iter().map(corner).collect::<Result<Vec<u32>, _>>()?;
        for k in 2..count {
            let triangle = if turned { [0, k, k - 1] } else { [0, k - 1, k] };
            let uvs = uvs.as_ref().map(|uvs| triangle.map(|c| uvs[these.start + c]));
            mesh.push(triangle.map(|c| polygon[c]), uvs);
        }
    }
    mesh.positions.extend(positions.iter().map(|&p| to.transform_point3(p)));
    Ok(misfit)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A square whose corner at (x, y) has (x, y) of the texture, and a mesh that it is added to.
    fn added(mesh: &mut Mesh, clockwise: bool, by_vertex: bool, to: Vec3) -> Result<Option<String>, Problem> {
        let positions = [Vec3::ZERO, Vec3::Y, Vec3::ONE.with_z(0.0), Vec3::X];
        let corners = [2, 3, 0, 1];
        let of_vertices = positions.map(|p| [p.x, p.y]);
        let of_corners = corners.map(|c| of_vertices[c as usize]);
        let uvs =
            Some(if by_vertex { Uvs::OfVertices(of_vertices.to_vec()) } else { Uvs::OfCorners(of_corners.to_vec()) });
        let polygons = Polygons { positions: &positions, counts: &[4], corners: &corners, clockwise, uvs };
        add_polygons(mesh, polygons, &Affine3A::from_scale(to))
    }

    #[test]
    fn corners_keep_their_texture_coordinates_however_they_are_turned() {
        for (clockwise, by_vertex, mirror) in
            (0..8).map(|i| (i & 1 == 1, i & 2 == 2, if i & 4 == 4 { Vec3::new(1.0, 1.0, -1.0) } else { Vec3::ONE }))
        {
            let mut mesh = Mesh::default();
            added(&mut mesh, clockwise, by_vertex, mirror).unwrap();
            added(&mut mesh, clockwise, by_vertex, mirror).unwrap();
            let of = |t: &[u32; 3]| t.map(|v| mesh.positions[v as usize].truncate());
            let expected: Vec<[Vec2; 3]> = mesh.triangles.iter().map(of).collect();
            assert_eq!((mesh.triangles.len(), &mesh.corner_uvs), (4, &Some(expected)));
        }
    }

    #[test]
    fn polygons_of_a_further_object_have_its_vertices() {
        let mut mesh = Mesh::default();
        for (to, corners) in [(Vec3::ZERO, [0, 1, 2]), (10.0 * Vec3::Z, [2, 0, 1])] {
            let polygons = Polygons {
                positions: &[Vec3::ZERO, Vec3::X, Vec3::Y],
                counts: &[3],
                corners: &corners,
                clockwise: false,
                uvs: None,
            };
            add_polygons(&mut mesh, polygons, &Affine3A::from_translation(to)).unwrap();
        }
        let places: Vec<[Vec3; 3]> = mesh.triangles.iter().map(|t| t.map(|v| mesh.positions[v as usize])).collect();
        let far = [Vec3::Y, Vec3::ZERO, Vec3::X].map(|p| p + 10.0 * Vec3::Z);
        assert_eq!(places, [[Vec3::ZERO, Vec3::X, Vec3::Y], far]);
    }

    #[test]
    fn polygons_without_texture_coordinates_leave_none_to_the_whole() {
        let positions = [Vec3::ZERO, Vec3::X, Vec3::Y];
        let bare = Polygons { positions: &positions, counts: &[3], corners: &[0, 1, 2], clockwise: false, uvs: None };
        for bare_first in [true, false] {
            let mut mesh = Mesh::default();
            for is_bare in [bare_first, !bare_first] {
                if is_bare {
                    add_polygons(&mut mesh, bare.clone(), &Affine3A::IDENTITY).unwrap();
                } else {
                    added(&mut mesh, false, true, Vec3::ONE).unwrap();
                }
            }
            assert_eq!((mesh.triangles.len(), mesh.corner_uvs), (3, None));
        }
        for (uvs, why) in [
            (Uvs::OfVertices([[0.0; 2]; 2].to_vec()), "2 for 3 vertices"),
            (Uvs::OfCorners([[0.0; 2]; 4].to_vec()), "4 for 3 corners"),
            (Uvs::OfCorners([[0.0, f32::NAN]; 3].to_vec()), "number 0 is (0, NaN), which is not finite"),
        ] {
            let (mut mesh, wrong) = (Mesh::default(), Polygons { uvs: Some(uvs), ..bare });
            let left_out = add_polygons(&mut mesh, wrong, &Affine3A::IDENTITY).unwrap();
            assert_eq!((left_out.as_deref(), mesh.triangles.len(), mesh.corner_uvs), (Some(why), 1, None));
        }
    }
}
