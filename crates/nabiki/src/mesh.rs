//! Triangle meshes of heads and bodies.

use glam::Vec3;

/// An indexed triangle mesh, counter-clockwise seen from outside (head space, cm, unless said otherwise).
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mesh {
    /// Vertex positions.
    pub positions: Vec<Vec3>,
    /// Indices into `positions`, three for each triangle.
    pub triangles: Vec<[u32; 3]>,
}

impl Mesh {
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
