//! How far the fast stepper strays from the f64 one over the gust: `cargo bench -p nabiki --bench twins`.
//!
//! The shipped head and default style, Table 1 of the paper, 19,330 strands of 18 segments, all points of all 100
//! frames. Distances are in segment lengths (1 cm).

use glam::Vec3;
use nabiki::Head;
use nabiki::dynamics::{Dynamics, Motion, Reference, Simulation, Stepper};
use nabiki::field::{Field, Keyframe};
use nabiki::groom::{Style, groom};
use nabiki::pseudo_force::PseudoForce;
use nabiki::roots::{Hairline, spread};

fn main() {
    let head = Head::builtin();
    let roots = spread(&head, &Hairline::default(), 19_330, 1).expect("a hairline in range");
    let hair = groom(&head, &roots, &Style::default(), 18, 1.0, 1).expect("a style in range");
    let key = |through, vector| Keyframe { through, vector };
    let field = [key(50, Vec3::new(-100.0, 0.0, 0.0)), key(100, Vec3::new(-15.0, -150.0, 0.0))];
    println!("{:>18} {:>12} {:>12} {:>12} {:>12}", "pseudo-force", "median", "99 %", "99.9 %", "largest");
    for (name, pseudo_force) in [("off", PseudoForce::off()), ("Table 1", PseudoForce::default())] {
        let dynamics = Dynamics {
            motion: Motion { friction_length: 18.0, ..Motion::default() },
            segment_length: 1.0,
            pseudo_force,
            ellipsoid: head.ellipsoid,
            shell: 1.25,
            field: Field::new(&field).expect("two keyframes"),
            disturbance: None,
        };
        let mut reference = Reference::new(&hair, &dynamics).expect("a stable field");
        let mut fast = Simulation::new(&hair, &dynamics).expect("a stable field");
        let mut distances = Vec::new();
        for _ in 0..100 {
            reference.step_frame();
            fast.step_frame();
            let pairs = reference.positions().iter().zip(fast.strands().points());
            distances.extend(pairs.map(|(a, b)| a.distance(b.as_dvec3())));
        }
        distances.sort_by(f64::total_cmp);
        let at = |share: f64| distances[((distances.len() - 1) as f64 * share) as usize];
        println!("{name:>18} {:>12.1e} {:>12.1e} {:>12.1e} {:>12.1e}", at(0.5), at(0.99), at(0.999), at(1.0));
    }
}
