use glam::{Vec3, vec3};

use super::{LOOKED_AT, evenly, evenly_while};

/// Points over the unit sphere, evenly but for a jitter.
fn sphere(n: usize) -> Vec<Vec3> {
    (0..n)
        .map(|i| {
            let y = 1.0 - (2.0 * i as f32 + 1.0) / n as f32;
            let around = 2.399_963_2 * i as f32 + 0.3 * (7.1 * i as f32).sin();
            vec3((1.0 - y * y).sqrt() * around.cos(), y, (1.0 - y * y).sqrt() * around.sin())
        })
        .collect()
}

/// The straightforward way, for comparison: every gap anew for every choice.
fn plainly(points: &[Vec3], count: usize) -> Vec<usize> {
    let mut gap = vec![f32::INFINITY; points.len()];
    let mut chosen: Vec<usize> = Vec::new();
    for step in 0..count {
        let mut next = 0;
        for i in 1..points.len() {
            if step > 0 && gap[i] > gap[next] {
                next = i;
            }
        }
        for (g, p) in gap.iter_mut().zip(points) {
            *g = g.min(p.distance_squared(points[next]));
        }
        gap[next] = -1.0;
        chosen.push(next);
    }
    chosen
}

#[test]
fn a_choice_that_is_wanted_no_more_is_given_up_and_is_the_same_otherwise() {
    // The first chosen looks at every point.
    let points = sphere(LOOKED_AT + 1);
    assert_eq!(evenly_while(&points, 3, &|| false), None);
    assert_eq!(evenly_while(&points, 3, &|| true), Some(evenly(&points, 3)));
}

#[test]
fn the_grid_finds_what_the_plain_search_finds() {
    let points = sphere(900);
    assert_eq!(evenly(&points, 400), plainly(&points, 400));
}

#[test]
fn a_smaller_choice_begins_a_larger_one() {
    let points = sphere(2000);
    let all = evenly(&points, 5000);
    assert_eq!(evenly(&points, 60), all[..60]);
    let mut sorted = all;
    sorted.sort_unstable();
    assert!(sorted.into_iter().eq(0..2000));
}

// Caps of half the least spacing about the chosen points do not overlap, and caps of the full spacing cover the sphere,
// since the farthest point was taken each time: n pi (s / 2)^2 < 4 pi < n pi s^2.
#[test]
fn the_least_spacing_is_between_the_bounds_of_packing_and_covering() {
    let points = sphere(20_000);
    for n in [30, 300, 3000] {
        let chosen: Vec<Vec3> = evenly(&points, n).into_iter().map(|i| points[i]).collect();
        let least = (0..n)
            .flat_map(|i| (0..i).map(move |j| (i, j)))
            .map(|(i, j)| chosen[i].distance(chosen[j]))
            .fold(f32::INFINITY, f32::min);
        let (covering, packing) = (2.0 / (n as f32).sqrt(), 4.0 / (n as f32).sqrt());
        // Choosing among 20,000 points falls short of choosing anywhere by less than two of their spacings.
        assert!((covering - 0.05 * covering - 2.0 * 0.025..packing).contains(&least), "{n}: {least}");
    }
}

#[test]
fn few_or_odd_points_are_no_trouble() {
    assert!(evenly(&[], 3).is_empty());
    assert!(evenly(&[Vec3::ONE], 0).is_empty());
    assert_eq!(evenly(&[Vec3::ONE; 4], 3), [0, 1, 2]);
    assert_eq!(evenly(&[Vec3::NAN, Vec3::ONE, Vec3::X], 3), [1, 2, 0]);
    assert_eq!(evenly(&[Vec3::splat(f32::MAX), Vec3::ZERO, Vec3::splat(-f32::MAX)], 2).len(), 2);
}

#[test]
fn of_places_taken_twice_each_is_chosen_once_first() {
    let mut points = sphere(200);
    points.extend_from_within(..);
    let mut first: Vec<usize> = evenly(&points, 200).into_iter().map(|i| i % 200).collect();
    first.sort_unstable();
    assert!(first.into_iter().eq(0..200));
}
