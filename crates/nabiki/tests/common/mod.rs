//! Hair and settings for the laws: arcs of equal segments from a spiral of roots on an ellipsoid.
#![allow(dead_code, reason = "each test file uses a part of it")]

use glam::{Vec3, Vec3Swizzles};
use nabiki::dynamics::{Dynamics, Motion, Stepper};
use nabiki::field::{Field, Keyframe};
use nabiki::pseudo_force::PseudoForce;
use nabiki::{Ellipsoid, Strands};

/// Round about y, so that a turned head is the same head.
pub const HEAD: Ellipsoid = Ellipsoid { center: Vec3::ZERO, half_axes: Vec3::new(9.0, 11.0, 9.0) };

pub fn field(vectors: &[(u32, [f32; 3])]) -> Field {
    let keys: Vec<Keyframe> = vectors.iter().map(|&(through, v)| Keyframe { through, vector: v.into() }).collect();
    Field::new(&keys).unwrap()
}

/// Table 1 of the paper.
pub fn gust() -> Dynamics {
    Dynamics {
        motion: Motion::default(),
        segment_length: 1.0,
        pseudo_force: PseudoForce::default(),
        ellipsoid: HEAD,
        shell: 1.25,
        field: field(&[(50, [-100.0, 0.0, 0.0]), (100, [-15.0, -150.0, 0.0])]),
        disturbance: None,
    }
}

/// Strands that leave the head along its normal and bend down, as many of them as wanted; `segments` of 18 cm in all.
pub fn hair(strands: usize, segments: usize) -> Strands {
    let mut hair = Strands::default();
    for s in 0..strands {
        let y = 1.0 - 1.2 * (s as f32 + 0.5) / strands as f32;
        let (sin, cos) = (s as f32 * 2.399_963).sin_cos();
        let out = Vec3::new((1.0 - y * y).sqrt() * sin, y, (1.0 - y * y).sqrt() * cos);
        let fine = 144 / segments;
        let mut p = out * HEAD.half_axes;
        let mut points = vec![p];
        for i in 0..144 {
            let bend = i as f32 / 144.0;
            p += 0.125 * (out * (1.0 - bend) + Vec3::new(0.02, -1.3 * bend, 0.01)).normalize();
            if (i + 1) % fine == 0 {
                points.push(p);
            }
        }
        hair.push(points);
    }
    hair
}

/// Strands of 1 to 30 segments of all lengths, in no order.
pub fn mixed_hair(strands: usize) -> Strands {
    let long = hair(strands, 36);
    let mut mixed = Strands::default();
    for (s, strand) in long.iter().enumerate() {
        mixed.push(strand[..12 + (s * 7) % 20].iter().copied());
    }
    mixed
}

/// (x, y, z) -> (z, y, -x): a quarter turn about y, exact in f32.
pub fn quarter_turn(v: Vec3) -> Vec3 {
    let turned = v.zyx();
    Vec3::new(turned.x, turned.y, -turned.z)
}

pub fn map(strands: &Strands, f: impl Fn(Vec3) -> Vec3) -> Strands {
    let mut mapped = strands.clone();
    mapped.points_mut().iter_mut().for_each(|p| *p = f(*p));
    mapped
}

pub fn run(stepper: &mut dyn Stepper, frames: u32) -> Strands {
    for _ in 0..frames {
        stepper.step_frame();
    }
    assert_eq!(stepper.frame(), frames);
    stepper.strands().clone()
}

pub fn bits(strands: &Strands) -> Vec<[u32; 3]> {
    strands.points().iter().map(|p| p.to_array().map(f32::to_bits)).collect()
}
