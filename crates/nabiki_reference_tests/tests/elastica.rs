//! The settled strand against the heavy elastica (method section 4), a table computed by another program.
//!
//! Error of the settled strand against the heavy elastica clamped level, the distance of the tips over L, by segment
//! count (`cargo test -p nabiki_reference_tests --test elastica -- --nocapture` prints it):
//!
//! | w L^3 / EI | 9      | 18     | 36     | 72     |
//! |-----------:|-------:|-------:|-------:|-------:|
//! |        0.1 | 1.5e-4 | 3.9e-5 | 9.6e-6 | 2.4e-6 |
//! |          1 | 1.5e-3 | 3.7e-4 | 9.1e-5 | 2.3e-5 |
//! |          2 | 2.5e-3 | 6.2e-4 | 1.5e-4 | 3.8e-5 |
//! |          5 | 2.9e-3 | 6.1e-4 | 1.3e-4 | 3.1e-5 |
//! |         10 | 2.7e-3 | 8.0e-4 | 2.4e-4 | 6.5e-5 |
//! |         20 | 5.7e-3 | 2.0e-3 | 6.0e-4 | 1.6e-4 |
//! |         50 | 8.5e-3 | 2.8e-3 | 8.9e-4 | 2.6e-4 |
//! |        100 | 1.0e-2 | 3.3e-3 | 1.0e-3 | 3.1e-4 |
//! |        300 | 1.2e-2 | 4.5e-3 | 1.4e-3 | 4.4e-4 |

use glam::DVec3;
use nabiki_groom::cantilever::{Beam, Hold, MOST_PASSES, Workspace};
use nabiki_reference_tests::shared;

const DOWN: DVec3 = DVec3::NEG_Y;

/// A strand of unit length under gravity, w = 1, with EI = 1 / gamma.
fn settled(gamma: f64, clamp: DVec3, segments: usize) -> (Vec<DVec3>, usize) {
    let beam =
        Beam { stiffness: 1.0 / gamma, segment: 1.0 / segments as f64, clamp: clamp.normalize(), hold: Hold::Clamped };
    let mut directions = Vec::new();
    let passes = beam.settle(&vec![DOWN; segments], 1e-12, false, &mut directions, &mut Workspace::default());
    (directions, passes)
}

fn tip(directions: &[DVec3]) -> DVec3 {
    directions.iter().sum::<DVec3>() / directions.len() as f64
}

fn angle(degrees: f64) -> DVec3 {
    let (s, c) = degrees.to_radians().sin_cos();
    DVec3::new(c, s, 0.0)
}

/// The scheme is a midpoint rule in the arc length and its chords turn by tan instead of the angle itself, both of
/// second order: four times the segments, a sixteenth of the error. Three quarters of that order are asked for, once
/// a segment is shorter than the bend at the clamp, sqrt(EI / w L).
#[test]
#[cfg_attr(not(shared_data), ignore = "needs the shared reference data beside the project")]
fn settled_strand_converges_to_the_heavy_elastica() {
    let text = std::fs::read_to_string(shared("reference/elastica_self_weight.csv")).unwrap();
    let mut rows = 0;
    for line in text.lines().skip(1).filter(|line| !line.trim().is_empty()) {
        let row: Vec<f64> = line.split(',').map(|cell| cell.trim().parse().unwrap()).collect();
        let [degrees, gamma, x, y, tip_angle] = row[..] else { panic!("five columns, not {line}") };
        let mut errors = Vec::new();
        for segments in [9, 18, 36, 72] {
            let (directions, passes) = settled(gamma, angle(degrees), segments);
            assert!(passes < MOST_PASSES, "gamma {gamma}: never came to rest");
            errors.push((tip(&directions) - DVec3::new(x, y, 0.0)).length());
            if segments == 72 {
                let last = directions[71];
                // The last segment's middle is half a segment short of the tip, where the curvature is nearly nil.
                assert!((last.y.atan2(last.x) - tip_angle).abs() < 1e-3, "gamma {gamma}: tip angle");
            }
        }
        println!("//! | {gamma:10} | {} |", errors.iter().map(|e| format!("{e:.1e}")).collect::<Vec<_>>().join(" | "));
        for pair in errors.windows(2) {
            assert!(pair[1] < pair[0], "gamma {gamma}: {errors:?}");
        }
        let bend = (1.0 / gamma).sqrt();
        if bend > 1.0 / 18.0 {
            assert!(errors[1] / errors[3] > 16f64.powf(0.75), "gamma {gamma}: {errors:?}");
        }
        rows += 1;
    }
    assert!(rows >= 9, "only {rows} rows in the reference table");
}
