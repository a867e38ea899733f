//! The laws of the free form: what must be true of its motion, for both twins.

mod common;

use std::f64::consts::TAU;
use std::sync::Arc;

use common::{
    ball, bits, exact, fast, field, free, hair, map, mixed_hair, quarter_turn, run, run_under, step, way_of_a_head,
};
use glam::{DVec3, Quat, Vec3};
use nabiki::body::{Body, BodyWay, Contact};
use nabiki::dynamics::{Dynamics, Form, Stepper, push};
use nabiki::field::Field;
use nabiki::free_form::{FreeForm, NeighbourForces, Neighbours, Tie};
use nabiki::{Profile, Strands};
use nabiki_groom::{Growth, Hairline, Style, bust, grow};
use proptest::prelude::*;

/// No field at all.
fn calm() -> impl Field {
    field(&[(1000, [0.0; 3])])
}

fn form(stiffness: f32, hold: f32, settle: f32, gravity: f32) -> FreeForm {
    FreeForm { stiffness: stiffness.into(), hold: hold.into(), settle: settle.into(), gravity, ..Default::default() }
}

/// Strands of one segment of 9 cm, all ways out.
fn single_segments(strands: usize) -> Strands {
    let mut single = Strands::default();
    for strand in hair(strands, 2).iter() {
        single.push(strand[..2].iter().copied());
    }
    single
}

fn both(strands: &Strands, dynamics: &Dynamics, field: &dyn Field) -> [Box<dyn Stepper>; 2] {
    [Box::new(exact(strands, dynamics, field)), Box::new(fast(strands, dynamics, field))]
}

fn directions(strands: &Strands) -> Vec<DVec3> {
    strands.iter().flat_map(|s| s.windows(2).map(|w| (w[1] - w[0]).as_dvec3().normalize())).collect()
}

#[test]
fn hair_at_rest_keeps_its_bits() {
    let carriers = Arc::new(hair(24, 18));
    for strands in [hair(40, 18), mixed_hair(40)] {
        // Strands of 5 cm would swing too fast.
        let mut dynamics = free(form(400.0, 30.0, 20.0, 100.0));
        dynamics.motion.inertia_length_floor = 12.0;
        if let Form::Free(free) = &mut dynamics.form {
            free.form.stiffness = Profile::RootToTip(vec![900.0, 100.0, 200.0]);
            free.bodies = vec![head_body(0.3)];
            free.neighbours = Some(Neighbours::new(NeighbourForces::default(), carriers.clone()));
        }
        for (twin, mut stepper) in both(&strands, &dynamics, &calm()).into_iter().enumerate() {
            let rest = stepper.strands().clone();
            for frame in 1..=50 {
                step(&mut *stepper, &calm());
                let moved = rest.points().iter().zip(stepper.strands().points()).position(|(a, b)| a != b);
                assert_eq!(moved, None, "twin {twin}, frame {frame}");
            }
        }
    }
}

/// A strand that passes a band keeps its bits up to there, under any wind and on a head that turns; from there on it moves,
/// and so does all of a strand that passes farther off, as without a band.
#[test]
fn tied_hair_does_not_move_before_its_band() {
    let strands = hair(40, 18);
    let at = strands.strand(7)[9];
    let near = |strand: &[Vec3]| strand.iter().any(|p| p.distance(at) <= 1.5);
    let tied = strands.iter().filter(|strand| near(strand)).count();
    assert!((1..40).contains(&tied), "{tied} of 40 pass the band");
    let loose = free(form(120.0, 30.0, 20.0, 100.0));
    let mut dynamics = loose.clone();
    if let Form::Free(free) = &mut dynamics.form {
        free.form.tie = Some(Tie { at, within: 1.5 });
    }
    let blows = field(&[(1000, [-60.0, 10.0, 40.0])]);
    let poses = way_of_a_head(30);
    let moved = both(&strands, &dynamics, &blows).map(|mut stepper| run_under(&mut *stepper, &blows, &poses));
    let moved_loose = both(&strands, &loose, &blows).map(|mut stepper| run_under(&mut *stepper, &blows, &poses));
    for (moved, moved_loose) in moved.iter().zip(&moved_loose) {
        for (s, rest) in strands.iter().enumerate() {
            if near(rest) {
                let held =
                    (0..rest.len()).min_by(|&i, &j| rest[i].distance(at).total_cmp(&rest[j].distance(at))).unwrap();
                assert_eq!(rest[..=held], moved.strand(s)[..=held], "strand {s}");
                assert!(held + 1 == rest.len() || rest[held + 1] != moved.strand(s)[held + 1], "strand {s}");
            } else {
                assert_eq!(moved.strand(s), moved_loose.strand(s), "strand {s}");
            }
        }
    }
}

