//! Where hair stands, as bytes: read back to the bit, and refused where they are not what they should be.

#[path = "common/allocations.rs"]
mod allocations;
mod common;

use std::sync::Arc;

use allocations::allocations;
use common::{ball, bits, fast, free_motion, gust, hair, way_of_a_head, wind};
use glam::Vec3;
use nabiki::body::{Body, BodyWay, Contact, Shape, skin_of};
use nabiki::disturbance::Disturbance;
use nabiki::dynamics::{Dynamics, FrameInput, Simulation, Stepper};
use nabiki::field::FieldSum;
use nabiki::free_form::{FreeMotion, NeighbourForces, Neighbours};
use nabiki::obstacle::{Capsule, Obstacle};
use nabiki::{METHOD_VERSION, Pose, Strands};
use nabiki_groom::bust;

/// Among a head and neighbours.
fn crowded() -> Dynamics {
    let neighbours = Some(Neighbours::new(NeighbourForces::default(), Arc::new(hair(24, 18))));
    let bodies = vec![Body::head(&bust(), Contact::default())];
    free_motion(FreeMotion { neighbours, bodies, rest_pose: way_of_a_head(0)[0], ..Default::default() })
}

/// The paper's form about an axis that is not y, disturbed.
fn tilted() -> Dynamics {
    let disturbance = Some(Disturbance { every: 5, ..Disturbance::default() });
    Dynamics { polar_axis: Vec3::new(0.3, 1.0, -0.2), disturbance, ..gust() }
}

fn run(simulation: &mut Simulation, frames: std::ops::RangeInclusive<u32>) -> Vec<[u32; 3]> {
    let poses = way_of_a_head(40);
    for frame in frames {
        simulation.step_frame(&FrameInput::new(frame, &poses, &wind()));
    }
    bits(simulation.strands())
}

fn refusal(simulation: &mut Simulation, bytes: &[u8]) -> String {
    let refused = simulation.set_state_bytes(bytes).unwrap_err();
    assert_eq!(refused.thing, "state of hair");
    let line = refused.to_string();
    assert!(!line.contains('\n'), "{line}");
    line
}

#[test]
fn a_state_read_back_moves_on_to_the_same_bits() {
    for dynamics in [gust(), tilted(), free_motion(FreeMotion::default()), crowded()] {
        let build = || fast(&hair(50, 18), &dynamics, &wind());
        let mut simulation = build();
        let at_rest = simulation.state_bytes();
        let tenth = run(&mut simulation, 1..=10);
        let bytes = simulation.state_bytes();
        let twentieth = run(&mut simulation, 11..=20);
        assert!(tenth != twentieth);

        let mut other = build();
        other.set_state_bytes(&bytes).unwrap();
        assert!((other.frame(), bits(other.strands())) == (10, tenth));
        assert!(other.state_bytes() == bytes);
        assert!(run(&mut other, 11..=20) == twentieth);
        // Into hair that has moved on, of states before and after.
        other.set_state_bytes(&at_rest).unwrap();
        assert_eq!(other.frame(), 0);
        run(&mut other, 1..=10);
        assert!(run(&mut other, 11..=20) == twentieth);
        other.rewind();
        assert!(other.state_bytes() == at_rest);
        // Of a clone that took its state over.
        let mut saved = build();
        let mut clone = saved.clone();
        saved.set_state_bytes(&bytes).unwrap();
        clone.set_state(&saved).unwrap();
        assert!(clone.state_bytes() == bytes);
    }
}

#[test]
fn a_state_shows_the_points_that_a_step_wrote_elsewhere() {
    let mut simulation = fast(&hair(20, 18), &crowded(), &wind());
    let (mut other, poses) = (simulation.clone(), way_of_a_head(40));
    let mut points = simulation.strands().points().to_vec();
    for frame in 1..=4 {
        simulation.step_frame_into(&FrameInput::new(frame, &poses, &wind()), &mut points);
    }
    run(&mut other, 1..=4);
    assert!(simulation.state_bytes() != other.state_bytes());
    assert!(simulation.state_bytes_showing(&points) == other.state_bytes());
}

#[test]
fn reading_a_state_allocates_nothing() {
    let mut simulation = fast(&hair(40, 18), &crowded(), &wind());
    run(&mut simulation, 1..=3);
    let bytes = simulation.state_bytes();
    let before = allocations();
    simulation.set_state_bytes(&bytes).unwrap();
    assert_eq!(allocations(), before);
}

#[test]
fn bytes_cut_or_altered_are_refused_and_change_nothing() {
    let mut simulation = fast(&hair(2, 3), &free_motion(FreeMotion::default()), &wind());
    run(&mut simulation, 1..=5);
    let bytes = simulation.state_bytes();
    let now = run(&mut simulation, 6..=7);
    for length in 0..bytes.len() {
        refusal(&mut simulation, &bytes[..length]);
    }
    let mut altered = bytes.clone();
    for at in 0..bytes.len() {
        for bit in 0..8 {
            altered[at] ^= 1 << bit;
            refusal(&mut simulation, &altered);
            altered[at] ^= 1 << bit;
        }
    }
    altered.extend([0; 4]);
    refusal(&mut simulation, &altered);
    assert!((simulation.frame(), bits(simulation.strands())) == (7, now));
    assert!(bytes != simulation.state_bytes());
    simulation.set_state_bytes(&bytes).unwrap();
    assert_eq!(simulation.frame(), 5);
}

