//! The fast step of the free form against itself, among bodies and neighbours: the same bits from any number of threads,
//! any vector width, within any subset, from the timeline; and no allocation.

#[path = "common/allocations.rs"]
mod allocations;
mod common;

use std::sync::Arc;

use allocations::allocations;
use common::{Whirl, bits, fast, field, gust, hair, mixed_hair, step, way_of_a_head, wind};
use glam::Vec3;
use nabiki::body::{Body, BodyWay, Contact};
use nabiki::dynamics::{Dynamics, Form, FrameInput, Motion, Simulation, Stepper, Timeline, VectorWidth};
use nabiki::field::Field;
use nabiki::free_form::{FreeMotion, NeighbourForces, Neighbours};
use nabiki::locks::LockVariation;
use nabiki::pseudo_force::PseudoForce;
use nabiki::{Pose, Profile, Strands};
use nabiki_groom::bust;

/// Frames of the head's way.
const FRAMES: u32 = 40;

/// All that a step may depend on: the head, another one that goes beside it in the world, carriers, profiles, locks.
fn crowded() -> Dynamics {
    let head = Body::head(&bust(), Contact { margin: 0.3, ..Contact::default() });
    let beside: Vec<Pose> = (way_of_a_head(FRAMES).into_iter())
        .map(|pose| Pose { position_cm: pose.position_cm + Vec3::new(-25.0, -3.0, 4.0), ..Pose::default() })
        .collect();
    let another = Body::new("body[0]", bust().skin().clone(), BodyWay::InWorld(beside.into()), head.contact);
    let mut free = FreeMotion { bodies: vec![head, another], rest_pose: way_of_a_head(0)[0], ..Default::default() };
    free.form.stiffness = Profile::RootToTip(vec![150.0, 40.0, 60.0]);
    free.form.variation = Some(LockVariation::default());
    free.neighbours = Some(Neighbours::new(NeighbourForces::default(), Arc::new(hair(24, 18))));
    let motion = Motion { frames: FRAMES, ..Motion::default() };
    Dynamics { motion, pseudo_force: PseudoForce::off(), form: Form::Free(free), ..gust() }
}

/// Under a field that differs from place to place, and a strong one now and then, a head that turns.
fn run_all(stepper: &mut dyn Stepper) -> Strands {
    let poses = way_of_a_head(FRAMES);
    for frame in 1..=FRAMES {
        let field: [&dyn Field; 2] = [&Whirl, &field(&[(1, [-400.0, 200.0, 300.0])])];
        let field = field[usize::from(frame % 7 == 0)];
        stepper.step_frame(&FrameInput::new(frame, &poses, field));
    }
    stepper.strands().clone()
}

#[test]
fn any_number_of_threads_gives_the_same_bits() {
    let (hair, dynamics) = (mixed_hair(333), crowded());
    let result = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| bits(&run_all(&mut fast(&hair, &dynamics, &wind()))))
    };
    let one = result(1);
    for threads in [2, 3, 7] {
        assert!(result(threads) == one, "{threads} threads");
    }
}

#[test]
fn any_vector_width_gives_the_same_bits() {
    let (hair, dynamics) = (mixed_hair(60), crowded());
    let result = |width| bits(&run_all(&mut fast(&hair, &dynamics, &wind()).with_vector_width(width)));
    let widest = result(VectorWidth::Widest);
    assert!(result(VectorWidth::Medium) == widest);
    assert!(result(VectorWidth::Baseline) == widest);
}

#[test]
fn any_subset_in_any_order_moves_as_within_the_whole() {
    let (hair, dynamics) = (mixed_hair(120), crowded());
    let whole = run_all(&mut fast(&hair, &dynamics, &wind()));
    for chosen in [vec![17], vec![119, 3, 90], (0..120).rev().step_by(3).collect::<Vec<usize>>()] {
        let part = run_all(&mut fast(&hair.select(&chosen), &dynamics, &wind()));
        assert!(bits(&part) == bits(&whole.select(&chosen)), "{chosen:?}");
    }
}

/// Without what is in the way of hair, its motion is another one: the tests above do meet it.
#[test]
fn bodies_and_neighbours_are_felt() {
    let hair = mixed_hair(60);
    let all = bits(&run_all(&mut fast(&hair, &crowded(), &wind())));
    for without in [|free: &mut FreeMotion| _ = free.bodies.pop(), |free: &mut FreeMotion| free.neighbours = None] {
        let mut dynamics = crowded();
        if let Form::Free(free) = &mut dynamics.form {
            without(free);
        }
        assert!(bits(&run_all(&mut fast(&hair, &dynamics, &wind()))) != all);
    }
}

#[test]
fn the_timeline_gives_the_frames_of_the_stepper_to_the_bit() {
    let (hair, dynamics, poses) = (mixed_hair(60), crowded(), way_of_a_head(FRAMES));
    let mut stepper = fast(&hair, &dynamics, &Whirl);
    let mut frames = vec![bits(stepper.strands())];
    for frame in 1..=FRAMES {
        stepper.step_frame(&FrameInput::new(frame, &poses, &Whirl));
        frames.push(bits(stepper.strands()));
    }
    let mut timeline = Timeline::new(&hair, &dynamics, Arc::new(Whirl), poses, FRAMES).unwrap();
    // Twice: what a motion left behind must not show in the next one.
    for _ in 0..2 {
        let film = timeline.play();
        for (frame, expected) in frames.iter().enumerate() {
            let found = film.points(frame as u32).iter().map(|p| p.to_array().map(f32::to_bits));
            assert!(found.eq(expected.iter().copied()), "frame {frame}");
        }
    }
}

#[test]
fn a_step_allocates_nothing() {
    // In a pool of one thread all the work happens on the thread that counts.
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
    pool.install(|| {
        let (field, poses) = (wind(), way_of_a_head(FRAMES));
        let mut simulation: Simulation = fast(&mixed_hair(120), &crowded(), &field);
        step(&mut simulation, &field);
        let before = allocations();
        for frame in 2..=FRAMES {
            let field: &dyn Field = if frame % 2 == 0 { &field } else { &Whirl };
            simulation.step_frame(&FrameInput::new(frame, &poses, field));
        }
        assert_eq!(allocations(), before);
    });
}
