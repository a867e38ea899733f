//! The same motion at another rate of steps.

mod common;

use common::{fast, field, free, gust, hair, wind, with_neighbours};
use glam::{Quat, Vec3};
use nabiki::body::{Body, BodyWay, Contact};
use nabiki::disturbance::Disturbance;
use nabiki::dynamics::{Dynamics, Form, FrameInput, Motion, Stepper};
use nabiki::free_form::{FreeForm, NeighbourForces};
use nabiki::{Pose, Strands};
use nabiki_groom::bust;

fn mean(a: &Strands, b: &Strands) -> f32 {
    a.points().iter().zip(b.points()).map(|(a, b)| a.distance(*b)).sum::<f32>() / a.points().len() as f32
}

/// Hair after a second, and the mean way of its points in the frame in which that is the longest.
fn after_a_second(dynamics: &Dynamics, hair: &Strands) -> (Strands, f32) {
    let rate = dynamics.motion.frame_rate;
    let pose = |n: u32| {
        let t = (f64::from(n) / rate) as f32;
        let rotation = Quat::from_rotation_y(0.3 * (4.0 * t).sin());
        Pose { position_cm: Vec3::new(5.0 * (3.0 * t).sin(), 0.0, 0.0), rotation }
    };
    let poses: Vec<Pose> = (0..=rate as u32).map(pose).collect();
    let mut simulation = fast(hair, dynamics, &wind());
    let mut longest = 0.0_f32;
    for frame in 1..=rate as u32 {
        let t = (f64::from(frame) / rate) as f32;
        let before = simulation.strands().clone();
        let blows = field(&[(1, [-150.0 * (2.0 * t).sin(), 0.0, 40.0])]);
        simulation.step_frame(&FrameInput::new(frame, &poses, &blows));
        longest = longest.max(mean(&before, simulation.strands()));
    }
    (simulation.strands().clone(), longest)
}

/// The scheme is of first order: from rest it is half a frame ahead, and its friction weakens forces by 1 / settle, so that it may be
/// about a frame off; from one rate to twice that half of it goes.
#[test]
fn settings_at_another_rate_give_the_same_motion_in_seconds() {
    let hair = hair(60, 18);
    let form = FreeForm { stiffness: 3000.0.into(), settle: 8.0.into(), ..FreeForm::default() };
    for dynamics in [gust(), free(form.clone()), with_neighbours(free(form))] {
        let at = [24.0, 48.0, 96.0].map(|rate| after_a_second(&dynamics.at_frame_rate(rate).unwrap(), &hair));
        let [once, twice] = [mean(&at[0].0, &at[1].0), mean(&at[1].0, &at[2].0)];
        println!("{once} {twice} of {} a frame, {} in all", at[0].1, mean(&at[0].0, &hair));
        assert!(once < at[0].1 && twice < at[1].1);
        assert!((0.35..0.65).contains(&(twice / once)), "{once} {twice}");
        let left = Dynamics { motion: Motion { frame_rate: 48.0, ..dynamics.motion.clone() }, ..dynamics };
        assert!(mean(&at[1].0, &after_a_second(&left, &hair).0) > 3.0 * once);
    }
}

#[test]
fn another_rate_scales_what_is_counted_in_frames_and_nothing_else() {
    let way: Vec<Pose> = (0..=100).map(|n| Pose { position_cm: Vec3::X * (n * n) as f32, ..Pose::STILL }).collect();
    let head = Body::head(&bust(), Contact::default());
    let mut dynamics = with_neighbours(free(FreeForm { settle: 8.0.into(), ..FreeForm::default() }));
    if let Form::Free(free) = &mut dynamics.form {
        let mut goes = head.clone();
        goes.way = BodyWay::InWorld(way.into());
        free.bodies = vec![head, goes];
    }
    assert_eq!(dynamics.at_frame_rate(24.0).unwrap().motion, dynamics.motion);
    let at = dynamics.at_frame_rate(60.0).unwrap();
    assert_eq!((at.motion.frames, at.motion.frame_rate, at.motion.time_step), (250, 60.0, 0.04));
    let (Form::Free(free), Form::Free(before)) = (&at.form, &dynamics.form) else { panic!("the free form") };
    assert_eq!(free.form, FreeForm { settle: 20.0.into(), ..before.form.clone() });
    let forces = &free.neighbours.as_ref().unwrap().forces;
    assert_eq!(*forces, NeighbourForces { cohesion: 100.0, ..NeighbourForces::default() });
    let place = |frame: u32| free.bodies[1].way.pose(frame, &Pose::STILL).position_cm.x;
    // Frame 6 is frame 2.4 of before: 4 + 0.4 * (9 - 4).
    assert_eq!([0, 5, 250].map(place), [0.0, 4.0, 10_000.0]);
    assert!((place(6) - 6.0).abs() < 1e-5);
    assert_eq!(free.bodies[0].way, BodyWay::WithHead);

    let disturbance = Some(Disturbance { every: 10, from: 40, over: 4, ..Disturbance::default() });
    let at = Dynamics { disturbance, ..gust() }.at_frame_rate(48.0).unwrap().disturbance.unwrap();
    assert_eq!((at.every, at.from, at.over), (20, 80, 8));
    for (rate, thing) in [(0.0, "motion.frame_rate"), (f64::NAN, "motion.frame_rate"), (1e9, "motion.frames")] {
        assert_eq!(gust().at_frame_rate(rate).unwrap_err().thing, thing);
    }
}
