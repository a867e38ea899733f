//! Bodies whose poses are told in each step, as an engine's are whose player moves them.

#[path = "common/allocations.rs"]
mod allocations;
mod common;

use std::sync::Arc;

use allocations::allocations;
use common::{ball, bits, exact, fast, gust, hair, way_of_a_head, wind};
use glam::{Quat, Vec3};
use nabiki::Pose;
use nabiki::body::{Body, BodyWay, Contact, skin_of};
use nabiki::dynamics::{Dynamics, Form, FrameInput, Motion, Stepper};
use nabiki::free_form::{FreeMotion, NeighbourForces, Neighbours};
use nabiki::pseudo_force::PseudoForce;
use nabiki_groom::bust;

const FRAMES: u32 = 40;

/// A ball that turns, comes through the hair beside a head that goes its way, and goes again.
fn way_of_the_ball() -> Vec<Pose> {
    (way_of_a_head(FRAMES).iter().enumerate())
        .map(|(n, head)| {
            let t = n as f32 / FRAMES as f32;
            let place = Vec3::new(40.0 * t - 20.0, 2.0 - 6.0 * t, 11.0);
            Pose { position_cm: head.position_cm + place, rotation: Quat::from_rotation_z(3.0 * t) }
        })
        .collect()
}

/// The head, a ball that goes this way, one more that stands still, carriers.
fn among(way: Vec<Pose>) -> Dynamics {
    let skin = Arc::new(skin_of(ball(4.0), "ball").unwrap());
    let contact = Contact { margin: 0.2, friction: 0.4, static_friction: 0.6 };
    let body = |name: &str, way: Vec<Pose>| Body::new(name, skin.clone(), BodyWay::InWorld(way.into()), contact);
    let still = way_of_a_head(FRAMES)[20].position_cm + Vec3::new(-12.0, 0.0, 0.0);
    let bodies = vec![
        Body::head(&bust(), Contact::default()),
        body("body[0]", vec![Pose { position_cm: still, ..Pose::STILL }]),
        body("body[1]", way),
    ];
    let neighbours = Some(Neighbours::new(NeighbourForces::default(), Arc::new(hair(24, 18))));
    let free = FreeMotion { bodies, neighbours, rest_pose: way_of_a_head(0)[0], ..Default::default() };
    let motion = Motion { frames: FRAMES, ..Motion::default() };
    Dynamics { motion, pseudo_force: PseudoForce::off(), form: Form::Free(free), ..gust() }
}

/// All frames; `told`: what a step is told of the bodies.
fn run(stepper: &mut dyn Stepper, told: impl Fn(usize) -> [Option<[Pose; 2]>; 3]) -> Vec<Vec<[u32; 3]>> {
    let poses = way_of_a_head(FRAMES);
    (1..=FRAMES)
        .map(|frame| {
            let bodies = &told(frame as usize);
            stepper.step_frame(&FrameInput::new(frame, &poses, &wind()).with_bodies(bodies));
            bits(stepper.strands())
        })
        .collect()
}

#[test]
fn a_body_told_frame_by_frame_is_met_as_on_its_way_to_the_bit() {
    let (hair, way) = (hair(80, 18), way_of_the_ball());
    let (known, told) = (among(way.clone()), among(vec![way[0]]));
    let by_way = |_: usize| [None; 3];
    let by_step = |frame: usize| [None, None, Some([way[frame], way[frame - 1]])];
    let on_its_way = run(&mut fast(&hair, &known, &wind()), by_way);
    assert!(run(&mut fast(&hair, &told, &wind()), by_step) == on_its_way);
    // What a body is told goes before its way.
    assert!(run(&mut fast(&hair, &known, &wind()), by_step) == on_its_way);
    // It is met, and so is its motion.
    assert!(run(&mut fast(&hair, &told, &wind()), by_way) != on_its_way);
    assert!(run(&mut fast(&hair, &told, &wind()), |frame| [None, None, Some([way[frame]; 2])]) != on_its_way);

    let [mut one, mut other] = [&known, &told].map(|dynamics| exact(&hair, dynamics, &wind()));
    run(&mut one, by_way);
    run(&mut other, by_step);
    let exact_bits = |p: &glam::DVec3| p.to_array().map(f64::to_bits);
    assert!(one.positions().iter().map(exact_bits).eq(other.positions().iter().map(exact_bits)));
}

