//! Shipped scenes after their wind: hair that it has moved comes back to where it was groomed.

use std::path::Path;

use nabiki::dynamics::Stepper;
use nabiki_scene::template::template;
use nabiki_scene::{Scene, Shown};

/// Ten seconds at 24 frames a second.
const CALM: u32 = 240;

/// Tips no farther from rest than this (cm) are there.
const NEAR_CM: f32 = 0.05;

/// Ten seconds after the last vector, which is 0, tips are where they were at rest. One strand in a hundred may have been caught
/// behind an ear or below a jaw, which keep it out with the shape it has there.
#[test]
fn hair_is_back_in_place_ten_seconds_after_the_wind() {
    for name in ["gust", "side_wind", "curls", "ponytail", "fifty_thousand", "bob", "short"] {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("../../scenes/{name}.toml"));
        let mut scene = Scene::load(&path, &[]).unwrap();
        let wind = scene.field.force.clone();
        assert_eq!(wind.last().unwrap().vector, glam::Vec3::ZERO, "{name}: its wind ends");
        scene.motion.frames = wind.last().unwrap().through + CALM;
        let built = scene.build(Shown::First(300)).unwrap();
        let mut simulation = built.simulation().unwrap();
        let rest = simulation.strands().clone();
        let off = |now: &nabiki::Strands| -> Vec<f32> {
            let tips = rest.iter().zip(now.iter()).map(|(rest, now)| (rest[rest.len() - 1], now[now.len() - 1]));
            tips.map(|(rest, now)| rest.distance(now)).collect()
        };
        let mut farthest = 0.0_f32;
        for frame in 1..=built.frames() {
            simulation.step_frame(&built.input(frame));
            farthest = off(simulation.strands()).into_iter().fold(farthest, f32::max);
        }
        assert!(farthest > 2.0, "{name}: the wind moves no tip by more than {farthest} cm");
        let off = off(simulation.strands());
        let away = off.iter().filter(|&&off| off > NEAR_CM).count();
        assert!(100 * away <= off.len(), "{name}: {away} of {} tips are not back: {:?}", off.len(), off);
    }
}

/// No node of hair that lies after a gust goes farther than this in a frame (cm): what still slides goes slower, and what is thrown falls back by
/// the earth's gravity, which is 1.7 cm a frame each frame.
const STILL_CM: f32 = 0.3;

/// Frames in which hair must lie still, the last ones.
const LAST: usize = 20;

/// How far the fastest node of a new scene goes in each frame of a gust and of four calm seconds after it (cm), with these settings.
fn ways_of_a_new_scene(settings: &[(&str, &str)], strands: usize) -> Vec<f32> {
    let path = Path::new("new.toml");
    let text = template(path, None, &[], None).unwrap().text;
    let calm = [("force.2.speed", "\"0 km/h\""), ("motion.frames", "160")];
    let set: Vec<_> = calm.iter().chain(settings).map(|&(key, value)| (key.to_owned(), value.to_owned())).collect();
    let built = Scene::parse(&text, path, &set).unwrap().build(Shown::First(strands)).unwrap();
    let mut simulation = built.simulation().unwrap();
    let mut before = simulation.strands().clone();
    let way = |frame| {
        simulation.step_frame(&built.input(frame));
        let now = simulation.strands();
        let ways = now.points().iter().zip(before.points()).map(|(now, before)| now.distance(*before));
        let farthest = ways.fold(0.0, f32::max);
        before.clone_from(now);
        farthest
    };
    (1..=built.frames()).map(way).collect()
}

/// A new scene is in true timing at 24 frames a second, and its gust presses hair hard to ears and neck. Four seconds after it none of 3,000
/// strands hops on.
#[test]
fn hair_in_true_timing_lies_still_after_the_wind() {
    let ways = ways_of_a_new_scene(&[], 3000);
    assert!(ways.iter().any(|&way| way > 3.0), "the gust moves no node by more than 3 cm a frame");
    let last = &ways[ways.len() - LAST..];
    assert!(last.iter().all(|&way| way < STILL_CM), "in the last frames nodes go {last:?} cm");
}

/// Hair that bends under its own weight within 2 cm cannot carry its groomed shape itself. What supports it at rest must not drive it: then it
/// would whirl on, by 10 cm a frame.
#[test]
fn soft_hair_comes_to_rest_after_the_wind() {
    let ways = ways_of_a_new_scene(&[("free.stiffness", "[\"2 cm\",\"2 cm\"]")], 1000);
    let last = &ways[ways.len() - LAST..];
    assert!(last.iter().all(|&way| way < STILL_CM), "in the last frames nodes go {last:?} cm");
}

/// A hand that goes under the hair at the jaw and carries it off gives no node more than its own greatest speed within a frame: hair that is
/// pressed between hand and jaw is not whipped away by its own joints.
#[test]
fn a_hand_throws_no_hair() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/hand.toml");
    let built = Scene::load(&path, &[]).unwrap().build(Shown::AtMost(2000)).unwrap();
    let of_hand = |frame: u32| -> Vec<glam::Vec3> {
        let (_, mesh, pose) = built.shown_bodies(frame).next().unwrap();
        mesh.positions.iter().map(|&p| pose.position_cm + pose.rotation * p).collect()
    };
    let ways = |now: &[glam::Vec3], before: &[glam::Vec3]| -> Vec<glam::Vec3> {
        now.iter().zip(before).map(|(now, before)| *now - *before).collect()
    };
    let mut simulation = built.simulation().unwrap();
    let (mut hand, mut hair) = (of_hand(0), simulation.strands().points().to_vec());
    let (mut fastest, mut hardest) = (0.0_f32, 0.0_f32);
    let mut velocities = vec![glam::Vec3::ZERO; hair.len()];
    for frame in 1..=built.frames() {
        simulation.step_frame(&built.input(frame));
        let now = of_hand(frame);
        fastest = ways(&now, &hand).into_iter().map(glam::Vec3::length).fold(fastest, f32::max);
        hand = now;
        let after = ways(simulation.strands().points(), &hair);
        hardest = ways(&after, &velocities).into_iter().map(glam::Vec3::length).fold(hardest, f32::max);
        velocities = after;
        hair.copy_from_slice(simulation.strands().points());
    }
    assert!(
        hardest < fastest,
        "a node is {hardest} cm a frame faster than a frame before, the hand goes {fastest} at most"
    );
}