/// With the word at a place replaced, and the checksum of that: SplitMix64 over words.
fn with_word(bytes: &[u8], at: usize, word: u32) -> Vec<u8> {
    let mut changed = bytes[..bytes.len() - 8].to_vec();
    changed[at..at + 4].copy_from_slice(&word.to_le_bytes());
    let checksum = changed.chunks(4).fold(0_u64, |sum, word| {
        let z = (sum ^ u64::from(u32::from_le_bytes(word.try_into().unwrap()))).wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    });
    changed.extend(checksum.to_le_bytes());
    changed
}

#[test]
fn the_state_of_something_else_is_refused_as_what_it_is() {
    let dynamics = free_motion(FreeMotion::default());
    let bytes = fast(&hair(10, 18), &dynamics, &wind()).state_bytes();
    let of = |hair: &Strands, dynamics: &Dynamics| refusal(&mut fast(hair, dynamics, &wind()), &bytes);
    assert!(of(&hair(10, 18), &gust()).contains("is of the free form, but this hair moves by the paper's form"));
    assert!(of(&hair(11, 18), &dynamics).contains("190 points, but this hair has 209"));
    let mut moved = hair(10, 18);
    moved.strand_mut(9)[18].x += 1e-5;
    assert!(of(&moved, &dynamics).contains("other hair"));
    let reversed = hair(10, 18).select(&(0..10).rev().collect::<Vec<_>>());
    assert!(of(&reversed, &dynamics).contains("other hair"));

    let mut simulation = fast(&hair(10, 18), &dynamics, &wind());
    assert_eq!(u32::from_le_bytes(bytes[16..20].try_into().unwrap()), METHOD_VERSION);
    assert!(simulation.set_state_bytes(&with_word(&bytes, 16, METHOD_VERSION)).is_ok());
    let line = refusal(&mut simulation, &with_word(&bytes, 16, METHOD_VERSION - 1));
    assert!(line.contains(&format!("METHOD_VERSION {}, but hair moves differently", METHOD_VERSION - 1)), "{line}");
    let mut layout = bytes.clone();
    layout[7] += 1;
    assert!(refusal(&mut simulation, &layout).contains("has layout 2 of"));
    // Whole, but with a header of another length.
    for word in (32..48).step_by(4) {
        refusal(&mut simulation, &with_word(&bytes, word, 0x4000_0001));
    }
}

/// Gaps to other bodies are none: a ball that is told to be where hair rests is met at once by hair that was read among another ball.
#[test]
fn hair_read_among_other_bodies_looks_for_contact() {
    let (hair, calm) = (hair(80, 18), FieldSum::default());
    let among = |place: Vec3| {
        let way = BodyWay::InWorld([Pose { position_cm: place, ..Pose::STILL }].into());
        let skin = Arc::new(skin_of(ball(4.0), "ball").unwrap());
        let body = Body::new("body[0]", skin, way, Contact::default());
        fast(&hair, &free_motion(FreeMotion { bodies: vec![body], ..Default::default() }), &calm)
    };
    let there = Vec3::new(14.0, 2.0, 0.0);
    let inside_after_a_step = |simulation: &mut Simulation| {
        let bodies = &[Some([Pose { position_cm: there, ..Pose::STILL }; 2])];
        simulation.step_frame(&FrameInput::new(1, &[], &calm).with_bodies(bodies));
        simulation.strands().points().iter().filter(|p| p.distance(there) < 4.0).count()
    };
    // Nobody said that it jumped there.
    let far = among(Vec3::splat(300.0));
    let bytes = far.state_bytes();
    assert!(inside_after_a_step(&mut far.clone()) > 5);
    let mut same = among(Vec3::splat(300.0));
    same.set_state_bytes(&bytes).unwrap();
    assert!(inside_after_a_step(&mut same) > 5);
    let mut other = among(Vec3::splat(301.0));
    other.set_state_bytes(&bytes).unwrap();
    assert_eq!(inside_after_a_step(&mut other), 0);
}

/// Gaps to another shape are none either, though it lies in the same box.
#[test]
fn hair_read_among_a_body_of_the_same_box_looks_for_contact() {
    let hair = hair(80, 18);
    let among = |y: f32| {
        let ends = [Vec3::new(-20.0, -y, -14.0), Vec3::new(-20.0, y, 14.0)];
        let stick = Shape::Other(Arc::new(Capsule::new(ends, 1.0, "stick").unwrap()));
        let body = Body::new("body[0]", stick, BodyWay::WithHead, Contact::default());
        fast(&hair, &free_motion(FreeMotion { bodies: vec![body], ..Default::default() }), &wind())
    };
    let reach = |y: f32| Capsule::new([Vec3::new(0.0, -y, 0.0), Vec3::new(0.0, y, 0.0)], 1.0, "").unwrap().reach();
    assert_eq!(reach(9.0), reach(-9.0));
    let mut falling = among(9.0);
    run(&mut falling, 1..=20);
    let (mut read, mut told) = (among(-9.0), among(-9.0));
    read.set_state(&falling).unwrap();
    told.set_state(&falling).unwrap();
    told.jumped();
    let gaps = |simulation: &Simulation| simulation.state_bytes();
    assert!(gaps(&read) == gaps(&told));
}
