//! The scene "curls" as it ships: its hair still curls while the wind blows and after it.

use std::path::Path;

use nabiki::Strands;
use nabiki::dynamics::Stepper;
use nabiki_scene::{Scene, Shown};

/// Mean angle (rad) between neighbouring segments.
fn mean_turn(strands: &Strands) -> f64 {
    let (mut sum, mut joints) = (0.0, 0);
    for strand in strands.iter() {
        for w in strand.windows(3) {
            sum += (w[1] - w[0]).as_dvec3().angle_between((w[2] - w[1]).as_dvec3());
            joints += 1;
        }
    }
    sum / f64::from(joints)
}

/// The mean angle between neighbouring segments stays within a tenth of that at rest, in every frame; and the wind does
/// move the hair.
#[test]
fn curls_keep_their_curl_in_the_wind_and_after_it() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/curls.toml");
    let built = Scene::load(&path, &[]).unwrap().build(Shown::First(400)).unwrap();
    let mut simulation = built.simulation().unwrap();
    let rest = simulation.strands().clone();
    let at_rest = mean_turn(&rest);
    let mut farthest = 0.0_f32;
    for frame in 1..=built.frames() {
        simulation.step_frame(&built.input(frame));
        let now = simulation.strands();
        let kept = mean_turn(now) / at_rest;
        assert!((0.9..=1.1).contains(&kept), "frame {frame}: {kept} of the {at_rest} rad at rest");
        farthest = rest.points().iter().zip(now.points()).map(|(a, b)| a.distance(*b)).fold(farthest, f32::max);
    }
    assert!(farthest > 5.0, "the wind moves the hair by no more than {farthest} cm");
}
