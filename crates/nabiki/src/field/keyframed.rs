//! The force field of the paper: a few vectors over intervals of frames, equation (5), optionally eased.

use glam::Vec3;

use super::Field;
use crate::error::SettingError;
use crate::smoothing::rise;
use crate::{settings, words};

settings! {
    /// One interval of the wind. `vector` applies in each frame after the previous interval, up to and including
    /// `through`.
    #[derive(Copy)]
    pub struct Keyframe {
        /// Last frame of the interval (k_j of equation (5)).
        pub through: u32 = 100 => "Last frame", must "50", unit "frame";
        /// Force F_j: direction and strength, without a unit. Only c_i |F| moves hair (section 4.3).
        pub vector: Vec3 = Vec3::ZERO => "Vector", must "[-100, 0, 0]";
    }
}

words! {
    /// How the wind changes from one vector to the next.
    pub enum Ease = Stepped {
        /// Each vector applies throughout its interval, as in the paper.
        Stepped = "stepped",
        /// Straight lines between the middles of the intervals: e(t) = t.
        Linear = "linear",
        /// Smooth curves between the middles of the intervals: e(t) = 3 t^2 - 2 t^3.
        Smooth = "smooth",
    }
}

settings! {
    /// How the vectors of the intervals follow one another.
    #[derive(Eq)]
    pub struct Wind in "wind" {
        /// How the wind changes from one vector to the next.
        pub ease: Ease = Ease::Stepped => "Ease";
    }
}

/// A keyframed force, uniform in space.
#[derive(Clone, Debug, PartialEq)]
pub struct KeyframedField {
    keyframes: Vec<Keyframe>,
    ease: Ease,
}

impl KeyframedField {
    /// The paper's field, constant between keyframes.
    ///
    /// # Errors
    /// No keyframes, frames that do not ascend from 1, or a vector that is not finite. The error names the keyframe
    /// `force[j]`, counted from 0 as in overrides of a scene file.
    pub fn new(keyframes: &[Keyframe]) -> Result<Self, SettingError> {
        if keyframes.is_empty() {
            return Err(SettingError::new("force", "", "has no keyframes: give at least one"));
        }
        let mut previous = 0;
        for (j, key) in keyframes.iter().enumerate() {
            if key.through <= previous {
                return Err(SettingError::new(
                    format!("force[{j}].through"),
                    key.through,
                    format!("must come after frame {previous}, where the interval before it ends"),
                ));
            }
            if !key.vector.is_finite() {
                let remedy = "each component must be a finite number";
                return Err(SettingError::new(format!("force[{j}].vector"), key.vector, remedy));
            }
            previous = key.through;
        }
        Ok(Self { keyframes: keyframes.to_vec(), ease: Ease::Stepped })
    }

    /// The same vectors with another ease.
    #[must_use]
    pub fn eased(self, ease: Ease) -> Self {
        Self { ease, ..self }
    }

    /// F(n). If stepped, it is equation (5): at a shared frame k_j the earlier vector applies, and the last vector
    /// applies after all keyframes, too.
    pub fn vector(&self, frame: u32) -> Vec3 {
        match self.ease {
            Ease::Stepped => {
                let j = self.keyframes.partition_point(|key| key.through < frame);
                self.keyframes[j.min(self.keyframes.len() - 1)].vector
            }
            Ease::Linear => self.between(frame, |t| t),
            Ease::Smooth => self.between(frame, rise),
        }
    }

    /// The vector in a frame. `ease` gives the part of the change at a part of the time.
    fn between(&self, frame: u32, ease: fn(f64) -> f64) -> Vec3 {
        self.between_at(f64::from(frame), frame, ease)
    }

    /// The force in the middle of the frames from the first to the last: the vector for an interval of them that
    /// changes an eased wind as little as possible.
    pub(crate) fn middle_of(&self, first: u32, last: u32) -> Vec3 {
        let time = 0.5 * (f64::from(first) + f64::from(last));
        let frame = first + (last - first).div_ceil(2);
        match self.ease {
            Ease::Stepped => self.vector(frame),
            Ease::Linear => self.between_at(time, frame, |t| t),
            Ease::Smooth => self.between_at(time, frame, rise),
        }
    }

    /// At a time; `frame` is the first that is not before it.
    fn between_at(&self, time: f64, frame: u32, ease: fn(f64) -> f64) -> Vec3 {
        let next = self.keyframes.partition_point(|key| key.through < frame).min(self.keyframes.len() - 1);
        // The frame lies in interval `next`: before its middle, or after.
        let next = if time > self.middle(next) { next + 1 } else { next };
        let Some(to) = self.keyframes.get(next) else { return self.keyframes[next - 1].vector };
        let Some(from) = next.checked_sub(1) else { return to.vector };
        let t = (time - self.middle(from)) / (self.middle(next) - self.middle(from));
        self.keyframes[from].vector.lerp(to.vector, ease(t) as f32)
    }

    /// Halfway between the first and the last frame of an interval.
    fn middle(&self, j: usize) -> f64 {
        let first = 1 + j.checked_sub(1).map_or(0, |before| self.keyframes[before].through);
        (f64::from(first) + f64::from(self.keyframes[j].through)) / 2.0
    }