/// Lengths, gains, joints and profiles count from the band. Both are put together in f32 and turn by the same increments but
/// for what rounding of a chain of 18 segments makes of them.
#[test]
fn tied_hair_moves_behind_its_band_as_hair_rooted_there() {
    let mut strands = Strands::default();
    strands.push(hair(40, 18).strand(7).iter().copied());
    let whole = strands.strand(0).to_vec();
    let mut behind = Strands::default();
    behind.push(whole[6..].iter().copied());
    let stiffness = Profile::RootToTip(vec![160.0, 90.0, 120.0]);
    let mut dynamics = free(FreeForm { stiffness, ..form(0.0, 30.0, 20.0, 100.0) });
    let blows = field(&[(1000, [-60.0, 10.0, 40.0])]);
    let run = |dynamics: &Dynamics, strands: &Strands| {
        let mut stepper = exact(strands, dynamics, &blows);
        run(&mut stepper, &blows, 30)
    };
    let alone = run(&dynamics, &behind);
    if let Form::Free(free) = &mut dynamics.form {
        free.form.tie = Some(Tie { at: whole[6], within: 0.1 });
    }
    let tied = run(&dynamics, &strands);
    let moved = behind.strand(0).iter().zip(alone.strand(0)).map(|(a, b)| a.distance(*b)).fold(0.0, f32::max);
    assert!(moved > 1.0, "{moved} cm");
    for (a, b) in tied.strand(0)[6..].iter().zip(alone.strand(0)) {
        assert!(a.distance(*b) < 1e-5, "{a} and {b}");
    }
}

#[test]
fn a_band_out_of_range_is_refused_by_name() {
    for (tie, thing) in [
        (Tie { at: Vec3::new(f32::NAN, 0.0, 0.0), within: 1.0 }, "free.tie.at"),
        (Tie { at: Vec3::ZERO, within: 0.0 }, "free.tie.within"),
    ] {
        let form = FreeForm { tie: Some(tie), ..FreeForm::default() };
        assert_eq!(form.check().unwrap_err().thing, thing);
    }
}

fn head_body(margin: f32) -> Body {
    Body::head(&bust(), Contact { margin, ..Contact::default() })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    /// A segment without another one settles along F + K r + H r, if it weighs nothing. Weight turns it by d x g, and what holds that at rest
    /// by -(r x g), half-way between r and d.
    #[test]
    fn a_segment_settles_where_all_that_pulls_on_it_is_in_balance(
        force in prop::array::uniform3(-150.0_f32..150.0), stiffness in 0.0_f32..16_000.0, hold in 1.0_f32..100.0, gravity in 0.0_f32..50.0,
    ) {
        let strands = single_segments(16);
        let dynamics = free(form(stiffness, hold, 20.0, gravity));
        let blows = field(&[(10_000, force)]);
        let rest = directions(&strands);
        for mut stepper in both(&strands, &dynamics, &blows) {
            let settled = directions(&run(&mut *stepper, &blows, 3000));
            for ((d, r), length) in settled.iter().zip(&rest).zip(strands.lengths()) {
                let weight = f64::from(gravity) * DVec3::NEG_Y;
                // What stands up is held up.
                let springs = joint(stiffness, length) + f64::from(hold) + f64::from(gravity) * r.y.max(0.0);
                let along = Vec3::from(force).as_dvec3() + springs * *r;
                // Near the point where nothing pulls, hair does not know where to go.
                prop_assume!(along.length() > 0.2 * springs + 2.0 * f64::from(gravity));
                prop_assume!(r.dot(along.normalize()) > -0.95);
                let support = -weight.reject_from(*r);
                let supported = (1.0 - d.dot(support.normalize_or_zero()).powi(2)).powi(2) * support;
                let left = d.cross(along + weight + supported);
                // Points of 20 cm in f32 give a direction of 9 cm to 3e-7; e-folds of 20 frames leave nothing else.
                prop_assert!(left.length() < 2e-6 * (along.length() + springs), "{left} is left of {along}");
            }
        }
    }
}

