//! How far the fast stepper strays from the f64 one over the gust: `cargo bench -p nabiki --bench twins`.
//!
//! The shipped head and default style, Table 1 of the paper, 19,330 strands of 18 segments, all points of all frames up
//! to each horizon; after frame 100 the last vector holds on. Distances are in segment lengths (1 cm).
//!
//! Beside the fast twin goes a second f64 stepper whose hair starts a rounding away from the first one's. How far those
//! two part is the doing of the motion alone.

use glam::{DVec3, Vec3};
use nabiki::Strands;
use nabiki::dynamics::{Dynamics, FrameInput, Motion, Reference, Simulation, Stepper};
use nabiki::field::{Keyframe, KeyframedField};
use nabiki::pseudo_force::PseudoForce;
use nabiki_groom::roots::spread;
use nabiki_groom::{Hairline, Style, bust, groom};

const HORIZONS: [u32; 3] = [100, 400, 800];

fn main() {
    let strands = std::env::args().filter_map(|arg| arg.parse().ok()).next().unwrap_or(19_330);
    let head = bust();
    let roots = spread(&head, &Hairline::default(), strands, 1).expect("a hairline in range");
    let hair = groom(&head, &roots, &Style::default(), 18, 1.0, 1).expect("a style in range");
    let key = |through, vector| Keyframe { through, vector };
    let field = [key(50, Vec3::new(-100.0, 0.0, 0.0)), key(100, Vec3::new(-15.0, -150.0, 0.0))];
    let field = KeyframedField::new(&field).expect("two keyframes");
    println!(
        "{:>14} {:>7} {:>22} {:>10} {:>10} {:>10} {:>10}",
        "pseudo-force", "frames", "beside the f64 one", "median", "99 %", "99.9 %", "largest"
    );
    for (name, pseudo_force) in [("off", PseudoForce::off()), ("Table 1", PseudoForce::default())] {
        let dynamics = Dynamics {
            motion: Motion { inertia_length_floor: 18.0, ..Motion::default() },
            pseudo_force,
            ..Dynamics::new(head.ellipsoid)
        };
        let mut reference = Reference::new(&hair, &dynamics, &field).expect("a stable field");
        let mut other = Reference::new(&nudged(&hair), &dynamics, &field).expect("a stable field");
        let mut fast = Simulation::new(&hair, &dynamics, &field).expect("a stable field");
        let (mut twin, mut chaos) = (Distances::new(), Distances::new());
        for frame in 1..=HORIZONS[2] {
            let input = FrameInput::new(frame, &[], &field);
            reference.step_frame(&input);
            other.step_frame(&input);
            fast.step_frame(&input);
            let exact = reference.positions();
            twin.add(exact, fast.strands().points().iter().map(|p| p.as_dvec3()));
            chaos.add(exact, other.positions().iter().copied());
            if HORIZONS.contains(&frame) {
                twin.print(name, frame, "the fast one");
                chaos.print(name, frame, "f64, a rounding away");
            }
        }
    }
}

/// The hair with every point but the roots moved by one unit in its last place.
fn nudged(hair: &Strands) -> Strands {
    let mut nudged = hair.clone();
    for s in 0..nudged.len() {
        for p in &mut nudged.strand_mut(s)[1..] {
            *p = Vec3::new(p.x.next_up(), p.y.next_down(), p.z.next_up());
        }
    }
    nudged
}

/// Distances counted by their size: 100 steps a decade, from 1e-9 to 100.
struct Distances {
    counts: Vec<u64>,
    largest: f64,
}

impl Distances {
    fn new() -> Self {
        Self { counts: vec![0; 1100], largest: 0.0 }
    }

    fn add(&mut self, exact: &[DVec3], there: impl Iterator<Item = DVec3>) {
        for (a, b) in exact.iter().zip(there) {
            let distance = a.distance(b);
            self.largest = self.largest.max(distance);
            self.counts[((distance.log10() + 9.0).max(0.0) * 100.0) as usize] += 1;
        }
    }

    fn at(&self, share: f64) -> f64 {
        let wanted = (self.counts.iter().sum::<u64>() as f64 * share) as u64;
        let mut seen = 0;
        let step = self.counts.iter().position(|count| {
            seen += count;
            seen > wanted
        });
        10_f64.powf(step.unwrap_or(0) as f64 / 100.0 - 9.0)
    }

    fn print(&self, pseudo_force: &str, frames: u32, beside: &str) {
        let [median, most, nearly_all] = [0.5, 0.99, 0.999].map(|share| self.at(share));
        println!(
            "{pseudo_force:>14} {frames:>7} {beside:>22} {median:>10.1e} {most:>10.1e} {nearly_all:>10.1e} {:>10.1e}",
            self.largest
        );
    }
}
