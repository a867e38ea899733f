//! Hair and settings for the laws: arcs of equal segments from a spiral of roots on an ellipsoid.
#![allow(dead_code, reason = "each test file uses a part of it")]

use std::f32::consts::{PI, TAU};
use std::sync::Arc;

use glam::{EulerRot, Quat, Vec3, Vec3Swizzles};
use nabiki::dynamics::{Dynamics, Form, FrameInput, Reference, Simulation, Stepper};
use nabiki::field::{Field, Keyframe, KeyframedField};
use nabiki::free_form::{FreeForm, FreeMotion, NeighbourForces, Neighbours};
use nabiki::pseudo_force::PseudoForce;
use nabiki::{Ellipsoid, Mesh, Pose, Strands};

/// Round about y, so that a turned head is the same head.
pub const HEAD: Ellipsoid = Ellipsoid { center: Vec3::ZERO, half_axes: Vec3::new(9.0, 11.0, 9.0) };

pub fn field(vectors: &[(u32, [f32; 3])]) -> KeyframedField {
    let keys: Vec<Keyframe> = vectors.iter().map(|&(through, v)| Keyframe { through, vector: v.into() }).collect();
    KeyframedField::new(&keys).unwrap()
}

/// Hair of Table 1 in the free form.
pub fn free_motion(motion: FreeMotion) -> Dynamics {
    Dynamics { pseudo_force: PseudoForce::off(), form: Form::Free(motion), ..gust() }
}

/// The same with nothing in the way.
pub fn free(form: FreeForm) -> Dynamics {
    free_motion(FreeMotion { form, ..Default::default() })
}

/// The same among other hair.
pub fn with_neighbours(mut dynamics: Dynamics) -> Dynamics {
    if let Form::Free(free) = &mut dynamics.form {
        free.neighbours = Some(Neighbours::new(NeighbourForces::default(), Arc::new(hair(24, 18))));
    }
    dynamics
}

/// The force of Table 1.
pub fn wind() -> KeyframedField {
    field(&[(50, [-100.0, 0.0, 0.0]), (100, [-15.0, -150.0, 0.0])])
}

/// Table 1 of the paper, but for the force.
pub fn gust() -> Dynamics {
    Dynamics::new(HEAD)
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

/// A force that differs from place to place and from frame to frame, of at most 110.
#[derive(Debug)]
pub struct Whirl;

impl Field for Whirl {
    fn at(&self, p: Vec3, frame: u32) -> Vec3 {
        let phase = 0.2 * p + 0.05 * frame as f32;
        60.0 * Vec3::new(phase.y.sin(), phase.z.sin(), phase.x.sin())
    }

    fn strongest(&self) -> f32 {
        110.0
    }
}

pub fn fast(hair: &Strands, dynamics: &Dynamics, field: &dyn Field) -> Simulation {
    Simulation::new(hair, dynamics, field).unwrap()
}

pub fn exact(hair: &Strands, dynamics: &Dynamics, field: &dyn Field) -> Reference {
    Reference::new(hair, dynamics, field).unwrap()
}

/// A ball of mesh.
pub fn ball(radius: f32) -> Mesh {
    let (rings, sides) = (16_u32, 24_u32);
    let mut mesh = Mesh::default();
    for i in 0..=rings {
        for j in 0..sides {
            let (polar, azimuth) = (PI * i as f32 / rings as f32, TAU * j as f32 / sides as f32);
            let ring = Vec3::new(polar.sin() * azimuth.cos(), polar.cos(), polar.sin() * azimuth.sin());
            mesh.positions.push(radius * ring);
        }
    }
    let at = |i: u32, j: u32| i * sides + j % sides;
    for i in 0..rings {
        for j in 0..sides {
            mesh.triangles.push([at(i, j), at(i, j + 1), at(i + 1, j)]);
            mesh.triangles.push([at(i, j + 1), at(i + 1, j + 1), at(i + 1, j)]);
        }
    }
    mesh
}

/// One frame, of a head that stands still.
pub fn step(stepper: &mut dyn Stepper, field: &dyn Field) {
    let frame = stepper.frame() + 1;
    stepper.step_frame(&FrameInput::new(frame, &[], field));
}

pub fn run(stepper: &mut dyn Stepper, field: &dyn Field, frames: u32) -> Strands {
    for _ in 0..frames {
        step(stepper, field);
    }
    assert_eq!(stepper.frame(), frames);
    stepper.strands().clone()
}

/// Frames 1 .. of a stepper, under a head that goes its way.
pub fn run_under(stepper: &mut dyn Stepper, field: &dyn Field, poses: &[Pose]) -> Strands {
    for frame in 1..poses.len() as u32 {
        stepper.step_frame(&FrameInput::new(frame, poses, field));
    }
    stepper.strands().clone()
}

/// A head that walks, nods and looks about, from a tilted start on.
pub fn way_of_a_head(frames: u32) -> Vec<Pose> {
    (0..=frames)
        .map(|n| {
            let t = 0.05 * n as f32;
            let rotation = Quat::from_euler(EulerRot::YXZ, 0.9 * t.sin(), 0.4 + 0.3 * (2.0 * t).cos(), 0.2 * t);
            Pose { position_cm: Vec3::new(10.0 * t, 160.0 + 3.0 * (3.0 * t).sin(), -4.0 * t), rotation }
        })
        .collect()
}

/// How far the two twins are apart after so many frames under a head that stands still: every node (cm), ascending.
pub fn twins_apart(hair: &Strands, dynamics: &Dynamics, field: &dyn Field, frames: u32) -> Vec<f64> {
    let (mut reference, mut simulation) = (exact(hair, dynamics, field), fast(hair, dynamics, field));
    for frame in 1..=frames {
        let input = FrameInput::new(frame, &[Pose::STILL], field);
        reference.step_frame(&input);
        simulation.step_frame(&input);
    }
    let pairs = reference.positions().iter().zip(simulation.strands().points());
    let mut apart: Vec<f64> = pairs.map(|(a, b)| a.distance(b.as_dvec3())).collect();
    apart.sort_by(f64::total_cmp);
    apart
}

pub fn bits(strands: &Strands) -> Vec<[u32; 3]> {
    strands.points().iter().map(|p| p.to_array().map(f32::to_bits)).collect()
}