#[test]
fn a_step_that_is_told_of_bodies_allocates_nothing() {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
    pool.install(|| {
        let (way, poses, wind) = (way_of_the_ball(), way_of_a_head(FRAMES), wind());
        let mut simulation = fast(&hair(40, 18), &among(vec![way[0]]), &wind);
        let before = allocations();
        for frame in 1..FRAMES as usize {
            let bodies = &[None, None, Some([way[frame], way[frame - 1]])];
            simulation.step_frame(&FrameInput::new(frame as u32, &poses, &wind).with_bodies(bodies));
        }
        assert_eq!(allocations(), before);
    });
}

#[test]
fn a_body_that_is_put_elsewhere_is_met_there_once_it_is_said_to_have_jumped() {
    let mut dynamics = among(vec![Pose { position_cm: Vec3::splat(500.0), ..Pose::STILL }]);
    if let Form::Free(free) = &mut dynamics.form {
        // Alone beside hair that rests.
        (free.neighbours, free.rest_pose) = (None, Pose::STILL);
        free.bodies.drain(..2);
    }
    let hair = hair(80, 18);
    let mut simulation = fast(&hair, &dynamics, &wind());
    let there = Pose { position_cm: Vec3::new(14.0, 2.0, 0.0), ..Pose::STILL };
    let calm = nabiki::field::FieldSum::default();
    let inside = |points: &[Vec3]| points.iter().filter(|p| p.distance(there.position_cm) < 4.0).count();
    assert!(inside(hair.points()) > 5);
    simulation.jumped();
    simulation.step_frame(&FrameInput::new(1, &[], &calm).with_bodies(&[Some([there; 2])]));
    assert_eq!(inside(simulation.strands().points()), 0);
}

/// A number of a body that there is not, and hair that meets none.
#[test]
fn what_is_told_of_no_body_changes_nothing() {
    let hair = hair(20, 18);
    for dynamics in [gust(), Dynamics { form: Form::Free(FreeMotion::default()), ..gust() }] {
        let told = run(&mut fast(&hair, &dynamics, &wind()), |_| [Some([Pose::STILL; 2]); 3]);
        assert!(told == run(&mut fast(&hair, &dynamics, &wind()), |_| [None; 3]));
    }
}

/// What a game's numbers are when they went wrong: a step takes them as they come, and a rewind leaves nothing of them.
#[test]
fn poses_that_are_no_numbers_do_not_stop_a_step_and_are_gone_after_a_rewind() {
    let (hair, way) = (hair(40, 18), way_of_the_ball());
    let dynamics = among(vec![way[0]]);
    let by_step = |frame: usize| [None, None, Some([way[frame], way[frame - 1]])];
    let well = run(&mut fast(&hair, &dynamics, &wind()), by_step);
    let wrong = [
        Pose { position_cm: Vec3::NAN, ..Pose::STILL },
        Pose { position_cm: Vec3::INFINITY, ..Pose::STILL },
        Pose { position_cm: Vec3::splat(1e30), ..Pose::STILL },
        Pose { rotation: Quat::from_xyzw(f32::NAN, 0.0, 0.0, 1.0), ..Pose::STILL },
        Pose { rotation: Quat::from_xyzw(0.0, 0.0, 0.0, 0.0), ..Pose::STILL },
        Pose { rotation: Quat::from_xyzw(1e20, 0.0, 0.0, 1e20), ..Pose::STILL },
    ];
    let poses = way_of_a_head(FRAMES);
    for pose in wrong {
        let field = wind();
        let mut simulation = fast(&hair, &dynamics, &field);
        let mut reference = exact(&hair, &dynamics, &field);
        let steppers: [&mut dyn Stepper; 2] = [&mut simulation, &mut reference];
        for stepper in steppers {
            // The body's, then the head's.
            for (frame, bodies, head) in [
                (1, [None, None, Some([pose; 2])], poses[1]),
                (2, [None, None, Some([pose, way[1]])], poses[2]),
                (3, [None; 3], pose),
            ] {
                let mut input = FrameInput::new(frame, &poses, &field).with_bodies(&bodies);
                input.pose = head;
                stepper.step_frame(&input);
            }
        }
        simulation.rewind();
        assert!(run(&mut simulation, by_step) == well, "{pose:?}");
    }
}
