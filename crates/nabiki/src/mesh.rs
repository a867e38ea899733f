//! Triangle meshes of heads and bodies.

mod outward;

use std::collections::HashMap;

use glam::{Vec2, Vec3};

use crate::curves::checked_counts;
use crate::error::Problem;
pub use outward::Orientation;

/// An indexed triangle mesh, counter-clockwise seen from outside (head space, cm, unless said otherwise).
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mesh {
    /// Vertex positions.
    pub positions: Vec<Vec3>,
    /// Indices into `positions`, three for each triangle.
    pub triangles: Vec<[u32; 3]>,
    /// Texture coordinates, one for each of `positions`; `None` where the source has none.
    pub uvs: Option<Vec<Vec2>>,
}

impl Mesh {
    /// Appends polygons, cut into triangles from their first corners. `counts`: corners of each; `corners`: indices
    /// into `positions`, polygon after polygon; `clockwise`: how they run, seen from outside.
    ///
    /// # Errors
    /// Counts that do not fit the corners, a corner past the positions.
    pub fn add_polygons(
        &mut self,
        positions: impl ExactSizeIterator<Item = Vec3>,
        counts: &[i64],
        corners: &[i64],
        clockwise: bool,
    ) -> Result<(), Problem> {
        let (base, own) = (self.positions.len(), positions.len());
        let mut rest = corners;
        for count in checked_counts(counts, corners.len())? {
            let (polygon, after) = rest.split_at(count);
            rest = after;
            let corner = |&c: &i64| match usize::try_from(c) {
                Ok(i) if i < own => Ok((base + i) as u32),
                _ => Err(Problem(format!("corner {c} of {own} vertices"))),
            };
            let polygon = polygon.iter().map(corner).collect::<Result<Vec<u32>, _>>()?;
            self.triangles.extend((2..count).map(|k| {
                let (b, c) = if clockwise { (k, k - 1) } else { (k - 1, k) };
                [polygon[0], polygon[b], polygon[c]]
            }));
        }
        self.positions.extend(positions);
        Ok(())
    }

    /// For each vertex the first one at the very same place: itself, but where a seam doubles vertices.
    pub(crate) fn first_at_place(&self) -> Vec<u32> {
        let mut first_at: HashMap<[u32; 3], u32> = HashMap::with_capacity(self.positions.len());
        // Adding 0 turns -0 into +0, which lies at the same place.
        let place = |p: &Vec3| (*p + 0.0).to_array().map(f32::to_bits);
        self.positions.iter().enumerate().map(|(v, p)| *first_at.entry(place(p)).or_insert(v as u32)).collect()
    }

    /// Unit normals at the vertices: the mean of the adjoining triangles' normals, weighted by area.
    /// A vertex without any gets +y.
    pub fn vertex_normals(&self) -> Vec<Vec3> {
        let mut normals = vec![Vec3::ZERO; self.positions.len()];
        for triangle in &self.triangles {
            let [a, b, c] = triangle.map(|v| self.positions[v as usize]);
            let twice_area = (b - a).cross(c - a);
            for &v in triangle {
                normals[v as usize] += twice_area;
            }
        }
        for n in &mut normals {
            *n = n.try_normalize().unwrap_or(Vec3::Y);
        }
        normals
    }
}
