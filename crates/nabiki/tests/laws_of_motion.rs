//! The facts that any implementation of the paper can be held against, on the f64 specification.

mod common;

use common::*;
use std::sync::Arc;

use glam::{DVec3, Quat, Vec3};
use nabiki::disturbance::Disturbance;
use nabiki::dynamics::{
    Dynamics, ForceSpace, Motion, Reference, Simulation, Stepper, Timeline, check_field, gain, largest_gain, period,
    straightened,
};
use nabiki::field::{Field, KeyframedField};
use nabiki::pseudo_force::PseudoForce;
use nabiki::strands::length;
use nabiki::{Ellipsoid, Pose, SettingError, Strands};

const FAR: Ellipsoid = Ellipsoid { center: Vec3::new(0.0, 1e6, 0.0), half_axes: Vec3::ONE };

/// A strand of one segment, 1 cm long.
fn one_segment(direction: Vec3) -> Strands {
    let mut strands = Strands::default();
    strands.push([Vec3::ZERO, direction]);
    strands
}

fn positions(mut reference: Reference, field: &dyn Field, frames: u32) -> Vec<DVec3> {
    run(&mut reference, field, frames);
    reference.positions().to_vec()
}

fn largest_distance(a: &[DVec3], b: &[DVec3]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max)
}

#[test]
fn a_small_swing_has_the_period_of_the_scheme() {
    for force in [0.02_f32, 1.0, 9.0, 13.2] {
        let (pull, dynamics) = (field(&[(1000, [0.0, -force, 0.0])]), Dynamics { ellipsoid: FAR, ..gust() });
        let a = 1e-4_f32;
        let length = f64::from(a).hypot(1.0);
        let x = gain(&dynamics, length / 2.0 + 0.5, length) * f64::from(force);
        let omega = std::f64::consts::TAU / period(x);
        assert!((omega.cos() - (1.0 - x / 2.0)).abs() < 1e-12);
        let mut reference = exact(&one_segment(Vec3::new(a, -1.0, 0.0)), &dynamics, &pull);
        let (a, mut largest) = (f64::from(a), 0.0_f64);
        for n in 1..=100 {
            step(&mut reference, &pull);
            // The solution of (7) that rests at first, theta^-1 = theta^0 = a.
            let linear = a * (omega * (f64::from(n) + 0.5)).cos() / (omega / 2.0).cos();
            largest = largest.max((reference.positions()[1].x - linear).abs());
        }
        // sin(theta) departs from theta by theta^3 / 6: at amplitude A that slows the swing by x A^2 / (16 sin
        // omega) rad a frame, and bends it by about A^3. Half as much again for the orders left out.
        let amplitude = a / (omega / 2.0).cos();
        let tolerance = 1.5 * amplitude.powi(3) * (100.0 * x / (16.0 * omega.sin()) + 1.0);
        assert!(largest < tolerance, "force {force}: {largest} of {tolerance}");
    }
}

#[test]
fn hair_on_which_nothing_pulls_stays_to_the_bit() {
    let (still, hair) = (field(&[(100, [0.0; 3])]), mixed_hair(50));
    for polar_axis in [Vec3::Y, Vec3::new(0.3, 0.8, -0.5)] {
        let dynamics = Dynamics { polar_axis, ..gust() };
        let (mut reference, mut fast) = (exact(&hair, &dynamics, &still), fast(&hair, &dynamics, &still));
        let at_rest = [bits(reference.strands()), bits(fast.strands())];
        assert_eq!([bits(&run(&mut reference, &still, 30)), bits(&run(&mut fast, &still, 30))], at_rest);
        // A head that turns takes such hair along as it is.
        let poses = way_of_a_head(60);
        assert_eq!(
            [bits(&run_under(&mut reference, &still, &poses)), bits(&run_under(&mut fast, &still, &poses))],
            at_rest
        );
    }
}

