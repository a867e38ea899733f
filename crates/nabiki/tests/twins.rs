//! The fast stepper against the specification, and against itself: other threads, widths, subsets, orders.

#[path = "common/allocations.rs"]
mod allocations;
mod common;

use allocations::allocations;
use common::*;
use glam::{DVec3, Vec3};
use nabiki::disturbance::Disturbance;
use nabiki::dynamics::{Dynamics, FrameInput, Reference, Simulation, Stepper, VectorWidth};
use nabiki::field::Field;
use nabiki::pseudo_force::PseudoForce;
use nabiki::{Pose, Strands};

/// Tolerances of the twin, in segment lengths over the 100 frames of the gust, without pseudo-force.
///
/// A step rounds the sine and cosine of each angle to 6e-8 and the push to a relative 3e-7 or so. In 100 steps the
/// first adds up to 100 * 1.2e-7, the second to 100^2 / 2 * c |F| * 3e-7 = 1.2e-5 for c |F| = 0.008 at the tip:
/// together 2.4e-5 rad a segment, 4.3e-4 over 18 segments if all err to one side.
const TYPICAL: f64 = 4.3e-4;
/// Where a segment stands against the wind its error grows by up to e^(n sqrt(c |F|)), e^(50 * 0.07) = 33 in the
/// first half of the gust.
const WORST: f64 = 33.0 * TYPICAL;
/// Beyond the gust's 100 frames there is no bound but a rule: the swing of a segment about two angles is chaotic, and its
/// errors go on growing. It is the motion that does so and not the arithmetic: specifications that start a rounding
/// apart part as far (`the_twins_part_as_two_specifications_a_rounding_apart_do`, and `benches/twins.rs` for figures).
const HORIZON: u32 = 100;

fn distances(dynamics: &Dynamics, field: &dyn Field, poses: &[Pose], hair: &Strands) -> Vec<f64> {
    let (mut reference, mut fast) = (exact(hair, dynamics, field), fast(hair, dynamics, field));
    let mut distances = Vec::new();
    for frame in 1..=HORIZON {
        let input = FrameInput::new(frame, poses, field);
        reference.step_frame(&input);
        fast.step_frame(&input);
        let pairs = reference.positions().iter().zip(fast.strands().points());
        distances.extend(pairs.map(|(a, b)| a.distance(b.as_dvec3())));
    }
    distances.sort_by(f64::total_cmp);
    distances
}

fn share(distances: &[f64], share: f64) -> f64 {
    distances[((distances.len() - 1) as f64 * share) as usize]
}

#[test]
fn the_fast_stepper_follows_the_specification() {
    let calm = Dynamics { pseudo_force: PseudoForce::off(), ..gust() };
    let poses = way_of_a_head(HORIZON);
    let tilted = Dynamics { polar_axis: poses[0].up_in_head(), ..calm.clone() };
    let disturbed = Dynamics { disturbance: Some(Disturbance { over: 4, ..Default::default() }), ..tilted.clone() };
    let still = [];
    let cases: [(&Dynamics, &dyn Field, &[Pose]); 4] = [
        (&calm, &wind(), &still),
        (&tilted, &wind(), &poses),
        (&disturbed, &wind(), &poses),
        (&tilted, &Whirl, &poses),
    ];
    for (i, (dynamics, field, poses)) in cases.into_iter().enumerate() {
        let distances = distances(dynamics, field, poses, &hair(500, 18));
        let (typical, worst) = (share(&distances, 0.999), share(&distances, 1.0));
        assert!(typical < TYPICAL && worst < WORST, "case {i}: 99.9 %: {typical}, largest: {worst}");
    }
}

