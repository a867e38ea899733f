//! Which wind makes the hair do this: `cargo bench -p nabiki --bench solve`.
//!
//! Hair of the default style, 18 segments, 100 frames of the gust, the head in the way where the form knows of it. A drag of
//! 20 strands with 6 unknowns, a call for each move of a hand that pulls a lock for 12 cm; and a full search with 12 unknowns
//! for 40 strands. The fastest, the median and the slowest of all rounds, in ms, and the time on all processors together, which
//! others on the machine move less: on two cores of one's own it takes half of that.

#[path = "common/dynamics.rs"]
mod dynamics;

use std::sync::Arc;
use std::time::Instant;

use dynamics::{dynamics, free};
use glam::Vec3;
use nabiki::Strands;
use nabiki::dynamics::{Dynamics, Form};
use nabiki::field::{Ease, Keyframe};
use nabiki::solve::{Drag, Goal, KeyedWind, OpenAir, Prior, Problem, Search, Solver, Unknown, Wish, nodes_of};
use nabiki_groom::{Growth, Hairline, Style, bust, grow};

fn main() {
    println!("threads: {}", rayon::current_num_threads());
    let head = bust();
    let (hairline, style) = (Hairline::default(), Style::default());
    let growth =
        Growth { hairline: &hairline, style: &style, strands: 2000, segments: 18, segment_length: 1.0, seed: 1 };
    let hair = grow(&head, &growth, 40).expect("settings in range").strands;
    for (name, form) in [("paper", Form::Paper), ("free", Form::Free(free(&head)))] {
        let dynamics = dynamics(&head, form);
        drag(name, &hair, &dynamics);
        full(name, &hair, &dynamics);
    }
}

fn key(through: u32, x: f32, y: f32, z: f32) -> Keyframe {
    Keyframe { through, vector: Vec3::new(x, y, z) }
}

fn problem(hair: &Strands, dynamics: &Dynamics, keyframes: Vec<Keyframe>, unknowns: Vec<Unknown>) -> Problem {
    Problem {
        hair: hair.clone(),
        ids: (0..hair.len() as u32).collect(),
        dynamics: dynamics.clone(),
        poses: Vec::new(),
        wind: KeyedWind { keyframes, ease: Ease::Stepped, gust: None },
        surroundings: Arc::new(OpenAir),
        unknowns,
        wishes: Vec::new(),
        prior: Prior::default(),
    }
}

/// All nodes of some strands, or their outer halves.
fn wish(strands: u32, hair: &Strands, frame: u32, along: f32, goal: Goal) -> Wish {
    let nodes = (0..strands).flat_map(|s| nodes_of(s, hair.strand(s as usize).len(), along..=1.0)).collect();
    Wish { frame, nodes, goal, weight: 1.0 }
}

fn drag(name: &str, hair: &Strands, dynamics: &Dynamics) {
    const CALLS: usize = 60;
    let keyframes = vec![key(50, -60.0, 0.0, 0.0), key(100, 0.0, 0.0, 0.0)];
    let unknowns = vec![Unknown::Vector(0), Unknown::Vector(1)];
    let held = wish(20, hair, 100, 0.5, Goal::Stay);
    let nail = Wish { nodes: held.nodes[..40].to_vec(), frame: 50, goal: Goal::Stay, weight: 0.1 };
    let problem = Problem { wishes: vec![held, nail], ..problem(hair, dynamics, keyframes, unknowns) };
    let mut drag = Drag::new(problem).expect("a sound problem");
    let mut times = Vec::new();
    let busy = processor_ms();
    for n in 1..=CALLS {
        let by = Vec3::new(-6.0, 5.0, -9.0) * (n as f32 / CALLS as f32);
        let start = Instant::now();
        drag.pull(0, Goal::MeanMoved(by)).expect("three numbers");
        times.push(1000.0 * start.elapsed().as_secs_f64());
    }
    let busy = processor_ms() - busy;
    let left = drag.into_solver().left_cm();
    print(&format!("{name}: a drag, 20 strands, 6 unknowns, {left:.2} cm left"), times, busy);
}

fn full(name: &str, hair: &Strands, dynamics: &Dynamics) {
    const ROUNDS: u32 = 9;
    let truth = vec![
        key(25, -100.0, 20.0, 10.0),
        key(50, -60.0, 0.0, 50.0),
        key(75, -15.0, -90.0, 0.0),
        key(100, 0.0, 0.0, -40.0),
    ];
    let unknowns: Vec<Unknown> = (0..4).map(Unknown::Vector).collect();
    let wishes: Vec<Wish> = [25, 50, 75, 100].map(|frame| wish(40, hair, frame, 0.0, Goal::Stay)).to_vec();
    let made = Solver::new(Problem { wishes: wishes.clone(), ..problem(hair, dynamics, truth, unknowns.clone()) });
    let made = made.expect("a sound problem");
    let places: Vec<Goal> = (0..4).map(|i| Goal::Places(made.places(i))).collect();
    let wishes: Vec<Wish> = wishes.into_iter().zip(places).map(|(wish, goal)| Wish { goal, ..wish }).collect();
    let mut times = Vec::new();
    let mut said = String::new();
    let busy = processor_ms();
    for round in 0..ROUNDS {
        let by = |axis: u32, j: u32| 40.0 * ((1.0 + round as f32) * (3.1 * axis as f32 + 1.7 * j as f32 + 1.0)).sin();
        let keyframes = (0..4).map(|j| key(25 * (j + 1), by(0, j) - 40.0, by(1, j), by(2, j))).collect();
        let problem = Problem { wishes: wishes.clone(), ..problem(hair, dynamics, keyframes, unknowns.clone()) };
        let start = Instant::now();
        let mut solver = Solver::new(problem).expect("a sound problem");
        let report = solver.solve(&Search::default());
        times.push(1000.0 * start.elapsed().as_secs_f64());
        said += &format!(
            "\n    {:.2} -> {:.3} cm in {} steps from {} starts, {} runs",
            report.before_cm, report.after_cm, report.iterations, report.starts, report.runs
        );
    }
    print(&format!("{name}: a full search, 40 strands, 12 unknowns"), times, processor_ms() - busy);
    println!("  each:{said}");
}

fn print(what: &str, mut times: Vec<f64>, busy: f64) {
    times.sort_by(f64::total_cmp);
    let (fastest, median, slowest) = (times[0], times[times.len() / 2], times[times.len() - 1]);
    let busy = busy / times.len() as f64;
    println!("{what}: {fastest:.1} {median:.1} {slowest:.1} ms, {busy:.1} ms on all processors together");
}

/// The time that this process has had on all processors (ms), as Linux counts it, by hundredths of a second; NaN elsewhere.
fn processor_ms() -> f64 {
    let read = || {
        let stat = std::fs::read_to_string("/proc/self/stat").ok()?;
        // After the name in brackets, which may hold spaces: the 14th and 15th numbers of all.
        let mut numbers = stat.rsplit_once(')')?.1.split_whitespace().skip(11);
        let ticks: f64 = numbers.next()?.parse::<f64>().ok()? + numbers.next()?.parse::<f64>().ok()?;
        Some(10.0 * ticks)
    };
    read().unwrap_or(f64::NAN)
}
