//! The fast stepper as an engine uses it: on any thread, under wind that is bounded beforehand, saved, restored and put back to
//! rest without an allocation.

#[path = "common/allocations.rs"]
mod allocations;
mod common;

use std::sync::Arc;

use allocations::allocations;
use common::{ball, bits, fast, field, gust, hair, way_of_a_head, wind};
use glam::{Quat, Vec3};
use nabiki::body::{Body, BodyWay, Contact, skin_of};
use nabiki::dynamics::{Dynamics, Form, FrameInput, Motion, Played, Reference, Simulation, Stepper, Timeline};
use nabiki::field::{Field, FieldSum, UniformField};
use nabiki::free_form::{FreeMotion, NeighbourForces, Neighbours};
use nabiki::pseudo_force::PseudoForce;
use nabiki::{Head, Pose, Profile, Strands};
use nabiki_groom::bust;

/// The free form among a head and neighbours.
fn crowded() -> Dynamics {
    let neighbours = Neighbours::new(NeighbourForces::default(), Arc::new(hair(24, 18)));
    let mut free = FreeMotion { neighbours: Some(neighbours), rest_pose: way_of_a_head(0)[0], ..Default::default() };
    free.bodies = vec![Body::head(&bust(), Contact::default())];
    Dynamics { pseudo_force: PseudoForce::off(), form: Form::Free(free), ..gust() }
}

fn farthest(a: &Strands, b: &Strands) -> f32 {
    a.points().iter().zip(b.points()).map(|(a, b)| a.distance(*b)).fold(0.0, f32::max)
}

fn run(simulation: &mut Simulation, frames: std::ops::RangeInclusive<u32>) -> Vec<[u32; 3]> {
    let poses = way_of_a_head(40);
    for frame in frames {
        simulation.step_frame(&FrameInput::new(frame, &poses, &wind()));
    }
    bits(simulation.strands())
}

#[test]
fn what_an_engine_holds_goes_to_any_thread() {
    fn is_free<T: Send + Sync>() {}
    is_free::<Simulation>();
    is_free::<Timeline>();
    is_free::<Reference>();
    is_free::<Played>();
    is_free::<Head>();
    is_free::<Dynamics>();
    is_free::<FrameInput>();
}

#[test]
fn a_saved_state_moves_on_to_the_same_bits_and_nothing_is_allocated_to_save_it() {
    for dynamics in [gust(), crowded()] {
        // Few enough strands for one thread, whose allocations are counted.
        let mut simulation = fast(&hair(100, 18), &dynamics, &wind());
        let at_rest = bits(simulation.strands());
        let mut saved = simulation.clone();
        let tenth = run(&mut simulation, 1..=10);
        let before = allocations();
        saved.set_state(&simulation).unwrap();
        assert_eq!(allocations(), before);
        let twentieth = run(&mut simulation, 11..=20);
        assert!(tenth != twentieth);
        let before = allocations();
        simulation.set_state(&saved).unwrap();
        assert_eq!(allocations(), before);
        assert!((simulation.frame(), bits(simulation.strands())) == (10, tenth));
        assert!(run(&mut simulation, 11..=20) == twentieth);
        assert!(run(&mut saved, 11..=20) == twentieth);

        let before = allocations();
        simulation.rewind();
        assert_eq!(allocations(), before);
        assert!((simulation.frame(), bits(simulation.strands())) == (0, at_rest));
        run(&mut simulation, 1..=10);
        assert!(run(&mut simulation, 11..=20) == twentieth);
    }
}

#[test]
fn a_state_is_refused_as_its_bytes_are() {
    let of = |segments: usize, dynamics: &Dynamics| fast(&hair(10, segments), dynamics, &wind());
    let mut one = of(18, &crowded());
    run(&mut one, 1..=5);
    let before = one.state_bytes();
    for (other, why) in [(of(9, &crowded()), "is of other hair"), (of(18, &gust()), "is of the paper's form")] {
        let refused = one.set_state(&other).unwrap_err();
        assert_eq!(Err(refused.clone()), one.set_state_bytes(&other.state_bytes()));
        assert!(refused.remedy.starts_with(why), "{refused}");
        assert!(one.state_bytes() == before);
    }
}

