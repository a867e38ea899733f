//! The file that a cache's hair came from, so that it can go back into that file's own space.

use glam::Vec3;

use crate::{
    axis::Axis,
    error::{Error, Result},
    placement::Placement,
    unit::Unit,
};

pub(super) const TAG: &[u8; 8] = b"origin  ";
pub(super) const BYTES: usize = 32;
/// Axes by the numbers that the block gives them.
const AXES: [Axis; 6] = [Axis::PlusX, Axis::MinusX, Axis::PlusY, Axis::MinusY, Axis::PlusZ, Axis::MinusZ];

/// How imported hair lay in its file.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Origin {
    /// Unit, axes and origin of the file.
    pub placement: Placement,
    /// Points in the file, of which the import may have left some out.
    pub points: u64,
}

impl Origin {
    pub(super) fn bytes(&self) -> Vec<u8> {
        let Placement { unit, up, facing, origin } = self.placement;
        let mut bytes = unit.cm.to_le_bytes().to_vec();
        let number = |axis: Axis| AXES.iter().position(|&a| a == axis).unwrap_or_default() as u32;
        bytes.extend([up, facing].into_iter().flat_map(|axis| number(axis).to_le_bytes()));
        bytes.extend(origin.to_array().into_iter().flat_map(f32::to_le_bytes));
        bytes.extend(self.points.to_le_bytes());
        bytes
    }

    pub(super) fn from_bytes(bytes: &[u8]) -> Result<Self> {
        let damaged = |what: &str| Error::new(format!("attribute origin: {what}: the file is damaged"));
        let (words, []) = bytes.as_chunks::<4>() else { return Err(damaged("not whole words")) };
        let &[cm, up, facing, x, y, z, low, high] = words else { return Err(damaged("not eight words")) };
        let axis = |word: [u8; 4]| {
            let axis = AXES.get(u32::from_le_bytes(word) as usize);
            axis.copied().ok_or_else(|| damaged("an axis beyond the sixth"))
        };
        let placement = Placement {
            unit: Unit { cm: f32::from_le_bytes(cm) },
            up: axis(up)?,
            facing: axis(facing)?,
            origin: Vec3::from_array([x, y, z].map(f32::from_le_bytes)),
        };
        placement.check("origin").map_err(|e| damaged(&e.to_string()))?;
        let points = u64::from(u32::from_le_bytes(low)) | u64::from(u32::from_le_bytes(high)) << 32;
        Ok(Self { placement, points })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_origin_comes_back_and_a_damaged_one_is_refused() {
        for up in AXES {
            for facing in AXES.into_iter().filter(|a| a.vector().dot(up.vector()) == 0.0) {
                let unit = Unit { cm: 2.54 };
                let placement = Placement { unit, up, facing, origin: Vec3::new(1.0, -2.0, 3e-7) };
                let origin = Origin { placement, points: (1 << 40) + 5 };
                assert_eq!(origin.bytes().len(), BYTES);
                assert_eq!(Origin::from_bytes(&origin.bytes()).unwrap(), origin);
            }
        }
        let sound = Origin { placement: Placement::default(), points: 9 }.bytes();
        for (at, byte) in [(3, 0xff), (4, 6), (4, 0), (8, 3), (15, 0x7f)] {
            let mut bytes = sound.clone();
            bytes[at] = byte;
            if at == 15 {
                bytes[14] = 0xc0;
            }
            let refused = Origin::from_bytes(&bytes).unwrap_err().to_string();
            assert!(refused.starts_with("attribute origin: ") && refused.ends_with("damaged"), "{at}: {refused}");
        }
    }
}