/// A / l, by which a force turns the only segment of a strand of this length: its mass is at its end.
fn gain_of_single(dynamics: &Dynamics, length: f32) -> f64 {
    push(dynamics, length.into()) / f64::from(length)
}

/// The force that the joint of a single segment of this length (cm) is as strong as. B is EI over half the length, 3/8 A l K d^2 / (l / 2),
/// and the force at the end that turns as far B / l, of a mass of l / 2.
fn joint(stiffness: f32, length: f32) -> f64 {
    1.5 * f64::from(stiffness) / f64::from(length).powi(2)
}

/// Angles to the rest direction of a single segment that swings back from a small push.
fn swing(stepper: &mut dyn Stepper, push: &dyn Field, frames: u32) -> Vec<f64> {
    let rest = directions(stepper.strands())[0];
    let side = DVec3::Y.cross(rest).normalize();
    let none = calm();
    (0..frames)
        .map(|n| {
            step(stepper, if n == 0 { push } else { &none });
            directions(stepper.strands())[0].dot(side)
        })
        .collect()
}

/// The step answers turns by 0.4 of those at its end less 0.25 of those at its beginning, and the difference takes of each swing
/// what no settling does.
#[test]
fn small_swings_have_their_period_and_die_to_1_over_e_when_they_should() {
    const AFTER: f64 = 0.4;
    const BEFORE: f64 = 0.25;
    let mut strands = Strands::default();
    strands.push([Vec3::new(0.0, 12.0, 0.0), Vec3::new(9.0, 12.0, 0.0)]);
    for (stiffness, hold) in [(6000.0, 20.0), (0.0, 60.0), (16_000.0, 0.0)] {
        for substeps in [1, 2, 5] {
            let with = |settle: f32| free(FreeForm { substeps: Some(substeps), ..form(stiffness, hold, settle, 0.0) });
            let dynamics = with(0.0);
            let speed = (gain_of_single(&dynamics, 9.0) * (joint(stiffness, 9.0) + f64::from(hold))).sqrt();
            let (period, h) = (TAU / speed, 1.0 / f64::from(substeps));
            // What a frame leaves of a swing: of the two numbers that a step takes to two others, the square root of the determinant.
            let squared = (h * speed).powi(2);
            let dies = |air: f64| 0.5 * ((1.0 + h * air + AFTER * squared) / (1.0 + BEFORE * squared)).ln() / h;
            let push = field(&[(1, [0.0, 0.0, -20.0])]);
            let frames = (5.0 * period) as u32;
            for mut stepper in both(&strands, &dynamics, &push) {
                let angles = swing(&mut *stepper, &push, frames);
                let crossings: Vec<f64> = (angles.windows(2).enumerate())
                    .filter(|(_, w)| w[0] < 0.0 && w[1] >= 0.0)
                    .map(|(n, w)| n as f64 + w[0] / (w[0] - w[1]))
                    .collect();
                let measured = (crossings.last().unwrap() - crossings[0]) / (crossings.len() - 1) as f64;
                // A pendulum's period grows by a sixteenth of the squared amplitude; straight lines between frames cross
                // zero within a sixth of the cube of the phase of a frame; atan, which a step turns by, is a third of that cube less.
                let amplitude = angles.iter().fold(0.0_f64, |a, b| a.max(b.abs()));
                let tolerance =
                    period * amplitude.powi(2) / 8.0 + speed.powi(2) / 3.0 + period * (h * speed).powi(2) / 3.0;
                assert!((measured - period).abs() < tolerance + 0.01, "{measured}, not {period}");
            }
            for settle in [60.0_f32, 100.0] {
                let dynamics = with(settle);
                for mut stepper in both(&strands, &dynamics, &push) {
                    let last = 2 * settle as usize;
                    let angles = swing(&mut *stepper, &push, last as u32 + 2);
                    // Of x_n = c r^n cos(n a + b) this is (c r^n sin a)^2, whatever the phase.
                    let left = |n: usize| angles[n].powi(2) - angles[n - 1] * angles[n + 1];
                    let rate = 0.5 * (left(2) / left(last)).ln() / (last - 2) as f64;
                    // Points of 20 cm in f32 give the direction of 9 cm to 3e-7, and so each of the two products; and of turns of the
                    // largest angle a step leaves out the cube.
                    let low = left(last).sqrt() / speed.sin();
                    let rounded = 2.0 * 2.0 * 3e-7 * low / left(last) / (2 * last) as f64;
                    let high = angles.iter().fold(0.0_f64, |a, b| a.max(b.abs()));
                    let expected = dies(2.0 / f64::from(settle));
                    let tolerance = rounded + dies(0.0) * high * high + 1e-3 * expected;
                    assert!((rate - expected).abs() < tolerance, "{rate}, not {expected}");
                    // The finer the steps, the less does the step take besides.
                    let besides = expected * f64::from(settle) - 1.0;
                    assert!(
                        besides.abs()
                            < 0.5 * (AFTER - BEFORE) * h * speed.powi(2) * f64::from(settle) + h / f64::from(settle),
                        "{besides}"
                    );
                }
            }
        }
    }
}

