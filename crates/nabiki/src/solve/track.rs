//! The wind as numbers that change: vectors, and borders between frames.

use glam::DVec3;

use crate::field::Ease;
use crate::smoothing::rise;

/// A wind uniform in space whose intervals may meet anywhere in time.
///
/// Stepped, the force of frame n is the mean of the vectors over the time from n - 1 to n: a border within it makes it a mix
/// of both, and a border at a frame is that of [`KeyframedField`](crate::field::KeyframedField). Eased fields go from the
/// middle of an interval to the middle of the next and need nothing new.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Track {
    pub vectors: Vec<DVec3>,
    /// The end of each interval; that of the last one counts only with an ease.
    pub borders: Vec<f64>,
    pub ease: Ease,
}

impl Track {
    /// Passes the share of each interval in the force of a frame to `part`.
    pub fn parts(&self, frame: u32, mut part: impl FnMut(usize, f64)) {
        let Some(last) = self.vectors.len().checked_sub(1) else { return };
        if self.ease == Ease::Stepped {
            let (begin, end) = (f64::from(frame) - 1.0, f64::from(frame));
            let mut since = begin;
            for (j, &border) in self.borders.iter().enumerate() {
                let until = if j == last { end } else { border.clamp(since, end) };
                if until > since {
                    part(j, until - since);
                }
                since = until;
            }
            return;
        }
        match self.between(frame) {
            Between::One(j) => part(j, 1.0),
            Between::Two { from, share, .. } => {
                part(from, 1.0 - share);
                part(from + 1, share);
            }
        }
    }

    pub fn vector(&self, frame: u32) -> DVec3 {
        let mut sum = DVec3::ZERO;
        self.parts(frame, |j, part| sum += part * self.vectors[j]);
        sum
    }

    /// The derivative of the force of a frame by the border after interval j. A border at a frame, where both sides
    /// meet, has the mean of both derivatives.
    pub fn by_border(&self, frame: u32, j: usize) -> DVec3 {
        let change = |next: usize| self.vectors[next - 1] - self.vectors[next];
        if self.ease == Ease::Stepped {
            let (border, end) = (self.borders[j], f64::from(frame));
            let within = if border > end - 1.0 && border < end {
                1.0
            } else if border == end || border == end - 1.0 {
                0.5
            } else {
                0.0
            };
            return within * change(j + 1);
        }
        let Between::Two { from, t, slope, length, .. } = self.between(frame) else { return DVec3::ZERO };
        // The middle of an interval moves half as far as each of its borders.
        let half = |i: usize| if i == j || i == j + 1 { 0.5 } else { 0.0 };
        let by_time = (half(from) * (t - 1.0) - half(from + 1) * t) / length;
        -slope * by_time * change(from + 1)
    }

    /// The place of a frame between two middles.
    fn between(&self, frame: u32) -> Between {
        let time = f64::from(frame);
        let last = self.vectors.len() - 1;
        let next = (0..=last).find(|&j| self.middle(j) >= time);
        match next {
            None => Between::One(last),
            Some(0) => Between::One(0),
            Some(next) => {
                let (begin, end) = (self.middle(next - 1), self.middle(next));
                let (length, t) = (end - begin, (time - begin) / (end - begin));
                let (share, slope) = match self.ease {
                    Ease::Smooth => (rise(t), 6.0 * t * (1.0 - t)),
                    _ => (t, 1.0),
                };
                Between::Two { from: next - 1, t, share, slope, length }
            }
        }
    }

    /// Halfway between the first and the last frame of an interval.
    fn middle(&self, j: usize) -> f64 {
        let before = if j == 0 { 0.0 } else { self.borders[j - 1] };
        (1.0 + before + self.borders[j]) / 2.0
    }
}

enum Between {
    /// In the first half of the first interval, or the second half of the last.
    One(usize),
    /// `t` of the way from the middle of interval `from` to that of the next, `length` frames apart: `share` of the
    /// force is the next one's, and `slope` is its derivative by t.
    Two { from: usize, t: f64, share: f64, slope: f64, length: f64 },
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::*;
    use crate::field::{Keyframe, KeyframedField};

    const EASES: [Ease; 3] = [Ease::Stepped, Ease::Linear, Ease::Smooth];

    fn track(ease: Ease, borders: [f64; 4]) -> Track {
        let vectors = vec![
            DVec3::new(1.0, 2.0, 3.0),
            DVec3::new(-4.0, 0.0, 8.0),
            DVec3::new(0.0, 16.0, -2.0),
            DVec3::new(5.0, 5.0, 0.0),
        ];
        Track { vectors, borders: borders.to_vec(), ease }
    }

    #[test]
    fn with_borders_at_frames_it_is_the_field_of_a_scene() {
        for ease in EASES {
            let track = track(ease, [7.0, 20.0, 21.0, 40.0]);
            let keys = track.borders.iter().zip(&track.vectors);
            let keys: Vec<Keyframe> =
                keys.map(|(&border, v)| Keyframe { through: border as u32, vector: v.as_vec3() }).collect();
            let field = KeyframedField::new(&keys).unwrap().eased(ease);
            for frame in 1..60 {
                let (a, b): (Vec3, Vec3) = (track.vector(frame).as_vec3(), field.vector(frame));
                assert!(a.distance(b) < 1e-5, "{ease:?}, frame {frame}: {a} {b}");
            }
        }
    }

    #[test]
    fn what_borders_change_is_what_differences_say() {
        const STEP: f64 = 1e-4;
        let at_frames = (Ease::Stepped, [7.0, 20.0, 21.0, 40.0]);
        for (ease, at) in EASES.map(|ease| (ease, [7.3, 19.5, 21.9, 40.0])).into_iter().chain([at_frames]) {
            for j in 0..3 {
                for frame in 1..45 {
                    let moved = |by: f64| {
                        let mut borders = at;
                        borders[j] += by;
                        track(ease, borders).vector(frame)
                    };
                    let expected = (moved(STEP) - moved(-STEP)) / (2.0 * STEP);
                    let exact = track(ease, at).by_border(frame, j);
                    assert!((exact - expected).length() < 1e-3, "{ease:?} {j} {frame}: {exact} {expected}");
                }
            }
        }
    }
}
