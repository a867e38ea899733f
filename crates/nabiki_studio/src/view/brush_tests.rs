use super::*;
use crate::view::pick::tests::{hanging, skins, view};

/// Strands in front of the face, 2 cm apart, and two behind the head.
fn hair() -> Strands {
    hanging(&[[13.0, -4.0], [13.0, -2.0], [13.0, 0.0], [13.0, 2.0], [13.0, 4.0], [-13.0, 0.0], [-13.0, 2.0]])
}

fn with<T>(strands: &Strands, does: impl FnOnce(&Seen<'_>) -> T) -> T {
    let (view, skins) = (view(), skins());
    does(&Seen { view: &view, points: strands.points(), strands, among: usize::MAX, skins: &skins })
}

fn pixel(place: Vec3) -> Vec2 {
    view().project(place).truncate()
}

#[test]
fn a_brush_touches_what_it_passes_over_and_nothing_that_is_hidden() {
    let strands = hair();
    let at = |z: f32| pixel(Vec3::new(13.0, 0.5, z));
    // Strands are 2 cm apart: a brush of 3 cm reaches the next ones.
    let radius = at(0.0).distance(at(3.0));
    let amounts = with(&strands, |seen| seen.under([at(0.0); 2], radius));
    assert!((amounts[2] - 1.0).abs() < 1e-4, "{amounts:?}");
    for (near, far) in [(1, 0), (3, 4)] {
        // The middle of the head is farther away than the strands; along one plane, pixels are as centimetres.
        assert!((amounts[near] - fall(2.0 / 3.0)).abs() < 0.02 && amounts[far] == 0.0, "{amounts:?}");
    }
    assert_eq!(amounts[5..], [0.0, 0.0]);
    // On its way it touches each as at its nearest.
    let along = with(&strands, |seen| seen.under([at(-4.0), at(4.0)], radius));
    assert!(along[..5].iter().all(|amount| (amount - 1.0).abs() < 1e-4) && along[5] == 0.0, "{along:?}");
}

#[test]
fn a_lasso_takes_the_strands_of_which_half_lies_within() {
    let strands = hair();
    let corner = |y: f32, z: f32| pixel(Vec3::new(13.0, y, z));
    let around = |low: f32| [corner(6.0, -5.0), corner(6.0, 1.0), corner(low, 1.0), corner(low, -5.0)];
    let chosen = |low: f32| with(&strands, |seen| seen.within(&around(low)));
    // Nodes are at 4, 3, ... -4: of nine, five lie above -0.5.
    assert_eq!(chosen(-0.5), [1.0, 1.0, 1.0, 0.0, 0.0, 0.0, 0.0]);
    assert_eq!(chosen(0.5), [0.0; 7]);
    assert_eq!(with(&strands, |seen| seen.within(&[])), [0.0; 7]);
}

#[test]
fn strokes_add_erase_and_even_out() {
    let strands = hair();
    let none = Weights::new(&strands, usize::MAX, None);
    assert_eq!(none.of(), [0.0; 7]);
    let covered = [0.0, 0.25, 1.0, 0.25, 0.0, 0.0, 0.0];
    let added = none.stroked(Stroke::Add, &covered);
    assert_eq!(added.of(), covered);
    let more = added.stroked(Stroke::Add, &covered);
    assert_eq!(more.of()[1], 0.4375);
    let erased = more.stroked(Stroke::Erase, &[1.0, 1.0, 0.5, 0.0, 0.0, 0.0, 0.0]);
    assert_eq!(erased.of(), [0.0, 0.0, 0.5, 0.4375, 0.0, 0.0, 0.0]);
    // Strands are 2 cm apart, so two others on each side are near the middle one.
    let even = added.stroked(Stroke::Smooth, &[0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0]);
    assert_eq!(even.of(), [0.0, 0.25, 0.3, 0.25, 0.0, 0.0, 0.0]);
}

#[test]
fn what_is_mirrored_is_the_same_on_both_sides() {
    let none = Weights::new(&hair(), 5, None);
    assert_eq!(none.mirrored(&[0.5, 0.1, 0.3, 0.0, 0.2]), [0.5, 0.1, 0.3, 0.1, 0.5]);
}

/// What the scene keeps gives each strand the weight that it was painted with, within the hundredth that is kept.
#[test]
fn a_painted_region_has_the_weights_that_were_painted() {
    let places: Vec<[f32; 2]> = (0..60).map(|i| [7.0 + 0.1 * (i % 3) as f32, -9.0 + 0.3 * i as f32]).collect();
    let strands = hanging(&places);
    let covered: Vec<f32> = (0..60).map(|i| fall((i as f32 - 20.0) / 9.5)).collect();
    let painted = Weights::new(&strands, 60, None).stroked(Stroke::Add, &covered);
    let mut region = Region { near: Some(Vec3::ONE), to: Some(Vec3::X), ..Region::default() };
    painted.paint(&mut region);
    assert_eq!((region.near, region.to), (None, None));
    assert!(region.painted.len() < 40, "only what is near: {}", region.painted.len());
    let again = Weights::new(&strands, 60, Some(&region));
    for (a, b) in again.of().iter().zip(painted.of()) {
        assert!((a - b).abs() <= 0.0051, "{a} {b}");
    }
    // Painted anew from what was kept, it stays.
    let mut twice = region.clone();
    again.paint(&mut twice);
    assert_eq!(twice, region);
}
