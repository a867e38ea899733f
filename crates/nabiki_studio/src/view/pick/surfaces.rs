//! What is hidden by bodies that are shown and do not keep hair out: nobody needs the distance to them, so their triangles are
//! asked.

use glam::{Affine3A, Vec2, Vec3};
use nabiki::Mesh;
use nabiki_render::View;
use nabiki_render::camera::NEAR;

/// Triangles that may lie before what is seen about a pixel (head space, cm).
#[derive(Debug, Default)]
pub struct Triangles(Vec<[Vec3; 3]>);

impl Triangles {
    /// Adds those of a surface that are seen within so many pixels of one, or reach behind the eye.
    pub fn add(&mut self, mesh: &Mesh, head_from_body: Affine3A, view: &View, pixel: Vec2, within: f32) {
        let corners: Vec<Vec3> = mesh.positions.iter().map(|&p| head_from_body.transform_point3(p)).collect();
        let seen: Vec<Vec3> = corners.iter().map(|&p| view.project(p)).collect();
        for triangle in &mesh.triangles {
            let [a, b, c] = triangle.map(|v| seen[v as usize]);
            let (low, high) = (a.min(b).min(c), a.max(b).max(c));
            let is_near = low.truncate().cmple(pixel + within).all() && high.truncate().cmpge(pixel - within).all();
            if high.z >= NEAR && (is_near || low.z < NEAR) {
                self.0.push(triangle.map(|v| corners[v as usize]));
            }
        }
    }

    /// Whether the way from a place in a unit direction, so many cm long, goes through one, from more than `grazes` cm behind it.
    pub fn hide(&self, place: Vec3, toward: Vec3, length: f32, grazes: f32) -> bool {
        self.0.iter().any(|&[a, b, c]| {
            // Moeller and Trumbore 1997, from either side.
            let (ab, ac) = (b - a, c - a);
            let p = toward.cross(ac);
            let (determinant, from) = (ab.dot(p), place - a);
            if determinant == 0.0 {
                return false;
            }
            let q = from.cross(ab);
            let [u, v, way] = [from.dot(p), toward.dot(q), ac.dot(q)].map(|x| x / determinant);
            let behind = (determinant / ab.cross(ac).length()).abs() * way;
            u >= 0.0 && v >= 0.0 && u + v <= 1.0 && behind > grazes && way < length
        })
    }
}
