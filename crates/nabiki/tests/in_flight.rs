//! Settings that change while hair moves.

#[path = "common/allocations.rs"]
mod allocations;
mod common;

use allocations::allocations;
use common::{bits, fast, free, hair, way_of_a_head, wind, with_neighbours};
use nabiki::Strands;
use nabiki::dynamics::{FrameInput, Simulation, Stepper, push};
use nabiki::free_form::{FreeForm, Tie};

fn run(simulation: &mut Simulation, frames: std::ops::RangeInclusive<u32>) -> Vec<[u32; 3]> {
    let poses = way_of_a_head(40);
    frames.for_each(|frame| simulation.step_frame(&FrameInput::new(frame, &poses, &wind())));
    bits(simulation.strands())
}

#[test]
fn hair_goes_on_under_other_settings_from_where_it_is() {
    let hair = hair(60, 18);
    let light = with_neighbours(free(FreeForm { gravity: 100.0, ..FreeForm::default() }));
    let heavy = with_neighbours(free(FreeForm { gravity: 120.0, ..FreeForm::default() }));
    let mut old = fast(&hair, &light, &wind());
    run(&mut old, 1..=15);
    // Built of its own with the same settings: to the bit.
    let mut same = fast(&hair, &light, &wind());
    same.set_state(&old).unwrap();
    let mut other = fast(&hair, &heavy, &wind());
    let before = allocations();
    other.set_state(&old).unwrap();
    assert_eq!(allocations(), before);
    let mut read = fast(&hair, &heavy, &wind());
    read.set_state_bytes(&old.state_bytes()).unwrap();
    assert!((other.frame(), bits(other.strands())) == (15, bits(old.strands())));
    let [next, goes_on, next_read] = [&mut old, &mut other, &mut read].map(|simulation| run(simulation, 16..=16));
    assert!(goes_on == next_read && goes_on != next);
    run(&mut same, 16..=16);
    assert!(bits(same.strands()) == next);
    // A node differs by what 20 more of weight, and of moments that carry it at rest, do in a frame, and joints between it and the root hand
    // on. Strands are 18 cm long, but for what their chords are shorter.
    let bound = 18.0 * 40.0 * push(&heavy, 17.9);
    let farthest = |a: &Strands, b: &Strands| {
        a.points().iter().zip(b.points()).map(|(a, b)| f64::from(a.distance(*b))).fold(0.0, f64::max)
    };
    let apart = farthest(old.strands(), other.strands());
    println!("{apart} {bound}");
    assert!(apart > 1e-5 && apart < bound, "{apart} cm, at most {bound}");
}

#[test]
fn hair_that_is_tied_in_flight_lies_as_at_rest_before_its_band() {
    let hair = hair(20, 18);
    let form = FreeForm { stiffness: 2000.0.into(), ..FreeForm::default() };
    let mut old = fast(&hair, &free(form.clone()), &wind());
    run(&mut old, 1..=15);
    let tie = Some(Tie { at: hair.strand(3)[9], within: 0.5 });
    let mut tied = fast(&hair, &free(FreeForm { tie, ..form }), &wind());
    tied.set_state(&old).unwrap();
    run(&mut tied, 16..=20);
    let moved = |i: usize| tied.strands().strand(3)[i].distance(hair.strand(3)[i]);
    assert!((0..=9).all(|i| moved(i) < 1e-5) && moved(18) > 0.1);
    assert!(old.strands().strand(3)[9].distance(hair.strand(3)[9]) > 0.1);
}
