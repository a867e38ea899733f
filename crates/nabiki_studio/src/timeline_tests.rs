use super::*;
use nabiki::field::{Keyframe, KeyframedField};

fn key(through: u32, x: f32) -> ForceSettings {
    ForceSettings { through, vector: Vec3::new(x, 0.0, 0.0), speed: None }
}

fn as_given(keys: &[ForceSettings]) -> Vec<Keyframe> {
    keys.iter().map(|key| key.keyframe(0.0)).collect()
}

fn three() -> Vec<ForceSettings> {
    vec![key(10, 1.0), key(30, 2.0), key(60, 3.0)]
}

/// The force of every frame, which is what an interval is for.
fn felt(keys: &[ForceSettings]) -> Vec<f32> {
    let field = KeyframedField::new(&as_given(keys)).unwrap();
    (1..=80).map(|n| field.vector(n).x).collect()
}

fn ends(keys: &[ForceSettings]) -> Vec<u32> {
    keys.iter().map(|key| key.through).collect()
}

#[test]
fn a_border_goes_where_it_is_led_and_no_farther_than_its_neighbours() {
    assert_eq!(ends(&move_border(&three(), 1, 40, false)), [10, 40, 60]);
    assert_eq!(ends(&move_border(&three(), 1, 0, false)), [10, 11, 60]);
    assert_eq!(ends(&move_border(&three(), 1, 99, false)), [10, 59, 60]);
    assert_eq!(ends(&move_border(&three(), 2, 99, false)), [10, 30, 99]);
    assert_eq!(ends(&move_border(&three(), 0, 0, false)), [1, 30, 60]);
    assert_eq!(ends(&move_border(&three(), 0, 15, true)), [15, 35, 65]);
    assert_eq!(ends(&move_border(&three(), 1, 3, true)), [10, 11, 41]);
}

#[test]
fn what_slides_keeps_its_length() {
    assert_eq!(ends(&slide(&three(), &[1], 5)), [15, 35, 60]);
    assert_eq!(ends(&slide(&three(), &[1], -50)), [1, 21, 60]);
    assert_eq!(ends(&slide(&three(), &[1], 50)), [39, 59, 60]);
    assert_eq!(ends(&slide(&three(), &[1, 2], 7)), [17, 37, 67]);
    assert_eq!(slide(&three(), &[0], 7), three());
    // Of those chosen while the others were dragged some are not among these.
    assert_eq!(slide(&three(), &[1, 2, 3, 7], 7), slide(&three(), &[1, 2], 7));
}

#[test]
fn a_cut_changes_no_force() {
    for frame in 1..70 {
        let Some(cut) = split(&three(), frame) else {
            assert!(ends(&three()).contains(&frame));
            continue;
        };
        assert_eq!(felt(&cut), felt(&three()), "at {frame}");
        assert_eq!(cut.len(), 4);
        assert!(ends(&cut).contains(&frame));
    }
    assert_eq!(split(&[], 5), None);
}

#[test]
fn joined_neighbours_have_the_force_of_the_longest() {
    assert_eq!(join(&three(), &[1, 2]), Some(vec![key(10, 1.0), key(60, 3.0)]));
    assert_eq!(join(&three(), &[0, 1, 2]), Some(vec![key(60, 3.0)]));
    assert_eq!(join(&three(), &[0, 2]), None);
    assert_eq!(join(&three(), &[1]), None);
    assert_eq!(join(&[key(30, 1.0), key(40, 9.0)], &[0, 1]), Some(vec![key(40, 1.0)]), "it is not the strongest");
    assert_eq!(join(&[key(10, 1.0), key(20, 2.0)], &[0, 1]), Some(vec![key(20, 1.0)]), "of equal ones the first");
    let cut = split(&three(), 20).unwrap();
    assert_eq!(join(&cut, &[1, 2]), Some(three()), "what was cut is joined again");
}

#[test]
fn what_is_removed_leaves_its_place_to_the_one_before() {
    assert_eq!(remove(&three(), &[1]), [key(30, 1.0), key(60, 3.0)]);
    assert_eq!(remove(&three(), &[0]), [key(30, 2.0), key(60, 3.0)]);
    assert_eq!(remove(&three(), &[0, 1, 2]), []);
}

