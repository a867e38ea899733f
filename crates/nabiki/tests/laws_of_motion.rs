//! The facts that any implementation of the paper can be held against, on the f64 specification.

mod common;

use common::*;
use glam::{DVec3, Vec3};
use nabiki::dynamics::{Dynamics, Reference, Simulation, Stepper, gain, largest_gain, period};
use nabiki::pseudo_force::PseudoForce;
use nabiki::{Ellipsoid, Strands};

const FAR: Ellipsoid = Ellipsoid { center: Vec3::new(0.0, 1e6, 0.0), half_axes: Vec3::ONE };

/// A strand of one segment, 1 cm long.
fn one_segment(direction: Vec3) -> Strands {
    let mut strands = Strands::default();
    strands.push([Vec3::ZERO, direction]);
    strands
}

fn positions(mut reference: Reference, frames: u32) -> Vec<DVec3> {
    run(&mut reference, frames);
    reference.positions().to_vec()
}

fn largest_distance(a: &[DVec3], b: &[DVec3]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max)
}

#[test]
fn a_small_swing_has_the_period_of_the_scheme() {
    for force in [0.02_f32, 1.0, 9.0, 13.2] {
        let dynamics = Dynamics { field: field(&[(1000, [0.0, -force, 0.0])]), ellipsoid: FAR, ..gust() };
        let a = 1e-4_f32;
        let length = f64::from(a).hypot(1.0);
        let x = gain(&dynamics, length / 2.0 + 0.5, length) * f64::from(force);
        let omega = std::f64::consts::TAU / period(x);
        assert!((omega.cos() - (1.0 - x / 2.0)).abs() < 1e-12);
        let mut reference = Reference::new(&one_segment(Vec3::new(a, -1.0, 0.0)), &dynamics).unwrap();
        let (a, mut largest) = (f64::from(a), 0.0_f64);
        for n in 1..=100 {
            reference.step_frame();
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
    let dynamics = Dynamics { field: field(&[(100, [0.0; 3])]), ..gust() };
    let hair = mixed_hair(50);
    let (mut reference, mut fast) =
        (Reference::new(&hair, &dynamics).unwrap(), Simulation::new(&hair, &dynamics).unwrap());
    let at_rest = [bits(reference.strands()), bits(fast.strands())];
    assert_eq!([bits(&run(&mut reference, 30)), bits(&run(&mut fast, 30))], at_rest);
}

#[test]
fn the_rest_shape_is_the_given_one() {
    let hair = hair(100, 18);
    let fast = Simulation::new(&hair, &gust()).unwrap();
    for (a, b) in fast.strands().points().iter().zip(hair.points()) {
        // Eighteen vectors of 1 cm, each with angles and sines within 2e-7.
        assert!(a.distance(*b) < 18.0 * 4e-7, "{a} {b}");
    }
}

#[test]
fn a_turned_scene_gives_the_turned_result() {
    let dynamics = gust();
    let turned = Dynamics { field: field(&[(50, [0.0, 0.0, 100.0]), (100, [0.0, -150.0, 15.0])]), ..gust() };
    let hair = hair(200, 18);
    let straight = positions(Reference::new(&hair, &dynamics).unwrap(), 100);
    let result = positions(Reference::new(&map(&hair, quarter_turn), &turned).unwrap(), 100);
    let expected: Vec<DVec3> = straight.iter().map(|p| DVec3::new(p.z, p.y, -p.x)).collect();
    // f64 rounding, 1e-16 a step, grows at most like e^(n sqrt(c |F|)) = e^9 where a segment stands against the wind.
    assert!(largest_distance(&result, &expected) < 1e-9, "{}", largest_distance(&result, &expected));
}

#[test]
fn a_mirrored_scene_gives_the_mirrored_result() {
    let wind = |z: f32| field(&[(50, [-60.0, 10.0, z]), (100, [-15.0, -150.0, -z])]);
    let hair = hair(200, 18);
    let mirror = |p: Vec3| Vec3::new(p.x, p.y, -p.z);
    let here = positions(Reference::new(&hair, &Dynamics { field: wind(80.0), ..gust() }).unwrap(), 100);
    let mirrored = Dynamics { field: wind(-80.0), ..gust() };
    let there = positions(Reference::new(&map(&hair, mirror), &mirrored).unwrap(), 100);
    let expected: Vec<DVec3> = here.iter().map(|p| DVec3::new(p.x, p.y, -p.z)).collect();
    assert!(largest_distance(&there, &expected) < 1e-9, "{}", largest_distance(&there, &expected));
}

#[test]
fn only_gain_times_force_matters() {
    let mut quarter = gust();
    quarter.motion.time_step *= 2.0;
    quarter.field = field(&[(50, [-25.0, 0.0, 0.0]), (100, [-3.75, -37.5, 0.0])]);
    let hair = mixed_hair(100);
    let mut fast = [gust(), quarter.clone()].map(|d| Simulation::new(&hair, &d).unwrap());
    let mut reference = [gust(), quarter].map(|d| Reference::new(&hair, &d).unwrap());
    // Factors of two: the same bits, not only the same motion.
    let [a, b] = &mut fast;
    assert_eq!(bits(&run(a, 100)), bits(&run(b, 100)));
    let [a, b] = &mut reference;
    assert_eq!(bits(&run(a, 100)), bits(&run(b, 100)));
}

#[test]
fn far_from_the_head_nothing_feels_the_pseudo_force() {
    let hair = hair(100, 18);
    let mut far = Simulation::new(&hair, &Dynamics { ellipsoid: FAR, ..gust() }).unwrap();
    let mut off = Simulation::new(&hair, &Dynamics { pseudo_force: PseudoForce::off(), ..gust() }).unwrap();
    let mut near = Simulation::new(&hair, &gust()).unwrap();
    let (far, off, near) = (run(&mut far, 100), run(&mut off, 100), run(&mut near, 100));
    assert_eq!(bits(&far), bits(&off));
    assert_ne!(bits(&near), bits(&off), "the pseudo-force acts on hair near the head");
}

#[test]
fn coefficients_of_one_make_gamma_void() {
    let hair = hair(100, 18);
    let everywhere = PseudoForce { alpha: 1.0, coefficients: vec![1.0] };
    let mut with = Simulation::new(&hair, &Dynamics { pseudo_force: everywhere, ..gust() }).unwrap();
    let mut without = Simulation::new(&hair, &Dynamics { ellipsoid: FAR, ..gust() }).unwrap();
    assert_eq!(bits(&run(&mut with, 100)), bits(&run(&mut without, 100)));
}

#[test]
fn hair_that_hangs_straight_takes_the_plane_of_the_wind() {
    let mut strands = Strands::default();
    strands.push((0..=18).map(|i| Vec3::NEG_Y * i as f32));
    for wind in [[30.0, -20.0, 0.0], [0.0, -20.0, -30.0], [18.0, -20.0, 24.0]] {
        let dynamics = Dynamics { field: field(&[(100, wind)]), ellipsoid: FAR, ..gust() };
        let side = Vec3::new(wind[0], 0.0, wind[2]).normalize();
        for stepper in [
            &mut Reference::new(&strands, &dynamics).unwrap() as &mut dyn Stepper,
            &mut Simulation::new(&strands, &dynamics).unwrap(),
        ] {
            let tip = *run(stepper, 30).points().last().unwrap();
            assert!(tip.dot(side) > 5.0, "blown to {tip} by {wind:?}");
            // 18 segments whose f32 azimuths, sines and sums are each within 3e-7.
            assert!(tip.dot(side.cross(Vec3::Y)).abs() < 18.0 * 6e-7, "{tip} left the plane of {wind:?}");
        }
    }
}

#[test]
fn segments_keep_their_length() {
    let hair = mixed_hair(100);
    let mut fast = Simulation::new(&hair, &gust()).unwrap();
    for _ in 0..100 {
        fast.step_frame();
        for (strand, rest) in fast.strands().iter().zip(hair.iter()) {
            for (now, rest) in strand.windows(2).zip(rest.windows(2)) {
                let error = (now[0].distance(now[1]) - rest[0].distance(rest[1])).abs();
                // Six coordinates below 32 cm rounded to 24 bits, and sines within 1.5e-7 of half a centimetre.
                assert!(error < 6.0 * 32.0 / 2_f32.powi(24), "{error}");
            }
        }
    }
}

#[test]
fn hair_cut_more_finely_moves_alike() {
    let dynamics = Dynamics { ellipsoid: FAR, ..gust() };
    let tips = |segments: usize| -> Vec<DVec3> {
        let p = positions(Reference::new(&hair(60, segments), &dynamics).unwrap(), 30);
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
    let with = |force: f32| Dynamics { field: field(&[(10, [1.0, 0.0, 0.0]), (100, [0.0, force, 0.0])]), ..gust() };
    let largest = 4.0 / largest_gain(&hair, &gust()).unwrap() as f32;
    assert!(Simulation::new(&hair, &with(-largest * 0.999)).is_ok());
    for force in [-largest * 1.001, largest * 10.0] {
        let error = Simulation::new(&hair, &with(force)).err().unwrap();
        assert_eq!(error.thing, "force[1].vector");
        assert!(error.remedy.contains(&format!("keep |F| below {largest:.0}")), "{error} {largest}");
        assert_eq!(Reference::new(&hair, &with(force)).err().unwrap(), error);
    }
}

#[test]
fn strands_that_cannot_be_moved_are_refused_by_number() {
    let mut dynamics = gust();
    let refuse = |strand: &[Vec3], what: &str| {
        let mut strands = hair(3, 18);
        strands.push(strand.iter().copied());
        let error = Simulation::new(&strands, &gust()).err().unwrap();
        assert_eq!(error.thing, "hair strand 3");
        assert!(error.to_string().contains(what), "{error}");
    };
    refuse(&[Vec3::ZERO], "1 points");
    refuse(&[Vec3::ZERO, Vec3::X, Vec3::X], "segment 2 of length 0");
    refuse(&[Vec3::ZERO, Vec3::NAN], "finite");
    refuse(&[Vec3::ZERO, Vec3::INFINITY], "finite");
    assert!(Simulation::new(&Strands::default(), &gust()).is_err());
    for (set, thing) in [
        ((|d: &mut Dynamics| d.motion.time_step = 0.0) as fn(&mut Dynamics), "motion.time_step"),
        (|d| d.motion.frame_rate = f64::INFINITY, "motion.frame_rate"),
        (|d| d.motion.linear_density = -0.05, "motion.linear_density"),
        (|d| d.motion.friction_length = f32::NAN, "motion.friction_length"),
        (|d| d.segment_length = 0.0, "hair.segment_length"),
        (|d| d.shell = 1.0, "head.shell"),
        (|d| d.ellipsoid.half_axes.y = 0.0, "head.ellipsoid.half_axes"),
    ] {
        set(&mut dynamics);
        assert_eq!(Simulation::new(&hair(1, 18), &dynamics).err().unwrap().thing, thing);
        dynamics = gust();
    }
}
