//! The terms of the free form's step, each against its formula in docs/motion-forms.md, for both twins.

mod common;

use common::{exact, fast, field, gust, hair, run_under, step};
use glam::{DQuat, DVec3, EulerRot, Quat, Vec3};
use nabiki::dynamics::{Dynamics, Form, FrameInput, Stepper, push};
use nabiki::field::Field;
use nabiki::free_form::{FreeForm, FreeMotion};
use nabiki::pseudo_force::PseudoForce;
use nabiki::{Pose, Profile, Strands};

/// Hair whose segments are counted in another length than their own: a centimetre is nothing special.
fn free(form: FreeForm, rest_pose: Pose) -> Dynamics {
    let form = Form::Free(FreeMotion { form, rest_pose, ..Default::default() });
    Dynamics { segment_length: 1.5, pseudo_force: PseudoForce::off(), form, ..gust() }
}

fn calm() -> impl Field {
    field(&[(1000, [0.0; 3])])
}

fn both(strands: &Strands, dynamics: &Dynamics, field: &dyn Field) -> [Box<dyn Stepper>; 2] {
    [Box::new(exact(strands, dynamics, field)), Box::new(fast(strands, dynamics, field))]
}

/// One segment of a strand at rest: its direction, its length, and where it begins as a part of the strand's length.
struct Rest {
    direction: DVec3,
    length: f64,
    begin: f64,
    middle: f64,
}

fn at_rest(strand: &[Vec3]) -> Vec<Rest> {
    let ways: Vec<DVec3> = strand.windows(2).map(|w| w[1].as_dvec3() - w[0].as_dvec3()).collect();
    let total: f64 = ways.iter().map(|way| way.length()).sum();
    let mut end = 0.0;
    let rest = |way: &DVec3| {
        let (length, begin) = (way.length(), end / total);
        end += length;
        Rest { direction: way / length, length, begin, middle: begin + 0.5 * length / total }
    };
    ways.iter().map(rest).collect()
}

fn directions(points: &[DVec3]) -> Vec<DVec3> {
    points.windows(2).map(|w| (w[1] - w[0]).normalize()).collect()
}

fn in_f64(strand: &[Vec3]) -> Vec<DVec3> {
    strand.iter().map(|p| p.as_dvec3()).collect()
}

/// Straight strands of 18 cm that go all ways from one point, cut into so many segments.
fn star(strands: usize, segments: usize, root: Vec3) -> Strands {
    let mut star = Strands::default();
    for strand in hair(strands, 2).iter() {
        let out = (strand[1] - strand[0]).normalize();
        star.push((0..=segments).map(|i| root + 18.0 * i as f32 / segments as f32 * out));
    }
    star
}

/// Where nothing else pulls and the root stays where it is, a segment is turned back by its drag's part of the head's turn, about the
/// axis that the head has for it: with a drag of 1 it stays where it is in the world.
#[test]
fn hair_is_left_behind_by_its_part_of_the_head_s_turn() {
    const FRAMES: u32 = 40;
    let (axis, by) = (Vec3::new(0.48, 0.6, -0.64), 0.02);
    let tilted = Quat::from_euler(EulerRot::YXZ, 0.7, 0.4, -0.2);
    let rotation = |n: u32| tilted * Quat::from_axis_angle(axis, by * n as f32);
    let poses: Vec<Pose> = (0..=FRAMES).map(|n| Pose { position_cm: Vec3::ZERO, rotation: rotation(n) }).collect();
    let strands = star(24, 18, Vec3::ZERO);
    for drag in [0.0.into(), 0.3.into(), 1.0.into(), Profile::RootToTip(vec![0.2, 2.5])] {
        let form = FreeForm {
            stiffness: 0.0.into(),
            hold: 0.0.into(),
            gravity: 0.0,
            drag: drag.clone(),
            ..Default::default()
        };
        for mut stepper in both(&strands, &free(form, poses[0]), &calm()) {
            let moved = run_under(&mut *stepper, &calm(), &poses);
            for (strand, rest) in moved.iter().zip(strands.iter()) {
                for (d, rest) in directions(&in_f64(strand)).into_iter().zip(at_rest(rest)) {
                    let back = -drag.at(rest.middle) * f64::from(by) * f64::from(FRAMES);
                    let expected = DQuat::from_axis_angle(axis.as_dvec3().normalize(), back) * rest.direction;
                    // Points of 18 cm in f32 give the direction of a centimetre to 4e-6; 80 turns of 6e-8 each, and of as
                    // much in the poses, are the rest.
                    assert!((d - expected).length() < 1.5e-5, "drag {drag:?}: {d}, not {expected}");
                }
            }
        }
    }
}

