//! A capsule: an arm, a finger, a stick.

use glam::{Mat3, Vec3};

use super::{Obstacle, Reading};
use crate::error::{SettingError, check_positive};
use crate::mesh::Mesh;

/// Largest distance at which it returns values (cm): contact keeps hair up to 5 cm away.
const AROUND_CM: f32 = 6.0;

/// All points within `radius` of a segment. Distances are exact everywhere and need no samples.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Capsule {
    ends: [Vec3; 2],
    radius: f32,
}

impl Capsule {
    /// A capsule around the segment between `ends` (its own space, cm), which may coincide. `thing` is its name in
    /// errors.
    ///
    /// # Errors
    /// Ends that are not finite, or a radius that is not above 0.
    pub fn new(ends: [Vec3; 2], radius: f32, thing: &str) -> Result<Self, SettingError> {
        if let Some(end) = ends.iter().find(|end| !end.is_finite()) {
            return Err(SettingError::new(thing, end, "must have finite coordinates"));
        }
        check_positive(&format!("{thing}.radius"), radius)?;
        Ok(Self { ends, radius })
    }

    /// Its surface, closed and facing outward, for pictures.
    pub fn mesh(&self) -> Mesh {
        const AROUND: u32 = 48;
        /// Rings from a pole to the widest one.
        const RINGS: u32 = 12;
        let [a, b] = self.ends;
        let axis = (b - a).normalize_or(Vec3::Y);
        let across = axis.any_orthonormal_vector();
        let other = axis.cross(across);
        let angle = |part: u32, of: u32| std::f32::consts::PI * part as f32 / of as f32;
        // A ball has one widest ring, not two in one place.
        let second = if a == b { RINGS + 1 } else { RINGS };
        let rings = (1..=RINGS).map(|k| (a, k)).chain((second..2 * RINGS).map(|k| (b, k)));
        let mut mesh = Mesh { positions: vec![a - self.radius * axis], ..Mesh::default() };
        for (end, k) in rings {
            let (sin, cos) = angle(k, 2 * RINGS).sin_cos();
            mesh.positions.extend((0..AROUND).map(|j| {
                let (s, c) = angle(2 * j, AROUND).sin_cos();
                end + self.radius * (sin * (c * across + s * other) - cos * axis)
            }));
        }
        let last = mesh.positions.len() as u32;
        mesh.positions.push(b + self.radius * axis);
        let rows = (last - 1) / AROUND;
        let at = |row: u32, j: u32| 1 + row * AROUND + j % AROUND;
        for j in 0..AROUND {
            mesh.triangles.push([0, at(0, j + 1), at(0, j)]);
            for row in 1..rows {
                mesh.triangles.push([at(row - 1, j), at(row - 1, j + 1), at(row, j + 1)]);
                mesh.triangles.push([at(row - 1, j), at(row, j + 1), at(row, j)]);
            }
            mesh.triangles.push([at(rows - 1, j), at(rows - 1, j + 1), last]);
        }
        mesh
    }
}

impl Obstacle for Capsule {
    fn reach(&self) -> [Vec3; 2] {
        let [a, b] = self.ends;
        let around = self.radius + AROUND_CM;
        [a.min(b) - around, a.max(b) + around]
    }

    fn read(&self, p: Vec3, _: u32) -> Option<Reading> {
        let ([low, high], [a, b]) = (self.reach(), self.ends);
        if !(p.cmpge(low) & p.cmple(high)).all() {
            return None;
        }
        let axis = b - a;
        let along = ((p - a).dot(axis) / axis.length_squared().max(f32::MIN_POSITIVE)).clamp(0.0, 1.0);
        let out = p - (a + along * axis);
        let (away, normal) = (out.length(), out.normalize_or(axis.any_orthogonal_vector().normalize_or(Vec3::Y)));
        let outer = |v: Vec3| Mat3::from_cols(v * v.x, v * v.y, v * v.z);
        // Around an end it is a ball, between them a cylinder, which is straight along its axis.
        let straight = if along > 0.0 && along < 1.0 { outer(axis.normalize_or_zero()) } else { Mat3::ZERO };
        let hessian = (Mat3::IDENTITY - outer(normal) - straight) * (1.0 / away.max(1e-3 * self.radius));
        Some(Reading { distance: away - self.radius, gradient: normal, hessian })
    }

