//! Laws of the cantilever beam (method section 4).

use nabiki::glam::{DMat3, DVec3};
use nabiki_groom::cantilever::{Beam, Hold, MOST_PASSES, Workspace};
use proptest::prelude::*;

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

/// With kappa_n = w d^2 n^2 / 2EI at the joint that carries n segments, the tip sinks by the sum of kappa_n n d^2,
/// half for n = k: w d^4 / 2EI (k^2 (k+1)^2 / 4 - k^3 / 2) = w L^4 / 8EI (1 + 1/k^2). So the order is two, exactly.
#[test]
fn tip_deflection_converges_to_w_l4_over_8ei() {
    let small = 1e-5;
    for segments in [1usize, 2, 9, 18, 36, 72] {
        let k = segments as f64;
        let beam = Beam { stiffness: 1.0 / small, segment: 1.0 / k, clamp: DVec3::X, hold: Hold::Clamped };
        let mut walk = Vec::new();
        beam.straight_arms(&vec![DOWN; segments], &mut walk);
        for (pass, directions) in [("straight", walk), ("settled", settled(small, DVec3::X, segments).0)] {
            let ratio = -tip(&directions).y / (small / 8.0);
            // What is left is of second order in the slopes, all below `small`.
            assert!((ratio - (1.0 + 1.0 / (k * k))).abs() < 1e-9, "{pass}, {segments} segments: {ratio}");
        }
    }
}

#[test]
fn straight_arms_have_the_moment_of_the_paper() {
    let (k, d, stiffness) = (7usize, 0.6, 40.0);
    let clamp = DVec3::new(0.3, 0.8, -0.2).normalize();
    let mut walk = Vec::new();
    Beam { stiffness, segment: d, clamp, hold: Hold::Clamped }.straight_arms(&vec![2.0 * DOWN; k], &mut walk);
    let mut a0 = clamp;
    for i in 1..=k {
        let w = 2.0 * DOWN;
        let w_perp = w - a0 * w.dot(a0);
        let moment = w_perp.length() * d * d * ((k - i + 1) as f64).powi(2) / 2.0;
        let kappa = moment / stiffness * if i == 1 { 0.5 } else { 1.0 };
        let expected = (a0 * d + w_perp.normalize() * kappa * d * d).normalize();
        assert!((walk[i - 1] - expected).length() < 1e-14, "segment {i}");
        a0 = expected;
    }
}

#[test]
fn upright_strand_buckles_beyond_its_critical_weight_only() {
    // The self-buckling of a clamped column: w L^3 / EI = 7.8373. (Just above it the fall is too slow to wait for.)
    let (straight, _) = settled(7.8, DVec3::Y, 72);
    assert!((tip(&straight) - DVec3::Y).length() < 1e-6);
    let (bent, _) = settled(9.0, DVec3::Y, 72);
    assert!(tip(&bent).y < 0.99);
    let (fallen, _) = settled(300.0, DVec3::Y, 72);
    assert!(tip(&fallen).y < -0.5);
}

#[test]
fn a_continued_beam_is_the_tail_of_the_whole() {
    let (whole, _) = settled(60.0, angle(40.0), 18);
    let beam = Beam { stiffness: 1.0 / 60.0, segment: 1.0 / 18.0, clamp: whole[6], hold: Hold::Continued };
    let mut tail = Vec::new();
    beam.settle(&[DOWN; 11], 1e-12, false, &mut tail, &mut Workspace::default());
    for (a, b) in whole[7..].iter().zip(&tail) {
        assert!((*a - *b).length() < 1e-10);
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 64, failure_persistence: None, ..ProptestConfig::default() })]

    /// Any weight, stiffness and clamp comes to rest, with segments of unit direction to rounding.
    #[test]
    fn every_strand_comes_to_rest(
        log_gamma in -4.0..4.5f64, elevation in -90.0..=90.0f64, azimuth in 0.0..360.0f64, segments in 1usize..60,
    ) {
        let clamp = DMat3::from_rotation_y(azimuth.to_radians()) * angle(elevation);
        let (directions, passes) = settled(10f64.powf(log_gamma), clamp, segments);
        prop_assert!(passes < MOST_PASSES, "{} passes", passes);
        for t in directions {
            prop_assert!((t.length() - 1.0).abs() < 4.0 * f64::EPSILON);
        }
    }

    /// The load has an axis of symmetry, so turning or mirroring the clamp about it turns or mirrors the strand.
    #[test]
    fn turned_and_mirrored_clamps_give_turned_and_mirrored_strands(
        gamma in 0.01..300.0f64, elevation in -80.0..80.0f64, azimuth in 0.0..360.0f64,
    ) {
        let turn = DMat3::from_rotation_y(azimuth.to_radians());
        let mirror = DMat3::from_diagonal(DVec3::new(-1.0, 1.0, 1.0));
        let (still, _) = settled(gamma, angle(elevation), 18);
        let (turned, _) = settled(gamma, turn * angle(elevation), 18);
        let (mirrored, _) = settled(gamma, mirror * angle(elevation), 18);
        for i in 0..18 {
            // Both stop within 1e-12 of the same shape, up to how soft it is against a turn.
            prop_assert!((turn * still[i] - turned[i]).length() < 1e-8);
            prop_assert!((mirror * still[i] - mirrored[i]).length() < 1e-8);
        }
    }
}