#[test]
fn the_rest_shape_is_the_given_one() {
    let hair = hair(100, 18);
    for polar_axis in [Vec3::Y, Vec3::new(0.3, 0.8, -0.5)] {
        // Straightening belongs to the making of the hair: the steppers take it as it is.
        let motion = Motion { straighten: 45.0, ..Motion::default() };
        let dynamics = Dynamics { motion, polar_axis, ..gust() };
        let (reference, fast) = (exact(&hair, &dynamics, &wind()), fast(&hair, &dynamics, &wind()));
        for ((a, b), c) in fast.strands().points().iter().zip(hair.points()).zip(reference.strands().points()) {
            // Eighteen vectors of 1 cm, the parts of each rounded three times (sines, product, sum), 6e-8 of at most 1,
            // and once more, 1e-6, where the sum passes 16 cm.
            assert!(a.distance(*b) < 18.0 * (3.0 * 6e-8 + 1e-6), "{a} {b}");
            // f64, rounded once at the end.
            assert!(c.distance(*b) < 4e-6, "{c} {b}");
        }
    }
}

#[test]
fn a_turned_scene_gives_the_turned_result() {
    let turned = field(&[(50, [0.0, 0.0, 100.0]), (100, [0.0, -150.0, 15.0])]);
    let hair = hair(200, 18);
    let straight = positions(exact(&hair, &gust(), &wind()), &wind(), 100);
    let result = positions(exact(&map(&hair, quarter_turn), &gust(), &turned), &turned, 100);
    let expected: Vec<DVec3> = straight.iter().map(|p| DVec3::new(p.z, p.y, -p.x)).collect();
    // f64 rounding, 1e-16 a step, grows at most like e^(n sqrt(c |F|)) = e^9 where a segment stands against the wind.
    assert!(largest_distance(&result, &expected) < 1e-9, "{}", largest_distance(&result, &expected));
}

#[test]
fn a_mirrored_scene_gives_the_mirrored_result() {
    let wind = |z: f32| field(&[(50, [-60.0, 10.0, z]), (100, [-15.0, -150.0, -z])]);
    let hair = hair(200, 18);
    let mirror = |p: Vec3| Vec3::new(p.x, p.y, -p.z);
    let here = positions(exact(&hair, &gust(), &wind(80.0)), &wind(80.0), 100);
    let there = positions(exact(&map(&hair, mirror), &gust(), &wind(-80.0)), &wind(-80.0), 100);
    let expected: Vec<DVec3> = here.iter().map(|p| DVec3::new(p.x, p.y, -p.z)).collect();
    assert!(largest_distance(&there, &expected) < 1e-9, "{}", largest_distance(&there, &expected));
}

#[test]
fn only_gain_times_force_matters() {
    let mut quarter = gust();
    quarter.motion.time_step *= 2.0;
    let weak = field(&[(50, [-25.0, 0.0, 0.0]), (100, [-3.75, -37.5, 0.0])]);
    let hair = mixed_hair(100);
    // Factors of two: the same bits, not only the same motion.
    let (mut a, mut b) = (fast(&hair, &gust(), &wind()), fast(&hair, &quarter, &weak));
    assert_eq!(bits(&run(&mut a, &wind(), 100)), bits(&run(&mut b, &weak, 100)));
    let (mut a, mut b) = (exact(&hair, &gust(), &wind()), exact(&hair, &quarter, &weak));
    assert_eq!(bits(&run(&mut a, &wind(), 100)), bits(&run(&mut b, &weak, 100)));
}

/// The floor is a length in cm, whatever the unit d in which the strand is counted.
#[test]
fn hair_below_the_floor_has_the_inertia_of_hair_as_long_as_that() {
    for segment_length in [0.5, 1.0, 1.5] {
        let bare = Dynamics { segment_length, ..gust() };
        let mut floored = bare.clone();
        floored.motion.inertia_length_floor = 12.0;
        let count = |length: f64| length / f64::from(segment_length);
        for place in [0.5, 3.0, 6.0] {
            let i = count(place) + 0.5;
            assert_eq!(gain(&floored, i, count(6.0)), gain(&bare, i, count(12.0)), "d = {segment_length}");
            assert_eq!(gain(&floored, i, count(20.0)), gain(&bare, i, count(20.0)), "d = {segment_length}");
        }
    }
}

#[test]
fn far_from_the_head_nothing_feels_the_pseudo_force() {
    let hair = hair(100, 18);
    let moved = |dynamics: &Dynamics| run(&mut fast(&hair, dynamics, &wind()), &wind(), 100);
    let far = moved(&Dynamics { ellipsoid: FAR, ..gust() });
    let off = moved(&Dynamics { pseudo_force: PseudoForce::off(), ..gust() });
    let near = moved(&gust());
    assert_eq!(bits(&far), bits(&off));
    assert_ne!(bits(&near), bits(&off), "the pseudo-force acts on hair near the head");
}

