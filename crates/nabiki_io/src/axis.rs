//! The six directions along the axes, for a file's up and facing.

use std::fmt;

use glam::DVec3;
use nabiki::words;

words! {
    /// One of the six axis directions.
    pub enum Axis {
        /// Along x.
        #[serde(alias = "x")]
        PlusX = "+x",
        /// Against x.
        MinusX = "-x",
        /// Along y.
        #[serde(alias = "y")]
        PlusY = "+y",
        /// Against y.
        MinusY = "-y",
        /// Along z.
        #[serde(alias = "z")]
        PlusZ = "+z",
        /// Against z.
        MinusZ = "-z",
    }
}

impl Axis {
    /// All six directions.
    pub const ALL: [Self; 6] = [Self::PlusX, Self::MinusX, Self::PlusY, Self::MinusY, Self::PlusZ, Self::MinusZ];

    /// Whether it is perpendicular to another.
    pub fn is_across(self, other: Self) -> bool {
        self.vector().dot(other.vector()) == 0.0
    }

    /// The direction that this one (perpendicular to `up`) becomes if the world is rotated so that `up` becomes
    /// `other`.
    #[must_use]
    pub fn tipped(self, up: Self, other: Self) -> Self {
        if !up.is_across(other) || self.is_across(other) {
            return self;
        }
        let along = -self.vector().dot(other.vector()) * up.vector();
        Self::ALL.into_iter().find(|axis| axis.vector() == along).unwrap_or(self)
    }

    /// Its unit vector.
    pub fn vector(self) -> DVec3 {
        match self {
            Self::PlusX => DVec3::X,
            Self::MinusX => DVec3::NEG_X,
            Self::PlusY => DVec3::Y,
            Self::MinusY => DVec3::NEG_Y,
            Self::PlusZ => DVec3::Z,
            Self::MinusZ => DVec3::NEG_Z,
        }
    }
}

impl fmt::Display for Axis {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.word())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DQuat;

    #[test]
    fn a_tipped_world_is_turned_by_a_right_angle() {
        use Axis::{MinusY, MinusZ, PlusX, PlusY, PlusZ};
        // As programs turn one into the other: y up and the face along +z, z up and the face along -y.
        assert_eq!(PlusZ.tipped(PlusY, PlusZ), MinusY);
        assert_eq!(MinusY.tipped(PlusZ, PlusY), PlusZ);
        assert_eq!(MinusZ.tipped(PlusY, PlusZ), PlusY);
        assert_eq!(PlusX.tipped(PlusY, PlusZ), PlusX);
        for up in Axis::ALL {
            for other in Axis::ALL.into_iter().filter(|other| other.is_across(up)) {
                let turn = DQuat::from_rotation_arc(up.vector(), other.vector());
                for facing in Axis::ALL.into_iter().filter(|facing| facing.is_across(up)) {
                    let tipped = facing.tipped(up, other);
                    assert!(tipped.vector().distance(turn * facing.vector()) < 1e-15, "{facing} {up} {other}");
                    assert_eq!(tipped.tipped(other, up), facing);
                }
                assert_eq!(other.tipped(up, up), other);
            }
        }
    }
}