#[test]
fn quarter_turns_and_mirrors_of_all_turn_the_result_to_the_bit() {
    let strands = hair(48, 18);
    let dynamics = free(form(2000.0, 10.0, 40.0, 80.0));
    let mirror = |v: Vec3| v * Vec3::new(1.0, 1.0, -1.0);
    let wind: [(u32, Vec3); 2] = [(30, Vec3::new(-100.0, 20.0, 35.0)), (60, Vec3::new(-15.0, -150.0, -60.0))];
    let blows = field(&wind.map(|(through, v)| (through, v.to_array())));
    for turn in [quarter_turn, mirror] {
        let turned = field(&wind.map(|(through, v)| (through, turn(v).to_array())));
        let expected = map(&run(&mut fast(&strands, &dynamics, &blows), &blows, 60), turn);
        let found = run(&mut fast(&map(&strands, turn), &dynamics, &turned), &turned, 60);
        // A quarter turn changes the order in which three products are added up: roundings, as between the twins.
        let farthest = expected.points().iter().zip(found.points()).map(|(a, b)| a.distance(*b)).fold(0.0, f32::max);
        assert!(farthest < 1e-3, "{farthest}");
    }
    let expected = map(&run(&mut fast(&strands, &dynamics, &blows), &blows, 60), mirror);
    let turned = field(&wind.map(|(through, v)| (through, mirror(v).to_array())));
    let found = run(&mut fast(&map(&strands, mirror), &dynamics, &turned), &turned, 60);
    assert!(bits(&found) == bits(&expected));
}