#[test]
fn coefficients_of_one_make_gamma_void() {
    let hair = hair(100, 18);
    let everywhere = PseudoForce { alpha: 1.0, coefficients: vec![1.0] };
    let moved = |dynamics: &Dynamics| run(&mut fast(&hair, dynamics, &wind()), &wind(), 100);
    let with = moved(&Dynamics { pseudo_force: everywhere, ..gust() });
    assert_eq!(bits(&with), bits(&moved(&Dynamics { ellipsoid: FAR, ..gust() })));
}

#[test]
fn hair_that_hangs_straight_takes_the_plane_of_the_wind() {
    let mut strands = Strands::default();
    strands.push((0..=18).map(|i| Vec3::NEG_Y * i as f32));
    for wind in [[30.0, -20.0, 0.0], [0.0, -20.0, -30.0], [18.0, -20.0, 24.0]] {
        let (dynamics, blows) = (Dynamics { ellipsoid: FAR, ..gust() }, field(&[(100, wind)]));
        let side = Vec3::new(wind[0], 0.0, wind[2]).normalize();
        for stepper in
            [&mut exact(&strands, &dynamics, &blows) as &mut dyn Stepper, &mut fast(&strands, &dynamics, &blows)]
        {
            let tip = *run(stepper, &blows, 30).points().last().unwrap();
            assert!(tip.dot(side) > 5.0, "blown to {tip} by {wind:?}");
            // 18 segments whose f32 azimuths, sines and sums are each within 3e-7.
            assert!(tip.dot(side.cross(Vec3::Y)).abs() < 18.0 * 6e-7, "{tip} left the plane of {wind:?}");
        }
    }
}

#[test]
fn segments_keep_their_length() {
    let hair = mixed_hair(100);
    let mut fast = fast(&hair, &gust(), &wind());
    // Far beyond the gust: sines that are turned frame after frame must not grow or shrink.
    for _ in 0..1000 {
        step(&mut fast, &wind());
        for (strand, rest) in fast.strands().iter().zip(hair.iter()) {
            for (now, rest) in strand.windows(2).zip(rest.windows(2)) {
                let error = (now[0].distance(now[1]) - rest[0].distance(rest[1])).abs();
                // Six coordinates below 32 cm rounded to 24 bits, and a direction within 2e-7 of length 1.
                assert!(error < 6.0 * 32.0 / 2_f32.powi(24), "{error}");
            }
        }
    }
}

#[test]
fn hair_cut_more_finely_moves_alike() {
    let dynamics = Dynamics { ellipsoid: FAR, ..gust() };
    let tips = |segments: usize| -> Vec<DVec3> {
        let p = positions(exact(&hair(60, segments), &dynamics, &wind()), &wind(), 30);
        p.chunks(segments + 1).map(|strand| strand[segments]).collect()
    };
    let [coarse, middle, fine, finest] = [9, 18, 36, 72].map(tips);
    let steps = [(&coarse, &middle), (&middle, &fine), (&fine, &finest)].map(|(a, b)| {
        let mut distances: Vec<f64> = a.iter().zip(b).map(|(a, b)| a.distance(*b)).collect();
        distances.sort_by(f64::total_cmp);
        distances[distances.len() / 2]
    });
    // Gains are taken where the middles of the segments are, so the error is of second order: in a third of a swing,
    // before strands that stood against the wind part, each halving
    // quarters it, up to terms of higher order.
    for (i, w) in steps.windows(2).enumerate() {
        let ratio = w[0] / w[1];
        assert!((3.0..5.0).contains(&ratio), "halving {i}: {steps:?}");
    }
}

#[test]
fn a_field_too_strong_for_the_step_is_refused_with_the_largest_that_holds() {
    let hair = hair(20, 18);
    let with = |force: f32| field(&[(10, [1.0, 0.0, 0.0]), (100, [0.0, force, 0.0])]);
    let largest = 4.0 / largest_gain(&hair, &gust()).unwrap() as f32;
    assert!(Simulation::new(&hair, &gust(), &with(-largest * 0.999)).is_ok());
    for force in [-largest * 1.001, largest * 10.0] {
        let error = Simulation::new(&hair, &gust(), &with(force)).err().unwrap();
        assert_eq!(error.thing, "force[1].vector");
        assert!(error.remedy.contains(&format!("keep |F| below {largest:.0}")), "{error} {largest}");
        assert_eq!(check_field(&hair, &gust(), &with(force)).unwrap_err(), error);
    }
}

