//! Both twins among bodies, frame by frame from the same state.
//!
//! Contact decides: whether a node touches, is held by friction, is deep enough to be pushed, in which sample it lies. A decision that
//! lies within a rounding goes one way in f64 and another in f32, and what follows is then another motion, no worse and as far away as
//! hair goes: over many frames the twins cannot be compared. So each frame of the fast twin is stepped once more by the exact one, from the
//! directions and increments that the fast one had. One frame leaves open a few roundings, and of a node that is or is not pushed
//! [`TOLERANCE_CM`]; the decisions that weigh more are rare.

use std::f32::consts::TAU;

use glam::{DVec3, Quat};

use super::*;
use crate::body::{Body, BodyWay, Contact, skin_of};
use crate::dynamics::air::Breeze;
use crate::dynamics::free::{Common, Springs, Strand, TOLERANCE_CM};
use crate::dynamics::row::lane as lane_of;
use crate::dynamics::sweep::Swept as _;
use crate::dynamics::{ForceSpace, Form, Motion};
use crate::field::{Keyframe, KeyframedField};
use crate::free_form::FreeForm;
use crate::pseudo_force::PseudoForce;
use crate::{Mesh, Pose, sketch};

const FRAMES: u32 = 90;
const SEGMENTS: usize = 18;

/// Each segment of 1 cm adds a point's rounding, 1e-6 cm along an axis at up to 32 cm from the origin, and a few of a direction (cm).
const ROUNDINGS_CM: f64 = SEGMENTS as f64 * 1.2e-6;

fn ball(radius: f32) -> Mesh {
    let (rings, sides) = (16_u32, 24_u32);
    let place = |i: u32| {
        let (sin, cos) = (0.5 * TAU * (i / sides) as f32 / rings as f32).sin_cos();
        let (across, ahead) = (TAU * (i % sides) as f32 / sides as f32).sin_cos();
        radius * Vec3::new(sin * ahead, cos, sin * across)
    };
    let at = |i: u32, j: u32| i * sides + j % sides;
    let square =
        |i: u32, j: u32| [[at(i, j), at(i, j + 1), at(i + 1, j)], [at(i, j + 1), at(i + 1, j + 1), at(i + 1, j)]];
    Mesh {
        positions: (0..(rings + 1) * sides).map(place).collect(),
        triangles: (0..rings).flat_map(|i| (0..sides).flat_map(move |j| square(i, j))).collect(),
        ..Mesh::default()
    }
}