#[test]
fn the_strongest_force_is_the_last_that_is_not_refused() {
    for dynamics in [gust(), crowded()] {
        let hair = hair(20, 18);
        let strongest = fast(&hair, &dynamics, &FieldSum::default()).strongest_force();
        let of = |strength: f32| field(&[(1, [-strength, 0.0, 0.0])]);
        let accepted = |strength: f32| Simulation::new(&hair, &dynamics, &of(strength)).is_ok();
        assert_eq!([strongest, strongest.next_up()].map(accepted), [true, false], "{strongest}");
    }
}

#[test]
fn a_frame_that_is_none_does_not_panic() {
    let mut simulation = fast(&hair(20, 18), &crowded(), &wind());
    let mut reference = Reference::new(&hair(20, 18), &crowded(), &wind()).unwrap();
    let (poses, calm) = (way_of_a_head(1), FieldSum::default());
    let input = FrameInput::new(0, &poses, &calm);
    simulation.step_frame(&input);
    reference.step_frame(&input);
    assert_eq!((simulation.frame(), reference.frame()), (0, 0));
}

#[test]
fn a_head_that_jumps_takes_its_hair_along() {
    let dynamics = Dynamics { form: Form::Free(FreeMotion::default()), pseudo_force: PseudoForce::off(), ..gust() };
    let hair = hair(20, 18);
    let mut simulation = fast(&hair, &dynamics, &FieldSum::default());
    let there = Pose { position_cm: Vec3::new(1e4, -3e3, 2.0), rotation: Quat::from_rotation_y(2.0) };
    let calm: &dyn Field = &FieldSum::default();
    let input = |before| FrameInput::live(1, there, before, calm);
    simulation.step_frame(&input([there; 2]));
    // But for the rounding of its weight under a head that is turned otherwise.
    assert!(farthest(simulation.strands(), &hair) < 1e-5);
    simulation.step_frame(&input([Pose::STILL; 2]));
    assert!(farthest(simulation.strands(), &hair) > 1.0);
}

#[test]
fn a_head_that_jumps_beside_a_body_of_the_world_keeps_its_hair_out_of_it() {
    let skin = Arc::new(skin_of(ball(5.0), "ball").unwrap());
    // Where hair rests that hangs before the face, without the head.
    let beside = Vec3::new(15.0, 2.0, 0.0);
    let way = BodyWay::InWorld([Pose { position_cm: Vec3::new(200.0, 0.0, 0.0), ..Pose::STILL }].into());
    let body = Body::new("body[0]", skin.clone(), way, Contact::default());
    let free = FreeMotion { bodies: vec![body], ..Default::default() };
    let dynamics = Dynamics { form: Form::Free(free), pseudo_force: PseudoForce::off(), ..gust() };
    let (hair, calm) = (hair(200, 18), FieldSum::default());
    let pose = Pose { position_cm: Vec3::new(200.0, 0.0, 0.0) - beside, ..Pose::STILL };
    let inside = |simulation: &Simulation| {
        simulation.strands().points().iter().filter(|p| skin.at(**p - beside) < -0.01).count()
    };
    let mut simulation = fast(&hair, &dynamics, &calm);
    assert!(inside(&simulation) > 20, "{}", inside(&simulation));
    for rewound in [false, true] {
        if rewound {
            simulation.rewind();
        }
        simulation.jumped();
        simulation.step_frame(&FrameInput::new(1, &[pose], &calm));
        assert_eq!(inside(&simulation), 0, "rewound: {rewound}");
    }
}

#[test]
fn to_look_for_contact_anew_changes_no_bit() {
    let mut simulation = fast(&hair(100, 18), &crowded(), &wind());
    let mut looking = simulation.clone();
    for frame in 1..=20 {
        looking.jumped();
        assert!(run(&mut simulation, frame..=frame) == run(&mut looking, frame..=frame), "frame {frame}");
    }
}

