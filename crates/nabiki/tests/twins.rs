//! The fast stepper against the specification, and against itself: other threads, widths, subsets, orders.

mod common;

use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;

use common::*;
use nabiki::Strands;
use nabiki::disturbance::Disturbance;
use nabiki::dynamics::{Dynamics, Reference, Simulation, Stepper, VectorWidth};
use nabiki::pseudo_force::PseudoForce;

/// Tolerances of the twin, in segment lengths over the 100 frames of the gust, without pseudo-force.
///
/// A step rounds theta and phi (up to 4 rad) to 2.4e-7 / 2 and the push to a relative 3e-7 or so. In 100 steps the
/// first adds up to 100 * 1.2e-7, the second to 100^2 / 2 * c |F| * 3e-7 = 1.2e-5 for c |F| = 0.008 at the tip:
/// together 2.4e-5 rad a segment, 4.3e-4 over 18 segments if all err to one side.
const TYPICAL: f64 = 4.3e-4;
/// Where a segment stands against the wind its error grows by up to e^(n sqrt(c |F|)), e^(50 * 0.07) = 33 in the
/// first half of the gust.
const WORST: f64 = 33.0 * TYPICAL;

fn distances(dynamics: &Dynamics, hair: &Strands) -> Vec<f64> {
    let mut reference = Reference::new(hair, dynamics).unwrap();
    let mut fast = Simulation::new(hair, dynamics).unwrap();
    let mut distances = Vec::new();
    for _ in 0..100 {
        reference.step_frame();
        fast.step_frame();
        let pairs = reference.positions().iter().zip(fast.strands().points());
        distances.extend(pairs.map(|(a, b)| a.distance(b.as_dvec3())));
    }
    distances.sort_by(f64::total_cmp);
    distances
}

#[test]
fn the_fast_stepper_follows_the_specification() {
    let distances = distances(&Dynamics { pseudo_force: PseudoForce::off(), ..gust() }, &hair(500, 18));
    let (typical, worst) = (distances[distances.len() * 999 / 1000], distances[distances.len() - 1]);
    assert!(typical < TYPICAL && worst < WORST, "99.9 %: {typical}, largest: {worst}");
}

/// With the pseudo-force, a point within rounding of Gamma's edge may feel eps_i F in one twin and F in the other.
#[test]
fn the_edge_of_gamma_parts_few_strands() {
    let distances = distances(&gust(), &hair(500, 18));
    // 100 frames x 9000 points, each within 1e-5 of an edge with a chance of about 1e-5 / 1 cm: some ten crossings,
    // each of which moves the rest of its strand for the rest of the gust. 99 % of the points feel none.
    assert!(distances[distances.len() * 99 / 100] < TYPICAL, "{}", distances[distances.len() * 99 / 100]);
}

fn running() -> Dynamics {
    Dynamics { disturbance: Some(Disturbance { from: 5, ..Default::default() }), ..gust() }
}

#[test]
fn any_number_of_threads_gives_the_same_bits() {
    let hair = mixed_hair(777);
    let result = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| bits(&run(&mut Simulation::new(&hair, &running()).unwrap(), 40)))
    };
    let one = result(1);
    for threads in [2, 3, 7] {
        assert_eq!(result(threads), one, "{threads} threads");
    }
}

#[test]
fn any_vector_width_gives_the_same_bits() {
    let hair = mixed_hair(40);
    let result = |width| bits(&run(&mut Simulation::new(&hair, &running()).unwrap().with_vector_width(width), 25));
    let widest = result(VectorWidth::Widest);
    assert_eq!(result(VectorWidth::Medium), widest);
    assert_eq!(result(VectorWidth::Baseline), widest);
}

#[test]
fn any_subset_in_any_order_moves_as_within_the_whole() {
    let hair = mixed_hair(200);
    let whole = run(&mut Simulation::new(&hair, &running()).unwrap(), 60);
    let exact = run(&mut Reference::new(&hair, &running()).unwrap(), 60);
    for chosen in [vec![17], vec![199, 3, 90], (0..200).rev().step_by(3).collect::<Vec<usize>>()] {
        let ids: Vec<u32> = chosen.iter().map(|&s| s as u32).collect();
        let part = hair.select(&chosen);
        let fast = run(&mut Simulation::with_ids(&part, &ids, &running()).unwrap(), 60);
        assert_eq!(bits(&fast), bits(&whole.select(&chosen)));
        let reference = run(&mut Reference::with_ids(&part, &ids, &running()).unwrap(), 60);
        assert_eq!(bits(&reference), bits(&exact.select(&chosen)));
    }
}

#[test]
fn the_disturbance_parts_the_hair_but_keeps_to_its_frames() {
    let hair = mixed_hair(50);
    let (mut calm, mut disturbed) =
        (Simulation::new(&hair, &gust()).unwrap(), Simulation::new(&hair, &running()).unwrap());
    assert_eq!(bits(&run(&mut calm, 9)), bits(&run(&mut disturbed, 9)));
    calm.step_frame();
    disturbed.step_frame();
    assert_ne!(bits(calm.strands()), bits(disturbed.strands()));
}

thread_local! {
    static ALLOCATIONS: Cell<usize> = const { Cell::new(0) };
}

struct Counting;

// SAFETY: every call goes on to the system's allocator unchanged.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        ALLOCATIONS.with(|n| n.set(n.get() + 1));
        unsafe { System.alloc(layout) }
    }
    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        unsafe { System.dealloc(pointer, layout) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

#[test]
fn a_step_allocates_nothing() {
    // In a pool of one thread all the work happens on the thread that counts.
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
    pool.install(|| {
        let mut fast = Simulation::new(&mixed_hair(300), &running()).unwrap();
        fast.step_frame();
        let before = ALLOCATIONS.with(Cell::get);
        run_on(&mut fast);
        assert_eq!(ALLOCATIONS.with(Cell::get), before);
    });
}

fn run_on(fast: &mut Simulation) {
    for _ in 0..30 {
        fast.step_frame();
    }
}