#[test]
fn any_turn_of_head_hair_and_field_turns_the_result() {
    let strands = hair(48, 18);
    let rotation = Quat::from_axis_angle(Vec3::new(0.6, -0.3, 0.74).normalize(), 1.234);
    let turn = |v: Vec3| rotation * v;
    let dynamics = free(form(2000.0, 10.0, 40.0, 0.0));
    let blows = field(&[(40, [-100.0, 20.0, 35.0])]);
    let turned = field(&[(40, turn(Vec3::new(-100.0, 20.0, 35.0)).to_array())]);
    let expected = map(&run(&mut exact(&strands, &dynamics, &blows), &blows, 40), turn);
    let found = run(&mut exact(&map(&strands, turn), &dynamics, &turned), &turned, 40);
    let farthest = expected.points().iter().zip(found.points()).map(|(a, b)| a.distance(*b)).fold(0.0, f32::max);
    // Points of 30 cm are turned within 4e-6 cm, and so are the directions of segments of a centimetre, 18 in a row.
    assert!(farthest < 19.0 * 4e-6, "{farthest}");
}

#[test]
fn hair_without_drag_is_carried_rigidly_by_a_head_that_moves() {
    let strands = hair(40, 18);
    let mut poses = way_of_a_head(60);
    let dynamics = free(FreeForm { drag: 0.0.into(), ..form(1000.0, 10.0, 30.0, 0.0) });
    for mut stepper in both(&strands, &dynamics, &calm()) {
        let rest = bits(stepper.strands());
        assert!(bits(&run_under(&mut *stepper, &calm(), &poses)) == rest);
    }
    // With lag it swings, but for its roots.
    poses.truncate(30);
    let lagging = free(form(1000.0, 10.0, 30.0, 0.0));
    let moved = run_under(&mut fast(&strands, &lagging, &calm()), &calm(), &poses);
    let way = |i: usize| moved.iter().zip(strands.iter()).map(|(a, b)| a[i].distance(b[i])).fold(0.0, f32::max);
    assert!(way(18) > 0.5 && way(1) < 0.1 * way(18), "{} and {}", way(18), way(1));
}

#[test]
fn the_twins_agree() {
    let strands = hair(160, 18);
    let poses = way_of_a_head(100);
    let mut distances = Vec::new();
    let dynamics = free(form(3000.0, 10.0, 40.0, 100.0));
    let wind = common::wind();
    let (mut reference, mut simulation) = (exact(&strands, &dynamics, &wind), fast(&strands, &dynamics, &wind));
    for frame in 1..=100 {
        let input = nabiki::dynamics::FrameInput::new(frame, &poses, &wind);
        reference.step_frame(&input);
        simulation.step_frame(&input);
        let pairs = reference.positions().iter().zip(simulation.strands().points());
        distances.extend(pairs.map(|(a, b)| a.distance(b.as_dvec3())));
    }
    distances.sort_by(f64::total_cmp);
    let at = |part: f64| distances[((distances.len() - 1) as f64 * part) as usize];
    println!("{:e} {:e} {:e}", at(0.99), at(0.999), at(1.0));
    // Each solve leaves a few roundings of a speed, which settling forgets within so many frames; what two joints in a row undo of one
    // another is many times as much.
    assert!(at(0.999) < 1e-3 && at(1.0) < 1e-2, "{:e} and {:e} cm", at(0.999), at(1.0));
}

/// Kinetic energy over 2 c, and the work against force, hold and the first joint, of strands of one segment each; from what
/// a stepper shows in three frames, as its increments are its own.
fn energy(dynamics: &Dynamics, force: DVec3, rest: &[DVec3], frames: [&[DVec3]; 2], lengths: &[f32]) -> Vec<f64> {
    let Form::Free(free) = &dynamics.form else { unreachable!() };
    let hold = free.form.hold.at(0.5);
    (0..rest.len())
        .map(|i| {
            let length = lengths[i];
            let c = gain_of_single(dynamics, length);
            let joint = joint(free.form.stiffness.at(0.0) as f32, length);
            // A step turns by the tangent of an angle.
            let tangent = frames[0][i].cross(frames[1][i]).length() / frames[0][i].dot(frames[1][i]);
            tangent * tangent / (2.0 * c) - (force + (hold + joint) * rest[i]).dot(frames[1][i])
        })
        .collect()
}

