//! The hill that hair makes over an ear: hair from above passes over the ear instead of parting about it.
//!
//! Seen from the middle of the head ellipsoid E, with E scaled to a sphere, the hill is the upper envelope of
//! paraboloids that stand on the points of the head's sides: an ear's rim is its crest.

use nabiki::Head;
use nabiki::glam::{DVec3, Vec3};

/// Steps of the samples in azimuth and in height, over the whole sphere and over its middle.
const AROUND: usize = 96;
const UP: usize = 48;
/// Heights sampled (unit sphere): from the jaw to well above an ear.
const LOWEST: f32 = -0.8;
const HIGHEST: f32 = 0.8;
/// Fall of the hill (radii of E) at an angle (rad) from its crest: this times the angle squared.
const FALL: f32 = 0.8;
/// Only what stands this far to the side (unit sphere) is an ear.
const ASIDE: f32 = 0.7;

/// Height of the hills over E, in radii of E.
#[derive(Clone, Debug)]
pub(crate) struct EarHills {
    center: DVec3,
    half_axes: DVec3,
    /// Rows of azimuth, one a height.
    radius: Vec<f32>,
}

impl EarHills {
    /// Finds them on any head.
    pub(crate) fn new(head: &Head) -> Self {
        let (center, half_axes) = (head.ellipsoid.center, head.ellipsoid.half_axes);
        let crests: Vec<(Vec3, f32)> = head
            .mesh
            .positions
            .iter()
            .filter_map(|&p| {
                let q = (p - center) / half_axes;
                let (u, r) = (q.try_normalize()?, q.length());
                (u.z.abs() > ASIDE && u.y.abs() < 0.6 && (1.02..1.6).contains(&r)).then_some((u, r))
            })
            .collect();
        let mut radius = Vec::with_capacity(AROUND * UP);
        for j in 0..UP {
            let y = LOWEST + (HIGHEST - LOWEST) * j as f32 / (UP - 1) as f32;
            for i in 0..AROUND {
                let (sin, cos) = (std::f32::consts::TAU * i as f32 / AROUND as f32).sin_cos();
                let u = Vec3::new(cos, 0.0, sin) * (1.0 - y * y).sqrt() + Vec3::Y * y;
                // The chord squared stands for the angle squared.
                let hill = |&(v, r): &(Vec3, f32)| r - FALL * u.distance_squared(v);
                radius.push(crests.iter().map(hill).fold(0.0, f32::max));
            }
        }
        Self { center: center.as_dvec3(), half_axes: half_axes.as_dvec3(), radius }
    }

    /// About how far `p` is above the hills (cm), negative under one; large where there is none.
    pub(crate) fn above(&self, p: DVec3) -> f64 {
        let offset = p - self.center;
        let q = offset / self.half_axes;
        let r = q.length();
        let Some(u) = q.try_normalize() else { return 0.0 };
        let row = (u.y as f32 - LOWEST) / (HIGHEST - LOWEST) * (UP - 1) as f32;
        if !(0.0..(UP - 1) as f32).contains(&row) {
            return f64::INFINITY;
        }
        let column = (u.z.atan2(u.x) as f32 / std::f32::consts::TAU).rem_euclid(1.0) * AROUND as f32;
        let (i, j) = (column as usize % AROUND, row as usize);
        let (s, t) = (column.fract(), row.fract());
        let at = |i: usize, j: usize| self.radius[j * AROUND + i % AROUND];
        let low = at(i, j) + (at(i + 1, j) - at(i, j)) * s;
        let high = at(i, j + 1) + (at(i + 1, j + 1) - at(i, j + 1)) * s;
        (r - f64::from(low + (high - low) * t)) * offset.length() / r
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_ears_are_under_a_hill_and_the_face_is_not() {
        let head = crate::bust();
        let hills = EarHills::new(&head);
        let ears: Vec<DVec3> =
            head.mesh.positions.iter().filter(|p| p.z.abs() > 8.3 && p.y.abs() < 4.0).map(|p| p.as_dvec3()).collect();
        for side in [-1.0, 1.0] {
            assert!(
                ears.iter().filter(|p| p.z * side > 0.0).count() > 10,
                "an ear stands out of the skull, which is 8 cm to either side"
            );
        }
        for &p in &ears {
            // Between samples a paraboloid sinks by its fall over half of a step along each axis, about 0.8 (0.03^2 + 0.02^2) of 9 cm.
            assert!(hills.above(p) < 0.02, "{p} stands {} cm out of its hill", hills.above(p));
        }
        // It is more than a radian from an ear, whose hill has fallen by 0.8 of 9 cm there.
        for z in [-2.0, 0.0, 2.0] {
            let above = hills.above(DVec3::new(9.0, 0.0, z));
            assert!(above > 1.0, "the face is {above} cm above at z = {z}");
        }
    }
}