#[test]
fn a_strand_too_short_for_a_field_is_named_by_its_number_in_the_whole() {
    let hair = hair(20, 18);
    let dynamics = gust();
    let largest = 4.0 / largest_gain(&hair, &dynamics).unwrap() as f32;
    let strong: Arc<dyn Field> = Arc::new(field(&[(100, [largest * 1.001, 0.0, 0.0])]));
    let whole = check_field(&hair, &dynamics, &*strong).unwrap_err().to_string();
    let named = |error: &str| -> usize {
        let (_, after) = error.split_once("at strand ").unwrap();
        after.split(' ').next().unwrap().parse().unwrap()
    };
    // The weakest strand and its neighbours, as a shard has them.
    let ids: Vec<u32> = (named(&whole) as u32..hair.len() as u32).collect();
    let some = hair.select(&ids.iter().map(|&id| id as usize).collect::<Vec<_>>());
    let refused = Timeline::with_ids(&some, &ids, &dynamics, strong, Vec::new(), 1).err().unwrap();
    assert_eq!(refused.to_string(), whole);
}

/// What both twins refuse, in the same words.
fn refusal(hair: &Strands, dynamics: &Dynamics, field: &dyn Field) -> SettingError {
    let refused = Simulation::new(hair, dynamics, field).expect_err("the fast twin refuses");
    assert_eq!(Reference::new(hair, dynamics, field).err().as_ref(), Some(&refused));
    let timeline = Timeline::new(hair, dynamics, Arc::new(wind()), Vec::new(), 100);
    // Stepping is the same, so the refusals are, but for the field of this one.
    assert!(timeline.is_err() || check_field(hair, dynamics, field).is_err());
    refused
}

#[test]
fn strands_that_cannot_be_moved_are_refused_by_number() {
    let refuse = |strand: &[Vec3], what: &str| {
        let mut strands = hair(3, 18);
        strands.push(strand.iter().copied());
        let error = refusal(&strands, &gust(), &wind());
        assert!(error.to_string().starts_with("hair strand 3"), "{error}");
        assert!(error.to_string().contains(what), "{error}");
    };
    refuse(&[Vec3::ZERO], "but has 1");
    refuse(&[Vec3::ZERO, Vec3::X, Vec3::X], "segment 2 of length 0");
    refuse(&[Vec3::ZERO, Vec3::NAN], ", point 1 = [NaN, NaN, NaN]: every coordinate must be a finite");
    refuse(&[Vec3::ZERO, Vec3::INFINITY], "finite");
    assert_eq!(refusal(&Strands::default(), &gust(), &wind()).thing, "hair");
}

#[test]
fn settings_that_cannot_be_stepped_are_refused_by_name() {
    let off = |over| Some(Disturbance { over, ..Default::default() });
    type Spoil<'a> = &'a dyn Fn(&mut Dynamics);
    let cases: [(Spoil, &str); 12] = [
        (&|d| d.motion.time_step = 0.0, "motion.time_step"),
        (&|d| d.motion.frame_rate = f64::INFINITY, "motion.frame_rate"),
        (&|d| d.motion.linear_density = -0.05, "motion.linear_density"),
        (&|d| d.motion.inertia_length_floor = f32::NAN, "motion.inertia_length_floor"),
        (&|d| d.motion.straighten = 46.0, "motion.straighten"),
        (&|d| d.segment_length = 0.0, "hair.segment_length"),
        (&|d| d.shell = 1.0, "head.shell"),
        (&|d| d.ellipsoid.half_axes.y = 0.0, "head.ellipsoid.half_axes"),
        (&|d| d.ellipsoid.center.z = f32::NAN, "head.ellipsoid.center"),
        (&|d| d.polar_axis = Vec3::ZERO, "head.motion"),
        (&|d| d.pseudo_force.alpha = 2.0, "pseudo_force.alpha"),
        (&|d| d.disturbance = off(0), "disturbance.over"),
    ];
    for (set, thing) in cases {
        let mut dynamics = gust();
        set(&mut dynamics);
        assert_eq!(refusal(&hair(1, 18), &dynamics, &wind()).thing, thing);
    }
    assert_eq!(refusal(&hair(1, 18), &gust(), &field(&[(9, [1e9, 0.0, 0.0])])).thing, "force[0].vector");
}