#[test]
fn energy_does_not_grow_under_a_constant_force() {
    let strands = single_segments(24);
    let force = DVec3::new(-90.0, 20.0, 60.0);
    let blows = field(&[(10_000, force.as_vec3().to_array())]);
    let dynamics = free(form(4000.0, 20.0, 60.0, 0.0));
    let rest = directions(&strands);
    let lengths: Vec<f32> = strands.lengths().collect();
    for mut stepper in both(&strands, &dynamics, &blows) {
        let mut frames = vec![rest.clone()];
        for _ in 0..400 {
            step(&mut *stepper, &blows);
            frames.push(directions(stepper.strands()));
        }
        let energies: Vec<Vec<f64>> =
            frames.windows(2).map(|w| energy(&dynamics, force, &rest, [&w[0], &w[1]], &lengths)).collect();
        for i in 0..rest.len() {
            let scale = force.length() + 20.0 + joint(4000.0, lengths[i]);
            // Speeds are those between frames, so within a swing the sum wavers by half of what the force adds to a speed
            // in a frame, c S^2 / 2 at the most; from one swing to the next it falls.
            let c = gain_of_single(&dynamics, lengths[i]);
            let swing = nabiki::dynamics::period(c * scale).ceil() as usize;
            let highest =
                |from: usize| energies[from..from + swing].iter().map(|e| e[i]).fold(f64::NEG_INFINITY, f64::max);
            let waver = 2.0 * c * scale * scale;
            for n in (0..400 - 2 * swing).step_by(swing) {
                assert!(highest(n + swing) <= highest(n) + 1e-3 * waver, "segment {i}, frame {n}");
            }
        }
    }
}

/// A ball that comes from behind, passes through the hair beside the jaw and goes on, without touching the head.
fn passing_ball() -> Body {
    let way = |n: u32| Vec3::new(-20.0 + 0.4 * n as f32, -9.0, 12.5);
    let poses: Vec<_> = (0..=100)
        .map(|n| nabiki::Pose { position_cm: way(n), rotation: Quat::from_rotation_x(0.01 * n as f32) })
        .collect();
    let skin = Arc::new(nabiki::body::skin_of(ball(4.0), "body[0].mesh").unwrap());
    let contact = Contact { margin: 0.2, friction: 0.3, static_friction: 0.5 };
    Body::new("body[0]", skin, BodyWay::InWorld(poses.into()), contact)
}

/// Grown hair, which lies on the head, and the head and a ball as bodies.
fn among_bodies(settle: f32) -> (Strands, Dynamics) {
    let head = bust();
    let (hairline, style) = (Hairline::default(), Style::default());
    let growth =
        Growth { hairline: &hairline, style: &style, strands: 300, segments: 18, segment_length: 1.0, seed: 1 };
    let hair = grow(&head, &growth, 300).unwrap().strands;
    let mut dynamics = free(FreeForm { settle: settle.into(), ..FreeForm::default() });
    dynamics.motion.inertia_length_floor = 18.0;
    if let Form::Free(free) = &mut dynamics.form {
        free.bodies = vec![Body::head(&head, Contact::default()), passing_ball()];
    }
    (hair, dynamics)
}

