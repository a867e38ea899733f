//! The force field of the paper: a few vectors over a few frames, equation (5).

use glam::Vec3;
use serde::{Deserialize, Serialize};

use super::Field;
use crate::error::SettingError;

/// One interval of a field: `vector` drives every frame after the previous keyframe's and up to `through`.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Keyframe {
    /// Last frame that feels this vector (k_j of equation (5)).
    pub through: u32,
    /// Force F_j: a direction with a strength, without a unit (section 4.3: only c_i |F| moves hair).
    pub vector: Vec3,
}

/// A force uniform in space and constant between keyframes.
#[derive(Clone, Debug, PartialEq)]
pub struct KeyframedField {
    keyframes: Vec<Keyframe>,
}

impl KeyframedField {
    /// Checks that there is a keyframe, that their frames ascend from 1 and that every vector is finite.
    ///
    /// # Errors
    /// Names the keyframe as `force[j]`, counted from 0 as the scene file's overrides count them.
    pub fn new(keyframes: &[Keyframe]) -> Result<Self, SettingError> {
        if keyframes.is_empty() {
            return Err(SettingError::new("force", "none", "a field has at least one keyframe"));
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
        Ok(Self { keyframes: keyframes.to_vec() })
    }

    /// F(n), equation (5). At a shared frame k_j the earlier vector holds; the last vector holds for good.
    pub fn vector(&self, frame: u32) -> Vec3 {
        let j = self.keyframes.partition_point(|key| key.through < frame);
        self.keyframes[j.min(self.keyframes.len() - 1)].vector
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