    /// The first frame that vector `j` influences. If eased, it is the first after the middle of the previous interval.
    ///
    /// # Panics
    /// If there is no such vector.
    pub fn first_felt(&self, j: usize) -> u32 {
        assert!(j < self.keyframes.len(), "vector {j} of {}", self.keyframes.len());
        match (j.checked_sub(1), self.ease) {
            (None, _) => 1,
            (Some(before), Ease::Stepped) => self.keyframes[before].through + 1,
            (Some(before), Ease::Linear | Ease::Smooth) => self.middle(before) as u32 + 1,
        }
    }

    /// The ease.
    pub fn ease(&self) -> Ease {
        self.ease
    }

    /// The intervals, in order.
    pub fn keyframes(&self) -> &[Keyframe] {
        &self.keyframes
    }
}

impl Field for KeyframedField {
    fn at(&self, _point: Vec3, frame: u32) -> Vec3 {
        self.vector(frame)
    }

    /// An eased value lies between two vectors.
    fn strongest(&self) -> f32 {
        self.keyframes.iter().map(|key| key.vector.length()).fold(0.0, f32::max)
    }

    fn first_above(&self, limit: f64) -> Option<(String, String)> {
        let above = |key: &Keyframe| f64::from(key.vector.length()) > limit;
        let j = self.keyframes.iter().position(above)?;
        Some((format!("force[{j}].vector"), self.keyframes[j].vector.to_string()))
    }

    fn uniform(&self, frame: u32) -> Option<Vec3> {
        Some(self.vector(frame))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn key(through: u32, x: f32) -> Keyframe {
        Keyframe { through, vector: Vec3::new(x, 0.0, 0.0) }
    }

    #[test]
    fn the_earlier_vector_holds_at_a_shared_frame_and_the_last_one_for_good() {
        let field = KeyframedField::new(&[key(50, 1.0), key(100, 2.0)]).unwrap();
        for (frame, x) in [(1, 1.0), (50, 1.0), (51, 2.0), (100, 2.0), (101, 2.0), (u32::MAX, 2.0)] {
            assert_eq!(field.vector(frame).x, x, "frame {frame}");
        }
    }

    #[test]
    fn eased_fields_meet_their_vectors_in_the_middle_and_each_other_halfway() {
        let keys = [key(10, 0.0), key(20, 8.0), key(40, 4.0)];
        let at = |ease, frame| KeyframedField::new(&keys).unwrap().eased(ease).vector(frame).x;
        // The middles are 5.5, 15.5 and 30.5.
        for ease in [Ease::Linear, Ease::Smooth] {
            for (frame, x) in
                [(0, 0.0), (1, 0.0), (5, 0.0), (23, 6.0), (31, 4.0), (40, 4.0), (41, 4.0), (u32::MAX, 4.0)]
            {
                assert_eq!(at(ease, frame), x, "{ease:?}, frame {frame}");
            }
            // Symmetrical about the frame and a half where two intervals of ten frames meet.
            for i in 0..5 {
                assert!((at(ease, 10 - i) + at(ease, 11 + i) - 8.0).abs() < 1e-6, "{ease:?}, {i}");
            }
        }
        assert_eq!(at(Ease::Linear, 8), 2.0);
        // 3/16 - 2/64 of 8.
        assert_eq!(at(Ease::Smooth, 8), 1.25);
    }

    #[test]
    fn a_vector_is_first_felt_where_it_first_makes_a_difference() {
        let frames = [10, 11, 20, 41];
        for ease in [Ease::Stepped, Ease::Linear, Ease::Smooth] {
            for j in 0..frames.len() {
                let alone: Vec<Keyframe> = (0..frames.len()).map(|i| key(frames[i], f32::from(i == j))).collect();
                let field = KeyframedField::new(&alone).unwrap().eased(ease);
                assert_eq!((1..).find(|&n| field.vector(n).x != 0.0), Some(field.first_felt(j)), "{ease:?}, {j}");
            }
        }
    }

    #[test]
    fn keyframes_in_every_frame_leave_nothing_to_ease() {
        let keys: Vec<Keyframe> = (1..30).map(|n| key(n, (n * n % 17) as f32)).collect();
        let field = KeyframedField::new(&keys).unwrap();
        for ease in [Ease::Linear, Ease::Smooth] {
            let eased = field.clone().eased(ease);
            assert!((0..40).all(|n| eased.vector(n) == field.vector(n)));
        }
    }

    #[test]
    fn fields_without_order_or_numbers_are_refused_by_name() {
        assert_eq!(KeyframedField::new(&[]).unwrap_err().thing, "force");
        assert_eq!(KeyframedField::new(&[key(0, 1.0)]).unwrap_err().thing, "force[0].through");
        assert_eq!(KeyframedField::new(&[key(50, 1.0), key(50, 1.0)]).unwrap_err().thing, "force[1].through");
        assert_eq!(KeyframedField::new(&[key(50, f32::NAN)]).unwrap_err().thing, "force[0].vector");
    }

    #[test]
    fn the_first_vector_too_strong_is_named() {
        let field = KeyframedField::new(&[key(10, 3.0), key(20, -5.0), key(30, 7.0)]).unwrap();
        assert_eq!(field.strongest(), 7.0);
        assert_eq!(field.first_above(7.0), None);
        assert_eq!(field.first_above(6.9).unwrap().0, "force[2].vector");
        assert_eq!(field.first_above(3.5).unwrap().0, "force[1].vector");
    }
}