#[test]
fn a_clip_lies_over_its_frames_and_no_others() {
    let clip = copy(&three(), &[0, 1]);
    let second = ForceSettings { through: 20, ..three()[1] };
    assert_eq!(clip, Clip(vec![(10, three()[0]), (20, second)]));
    for from in 1..70_usize {
        let (pasted, chosen) = paste(&three(), from as u32, &clip);
        let (before, after) = (felt(&three()), felt(&pasted));
        for n in 1..=60_usize {
            let expected = match n {
                n if n < from => before[n - 1],
                n if n < from + 10 => 1.0,
                n if n < from + 30 => 2.0,
                n => before[n - 1],
            };
            assert_eq!(after[n - 1], expected, "frame {n} after a paste at {from}");
        }
        assert_eq!(copy(&pasted, &chosen), clip);
    }
    let (alone, chosen) = paste(&[], 5, &clip);
    assert_eq!((ends(&alone), chosen), (vec![4, 14, 34], vec![1, 2]));
}

#[test]
fn a_new_interval_is_always_there_afterwards() {
    for frame in 0..=80 {
        let (keys, j) = add(&three(), frame, 80);
        assert!(KeyframedField::new(&as_given(&keys)).is_ok(), "at {frame}");
        assert!(keys.len() == 4 && j < 4, "at {frame}: {keys:?}");
    }
    assert_eq!(ends(&add(&[], 3, 50).0), [50], "the first one is all the wind there is");
    let (keys, j) = add(&three(), 15, 60);
    assert_eq!(
        (ends(&keys), j, felt(&keys)),
        (vec![10, 15, 30, 60], 2, felt(&three())),
        "it begins after the frame shown"
    );
    let (keys, j) = add(&three(), 30, 60);
    assert_eq!((ends(&keys), j), (vec![10, 20, 30, 60], 2), "or in the middle, where that ends there");
    let (keys, j) = add(&three(), 70, 80);
    assert_eq!((ends(&keys), j, felt(&keys)), (vec![10, 30, 60, 80], 3, felt(&three())));
}

#[test]
fn a_frame_belongs_to_the_interval_that_it_feels() {
    assert_eq!([1, 10, 11, 30, 60, 99].map(|n| at(&three(), n)), [0, 0, 1, 1, 2, 2].map(Some));
    assert_eq!(within(&three(), 10..=11), [0, 1]);
    assert!(within(&three(), 61..=70).is_empty());
}

#[test]
fn an_interval_that_ends_with_the_last_frame_that_there_is_can_be_worked_on_like_any_other() {
    const LAST: u32 = u32::MAX;
    let keys = vec![key(10, 1.0), key(30, 2.0), key(LAST, 3.0)];
    assert_eq!(ends(&move_border(&keys, 0, 50, true)), [10, 30, LAST], "nothing can move along");
    assert_eq!(ends(&move_border(&keys, 0, 4, true)), [4, 24, LAST - 6]);
    assert_eq!(ends(&slide(&keys, &[2], 7)), [10, 30, LAST]);
    assert_eq!(join(&keys, &[1, 2]), Some(vec![key(10, 1.0), key(LAST, 3.0)]));
    let all = copy(&keys, &[0, 1, 2]);
    assert_eq!(all.0.iter().map(|of| of.0).collect::<Vec<_>>(), [10, 20, LAST - 30]);
    assert_eq!(copy(&[key(LAST, 1.0)], &[0]).0[0].0, LAST);
    let twice = Clip([all.0.clone(), all.0.clone()].concat());
    for (from, clip) in [(1, &all), (25, &all), (25, &twice)] {
        let (pasted, chosen) = paste(&keys, from, clip);
        assert!(KeyframedField::new(&as_given(&pasted)).is_ok(), "{pasted:?}");
        assert_eq!((pasted.last().unwrap().through, chosen.last().unwrap() + 1), (LAST, pasted.len()));
    }
}

#[test]
fn chosen_intervals_get_their_lengths_and_what_comes_after_moves_along() {
    let keys = three();
    assert_eq!(ends(&with_lengths(&keys, &[0, 2], |j| 5 + j as u32)), [5, 25, 32]);
    assert_eq!(ends(&with_lengths(&keys, &[1], |_| 0)), [10, 11, 41], "each keeps a frame");
    assert_eq!(ends(&with_lengths(&keys, &[0, 1], |_| u32::MAX)), [u32::MAX - 2, u32::MAX - 1, u32::MAX]);
    assert_eq!(with_lengths(&keys, &[], |_| 1), keys);
}
