//! The terms of the free form's step, each against its formula in docs/motion-forms.md, for both twins.

mod common;

use common::{exact, fast, field, gust, hair, run_under, step, way_of_a_head};
use glam::{DQuat, DVec3, EulerRot, Quat, Vec3};
use nabiki::dynamics::{Dynamics, Form, FrameInput, Stepper, gain};
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

/// Where nothing else pulls, a segment is turned back by 1 - (1 - m/L)^lag of the head's turn, about the axis that the head
/// has for it.
#[test]
fn hair_is_left_behind_by_its_part_of_the_head_s_turn() {
    const FRAMES: u32 = 40;
    let (axis, by) = (Vec3::new(0.48, 0.6, -0.64), 0.02);
    let tilted = Quat::from_euler(EulerRot::YXZ, 0.7, 0.4, -0.2);
    let rotation = |n: u32| tilted * Quat::from_axis_angle(axis, by * n as f32);
    let poses: Vec<Pose> = (0..=FRAMES).map(|n| Pose { position_cm: Vec3::ZERO, rotation: rotation(n) }).collect();
    let strands = hair(24, 18);
    for lag in [0.5, 1.0, 3.0] {
        let form = FreeForm { stiffness: 0.0.into(), hold: 0.0.into(), gravity: 0.0.into(), lag, ..Default::default() };
        for mut stepper in both(&strands, &free(form, poses[0]), &calm()) {
            let moved = run_under(&mut *stepper, &calm(), &poses);
            for (strand, rest) in moved.iter().zip(strands.iter()) {
                for (d, rest) in directions(&in_f64(strand)).into_iter().zip(at_rest(rest)) {
                    let part = 1.0 - (1.0 - rest.middle).powf(f64::from(lag));
                    let back = -part * f64::from(by) * f64::from(FRAMES);
                    let expected = DQuat::from_axis_angle(axis.as_dvec3().normalize(), back) * rest.direction;
                    // Points of 30 cm in f32 give the direction of a centimetre to 7e-6; 40 turns of 6e-8 each, and of as
                    // much in the poses, are the rest.
                    assert!((d - expected).length() < 1.5e-5, "lag {lag}: {d}, not {expected}");
                }
            }
        }
    }
}

/// Weight and what is felt of the head's acceleration, as a force of the world.
#[derive(Debug)]
struct Inertia {
    poses: Vec<Pose>,
    gravity: f64,
    jolt: f64,
    rate: f64,
}

impl Field for Inertia {
    fn at(&self, point: Vec3, frame: u32) -> Vec3 {
        let pose = |n: i64| match n {
            ..0 => self.poses[0].continued_back_from(&self.poses[1]),
            _ => self.poses[n as usize],
        };
        let exact = |n: i64| (pose(n).position_cm.as_dvec3(), pose(n).rotation.as_dquat().normalize());
        let n = i64::from(frame);
        let in_head = exact(n).1.inverse() * (point.as_dvec3() - exact(n).0);
        let place = |n: i64| exact(n).0 + exact(n).1 * in_head;
        let acceleration = (place(n) - 2.0 * place(n - 1) + place(n - 2)) * self.rate * self.rate;
        let weight = DVec3::new(0.0, -self.gravity, 0.0);
        // In balance at rest: the head takes along what holds that up.
        let held = exact(n).1 * (exact(0).1.inverse() * weight);
        (weight - held - acceleration * self.gravity * self.jolt / 981.0).as_vec3()
    }

    fn strongest(&self) -> f32 {
        (5.0 * self.gravity * self.jolt.max(1.0)) as f32
    }
}

/// On a head that goes, turns and tilts: single segments, of which no weight is carried along by others.
#[test]
fn weight_and_acceleration_are_forces_of_the_world() {
    const FRAMES: u32 = 40;
    let mut strands = Strands::default();
    for strand in hair(24, 2).iter() {
        strands.push(strand[..2].iter().copied());
    }
    let poses = way_of_a_head(FRAMES);
    let with = |gravity: f32, jolt: f32| {
        let form =
            FreeForm { stiffness: 0.0.into(), hold: 10.0.into(), gravity: gravity.into(), jolt, ..Default::default() };
        free(form, poses[0])
    };
    let farthest =
        |a: &Strands, b: &Strands| a.points().iter().zip(b.points()).map(|(a, b)| a.distance(*b)).fold(0.0, f32::max);
    let unmoved = run_under(&mut exact(&strands, &with(0.0, 1.0), &calm()), &calm(), &poses);
    for jolt in [0.0, 1.0, 2.5] {
        let rate = with(0.0, jolt).motion.frame_rate;
        let as_field = Inertia { poses: poses.clone(), gravity: 60.0, jolt: jolt.into(), rate };
        let felt = run_under(&mut exact(&strands, &with(60.0, jolt), &calm()), &calm(), &poses);
        let pulled = run_under(&mut exact(&strands, &with(0.0, jolt), &as_field), &as_field, &poses);
        assert!(jolt == 0.0 || farthest(&felt, &unmoved) > 1.0);
        // A force in f32 is off by 6e-8 of itself, points of 30 cm by 2e-6.
        assert!(farthest(&felt, &pulled) < 2e-5, "jolt {jolt}: {}", farthest(&felt, &pulled));
    }
}