/// A head that stands still, tilted, is the paper's: what matters is the vertical.
#[test]
fn hair_of_a_tilted_head_that_stands_still_moves_as_hair_of_an_upright_one() {
    // A sphere looks alike from all sides.
    let round = Dynamics { ellipsoid: Ellipsoid { center: Vec3::ZERO, half_axes: Vec3::splat(9.0) }, ..gust() };
    let hair_in_world = hair(200, 18);
    let upright = positions(exact(&hair_in_world, &round, &wind()), &wind(), 40);
    // The hair is rounded to 4e-6 cm in another place, a segment; 33 is how much an error may grow, see tests/twins.rs.
    let tolerance = 33.0 * 18.0 * 4e-6;
    for turn in [Quat::from_rotation_z(std::f32::consts::FRAC_PI_2), Quat::from_rotation_x(0.7)] {
        let pose = Pose { position_cm: Vec3::ZERO, rotation: turn };
        let hair_in_head = map(&hair_in_world, |p| turn.inverse() * p);
        let dynamics = Dynamics { polar_axis: pose.up_in_head(), ..round.clone() };
        let mut tilted = exact(&hair_in_head, &dynamics, &wind());
        run_under(&mut tilted, &wind(), &[pose; 41]);
        let world: Vec<DVec3> = tilted.positions().iter().map(|&p| turn.as_dquat() * p).collect();
        let largest = largest_distance(&world, &upright);
        assert!(largest < tolerance, "{turn}: {largest} of {tolerance}");
        // With the head's own y the same hair goes another way.
        let mut other = exact(&hair_in_head, &round, &wind());
        run_under(&mut other, &wind(), &[pose; 41]);
        let world: Vec<DVec3> = other.positions().iter().map(|&p| turn.as_dquat() * p).collect();
        assert!(largest_distance(&world, &upright) > 1.0);
    }
}

/// Forces given in the head's space know nothing of its way.
#[test]
fn forces_of_the_head_turn_with_it_and_those_of_the_world_do_not() {
    let hair = mixed_hair(40);
    let poses = way_of_a_head(30);
    let in_space = |force_space| Dynamics { motion: Motion { force_space, ..Motion::default() }, ..gust() };
    for field in [&wind() as &dyn Field, &Whirl] {
        let still = run(&mut fast(&hair, &gust(), field), field, 30);
        let in_head = in_space(ForceSpace::Head);
        assert_eq!(bits(&run_under(&mut fast(&hair, &in_head, field), field, &poses)), bits(&still));
        let in_world = in_space(ForceSpace::World);
        assert_ne!(bits(&run_under(&mut fast(&hair, &in_world, field), field, &poses)), bits(&still));
    }
}

/// A field that is asked for everywhere and answers the same is the uniform one.
#[test]
fn a_field_asked_at_every_node_moves_hair_as_one_that_is_known_to_be_uniform() {
    #[derive(Debug)]
    struct Asked(KeyframedField);
    impl Field for Asked {
        fn at(&self, _: Vec3, frame: u32) -> Vec3 {
            self.0.vector(frame)
        }
        fn strongest(&self) -> f32 {
            self.0.strongest()
        }
    }
    let (hair, poses, asked) = (mixed_hair(60), way_of_a_head(60), Asked(wind()));
    let dynamics = Dynamics { polar_axis: poses[0].up_in_head(), ..gust() };
    let (mut a, mut b) = (fast(&hair, &dynamics, &asked), fast(&hair, &dynamics, &wind()));
    assert_eq!(bits(&run_under(&mut a, &asked, &poses)), bits(&run_under(&mut b, &wind(), &poses)));
    let (mut a, mut b) = (exact(&hair, &dynamics, &asked), exact(&hair, &dynamics, &wind()));
    assert_eq!(bits(&run_under(&mut a, &asked, &poses)), bits(&run_under(&mut b, &wind(), &poses)));
}