#[test]
fn hair_stepped_twice_as_often_moves_alike() {
    let hair = hair(60, 18);
    let pose = |seconds: f32| Pose {
        position_cm: Vec3::new(10.0 * (1.0 - (3.0 * seconds).cos()), 0.0, 0.0),
        rotation: Quat::from_rotation_y(0.3 * (1.0 - (4.0 * seconds).cos())),
    };
    let after_a_second = |rate: u32, time_step: f32| {
        // Held so firmly that nothing buckles, and so limp that no ripple is faster than a step can follow.
        let mut free = FreeMotion::default();
        free.form.settle = Profile::Even(rate as f32 / 3.0);
        (free.form.stiffness, free.form.hold, free.form.gravity) = (0.0.into(), 100.0.into(), 0.0);
        let motion = Motion { frame_rate: f64::from(rate), time_step, ..Motion::default() };
        let dynamics = Dynamics { motion, pseudo_force: PseudoForce::off(), form: Form::Free(free), ..gust() };
        let poses: Vec<Pose> = (0..=rate).map(|n| pose(n as f32 / rate as f32)).collect();
        let mut simulation = fast(&hair, &dynamics, &wind());
        for frame in 1..=rate {
            let grown = (1.5 * frame as f32 / rate as f32).sin().powi(2);
            let vector = [-60.0 * grown, 0.0, 20.0 * grown];
            simulation.step_frame(&FrameInput::new(frame, &poses, &field(&[(1, vector)])));
        }
        simulation.strands().clone()
    };
    let mean = |a: &Strands, b: &Strands| {
        a.points().iter().zip(b.points()).map(|(a, b)| a.distance(*b)).sum::<f32>() / a.points().len() as f32
    };
    let at = [(120, 0.08), (240, 0.04), (480, 0.02)].map(|(rate, time_step)| after_a_second(rate, time_step));
    let [way, once, twice] = [mean(&at[0], &hair), mean(&at[0], &at[1]), mean(&at[1], &at[2])];
    // The scheme's error is of first order: it halves.
    assert!(once < 0.05 * way && (0.4..0.6).contains(&(twice / once)), "{way} {once} {twice}");
    assert!(mean(&at[0], &after_a_second(240, 0.08)) > 10.0 * once);
}

#[test]
fn a_pose_between_two_lies_on_the_shorter_way() {
    let from = Pose { position_cm: Vec3::X, rotation: Quat::from_rotation_y(0.2) };
    // The same rotation with the other sign.
    let to = Pose { position_cm: Vec3::new(3.0, 4.0, 0.0), rotation: -Quat::from_rotation_y(1.0) };
    let near = |a: Pose, b: Pose| {
        a.position_cm.distance(b.position_cm) < 1e-6 && a.rotation.dot(b.rotation).abs() > 1.0 - 1e-6 && a.is_valid()
    };
    assert!(near(from.between(&to, 0.0), from) && near(from.between(&to, 1.0), to));
    let quarter = Pose { position_cm: Vec3::new(1.5, 1.0, 0.0), rotation: Quat::from_rotation_y(0.4) };
    assert!(near(from.between(&to, 0.25), quarter));
    assert!(near(from.between(&from, 0.5), from));
}

