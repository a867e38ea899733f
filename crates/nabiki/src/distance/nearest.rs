//! The triangle of a mesh nearest to a point, and where on it that is.

use std::collections::HashMap;

use glam::Vec3;

use super::tree::Tree;
use crate::Mesh;

/// Finds the nearest of some triangles, of which there is at least one.
#[derive(Debug)]
pub(crate) struct Nearest {
    tree: Tree,
    /// The tree reorders triangles, so they are told by the places of their corners.
    numbers: HashMap<[[u32; 3]; 3], u32>,
}

impl Nearest {
    pub fn new(points: &[Vec3], triangles: &[[u32; 3]]) -> Self {
        let mesh = Mesh { positions: points.to_vec(), triangles: triangles.to_vec(), ..Mesh::default() };
        let mut numbers = HashMap::with_capacity(triangles.len());
        for (number, triangle) in triangles.iter().enumerate() {
            // Of triangles in the same place, the first.
            numbers.entry(bits(triangle.map(|v| points[v as usize]))).or_insert(number as u32);
        }
        Self { tree: Tree::new(&mesh), numbers }
    }

    /// The number of the triangle nearest to `p`.
    pub fn triangle(&self, p: Vec3) -> usize {
        self.numbers[&bits(self.tree.nearest(p))] as usize
    }
}

/// A mesh that finds its point nearest to a place.
#[derive(Debug)]
pub struct Surface {
    nearest: Nearest,
    corners: Vec<[Vec3; 3]>,
}

impl Surface {
    /// That of a mesh; `None` if it has no triangle.
    pub fn new(mesh: &Mesh) -> Option<Self> {
        let corners = mesh.triangles.iter().map(|triangle| triangle.map(|v| mesh.positions[v as usize])).collect();
        let nearest = || Nearest::new(&mesh.positions, &mesh.triangles);
        (!mesh.triangles.is_empty()).then(|| Self { nearest: nearest(), corners })
    }

    /// The triangle nearest to `p`, and the weights of its corners at the point nearest to `p`.
    pub fn nearest(&self, p: Vec3) -> (usize, Vec3) {
        let triangle = self.nearest.triangle(p);
        (triangle, weights(self.corners[triangle], p))
    }
}

fn bits(corners: [Vec3; 3]) -> [[u32; 3]; 3] {
    corners.map(|corner| corner.to_array().map(f32::to_bits))
}

/// Weights of the corners at the point of a triangle nearest to `p`; exactly 0 of those that have none.
pub(crate) fn weights([a, b, c]: [Vec3; 3], p: Vec3) -> Vec3 {
    let (ab, ac, ap) = (b - a, c - a, p - a);
    let (d1, d2) = (ab.dot(ap), ac.dot(ap));
    if d1 <= 0.0 && d2 <= 0.0 {
        return Vec3::X;
    }
    let bp = p - b;
    let (d3, d4) = (ab.dot(bp), ac.dot(bp));
    if d3 >= 0.0 && d4 <= d3 {
        return Vec3::Y;
    }
    let cp = p - c;
    let (d5, d6) = (ab.dot(cp), ac.dot(cp));
    if d6 >= 0.0 && d5 <= d6 {
        return Vec3::Z;
    }
    let along_ab = d1 * d4 - d3 * d2;
    if along_ab <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        let part = d1 / (d1 - d3);
        return Vec3::new(1.0 - part, part, 0.0);
    }
    let along_ac = d5 * d2 - d1 * d6;
    if along_ac <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        let part = d2 / (d2 - d6);
        return Vec3::new(1.0 - part, 0.0, part);
    }
    let along_bc = d3 * d6 - d5 * d4;
    if along_bc <= 0.0 && d4 >= d3 && d5 >= d6 {
        let part = (d4 - d3) / ((d4 - d3) + (d5 - d6));
        return Vec3::new(0.0, 1.0 - part, part);
    }
    let sum = along_ab + along_ac + along_bc;
    if sum > 0.0 { Vec3::new(along_bc, along_ac, along_ab) / sum } else { Vec3::X }
}