/// Air takes of a speed in the world: a head that goes evenly drags its hair as a wind of F = alpha v / A would that blows the other way.
#[test]
fn still_air_is_a_wind_against_a_head_that_goes_evenly() {
    const FRAMES: u32 = 40;
    let strands = star(24, 18, Vec3::new(0.0, 12.0, 3.0));
    let velocity = DVec3::new(0.045, -0.015, 0.06);
    let poses: Vec<Pose> = (0..=FRAMES)
        .map(|n| Pose { position_cm: (f64::from(n) * velocity).as_vec3(), rotation: Quat::IDENTITY })
        .collect();
    for drag in [1.0_f32, 0.4] {
        // So firm that no strand buckles that points into the wind: roundings would decide to which side.
        let form =
            FreeForm { hold: 400.0.into(), settle: 9.0.into(), drag: drag.into(), gravity: 0.0, ..Default::default() };
        let dynamics = free(form, Pose::STILL);
        // Before frame 0 the head went on as it does then.
        let wind = -2.0 / 9.0 * velocity * f64::from(drag) / push(&dynamics, 18.0);
        let blows = field(&[(FRAMES, wind.as_vec3().to_array())]);
        let carried = run_under(&mut exact(&strands, &dynamics, &calm()), &calm(), &poses);
        let blown = run_under(&mut exact(&strands, &dynamics, &blows), &blows, &[Pose::STILL; FRAMES as usize + 1]);
        let way = |a: &Strands, b: &Strands| {
            a.points().iter().zip(b.points()).map(|(a, b)| a.distance(*b)).fold(0.0, f32::max)
        };
        // A force in f32 is off by 6e-8 of itself, poses of 80 cm by 4e-6, of which the speed is a difference.
        assert!(way(&carried, &strands) > 0.2 && way(&carried, &blown) < 2e-4, "{}", way(&carried, &blown));
    }
}

/// By how much a unit of acceleration that is felt from rest on has moved what nothing else moves after a frame of two steps, each of
/// which takes its part of the speed and goes on with the new one.
fn moved_in_a_frame(air: f64) -> f64 {
    let h = 0.5;
    let (mut way, mut speed) = (0.0, 0.0);
    for _ in 0..2 {
        speed = (speed + h) / (1.0 + h * air);
        way += h * speed;
    }
    way
}

/// From rest nothing pulls but the field: after a frame a single segment has gone A F aside but for what the air takes.
#[test]
fn a_push_from_rest_moves_a_node_by_its_acceleration() {
    let (strands, force) = (star(24, 1, Vec3::Y), DVec3::new(-0.6, 0.2, 0.4));
    let settle = Profile::RootToTip(vec![3.0, 40.0]);
    let form = FreeForm {
        settle: settle.clone(),
        stiffness: 0.0.into(),
        hold: 0.0.into(),
        gravity: 0.0,
        ..Default::default()
    };
    let (dynamics, blows) = (free(form, Pose::STILL), field(&[(9, force.as_vec3().to_array())]));
    let mut reference = exact(&strands, &dynamics, &blows);
    step(&mut reference, &blows);
    let mut simulation = fast(&strands, &dynamics, &blows);
    step(&mut simulation, &blows);
    let fast_points: Vec<DVec3> = in_f64(simulation.strands().points());
    let moves = push(&dynamics, 18.0) * moved_in_a_frame(2.0 / settle.at(0.5));
    // Of a thousandth of a radian the cube is left out; points of 20 cm are rounded to 1e-6 in f32.
    for (points, tolerance) in [(reference.positions(), 1e-8), (&fast_points[..], 2e-6)] {
        for (strand, points) in strands.iter().zip(points.chunks(2)) {
            let rest = in_f64(strand);
            let across = force.reject_from((rest[1] - rest[0]).normalize());
            let off = (points[1] - rest[1]) - moves * across;
            // On a circle.
            let off = off.reject_from(rest[1] - rest[0]);
            assert!(off.length() < tolerance, "{} cm off {}", off.length(), moves * across.length());
        }
    }
}

/// eps_i is that of the segment's own number. All of a strand about the head lies in Gamma where alpha is 1; it is straight, and a force
/// across it makes no tension.
#[test]
fn the_pseudo_force_weakens_the_field_by_the_number_of_the_segment() {
    let mut strands = Strands::default();
    strands.push((0..=6).map(|i| Vec3::new(10.6, 0.0, -4.5 + 1.5 * i as f32)));
    let coefficients = vec![0.05, 0.2, 0.3, 0.5, 0.7, 1.0];
    let form =
        FreeForm { pseudo_force: true, stiffness: 0.0.into(), hold: 0.0.into(), gravity: 0.0, ..FreeForm::default() };
    let mut dynamics = free(form, Pose::STILL);
    dynamics.pseudo_force = PseudoForce { alpha: 1.0, coefficients: coefficients.clone() };
    let blows = field(&[(9, [0.0, 0.02, 0.0])]);
    let mut reference = exact(&strands, &dynamics, &blows);
    step(&mut reference, &blows);
    let moves = 0.02 * push(&dynamics, 9.0) * moved_in_a_frame(2.0 / 20.0);
    for (i, eps) in coefficients.into_iter().enumerate() {
        let moved = reference.positions()[i + 1].y / (moves * f64::from(eps));
        // The strength is given in f32, and turns of a ten-thousandth leave out their cubes.
        assert!((moved - 1.0).abs() < 1e-5, "node {}: {moved} of what it should", i + 1);
    }
}