#[test]
fn straightened_hair_hangs_straight_and_takes_the_plane_of_the_wind() {
    for turn in [Quat::IDENTITY, Quat::from_rotation_x(0.7)] {
        let axis = turn * Vec3::Y;
        // Two degrees off the vertical, each strand another way, behind one segment that is to stay.
        let mut strands = Strands::default();
        for s in 0..12 {
            let lean = turn * Vec3::new((s as f32).sin() * 0.035, -1.0, (s as f32).cos() * 0.035);
            let root = turn * Vec3::new(1.0, 2.0, 3.0);
            let first = root + turn * Vec3::new(0.8, -0.6, 0.0);
            strands.push(std::iter::once(root).chain((0..17).map(|i| first + i as f32 * lean)));
        }
        let motion = Motion { straighten: 3.0, ..Motion::default() };
        let straight = straightened(&strands, &motion, axis);
        for (now, before) in straight.iter().zip(strands.iter()) {
            assert_eq!(now[0], before[0]);
            // Rounded once each, below 32 cm.
            assert!(now[1].distance(before[1]) < 2e-6);
            for w in now[1..].windows(2) {
                assert!((w[1] - w[0]).cross(axis).length() < 4e-6, "{} is not vertical", w[1] - w[0]);
            }
            assert!((length(now) - length(before)).abs() < 18.0 * 4e-6);
            // Turned by the two degrees that it was off, and not over.
            for (now, before) in now.windows(2).zip(before.windows(2)) {
                assert!((now[1] - now[0]).angle_between(before[1] - before[0]) < 2.1_f32.to_radians());
            }
        }
        let again = straightened(&straight, &motion, axis);
        let moved = again.points().iter().zip(straight.points()).map(|(a, b)| a.distance(*b)).fold(0.0, f32::max);
        assert!(moved < 18.0 * 4e-6, "{moved}");
        assert_eq!(straightened(&strands, &Motion::default(), axis), strands);

        // Whatever its lean was, hair is blown into the plane of the wind.
        let dynamics = Dynamics { motion, ellipsoid: FAR, polar_axis: axis, ..gust() };
        let blows = field(&[(100, (turn * Vec3::new(0.0, 0.0, 40.0)).to_array())]);
        for stepper in
            [&mut exact(&straight, &dynamics, &blows) as &mut dyn Stepper, &mut fast(&straight, &dynamics, &blows)]
        {
            let blown = run(stepper, &blows, 20);
            for strand in blown.iter() {
                // Sixteen free segments, each within 1e-5 of the plane; what hangs on the first goes with it.
                let across = (strand[17] - strand[1]).dot(turn * Vec3::X);
                assert!(across.abs() < 17.0 * 2e-5, "{across}");
            }
        }
    }
}

/// Of a strand that nothing else moves: the tip turns by all that the disturbance gives it, the first of k segments by 1 / k of it.
#[test]
fn a_disturbance_turns_each_segment_by_the_part_of_the_length_that_it_ends_at() {
    let (segments, theta, phi) = (9, 1.9_f32, 0.7_f32);
    let directed = |theta: f32, phi: f32| Vec3::new(theta.sin() * phi.sin(), theta.cos(), theta.sin() * phi.cos());
    let mut strands = Strands::default();
    for s in 0..20 {
        strands.push((0..=segments).map(|i| Vec3::new(0.0, s as f32, 2.0) + i as f32 * directed(theta, phi)));
    }
    let disturbance = Disturbance { amplitude: 0.4, ..Default::default() };
    let part = disturbance.part(10).unwrap();
    let dynamics = Dynamics { ellipsoid: FAR, disturbance: Some(disturbance.clone()), ..gust() };
    let calm = field(&[(100, [0.0; 3])]);
    for stepper in [&mut exact(&strands, &dynamics, &calm) as &mut dyn Stepper, &mut fast(&strands, &dynamics, &calm)] {
        let disturbed = run(stepper, &calm, 10);
        for (s, strand) in disturbed.iter().enumerate() {
            let [by_theta, by_phi] = disturbance.turn(s as u32, &part);
            for (i, w) in strand.windows(2).enumerate() {
                let share = (i + 1) as f32 / segments as f32;
                let turned = directed(theta + share * by_theta, phi + share * by_phi);
                // Points of 20 cm are rounded to 1e-6 cm along each axis, segments are 1 cm long.
                assert!((w[1] - w[0]).distance(turned) < 1e-5, "segment {i} of strand {s}: {} {turned}", w[1] - w[0]);
            }
        }
    }
}
