//! The head and the bodies as one surface.

use glam::{Affine3A, Vec3};
use nabiki::Mesh;

/// Head and bodies, the head first: solid 0.
pub struct Solids {
    /// Corners by their number among the vertices of all.
    pub triangles: Vec<[u32; 3]>,
    /// Vertices and their unit normals, each in the space of its solid, which for the head is head space.
    positions: Vec<Vec3>,
    normals: Vec<Vec3>,
    /// The first vertex of each body.
    bodies: Vec<u32>,
}

impl Solids {
    /// Of these meshes, each in its own space (cm).
    pub fn new<'a>(head: &Mesh, bodies: impl Iterator<Item = &'a Mesh>) -> Self {
        let mut all = Self {
            triangles: head.triangles.clone(),
            positions: head.positions.clone(),
            normals: head.vertex_normals(),
            bodies: Vec::new(),
        };
        for body in bodies {
            let first = all.positions.len() as u32;
            all.bodies.push(first);
            all.triangles.extend(body.triangles.iter().map(|t| t.map(|v| first + v)));
            all.positions.extend(&body.positions);
            all.normals.extend(body.vertex_normals());
        }
        all
    }

    /// The solid that a vertex belongs to.
    pub fn solid_of(&self, vertex: u32) -> u16 {
        self.bodies.partition_point(|&first| first <= vertex) as u16
    }

    /// All vertices in head space, where each body is placed so.
    pub fn positions(&self, places: impl Iterator<Item = Affine3A>) -> Vec<Vec3> {
        self.in_head_space(&self.positions, places, |place, p| place.transform_point3(p))
    }

    /// The unit normals of all vertices in head space.
    pub fn normals(&self, places: impl Iterator<Item = Affine3A>) -> Vec<Vec3> {
        self.in_head_space(&self.normals, places, |place, n| place.transform_vector3(n))
    }

    fn in_head_space(
        &self,
        own: &[Vec3],
        places: impl Iterator<Item = Affine3A>,
        place: impl Fn(&Affine3A, Vec3) -> Vec3,
    ) -> Vec<Vec3> {
        let mut all = own.to_vec();
        for (i, at) in places.enumerate() {
            let end = self.bodies.get(i + 1).map_or(all.len(), |&end| end as usize);
            all[self.bodies[i] as usize..end].iter_mut().for_each(|v| *v = place(&at, *v));
        }
        all
    }
}

/// A body's mesh where it is in head space.
pub fn placed(mesh: &Mesh, place: &Affine3A) -> Mesh {
    let positions = mesh.positions.iter().map(|&p| place.transform_point3(p)).collect();
    Mesh { positions, triangles: mesh.triangles.clone(), ..Mesh::default() }
}
