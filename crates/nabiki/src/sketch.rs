//! A simple head and hair for tests, because growing and the bust are in `nabiki_groom`.

use std::f32::consts::PI;

use glam::{Vec3, vec3};

use crate::distance::{Samples, SkinDistance};
use crate::{Ellipsoid, Head, Mesh, Strands};

/// A ball of `rings` rings with twice as many corners each, stretched to `ellipsoid`.
pub(crate) fn egg(ellipsoid: Ellipsoid, rings: u32) -> Mesh {
    let mut mesh = Mesh::default();
    for i in 0..=rings {
        for j in 0..2 * rings {
            let ((st, ct), (sp, cp)) =
                ((PI * i as f32 / rings as f32).sin_cos(), (PI * j as f32 / rings as f32).sin_cos());
            mesh.positions.push(ellipsoid.center + ellipsoid.half_axes * vec3(st * sp, ct, st * cp));
            let (next, below) = (i * 2 * rings + (j + 1) % (2 * rings), 2 * rings);
            if i < rings {
                let here = i * 2 * rings + j;
                mesh.triangles.push([here, here + below, next + below]);
                mesh.triangles.push([here, next + below, next]);
            }
        }
    }
    mesh
}

/// A skull on shoulders, of a person's size and symmetric: sampled on one side only, as the bust is.
pub(crate) fn head() -> Head {
    let skull = Ellipsoid { center: Vec3::ZERO, half_axes: vec3(9.5, 11.0, 7.8) };
    let mut mesh = egg(skull, 40);
    for (center, half_axes) in
        [(vec3(-1.5, -12.0, 0.0), vec3(5.5, 9.0, 5.5)), (vec3(-2.0, -24.0, 0.0), vec3(9.0, 8.0, 19.0))]
    {
        let (first, part) = (mesh.positions.len() as u32, egg(Ellipsoid { center, half_axes }, 40));
        mesh.positions.extend(part.positions);
        mesh.triangles.extend(part.triangles.iter().map(|t| t.map(|v| v + first)));
    }
    let right = SkinDistance::new(&mesh, vec3(-18.0, -40.0, 0.0), vec3(18.0, 40.0, 26.0), 0.33);
    let samples = Samples { mirrored: true, ..right.samples().clone() };
    Head::from_samples(mesh, skull, samples).expect("a head")
}

/// Strands of this many segments of this length (cm), from a spiral of roots on the skull: they lie on it, and fall
/// beside it.
pub(crate) fn hair(head: &Head, strands: usize, segments: usize, length: f32) -> Strands {
    let mut hair = Strands::default();
    for s in 0..strands {
        let y = 1.0 - 1.2 * (s as f32 + 0.5) / strands as f32;
        let (sin, cos) = (s as f32 * 2.399_963).sin_cos();
        let out = vec3((1.0 - y * y).sqrt() * cos, y, (1.0 - y * y).sqrt() * sin);
        let mut p = head.ellipsoid.center + head.ellipsoid.half_axes * out;
        // Combed away from the crown, one over the other.
        let (normal, away) = (head.outward(p), vec3(out.x, -0.5, out.z));
        let along = (away - normal * away.dot(normal)).normalize();
        let (mut direction, mut points) = ((along + 0.35 * normal).normalize(), vec![p]);
        let gap = 0.1 + 0.6 * (s as f32 * 0.618_034).fract();
        for _ in 0..segments {
            // It bends down, and along the skin where that would lead into it.
            direction = (direction + 0.4 * Vec3::NEG_Y).normalize();
            for _ in 0..4 {
                let end = p + length * direction;
                let lifted = end + (gap - head.distance(end)).max(0.0) * head.outward(end);
                direction = (lifted - p).normalize();
            }
            p += length * direction;
            points.push(p);
        }
        hair.push(points);
    }
    hair
}
