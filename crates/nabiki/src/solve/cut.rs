//! Cuts an interval for a pull out of the wind, before the frame in which hair is pulled. The wind acts where it is
//! felt and stays the same in all other frames.

use std::ops::RangeInclusive;

use glam::Vec3;

use super::keyed_wind::with_interval;
use crate::field::{Ease, Keyframe, KeyframedField};

/// An interval for a pull may end up to this many frames after the pulled one, so that no rest of a frame or two remains.
const TAIL: u32 = 2;

/// A wind with an interval for a pull.
#[derive(Clone, Debug, PartialEq)]
pub struct Cut {
    /// All intervals. A stepped wind is unchanged until you change a vector. In an eased wind, the intervals next to
    /// the new one get the vector that the wind had in their middle.
    pub keyframes: Vec<Keyframe>,
    /// The index of the pull's interval.
    pub interval: usize,
    /// The frames in which the wind may change, whatever the vector of the pull's interval. In all other frames it
    /// stays the same, bit by bit.
    pub felt: RangeInclusive<u32>,
}

/// Makes an interval of about `length` frames that ends at `frame`, for a pull in that frame. It uses the interval of
/// an earlier pull again and keeps nearby borders, so that repeated pulls do not create many small intervals.
///
/// # Panics
/// If the frame is 0.
pub fn cut_for_pull(keyframes: &[Keyframe], ease: Ease, frame: u32, length: u32) -> Cut {
    assert!(frame > 0, "frame 0 is rest");
    let length = length.clamp(1, frame);
    let firsts: Vec<u32> = (0..keyframes.len()).map(|j| first(keyframes, j)).collect();
    let wanted = frame + 1 - length;
    let near = length.div_ceil(3);
    let begins = firsts.iter().copied().filter(|first| first.abs_diff(wanted) <= near && first + 1 < frame.max(2));
    let from = begins.min_by_key(|first| first.abs_diff(wanted)).unwrap_or(wanted);
    let ends = keyframes.iter().map(|key| key.through).find(|&through| through >= frame);
    let through = ends.filter(|end| end - frame <= TAIL).unwrap_or(frame);
    let known = keyframes.iter().position(|key| key.through == through).filter(|&j| firsts[j] == from);
    let (keyframes, interval, before) = match known {
        Some(interval) => (ended(keyframes, interval), interval, keyframes),
        None => {
            let (cut, interval) = with_interval(keyframes, from, through);
            (as_it_was(keyframes, ease, cut), interval, keyframes)
        }
    };
    let felt = felt(before, &keyframes, ease, &[interval]);
    Cut { keyframes, interval, felt }
}

/// The wind that held after the last interval gets an interval of its own, so that the pull ends with its frames.
fn ended(keyframes: &[Keyframe], interval: usize) -> Vec<Keyframe> {
    let Keyframe { through, vector } = keyframes[interval];
    let goes_on =
        (interval + 1 == keyframes.len() && through < u32::MAX).then_some(Keyframe { through: through + 1, vector });
    keyframes.iter().copied().chain(goes_on).collect()
}

/// First frame of interval `j`.
fn first(keyframes: &[Keyframe], j: usize) -> u32 {
    1 + j.checked_sub(1).map_or(0, |before| keyframes[before].through)
}

/// Sets the vectors of new intervals of an eased wind to the wind in their middle.
fn as_it_was(before: &[Keyframe], ease: Ease, mut cut: Vec<Keyframe>) -> Vec<Keyframe> {
    let (Ok(field), true) = (KeyframedField::new(before), ease != Ease::Stepped) else { return cut };
    let field = field.eased(ease);
    for j in 0..cut.len() {
        let range = [first(&cut, j), cut[j].through];
        let was_there = (0..before.len()).any(|i| [first(before, i), before[i].through] == range);
        if !was_there {
            cut[j].vector = field.middle_of(range[0], range[1]);
        }
    }
    cut
}

/// The frames in which the wind may differ, whatever the vectors of these intervals of the new one. If an interval
/// lasts indefinitely, the range ends at `u32::MAX`.
///
/// # Panics
/// If there is no such interval.
pub fn felt(before: &[Keyframe], after: &[Keyframe], ease: Ease, intervals: &[usize]) -> RangeInclusive<u32> {
    let mut changed = after.to_vec();
    intervals.iter().for_each(|&interval| changed[interval].vector += Vec3::splat(1e3));
    let vector = |keyframes: &[Keyframe], frame: u32| match KeyframedField::new(keyframes) {
        Ok(field) => field.eased(ease).vector(frame),
        Err(_) => Vec3::ZERO,
    };
    let last = after.last().map_or(0, |key| key.through).saturating_add(1);
    let differs = |&frame: &u32| vector(before, frame) != vector(&changed, frame);
    let begin = (1..=last).find(differs).unwrap_or(1);
    let end = (begin..=last).rev().find(differs).unwrap_or(begin);
    begin..=if end == last { u32::MAX } else { end }
}