/// Increments of any size: the fast twin has a short way for those below a third of a radian and a long one.
#[test]
fn the_fast_stepper_follows_fast_swings_too() {
    let calm = Dynamics { pseudo_force: PseudoForce::off(), ..gust() };
    // c |F| up to 1 at the tip, 0.05 at the root.
    let field = field(&[(100, [-9000.0, -8000.0, 3000.0])]);
    let hair = hair(100, 18);
    let (mut reference, mut fast) = (exact(&hair, &calm, &field), fast(&hair, &calm, &field));
    let mut largest = 0.0_f64;
    for _ in 0..8 {
        step(&mut reference, &field);
        step(&mut fast, &field);
        let pairs = reference.positions().iter().zip(fast.strands().points());
        largest = pairs.map(|(a, b)| a.distance(b.as_dvec3())).fold(largest, f64::max);
    }
    // Eight steps of at most 3e-7 a segment, grown by up to e^(8 sqrt 1).
    assert!(largest < 18.0 * 8.0 * 3e-7 * 8_f64.exp(), "{largest}");
}

/// With the pseudo-force, a point within rounding of Gamma's edge may feel eps_i F in one twin and F in the other.
#[test]
fn the_edge_of_gamma_parts_few_strands() {
    let distances = distances(&gust(), &wind(), &[], &hair(500, 18));
    // 100 frames x 9000 points, each within 1e-5 of an edge with a chance of about 1e-5 / 1 cm: some ten crossings,
    // each of which moves the rest of its strand for the rest of the gust. 99 % of the points feel none.
    assert!(share(&distances, 0.99) < TYPICAL, "{}", share(&distances, 0.99));
}

#[test]
fn the_twins_part_as_two_specifications_a_rounding_apart_do() {
    let calm = Dynamics { pseudo_force: PseudoForce::off(), ..gust() };
    let hair = hair(300, 18);
    // One specification starts with its hair as it is, one with all points but the roots moved by one unit of their
    // last place, about what the fast one rounds in each of its steps.
    let mut nudged = hair.clone();
    for s in 0..nudged.len() {
        for p in &mut nudged.strand_mut(s)[1..] {
            *p = Vec3::new(p.x.next_up(), p.y.next_down(), p.z.next_up());
        }
    }
    let (mut reference, mut other) = (exact(&hair, &calm, &wind()), exact(&nudged, &calm, &wind()));
    let mut fast = fast(&hair, &calm, &wind());
    for _ in 0..400 {
        step(&mut reference, &wind());
        step(&mut other, &wind());
        step(&mut fast, &wind());
    }
    let apart = |there: &mut dyn Iterator<Item = DVec3>| {
        let mut d: Vec<f64> = reference.positions().iter().zip(there).map(|(a, b)| a.distance(b)).collect();
        d.sort_by(f64::total_cmp);
        share(&d, 0.99)
    };
    let (chaos, twin) = (
        apart(&mut other.positions().iter().copied()),
        apart(&mut fast.strands().points().iter().map(|p| p.as_dvec3())),
    );
    // The fast twin rounds 400 times where the other was moved once.
    assert!(chaos > 10.0 * 2e-6, "{chaos}: no growth to speak of");
    assert!(twin < 400.0 * chaos, "{twin} apart, specifications {chaos}");
}

fn running() -> Dynamics {
    Dynamics { disturbance: Some(Disturbance { from: 5, over: 3, ..Default::default() }), ..gust() }
}

/// Under a field that differs from place to place, one too strong for the short way of some lanes, a head that turns.
fn run_all(stepper: &mut dyn Stepper, frames: u32) -> Strands {
    let poses = way_of_a_head(frames);
    for frame in 1..=frames {
        let field: [&dyn Field; 2] = [&Whirl, &field(&[(1, [-2000.0, 500.0, 300.0])])];
        let field = field[usize::from(frame % 7 == 0)];
        stepper.step_frame(&FrameInput::new(frame, &poses, field));
    }
    stepper.strands().clone()
}

#[test]
fn any_number_of_threads_gives_the_same_bits() {
    let hair = mixed_hair(777);
    let result = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| bits(&run_all(&mut fast(&hair, &running(), &wind()), 40)))
    };
    let one = result(1);
    for threads in [2, 3, 7] {
        assert_eq!(result(threads), one, "{threads} threads");
    }
}

#[test]
fn any_vector_width_gives_the_same_bits() {
    let hair = mixed_hair(40);
    for polar_axis in [Vec3::Y, Vec3::new(0.2, 1.0, 0.4)] {
        let dynamics = Dynamics { polar_axis, ..running() };
        let result = |width| bits(&run_all(&mut fast(&hair, &dynamics, &wind()).with_vector_width(width), 25));
        let widest = result(VectorWidth::Widest);
        assert_eq!(result(VectorWidth::Medium), widest);
        assert_eq!(result(VectorWidth::Baseline), widest);
    }
}