#[test]
fn between_two_steps_segments_keep_their_length() {
    let hair = hair(30, 18);
    let mut simulation = fast(&hair, &gust(), &wind());
    run(&mut simulation, 1..=19);
    let before = simulation.strands().points().to_vec();
    run(&mut simulation, 20..=20);
    let now = simulation.strands();
    let mut points = before.clone();
    let lengths = |points: &[Vec3]| -> Vec<f32> {
        points
            .chunks(19)
            .flat_map(|strand| strand.windows(2).map(|w| w[0].distance(w[1])).collect::<Vec<_>>())
            .collect()
    };
    let shorter =
        |points: &[Vec3]| lengths(&before).iter().zip(lengths(points)).map(|(a, b)| a - b).fold(0.0, f32::max);
    for part in [0.0, 0.25, 0.5, 0.9, 1.0] {
        now.between(&before, part, &mut points);
        // Coordinates of up to 32 cm, rounded at both ends of both.
        assert!(shorter(&points) < 2e-5, "{part}: {}", shorter(&points));
        let farthest = |to: &[Vec3]| points.iter().zip(to).map(|(a, b)| a.distance(*b)).fold(0.0, f32::max);
        // Eighteen roundings of up to 2e-6 cm.
        assert!(part != 0.0 || farthest(&before) < 5e-5);
        assert!(part != 1.0 || farthest(now.points()) < 5e-5);
    }
    let mean: Vec<Vec3> = before.iter().zip(now.points()).map(|(a, b)| 0.5 * (*a + *b)).collect();
    assert!(shorter(&mean) > 1e-3, "a mean of points shortens segments: {}", shorter(&mean));

    // In the middle of a turn by 80 degrees: at 40, and 10 cm long. Right about: the nearer in time.
    let straight = |angle: f32| [Vec3::ZERO, 10.0 * Vec3::new(angle.cos(), angle.sin(), 0.0)];
    let turned = |by: f32, part: f32| {
        let mut strands = Strands::default();
        strands.push(straight(by.to_radians()));
        let mut points = [Vec3::ZERO; 2];
        strands.between(&straight(0.0), part, &mut points);
        points[1]
    };
    assert!(turned(80.0, 0.5).distance(straight(40_f32.to_radians())[1]) < 1e-5);
    for (part, angle) in [(0.0, 0.0), (0.499_999_9, 0.0), (0.5, 180.0), (1.0, 180.0)] {
        assert!(turned(180.0, part).distance(straight(f32::to_radians(angle))[1]) < 1e-5, "{part}");
    }
    // Strands of no segment, and none.
    let mut lone = Strands::default();
    lone.push([Vec3::X]);
    lone.push([]);
    let mut point = [Vec3::ZERO];
    lone.between(&[Vec3::ZERO], 0.25, &mut point);
    assert_eq!(point, [Vec3::new(0.25, 0.0, 0.0)]);
    Strands::default().between(&[], 0.5, &mut []);
}

#[test]
fn a_uniform_field_is_the_wind_that_it_is_set_to() {
    for dynamics in [gust(), crowded()] {
        let [mut set, mut given] = [(); 2].map(|()| fast(&hair(20, 18), &dynamics, &UniformField::default()));
        let mut wind = UniformField::default();
        for (frame, vector) in (1..).zip([[-90.0, 10.0, 0.0], [0.0; 3], [0.0, -40.0, 70.0]]) {
            wind.0 = vector.into();
            set.step_frame(&FrameInput::new(frame, &[], &wind));
            given.step_frame(&FrameInput::new(frame, &[], &field(&[(frame, vector)])));
            assert!(bits(set.strands()) == bits(given.strands()));
        }
        assert_eq!((wind.strongest(), UniformField(Vec3::new(2.0, 3.0, 6.0)).strongest()), (wind.0.length(), 7.0));
    }
}

#[test]
fn a_clone_of_the_reference_moves_on_by_itself() {
    for dynamics in [gust(), crowded()] {
        let mut reference = Reference::new(&hair(4, 18), &dynamics, &wind()).unwrap();
        common::step(&mut reference, &wind());
        let mut saved = reference.clone();
        let first = reference.positions().to_vec();
        common::step(&mut reference, &wind());
        assert!(saved.positions() == first && reference.positions() != first);
        common::step(&mut saved, &wind());
        assert!(saved.positions() == reference.positions());
    }
}

#[test]
fn unstable_hair_that_may_be_in_metres_is_said_to_be() {
    let refusal = |scale: f32, head: f32, force: f32| {
        let mut dynamics = gust();
        dynamics.ellipsoid.half_axes *= head;
        let blows = field(&[(1, [force, 0.0, 0.0])]);
        let hair = common::map(&hair(5, 18), |p| scale * p);
        Simulation::new(&hair, &dynamics, &blows).err().map(|refused| refused.to_string())
    };
    let metres = refusal(0.01, 0.01, 100.0).unwrap();
    let hint = "; the longest strand is 0.18 cm and the head's mean half axis is 0.10 cm: if that is in metres, convert it to cm (times 100)";
    assert!(metres.ends_with(hint), "{metres}");
    assert!(refusal(0.01, 1.0, 100.0).unwrap().contains("strand is 0.18 cm: if"));
    assert!(refusal(1.0, 0.01, 1e5).unwrap().contains("axis is 0.10 cm: if"));
    // Too strong a force on hair and head of a person's, and hair in metres under forces that it bears.
    assert!(!refusal(1.0, 1.0, 1e5).unwrap().contains("metres"));
    assert_eq!(refusal(0.01, 0.01, 1e-9), None);
}