/// From rest nothing pulls but the field, so after a frame the tangent of each turn is exp(-2 / settle) c_i |F across r_i|.
#[test]
fn a_push_from_rest_turns_each_segment_by_its_gain_and_its_settling() {
    let (strands, force) = (hair(24, 18), DVec3::new(-60.0, 20.0, 40.0));
    let settle = Profile::RootToTip(vec![3.0, 40.0]);
    let form = FreeForm { settle: settle.clone(), stiffness: 500.0.into(), ..Default::default() };
    let (dynamics, blows) = (free(form, Pose::STILL), field(&[(9, force.as_vec3().to_array())]));
    let d = f64::from(dynamics.segment_length);
    let mut reference = exact(&strands, &dynamics, &blows);
    step(&mut reference, &blows);
    let mut simulation = fast(&strands, &dynamics, &blows);
    step(&mut simulation, &blows);
    let fast_points: Vec<DVec3> = in_f64(simulation.strands().points());
    // Directions of a centimetre between points of 30 cm in f64, and in f32.
    for (points, tolerance) in [(reference.positions(), 1e-13), (&fast_points[..], 1e-5)] {
        for (strand, points) in strands.iter().zip(points.chunks(19)) {
            let rest = at_rest(strand);
            let length: f64 = rest.iter().map(|rest| rest.length).sum();
            for (now, rest) in directions(points).into_iter().zip(rest) {
                let c = gain(&dynamics, rest.middle * length / d + 0.5, length / d);
                let expected = (-2.0 / settle.at(rest.middle)).exp() * c * force.reject_from(rest.direction).length();
                let tangent = rest.direction.cross(now).length() / rest.direction.dot(now);
                assert!((tangent - expected).abs() < tolerance, "{tangent}, not {expected}, at {}", rest.middle);
            }
        }
    }
}

/// eps_i is that of the segment's own number. All of a strand about the head lies in Gamma where alpha is 1.
#[test]
fn the_pseudo_force_weakens_the_field_by_the_number_of_the_segment() {
    let mut strands = Strands::default();
    let angle = 2.0 * (0.75_f32 / 10.0).asin();
    strands.push((0..=6).map(|i| 10.0 * Vec3::new((angle * i as f32).cos(), 0.0, (angle * i as f32).sin())));
    let force = DVec3::new(-30.0, 50.0, 20.0);
    let coefficients = vec![0.05, 0.2, 0.3, 0.5, 0.7, 1.0];
    let mut dynamics = free(FreeForm { pseudo_force: true, ..FreeForm::default() }, Pose::STILL);
    dynamics.motion.inertia_length_floor = 18.0;
    dynamics.pseudo_force = PseudoForce { alpha: 1.0, coefficients: coefficients.clone() };
    let blows = field(&[(9, force.as_vec3().to_array())]);
    let mut reference = exact(&strands, &dynamics, &blows);
    step(&mut reference, &blows);
    let d = directions(reference.positions());
    for (i, rest) in at_rest(strands.strand(0)).into_iter().enumerate() {
        let c = gain(&dynamics, i as f64 + 1.0, 6.0) * f64::from(coefficients[i]);
        let expected = (-2.0_f64 / 20.0).exp() * c * force.reject_from(rest.direction).length();
        let tangent = rest.direction.cross(d[i]).length() / rest.direction.dot(d[i]);
        // The segments are 1.5 cm long to a rounding of points of 10 cm.
        assert!((tangent / expected - 1.0).abs() < 1e-5, "segment {}: {tangent}, not {expected}", i + 1);
    }
}

/// f across d, and d x (M_i - M_(i+1)), add up to nothing on every segment of hair that has settled: K_i is that of the place of
/// its joint, for its length, and the frame of the segment before carries rest shape and the weight that it bore.
#[test]
fn settled_hair_is_in_balance() {
    let (strands, force, gravity) = (hair(12, 6), DVec3::new(-40.0, 10.0, 25.0), 50.0);
    let [stiffness, hold] = [vec![4000.0, 1000.0], vec![20.0, 5.0]].map(Profile::RootToTip);
    let form = FreeForm {
        stiffness: stiffness.clone(),
        hold: hold.clone(),
        settle: 20.0.into(),
        gravity: (gravity as f32).into(),
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
    // The rotation of the pose is of length 1 to 1e-7, which forces of 100 show. Points of 30 cm in f32 give the direction of 3 cm
    // to 2e-6, which two joints of up to 1000 show, and the others of as many roundings as an increment may be off.
    for (points, tolerance) in [(reference.positions(), 5e-5), (&fast_points[..], 2e-2)] {
        for (strand, points) in strands.iter().zip(points.chunks(7)) {
            let (rest, d) = (at_rest(strand), directions(points));
            let mut frames = vec![DQuat::IDENTITY];
            let mut moments = Vec::new();
            for (i, rest_i) in rest.iter().enumerate() {
                let carried = frames[i] * rest_i.direction;
                let between = if i == 0 { rest_i.length } else { 0.5 * (rest[i - 1].length + rest_i.length) };
                let k = stiffness.at(rest_i.begin) * (f64::from(dynamics.segment_length) / between).powi(2);
                moments.push(k * carried.cross(d[i]));
                frames.push(DQuat::from_rotation_arc(carried, d[i]) * frames[i]);
            }
            moments.push(DVec3::ZERO);
            for (i, rest) in rest.iter().enumerate() {
                let of_weight = weight(&tilted) - frames[i] * weight(&Pose::STILL);
                let f = force + of_weight + hold.at(rest.middle) * (rest.direction - d[i]);
                let left = f.reject_from(d[i]) + d[i].cross(moments[i] - moments[i + 1]);
                assert!(left.length() < tolerance, "segment {i}: {left} of {}", f.length());
            }
        }
    }
}