    fn identify(&self, hand_on: &mut dyn FnMut(&[f32])) {
        self.ends.iter().for_each(|end| hand_on(&end.to_array()));
        hand_on(&[self.radius]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn capsule() -> Capsule {
        Capsule::new([Vec3::new(-2.0, 1.0, 0.5), Vec3::new(3.0, -1.0, 2.0)], 1.5, "body[0]").unwrap()
    }

    #[test]
    fn gradient_and_hessian_are_those_of_the_distance() {
        let (capsule, step) = (capsule(), 0.02);
        for i in 0..300_u32 {
            let part = |k: u32| 12.0 * (((i * k) % 97) as f32 / 97.0) - 6.0;
            let p = Vec3::new(part(13), part(29), part(71));
            let at = |p: Vec3| capsule.read(p, 0).unwrap();
            let Reading { distance, gradient, hessian } = at(p);
            // Near the axis the curvature is too large for the differences.
            if distance < -1.0 {
                continue;
            }
            for axis in [Vec3::X, Vec3::Y, Vec3::Z] {
                let (ahead, behind) = (at(p + step * axis), at(p - step * axis));
                let slope = (ahead.distance - behind.distance) / (2.0 * step);
                assert!((slope - gradient.dot(axis)).abs() < 2e-3, "{p}: {slope}, {gradient}");
                let turned = (ahead.gradient - behind.gradient) / (2.0 * step);
                // It jumps where ball and cylinder meet.
                let jumps = (at(p + step * axis).hessian - at(p - step * axis).hessian).mul_vec3(axis).length() > 0.05;
                assert!(jumps || turned.distance(hessian * axis) < 5e-3, "{p}: {turned}, {}", hessian * axis);
            }
        }
    }

    /// On the surface, closed, outward: the volume of a mesh inscribed in capsule or ball is a little less than its own.
    #[test]
    fn its_mesh_is_its_surface() {
        let ball = Capsule::new([Vec3::X; 2], 2.0, "body[1]").unwrap();
        for shape in [capsule(), ball] {
            let mesh = shape.mesh();
            let Capsule { ends: [a, b], radius } = shape;
            for &p in &mesh.positions {
                assert!(shape.read(p, 0).unwrap().distance.abs() < 1e-5, "{p}");
            }
            let corners = |t: &[u32; 3]| t.map(|v| mesh.positions[v as usize] - a);
            let volume: f32 = mesh.triangles.iter().map(corners).map(|[p, q, r]| p.dot(q.cross(r)) / 6.0).sum();
            let exact = std::f32::consts::PI * radius * radius * (4.0 / 3.0 * radius + a.distance(b));
            // Each of 48 sides lies inside by 1 - sinc(2 pi / 48), and the rings of a quarter by as much again.
            assert!(volume < exact && volume > 0.99 * exact, "{volume} of {exact}");
            let count = mesh.clone().turn_outward();
            assert_eq!((count.open_edges, count.turned, count.doubled), (0, 0, 0));
        }
    }

    #[test]
    fn it_reaches_as_far_as_contact_and_no_number_is_refused_by_name() {
        let capsule = capsule();
        let [low, high] = capsule.reach();
        assert!(capsule.read(low, 0).is_some() && capsule.read(high, 0).is_some());
        assert!(capsule.read(high + 1e-3, 0).is_none() && capsule.read(low - 1e-3, 7).is_none());
        assert_eq!(capsule.read(Vec3::new(-2.0, 1.0, 0.5), 0).unwrap().distance, -1.5);
        let refused = |ends, radius| Capsule::new(ends, radius, "body[1]").unwrap_err().thing;
        assert_eq!(refused([Vec3::ZERO, Vec3::NAN], 1.0), "body[1]");
        assert_eq!(refused([Vec3::ZERO; 2], 0.0), "body[1].radius");
        let ball = Capsule::new([Vec3::X; 2], 2.0, "body[1]").unwrap();
        assert_eq!(ball.read(Vec3::X * 4.0, 0).map(|at| (at.distance, at.gradient)), Some((1.0, Vec3::X)));
    }
}
