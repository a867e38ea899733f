use nabiki::Strands;

use super::*;
use crate::view::pick::tests::{hanging, skins, view};

fn lengths(strand: &[Vec3]) -> Vec<f32> {
    strand.windows(2).map(|ends| ends[0].distance(ends[1])).collect()
}

fn take(strands: &Strands, place: Vec3, radius: f32) -> Option<Comb> {
    let (view, skins) = (view(), skins());
    let seen = Seen { view: &view, points: strands.points(), strands, among: usize::MAX, skins: &skins };
    Comb::take(&seen, view.project(place).truncate(), radius)
}

#[test]
fn combed_hair_goes_where_the_hand_goes_and_keeps_root_and_length() {
    let strands = hanging(&[[13.0, 0.0], [13.0, 0.6], [13.0, 6.0]]);
    let tip = strands.strand(0)[9];
    let comb = take(&strands, tip, 30.0).unwrap();
    assert_eq!(comb.hand, tip);
    let way = Vec3::new(0.0, 2.0, -4.0);
    let combed = comb.combed(way, &skins());
    // The one aside is out of reach.
    assert_eq!(combed.iter().map(|of| of.0).collect::<Vec<_>>(), [0, 1]);
    for (s, laid) in &combed {
        let of = strands.strand(*s);
        assert_eq!(laid[0], of[0]);
        for (a, b) in lengths(laid).into_iter().zip(lengths(of)) {
            assert!((a - b).abs() < 1e-5, "{a} {b}");
        }
    }
    assert!(combed[0].1[9].distance(tip + way) < 2.0 * ARRIVED_CM);
    let part = combed[1].1[9].distance(strands.strand(1)[9]) / way.length();
    assert!(part > 0.2 && part < 0.95, "the one beside it comes along in part: {part}");
}

#[test]
fn a_hand_at_the_middle_takes_the_tip_along_and_one_too_far_away_stretches_it() {
    let strands = hanging(&[[13.0, 0.0]]);
    let of = strands.strand(0);
    let middle = take(&strands, of[5], 8.0).unwrap().combed(Vec3::new(0.0, 1.5, 2.5), &skins());
    let laid = &middle[0].1;
    assert!(laid[5].distance(of[5] + Vec3::new(0.0, 1.5, 2.5)) < 2.0 * ARRIVED_CM);
    // Beyond it the shape stays.
    for i in 5..9 {
        assert!((laid[i + 1].distance(laid[5]) - of[i + 1].distance(of[5])).abs() < 1e-4);
    }
    let far = take(&strands, of[9], 8.0).unwrap().combed(Vec3::new(0.0, 0.0, 40.0), &skins());
    let laid = &far[0].1;
    assert!((laid[9].distance(laid[0]) - 9.0).abs() < 0.01, "it is straight: {}", laid[9].distance(laid[0]));
}

#[test]
fn hair_is_not_combed_into_the_head_and_the_root_is_no_handle() {
    let strands = hanging(&[[13.0, 0.0]]);
    let of = strands.strand(0);
    let combed = take(&strands, of[9], 8.0).unwrap().combed(Vec3::new(-9.0, 3.0, 0.0), &skins());
    let laid = &combed[0].1;
    // Lengths are kept last, which may press a node in by little.
    let deepest = laid.iter().skip(1).map(|&place| skins().clearance(place)).fold(f32::INFINITY, f32::min);
    assert!(deepest > -0.2, "{deepest}");
    for (a, b) in lengths(laid).into_iter().zip(lengths(of)) {
        assert!((a - b).abs() < 1e-5, "{a} {b}");
    }
    let nothing = take(&strands, Vec3::new(13.0, 5.0, 30.0), 8.0);
    assert_eq!(nothing, None);
}