#[test]
fn any_subset_in_any_order_moves_as_within_the_whole() {
    let hair = mixed_hair(200);
    let whole = run_all(&mut fast(&hair, &running(), &wind()), 60);
    let specified = run_all(&mut exact(&hair, &running(), &wind()), 60);
    for chosen in [vec![17], vec![199, 3, 90], (0..200).rev().step_by(3).collect::<Vec<usize>>()] {
        let ids: Vec<u32> = chosen.iter().map(|&s| s as u32).collect();
        let part = hair.select(&chosen);
        let fast = run_all(&mut Simulation::with_ids(&part, &ids, &running(), &wind()).unwrap(), 60);
        assert_eq!(bits(&fast), bits(&whole.select(&chosen)));
        let reference = run_all(&mut Reference::with_ids(&part, &ids, &running(), &wind()).unwrap(), 60);
        assert_eq!(bits(&reference), bits(&specified.select(&chosen)));
    }
}

#[test]
fn the_disturbance_parts_the_hair_but_keeps_to_its_frames() {
    let hair = mixed_hair(50);
    let (mut calm, mut disturbed) = (fast(&hair, &gust(), &wind()), fast(&hair, &running(), &wind()));
    assert_eq!(bits(&run(&mut calm, &wind(), 9)), bits(&run(&mut disturbed, &wind(), 9)));
    step(&mut calm, &wind());
    step(&mut disturbed, &wind());
    assert_ne!(bits(calm.strands()), bits(disturbed.strands()));
}

/// Hair that nothing else moves shows the disturbance alone.
#[test]
fn a_disturbance_over_more_frames_goes_as_far_and_jolts_less() {
    let (hair, still) = (hair(100, 18), field(&[(100, [0.0; 3])]));
    let tips = |over: u32, exactly: bool| -> Vec<Vec<Vec3>> {
        let disturbance = Some(Disturbance { over, ..Default::default() });
        let dynamics = Dynamics { disturbance, ..gust() };
        let mut stepper: Box<dyn Stepper> = match exactly {
            true => Box::new(exact(&hair, &dynamics, &still)),
            false => Box::new(fast(&hair, &dynamics, &still)),
        };
        let mut frames = Vec::new();
        for _ in 0..29 {
            step(&mut *stepper, &still);
            frames.push(stepper.strands().iter().map(|strand| strand[18]).collect());
        }
        frames
    };
    let jolt = |frames: &[Vec<Vec3>]| {
        let second = |w: &[Vec<Vec3>], s: usize| (w[0][s] - 2.0 * w[1][s] + w[2][s]).length();
        let all = frames.windows(3).flat_map(|w| (0..100).map(move |s| second(w, s)));
        all.fold(0.0, f32::max)
    };
    for exactly in [true, false] {
        let (at_once, slow) = (tips(1, exactly), tips(10, exactly));
        for (a, b) in at_once[28].iter().zip(&slow[28]) {
            // Ten turns of f32 in the place of one.
            assert!(a.distance(*b) < 10.0 * 18.0 * 4e-7 + 4e-6, "{a} {b}");
        }
        // 6 / 10^2 of the jump, and the bend of the arc that the tip goes along: its square over the length, 9 cm or
        // more away.
        let (jump, jolt) = (jolt(&at_once), jolt(&slow));
        assert!(jolt < 0.06 * jump + jump * jump / 9.0, "{jolt} after {jump}");
    }
}

#[test]
fn a_step_allocates_nothing() {
    // In a pool of one thread all the work happens on the thread that counts.
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
    pool.install(|| {
        let field = wind();
        let mut fast = fast(&mixed_hair(300), &running(), &field);
        step(&mut fast, &field);
        let before = allocations();
        for _ in 0..30 {
            step(&mut fast, &field);
            step(&mut fast, &Whirl);
        }
        assert_eq!(allocations(), before);
    });
}