#[test]
fn the_twins_agree_in_each_frame_among_bodies_that_hair_slides_along() {
    let head = sketch::head();
    let hair = sketch::hair(&head, 64, SEGMENTS, 1.0);
    let turned = |n: u32| Quat::from_rotation_y(0.3 * (0.1 * n as f32).sin());
    let poses: Vec<Pose> = (0..=FRAMES)
        .map(|n| Pose { position_cm: Vec3::new(0.1 * n as f32, 150.0, 0.0), rotation: turned(n) })
        .collect();
    // It goes round the head through the hair, and turns.
    let ball_poses: Vec<Pose> = (0..=FRAMES)
        .map(|n| {
            let (sin, cos) = (0.07 * n as f32).sin_cos();
            let position_cm = poses[n as usize].position_cm + Vec3::new(12.0 * cos, -2.0, 12.0 * sin);
            Pose { position_cm, rotation: Quat::from_rotation_z(0.05 * n as f32) }
        })
        .collect();
    let (skin, way) = (Arc::new(skin_of(ball(3.5), "body[0].mesh").unwrap()), BodyWay::InWorld(ball_poses.into()));
    let passing = Body::new("body[0]", skin, way, Contact { margin: 0.1, friction: 0.4, static_friction: 0.6 });
    let bodies = vec![Body::head(&head, Contact::default()), passing];
    let form = FreeForm { stiffness: 2000.0.into(), hold: 10.0.into(), gravity: 60.0, ..Default::default() };
    let free = FreeMotion { form, bodies, rest_pose: poses[0], ..Default::default() };
    let alone = FreeMotion { bodies: Vec::new(), ..free.clone() };
    let motion =
        Motion { force_space: ForceSpace::World, inertia_length_floor: 18.0, frames: FRAMES, ..Motion::default() };
    let dynamics = Dynamics {
        motion,
        pseudo_force: PseudoForce::off(),
        form: Form::Free(free.clone()),
        ..Dynamics::new(head.ellipsoid)
    };
    let keys = [(30, [-60.0, -60.0, 20.0]), (60, [80.0, -40.0, -90.0]), (FRAMES, [0.0, -120.0, 60.0])];
    let keys = keys.map(|(through, vector)| Keyframe { through, vector: vector.into() });
    let field = KeyframedField::new(&keys).unwrap();

    let mut fast = Runner::new(&hair, &dynamics, &free, None).unwrap();
    let springs = Springs::default();
    let strand = |s: usize| Strand::<f64>::new(&dynamics, &free, &springs, hair.strand(s), s).unwrap();
    let mut exact: Vec<Strand<f64>> = (0..hair.len()).map(strand).collect();
    let mut page = hair.points().to_vec();
    fast.rewind(VectorWidth::default(), &mut page);
    let (mut of_free, mut of_touching) = (Vec::new(), Vec::new());
    for frame in 1..=FRAMES {
        let input = FrameInput::new(frame, &poses, &field);
        let states = fast.states.clone();
        fast.step(&input, VectorWidth::default(), &mut page);
        let air = Breeze { input: &input, space: ForceSpace::World };
        let [among, without] = [&free, &alone].map(|free| Common::new(&dynamics, free, &input));
        for (s, strand) in exact.iter_mut().enumerate() {
            let block = &fast.packed.blocks()[s / LANES];
            let as_it_was = states[block.rows()].iter().map(|state| {
                let [direction, increment] =
                    [&state.direction, &state.increment].map(|row| Vec3::from(lane_of(row, s % LANES)).as_dvec3());
                let [twist, pressed] = [&state.twist, &state.pressed].map(|row| f64::from(row.0[s % LANES]));
                (direction, increment, twist, pressed)
            });
            strand.stand(as_it_was);
            let mut unhindered = strand.clone();
            strand.step(&among, &air, None);
            unhindered.step(&without, &air, None);
            let apart = |a: &mut dyn Iterator<Item = DVec3>, b: &mut dyn Iterator<Item = DVec3>| {
                a.zip(b).map(|(a, b)| a.distance(b)).fold(0.0, f64::max)
            };
            let places = |strand: &Strand<f64>| strand.positions().iter().map(|p| p.value()).collect::<Vec<_>>();
            let touches = places(strand) != places(&unhindered);
            let of_places =
                apart(&mut places(strand).into_iter(), &mut page[hair.range(s)].iter().map(|p| p.as_dvec3()));
            // What they move by in the next frame, added up from the root.
            let increments =
                fast.states[block.rows()].iter().map(|state| Vec3::from(lane_of(&state.increment, s % LANES)));
            let lengths = hair.strand(s).windows(2).map(|w| w[0].distance(w[1]));
            let mut velocities = std::iter::once(DVec3::ZERO).chain(lengths.zip(increments).scan(
                DVec3::ZERO,
                |velocity, (length, increment)| {
                    *velocity += (length * increment).as_dvec3();
                    Some(*velocity)
                },
            ));
            let apart = of_places.max(apart(&mut strand.velocities(), &mut velocities));
            if touches { &mut of_touching } else { &mut of_free }.push(apart);
        }
    }
    of_free.sort_by(f64::total_cmp);
    of_touching.sort_by(f64::total_cmp);
    let at = |all: &[f64], part: f64| all[((all.len() - 1) as f64 * part) as usize];
    let (worst, most, all) = (at(&of_free, 1.0), at(&of_touching, 0.99), at(&of_touching, 0.999));
    println!("{} and {} touch: {worst:e}, {most:e} {all:e}", of_free.len(), of_touching.len());
    assert!(of_touching.len() > 1000, "{} strands touch in a frame", of_touching.len());
    assert!(worst < ROUNDINGS_CM, "{worst:e} cm where nothing touches");
    assert!(most < ROUNDINGS_CM, "{most:e} cm where bodies are touched");
    // Pushed or not, each node of a strand.
    let pushes = SEGMENTS as f64 * f64::from(TOLERANCE_CM);
    assert!(all < pushes + ROUNDINGS_CM, "{all:e} cm where bodies are touched");
}
