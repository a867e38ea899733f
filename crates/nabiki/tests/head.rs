//! Laws of a head that is read from samples, of the bust: it has folds and edges, and is sampled on one side alone.

use std::sync::LazyLock;

use glam::{Vec3, vec3};
use nabiki::Head;
use nabiki::obstacle::{Obstacle, Reading};
use nabiki_groom::bust;

static BUST: LazyLock<Head> = LazyLock::new(bust);

fn scattered(reach: f32) -> impl Iterator<Item = Vec3> {
    (0..3000).map(move |i| {
        let [a, b, c] = [0.754_877_7, 0.569_840_3, 0.430_159_7].map(|g: f32| (i as f32 * g).fract() - 0.5);
        2.0 * reach * vec3(a, b, c)
    })
}

/// Between samples the distance is linear along each axis, so its differences are the gradient, and those of the gradient the second
/// derivatives, to rounding. The built-in head is sampled on one side alone.
#[test]
fn what_is_read_of_either_side_of_a_head_is_as_steep_and_as_curved_as_it_changes() {
    let skin = BUST.skin();
    let [low, high] = skin.reach();
    let h = 0.02;
    let (mut compared, mut all) = (0, 0);
    let sample = |p| skin.read(p, 0).map(|at| (at.distance, at.gradient));
    for p in scattered(12.0).filter(|&p| sample(p).is_some_and(|(distance, _)| distance.abs() < 4.0)) {
        let ((distance, gradient), mirrored) = (sample(p).unwrap(), p.with_z(-p.z));
        assert_eq!(sample(mirrored), Some((distance, gradient.with_z(-gradient.z))), "{p}");
        assert!(mirrored.cmpge(low).all() && mirrored.cmple(high).all(), "{p}");
        let hessian = skin.read(p, 0).unwrap().hessian;
        for (axis, e) in [Vec3::X, Vec3::Y, Vec3::Z].into_iter().enumerate() {
            let Some(((after, to), (before, from))) = sample(p + h * e).zip(sample(p - h * e)) else {
                continue;
            };
            all += 1;
            // Within one cell the slope along an axis does not change along it.
            if (to[axis] - from[axis]).abs() > 1e-5 || (to[axis] - gradient[axis]).abs() > 1e-5 {
                continue;
            }
            compared += 1;
            // Points are rounded to 1e-6 cm, and once more among the samples; both ends over 2 h. Slopes between samples an eighth of a cm
            // apart are rounded to 4e-6.
            let slope = (after - before) / (2.0 * h);
            assert!((slope - gradient[axis]).abs() < 2e-4, "{p}: {slope}, not {gradient}");
            let bent = (to - from) / (2.0 * h);
            assert!(bent.distance(hessian.col(axis)) < 1e-3, "{p}: {bent}, not {}", hessian.col(axis));
        }
    }
    assert!(compared > 500 && 3 * compared > 2 * all, "{compared} of {all}");
}

#[test]
fn a_filled_head_encloses_the_head_and_is_the_head_where_that_is_convex() {
    let head = &*BUST;
    let (spacing, radius) = (0.5, 3.0);
    let filled = head.skin().filled(radius, spacing);
    let (mut deepest, mut farthest) = (0.0_f32, 0.0_f32);
    for vertex in head.mesh.positions.iter().step_by(7) {
        let Some(Reading { distance, .. }) = filled.read(*vertex, 0) else { continue };
        deepest = deepest.max(distance);
        if vertex.y > 6.0 {
            farthest = farthest.max(-distance);
        }
    }
    // Between the places that are looked at, an edge may still be cut by the height of a corner of 90 degrees over a
    // quarter of a step.
    assert!(deepest < 0.25 * spacing * 0.5, "{deepest}");
    assert!(farthest < 0.4 * spacing, "the crown is convex, and yet filled by {farthest} cm");
    let behind_the_ear = Vec3::new(-3.2, -0.5, 7.4);
    assert!(head.distance(behind_the_ear) > 0.0, "a place of the fold, not of the head");
    assert!(filled.at(behind_the_ear) < head.distance(behind_the_ear) - 0.3);
}

#[test]
fn depth_is_the_distance_within_and_nothing_without() {
    let head = &*BUST;
    for i in 0..4000 {
        let share = [0.618_034, 0.754_878, 0.569_84].map(|g: f32| 2.0 * (i as f32 * g).fract() - 1.0);
        let p = Vec3::from_array(share) * vec3(30.0, 40.0, 40.0);
        assert_eq!(head.depth(p), (-head.distance(p)).max(0.0), "{p}");
    }
}
