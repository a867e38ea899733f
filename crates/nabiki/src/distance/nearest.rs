//! The triangle of a mesh nearest to a point.

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
        let mesh = Mesh { positions: points.to_vec(), triangles: triangles.to_vec(), corner_uvs: None };
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

fn bits(corners: [Vec3; 3]) -> [[u32; 3]; 3] {
    corners.map(|corner| corner.to_array().map(f32::to_bits))
}
