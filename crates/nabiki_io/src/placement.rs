//! The placement of a file's coordinates in head space: unit, up axis, facing and origin. It is applied once, on
//! import.

use glam::{Affine3A, DAffine3, DVec3, Mat3, Vec3};
use nabiki::SettingError;
use serde::{Deserialize, Serialize};

pub use crate::axis::Axis;
pub use crate::unit::Unit;

/// The conversion of a file's coordinates to head space (cm, y up, face +x).
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields, default)]
pub struct Placement {
    /// Length of one file unit (default: 1 cm).
    pub unit: Unit,
    /// Axis of the file that points up (default: +y).
    pub up: Axis,
    /// Axis of the file along which the face looks (default: +x).
    pub facing: Axis,
    /// Point of the file that becomes the origin of head space (file units, default: 0, 0, 0).
    pub origin: Vec3,
}

impl Default for Placement {
    fn default() -> Self {
        Self { unit: Unit::default(), up: Axis::PlusY, facing: Axis::PlusX, origin: Vec3::ZERO }
    }
}

impl Placement {
    /// Refuses units that are not above 0, equal or opposite axes, and origins that are not finite. `table` is the
    /// scene table with these settings, such as `head`.
    pub fn check(&self, table: &str) -> Result<(), SettingError> {
        nabiki::error::check_positive(&format!("{table}.unit"), self.unit.cm)?;
        if self.up.vector().dot(self.facing.vector()) != 0.0 {
            let remedy = format!("must not lie along {table}.up, which is \"{}\"", self.up);
            return Err(SettingError::new(format!("{table}.facing"), format!("\"{}\"", self.facing), remedy));
        }
        if !self.origin.is_finite() {
            return Err(SettingError::new(format!("{table}.origin"), self.origin, "must be finite"));
        }
        Ok(())
    }

    /// Rotation whose rows are the head's axes in the file: facing, up, right hand.
    fn head_from_file_rotation(&self) -> Mat3 {
        let (facing, up) = (self.facing.vector().as_vec3(), self.up.vector().as_vec3());
        Mat3::from_cols(facing, up, facing.cross(up)).transpose()
    }

    /// Maps the file's points into head space (cm).
    pub fn head_from_file(&self) -> Affine3A {
        self.head_from_file_in_doubles().as_affine3a()
    }

    /// Maps head space back to the file's space.
    pub fn file_from_head(&self) -> Affine3A {
        self.file_from_head_in_doubles().as_affine3a()
    }

    /// The origin of head space in the file's world, in the axes and unit of head space (cm).
    pub fn origin_in_world(&self) -> DVec3 {
        -self.head_from_file_in_doubles().translation
    }

    /// Like [`head_from_file`](Self::head_from_file), in f64, for combining it with the transforms of a file before
    /// points are transformed.
    pub fn head_from_file_in_doubles(&self) -> DAffine3 {
        let matrix3 = self.head_from_file_rotation().as_dmat3() * f64::from(self.unit.cm);
        DAffine3 { matrix3, translation: matrix3 * -self.origin.as_dvec3() }
    }

    /// Like [`file_from_head`](Self::file_from_head), in f64.
    pub fn file_from_head_in_doubles(&self) -> DAffine3 {
        let matrix3 = self.head_from_file_rotation().transpose().as_dmat3() * f64::from(self.unit.cm).recip();
        DAffine3 { matrix3, translation: self.origin.as_dvec3() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn facing_z_in_metres() -> Placement {
        Placement { unit: Unit { cm: 100.0 }, up: Axis::PlusY, facing: Axis::PlusZ, origin: Vec3::new(0.0, 1.5, 0.0) }
    }

    #[test]
    fn the_file_s_facing_up_and_right_become_x_y_and_z() {
        let head_from_file = facing_z_in_metres().head_from_file();
        assert_eq!(head_from_file.transform_point3(Vec3::new(0.0, 1.5, 0.25)), Vec3::new(25.0, 0.0, 0.0));
        assert_eq!(head_from_file.transform_point3(Vec3::new(0.0, 1.75, 0.0)), Vec3::new(0.0, 25.0, 0.0));
        // Facing +z with y up, the right hand is at -x.
        assert_eq!(head_from_file.transform_point3(Vec3::new(-0.25, 1.5, 0.0)), Vec3::new(0.0, 0.0, 25.0));
    }

    #[test]
    fn every_placement_is_a_rotation_and_comes_back() {
        let axes = [Axis::PlusX, Axis::MinusX, Axis::PlusY, Axis::MinusY, Axis::PlusZ, Axis::MinusZ];
        for up in axes {
            for facing in axes.into_iter().filter(|a| a.vector().dot(up.vector()) == 0.0) {
                let placement = Placement { up, facing, unit: Unit { cm: 4.0 }, origin: Vec3::new(1.0, -2.0, 3.0) };
                assert_eq!(placement.check("head"), Ok(()));
                assert_eq!(placement.head_from_file().matrix3.determinant(), 64.0);
                let there_and_back = placement.file_from_head() * placement.head_from_file();
                assert_eq!(there_and_back, Affine3A::IDENTITY, "up {up}, facing {facing}: all products are exact");
            }
        }
    }

    #[test]
    fn nonsense_is_refused_by_name() {
        let refused = |placement: Placement| placement.check("hair").unwrap_err().to_string();
        let good = facing_z_in_metres();
        assert_eq!(
            refused(Placement { facing: Axis::MinusY, ..good }),
            "hair.facing = \"-y\": must not lie along hair.up, which is \"+y\""
        );
        assert_eq!(
            refused(Placement { unit: Unit { cm: 0.0 }, ..good }),
            "hair.unit = 0: must be a finite number above 0"
        );
    }
}
