//! Triangle meshes of heads and bodies.

mod outward;
#[cfg(test)]
mod tests;
mod two_sided;
mod weights;

use std::collections::HashMap;

use glam::{Vec2, Vec3};

pub use outward::Orientation;
pub use weights::VertexWeights;

/// An indexed triangle mesh, counter-clockwise seen from outside (head space, cm, unless documented otherwise).
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mesh {
    /// Vertex positions.
    pub positions: Vec<Vec3>,
    /// Indices into `positions`, three for each triangle.
    pub triangles: Vec<[u32; 3]>,
    /// Texture coordinates of the corners of each of `triangles`, v upward. `None` if the source lacks any of them.
    /// They are per corner because at a seam the triangles on both sides use different coordinates for the same vertex.
    pub corner_uvs: Option<Vec<[Vec2; 3]>>,
    /// Painted weights and colours of the vertices, by name.
    pub weights: Vec<VertexWeights>,
}

impl Mesh {
    /// Appends a triangle with the texture coordinates of its corners. Without `uvs`, the whole mesh loses its texture
    /// coordinates.
    pub fn push(&mut self, triangle: [u32; 3], uvs: Option<[Vec2; 3]>) {
        if self.triangles.is_empty() {
            self.corner_uvs = uvs.map(|_| Vec::new());
        }
        match (&mut self.corner_uvs, uvs) {
            (Some(all), Some(uvs)) => all.push(uvs),
            _ => self.corner_uvs = None,
        }
        self.triangles.push(triangle);
    }

    /// For each vertex, the index of the first vertex at exactly the same position: itself, except where a seam doubles
    /// vertices.
    pub(crate) fn first_at_place(&self) -> Vec<u32> {
        let mut first_at: HashMap<[u32; 3], u32> = HashMap::with_capacity(self.positions.len());
        // Adding 0 turns -0 into +0, which lies at the same place.
        let place = |p: &Vec3| (*p + 0.0).to_array().map(f32::to_bits);
        self.positions.iter().enumerate().map(|(v, p)| *first_at.entry(place(p)).or_insert(v as u32)).collect()
    }

    /// Unit normals of the vertices. Each is the mean of the adjacent triangle normals, weighted by the sine of the
    /// corner over the lengths of its two edges (N. Max, "Weights for computing vertex normals from facet normals",
    /// 1999). For any mesh of a sphere they are exact. A vertex without a triangle that has an area gets +y.
    pub fn vertex_normals(&self) -> Vec<Vec3> {
        vertex_normals(&self.positions, &self.triangles, |v| v)
    }
}

/// See [`Mesh::vertex_normals`]. `same` gives the vertex whose normal a vertex shares.
pub(crate) fn vertex_normals(positions: &[Vec3], triangles: &[[u32; 3]], same: impl Fn(usize) -> usize) -> Vec<Vec3> {
    let mut normals = vec![Vec3::ZERO; positions.len()];
    for triangle in triangles {
        for corner in 0..3 {
            let [at, next, last] = [0, 1, 2].map(|i| triangle[(corner + i) % 3] as usize);
            let [a, b] = [next, last].map(|v| positions[v] - positions[at]);
            let weighted = (a / a.length_squared()).cross(b / b.length_squared());
            if weighted.is_finite() {
                normals[same(at)] += weighted;
            }
        }
    }
    for n in &mut normals {
        *n = n.try_normalize().unwrap_or(Vec3::Y);
    }
    normals
}