/// On every segment of hair that has settled, the moments of its joints, of hold and of what supports its weight hold what hangs on its
/// end: field and weight of all nodes from there on, each on half of the two segments beside it. B is EI over the way between two middles. Straight hair is not twisted,
/// and its frames are those that turn least. What supports weight at rest loses its force as the segment turns along it, and where a segment
/// stands up, hold supports it.
#[test]
fn settled_hair_is_in_balance() {
    let (strands, force, gravity) = (star(12, 6, Vec3::new(0.0, 12.0, 0.0)), DVec3::new(-40.0, 10.0, 25.0), 50.0);
    let [stiffness, hold] = [vec![4000.0, 1000.0], vec![20.0, 5.0]].map(Profile::RootToTip);
    let form = FreeForm {
        stiffness: stiffness.clone(),
        hold: hold.clone(),
        settle: 20.0.into(),
        gravity: gravity as f32,
        ..Default::default()
    };
    let (dynamics, blows) = (free(form, Pose::STILL), field(&[(9, force.as_vec3().to_array())]));
    let tilted = Pose { position_cm: Vec3::ZERO, rotation: Quat::from_euler(EulerRot::YXZ, 0.3, 0.5, -0.4) };
    let force = tilted.rotation.as_dquat().inverse() * force;
    let weight = |pose: &Pose| pose.rotation.as_dquat().inverse() * DVec3::new(0.0, -gravity, 0.0);
    let settle = |stepper: &mut dyn Stepper| {
        (1..=1500).for_each(|frame| stepper.step_frame(&FrameInput::new(frame, &[tilted], &blows)));
    };
    let (mut reference, mut simulation) = (exact(&strands, &dynamics, &blows), fast(&strands, &dynamics, &blows));
    settle(&mut reference);
    settle(&mut simulation);
    let fast_points: Vec<DVec3> = in_f64(simulation.strands().points());
    // All in units of A. The rotation of the pose is of length 1 to 1e-7, which moments of thousands show. Points of 30 cm in f32 give the
    // direction of 3 cm to 2e-6, which two joints of up to 10,000 show, and the others of as many roundings as an increment may be off.
    for (points, tolerance) in [(reference.positions(), 2e-3), (&fast_points[..], 0.3)] {
        for (strand, points) in strands.iter().zip(points.chunks(7)) {
            let (rest, d) = (at_rest(strand), directions(points));
            let length: f64 = rest.iter().map(|rest| rest.length).sum();
            let node = |i: usize| 0.5 * (rest[i].length + rest.get(i + 1).map_or(0.0, |rest| rest.length));
            let mut frames = vec![DQuat::IDENTITY];
            let mut moments = Vec::new();
            for (i, of) in rest.iter().enumerate() {
                let carried = frames[i] * of.direction;
                let between = if i == 0 { 0.5 * of.length } else { 0.5 * (rest[i - 1].length + of.length) };
                let bending = 0.375 * length * stiffness.at(of.begin) * f64::from(dynamics.segment_length).powi(2);
                frames.push(DQuat::from_rotation_arc(carried, d[i]) * frames[i]);
                moments.push(bending / between * d[i].cross(carried));
            }
            moments.push(DVec3::ZERO);
            for (i, of) in rest.iter().enumerate() {
                let hangs: DVec3 = (i..6).map(|j| node(j) * (force + weight(&tilted))).sum();
                let held = hold.at(of.middle) + (-weight(&Pose::STILL)).dot(of.direction).max(0.0);
                let held = held * (1.0 - of.middle) * length * of.length * d[i].cross(of.direction);
                let beyond: f64 = (i..6).map(node).sum();
                let support = (-beyond * weight(&Pose::STILL)).reject_from(of.direction);
                let supported = (1.0 - d[i].dot(support.normalize_or_zero()).powi(2)).powi(2) * support;
                let left = moments[i] - moments[i + 1] + held + of.length * d[i].cross(hangs + supported);
                let left = left.reject_from(d[i]);
                assert!(left.length() < tolerance, "segment {i}: {left} of {}", (of.length * hangs).length());
            }
        }
    }
}