/// The largest change of the wind in any of these frames.
pub fn change(before: &[Keyframe], after: &[Keyframe], ease: Ease, frames: RangeInclusive<u32>) -> f32 {
    let field = |keyframes: &[Keyframe]| KeyframedField::new(keyframes).ok().map(|field| field.eased(ease));
    let (before, after) = (field(before), field(after));
    let vector = |field: &Option<KeyframedField>, frame| field.as_ref().map_or(Vec3::ZERO, |field| field.vector(frame));
    frames.map(|frame| vector(&before, frame).distance(vector(&after, frame))).fold(0.0, f32::max)
}

#[cfg(test)]
mod tests {
    use super::*;

    const EASES: [Ease; 3] = [Ease::Stepped, Ease::Linear, Ease::Smooth];

    fn key(through: u32, x: f32, y: f32) -> Keyframe {
        Keyframe { through, vector: Vec3::new(x, y, 0.1 * x - y) }
    }

    /// The intervals of the gust, others, and none.
    fn winds() -> [Vec<Keyframe>; 4] {
        let gust = [(6, 0.0, 0.0), (24, -300.0, 60.0), (40, -140.0, 10.0), (52, -320.0, 80.0), (60, 0.0, 0.0)];
        let others = [(3, 7.0, -1.0), (4, 50.0, 3.0), (90, -20.0, 30.0)];
        [
            gust.map(|(through, x, y)| key(through, x, y)).to_vec(),
            others.map(|(through, x, y)| key(through, x, y)).to_vec(),
            vec![key(50, 80.0, -3.0)],
            Vec::new(),
        ]
    }

    fn vector(keyframes: &[Keyframe], ease: Ease, frame: u32) -> Vec3 {
        if keyframes.is_empty() {
            return Vec3::ZERO;
        }
        KeyframedField::new(keyframes).unwrap().eased(ease).vector(frame)
    }

    #[test]
    fn whatever_a_pull_makes_of_its_interval_the_wind_beside_is_what_it_was_to_the_bit() {
        for keys in &winds() {
            for ease in EASES {
                for frame in [1, 2, 5, 20, 24, 36, 53, 58, 60, 70, 100] {
                    for length in [4, 10, 16, 200] {
                        let Cut { mut keyframes, interval, felt } = cut_for_pull(keys, ease, frame, length);
                        keyframes[interval].vector = Vec3::new(-500.0, 20.0, 333.0);
                        assert!(felt.contains(&frame), "{keys:?} {ease:?} {frame} {length}: {felt:?}");
                        assert!(*felt.end() < u32::MAX, "{keys:?} {ease:?} {frame} {length} never ends");
                        for n in (1..130).filter(|n| !felt.contains(n)) {
                            let (was, is) = (vector(keys, ease, n), vector(&keyframes, ease, n));
                            assert_eq!(was, is, "{keys:?} {ease:?} {frame} {length}: frame {n} outside {felt:?}");
                        }
                    }
                }
            }
        }
    }

    #[test]
    fn a_stepped_wind_feels_a_pull_in_its_interval_alone_and_an_eased_one_no_farther_than_the_middles_beside() {
        for keys in &winds() {
            let cut = cut_for_pull(keys, Ease::Stepped, 36, 10);
            let own = first(&cut.keyframes, cut.interval)..=cut.keyframes[cut.interval].through;
            assert_eq!(cut.felt, own);
            assert!(own.contains(&36) && own.end() - 36 <= TAIL);
            for n in 1..130 {
                assert_eq!(vector(&cut.keyframes, Ease::Stepped, n), vector(keys, Ease::Stepped, n));
            }
        }
        // The calm at the end is calm again one frame later, and was calm up to the middle of the remainder before it, 61 to 70.
        let cut = cut_for_pull(&winds()[0], Ease::Smooth, 80, 10);
        assert_eq!(cut.felt, 66..=80);
        // The middles of the intervals that remain: 3.5 and 32.5.
        let cut = cut_for_pull(&winds()[0], Ease::Smooth, 20, 8);
        assert!(*cut.felt.start() >= 4 && *cut.felt.end() <= 32, "{:?}", cut.felt);
    }

    #[test]
    fn an_eased_wind_is_nearly_what_it_was_before_a_pull_changes_its_interval() {
        let keys = &winds()[0];
        for ease in [Ease::Linear, Ease::Smooth] {
            for frame in [20, 36, 50, 58, 80] {
                let cut = cut_for_pull(keys, ease, frame, 10);
                let off = (1..110).map(|n| vector(&cut.keyframes, ease, n).distance(vector(keys, ease, n)));
                let off = off.fold(0.0, f32::max);
                assert!(off < 0.2 * 330.0, "{ease:?} {frame}: {off}");
            }
        }
    }

    #[test]
    fn pull_after_pull_at_a_frame_or_beside_it_makes_one_interval() {
        for keys in winds() {
            for ease in EASES {
                let once = cut_for_pull(&keys, ease, 36, 10);
                let mut twice = once.clone();
                for frame in [36, 36, 35, 36, 34, 36] {
                    twice = cut_for_pull(&twice.keyframes, ease, frame, 10);
                }
                assert_eq!(twice.keyframes, once.keyframes, "{keys:?} {ease:?}");
                assert_eq!(twice.interval, once.interval);
                // A nearly equal length is not another interval, either.
                assert_eq!(cut_for_pull(&once.keyframes, ease, 36, 12).keyframes, once.keyframes);
            }
        }
    }
}