#[test]
fn no_node_enters_a_body_in_any_frame() {
    let (hair, dynamics) = among_bodies(20.0);
    let Form::Free(free) = dynamics.form.clone() else { unreachable!() };
    let blows = field(&[(30, [-150.0, 30.0, 60.0]), (60, [0.0, -100.0, -150.0]), (100, [0.0; 3])]);
    for mut stepper in both(&hair, &dynamics, &blows) {
        let inside = |strands: &Strands, frame: u32| {
            let deepest = |body: &Body| {
                let body_from_head = body.head_from_body(frame, &nabiki::Pose::STILL).inverse();
                let shape = body.shape.obstacle();
                let depth =
                    |p: &Vec3| -shape.read(body_from_head.transform_point3(*p), frame).map_or(1.0, |at| at.distance);
                strands.iter().flat_map(|strand| &strand[1..]).map(depth).fold(0.0, f32::max)
            };
            free.bodies.iter().map(deepest).fold(0.0, f32::max)
        };
        let at_rest = inside(stepper.strands(), 0);
        for frame in 1..=100 {
            step(&mut *stepper, &blows);
            let deepest = inside(stepper.strands(), frame);
            assert!(deepest <= at_rest + 0.01, "{deepest} cm deep in frame {frame}, {at_rest} at rest");
        }
    }
}

#[test]
fn a_body_carries_hair_along_and_lets_it_go() {
    let (hair, dynamics) = among_bodies(20.0);
    let calm_field = field(&[(1000, [0.0; 3])]);
    let mut simulation = fast(&hair, &dynamics, &calm_field);
    let mut farthest = Vec::new();
    for _ in 1..=340 {
        step(&mut simulation, &calm_field);
        let moved = hair.points().iter().zip(simulation.strands().points()).map(|(a, b)| a.distance(*b));
        farthest.push(moved.fold(0.0, f32::max));
    }
    let carried = farthest.iter().copied().fold(0.0, f32::max);
    assert!(carried > 2.0, "the ball moved no hair by more than {carried} cm");
    // It is gone from frame 100 on, and hair has ten seconds to come back.
    assert!(farthest[339] < 0.05, "{} cm off its rest shape", farthest[339]);
}

#[test]
fn hair_comes_to_rest_where_it_was_when_the_wind_stops() {
    let (hair, mut dynamics) = among_bodies(20.0);
    if let Form::Free(free) = &mut dynamics.form {
        free.bodies.truncate(1);
    }
    dynamics.motion.frames = 400;
    let blows = field(&[(50, [-100.0, 0.0, 0.0]), (400, [0.0; 3])]);
    let mut simulation = fast(&hair, &dynamics, &blows);
    let mut before = simulation.strands().clone();
    for _ in 1..=290 {
        before = simulation.strands().clone();
        step(&mut simulation, &blows);
    }
    let farthest =
        |a: &Strands, b: &Strands| a.points().iter().zip(b.points()).map(|(a, b)| a.distance(*b)).fold(0.0, f32::max);
    let (off, speed) = (farthest(simulation.strands(), &hair), farthest(simulation.strands(), &before));
    assert!(off < 0.05, "{off} cm off its rest shape ten seconds after the wind");
    // Of the tip of a strand of 18 cm: 1e-6 rad a frame of each of its segments, and the rounding of points 30 cm off.
    assert!(speed < 18.0 * 18.0 * 0.5 * 1e-6 + 4e-6, "{speed} cm a frame");
}

#[test]
fn any_subset_moves_as_within_the_whole_with_its_carriers() {
    let (hair, mut dynamics) = among_bodies(20.0);
    if let Form::Free(free) = &mut dynamics.form {
        let carriers = Arc::new(hair.select(&(0..64).collect::<Vec<_>>()));
        free.neighbours = Some(Neighbours::new(NeighbourForces::default(), carriers));
    }
    let blows = field(&[(30, [-150.0, 30.0, 60.0])]);
    let all = run(&mut fast(&hair, &dynamics, &blows), &blows, 30);
    let some: Vec<usize> = (0..300).step_by(7).rev().collect();
    let few = run(&mut fast(&hair.select(&some), &dynamics, &blows), &blows, 30);
    assert!(bits(&few) == bits(&all.select(&some)));
    let without = {
        if let Form::Free(free) = &mut dynamics.form {
            free.neighbours = None;
        }
        run(&mut fast(&hair, &dynamics, &blows), &blows, 30)
    };
    assert!(bits(&without) != bits(&all), "neighbours are felt");
}
