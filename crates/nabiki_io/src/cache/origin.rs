//! The file that a cache's hair came from, for exports into that file's space.

use glam::{DAffine3, DVec3, Vec3};
use nabiki::Pose;
use nabiki_exchange::Course;
use nabiki_exchange::curves::Basis;

use crate::{
    axis::Axis,
    bytes::put,
    error::{Error, Result},
    groom_curves::{CurvePrim, GroomCurves},
    placement::Placement,
    unit::Unit,
};

pub(super) const TAG: &[u8; 8] = b"origin  ";
pub(super) const BYTES: usize = 32;
/// The block of one byte, 1, where the hair goes into its file's world.
pub(super) const WORLD_TAG: &[u8; 8] = b"in_world";
/// The block that names the file and its curves.
pub(super) const GROOM_TAG: &[u8; 8] = b"groom   ";
/// Axes by the numbers that the block gives them.
const AXES: [Axis; 6] = [Axis::PlusX, Axis::MinusX, Axis::PlusY, Axis::MinusY, Axis::PlusZ, Axis::MinusZ];

/// How imported hair was placed in its file.
#[derive(Clone, Debug, PartialEq)]
pub struct Origin {
    /// Unit, axes and origin of the file.
    pub placement: Placement,
    /// Number of points in the file. The import may have left some out.
    pub points: u64,
    /// The file, and the position of its curves in it.
    pub groom: GroomCurves,
    /// Whether a motion places the head in the file's world. Otherwise the hair moves from its place in the file.
    pub in_world: bool,
}

impl Origin {
    /// Transform from head space to the pose of a head, for a file that the hair came from. In such a file the origin
    /// of head space is a point of the file; a head that a motion places in its world includes it already. Grown hair
    /// (`None`) has no other file.
    pub fn world_from_head(of: Option<&Self>, pose: &Pose) -> DAffine3 {
        let origin = of.filter(|of| of.in_world).map_or(DVec3::ZERO, |of| of.placement.origin_in_world());
        let world = pose.world_from_head().as_daffine3();
        DAffine3 { translation: world.translation - origin, ..world }
    }

    pub(super) fn bytes(&self) -> Vec<u8> {
        let Placement { unit, up, facing, origin } = self.placement;
        let mut bytes = unit.cm.to_le_bytes().to_vec();
        let number = |axis: Axis| AXES.iter().position(|&a| a == axis).unwrap_or_default() as u32;
        bytes.extend([up, facing].into_iter().flat_map(|axis| number(axis).to_le_bytes()));
        bytes.extend(origin.to_array().into_iter().flat_map(f32::to_le_bytes));
        bytes.extend(self.points.to_le_bytes());
        bytes
    }
}

/// Placement and number of points, as [`Origin::bytes`] has them.
pub(super) fn from_bytes(bytes: &[u8]) -> Result<(Placement, u64)> {
    let damaged = |what: &str| Error::new(format!("attribute origin: {what}: the file is damaged"));
    let (words, []) = bytes.as_chunks::<4>() else { return Err(damaged("not whole words")) };
    let &[cm, up, facing, x, y, z, low, high] = words else { return Err(damaged("not eight words")) };
    let axis = |word: [u8; 4]| {
        let axis = AXES.get(u32::from_le_bytes(word) as usize);
        axis.copied().ok_or_else(|| damaged("unknown axis"))
    };
    let placement = Placement {
        unit: Unit { cm: f32::from_le_bytes(cm) },
        up: axis(up)?,
        facing: axis(facing)?,
        origin: Vec3::from_array([x, y, z].map(f32::from_le_bytes)),
    };
    placement.check("origin").map_err(|e| damaged(&e.to_string()))?;
    Ok((placement, u64::from(u32::from_le_bytes(low)) | u64::from(u32::from_le_bytes(high)) << 32))
}

/// What the number of each curves says before their transform: their basis, whether they are pinned, and whether a skeleton moves
/// them.
const BASES: [Basis; 4] = [Basis::Linear, Basis::Bezier, Basis::Bspline, Basis::CatmullRom];
const PINNED: u32 = 16;
const BOUND: u32 = 32;

/// The number of curves that run so.
fn number_of(Course { basis, pinned }: Course) -> u32 {
    let basis = BASES.iter().position(|&other| other == basis).unwrap_or_default() as u32;
    basis + if pinned { PINNED } else { 0 }
}

/// How curves of a number run; `None` for a number that is none.
fn course_of(number: u32) -> Option<Course> {
    let course = Course { basis: *BASES.get((number & !PINNED) as usize)?, pinned: number & PINNED != 0 };
    (course.basis != Basis::Linear || course == Course::LINEAR).then_some(course)
}

/// Two numbers, of the name's bytes and of the curves, the name, then of each curves' points, its path's bytes, and it. There follow
/// for each a number, of [`BASES`] and the two after it, and the columns of the transform above it.
pub(super) fn groom_bytes(groom: &GroomCurves) -> Result<Vec<u8>> {
    let whole = |n: usize| u32::try_from(n).map_err(|_| Error::new("the groom's file: a name has 2^32 bytes or more"));
    let mut out = Vec::new();
    put(&mut out, &[whole(groom.file.len())?, whole(groom.curves.len())?])?;
    out.extend_from_slice(groom.file.as_bytes());
    for CurvePrim { path, points, .. } in &groom.curves {
        put(&mut out, &[*points])?;
        put(&mut out, &[whole(path.len())?])?;
        out.extend_from_slice(path.as_bytes());
    }
    for CurvePrim { course, world_from_curves, bound, .. } in &groom.curves {
        put(&mut out, &[number_of(*course) + if *bound { BOUND } else { 0 }])?;
        put(&mut out, &world_from_curves.to_cols_array())?;
    }
    Ok(out)
}

pub(super) fn groom_from_bytes(bytes: &[u8]) -> Result<GroomCurves> {
    let damaged = || Error::new("attribute groom: does not fill its block: the file is damaged");
    fn number<const N: usize>(rest: &mut &[u8]) -> Option<[u8; N]> {
        let (number, after) = rest.split_first_chunk()?;
        *rest = after;
        Some(*number)
    }
    fn text(rest: &mut &[u8], length: [u8; 4]) -> Option<String> {
        let (text, after) = rest.split_at_checked(u32::from_le_bytes(length) as usize)?;
        *rest = after;
        Some(std::str::from_utf8(text).ok()?.to_owned())
    }
    let mut rest = bytes;
    let mut read = || {
        let (length, count) = (number(&mut rest)?, u32::from_le_bytes(number(&mut rest)?));
        let file = text(&mut rest, length)?;
        let mut curves = Vec::new();
        for _ in 0..count {
            let (points, length) = (u64::from_le_bytes(number(&mut rest)?), number(&mut rest)?);
            let path = text(&mut rest, length)?;
            let world_from_curves = DAffine3::IDENTITY;
            curves.push(CurvePrim { path, points, course: Course::LINEAR, world_from_curves, bound: false });
        }
        for prim in &mut curves {
            let kind = u32::from_le_bytes(number(&mut rest)?);
            prim.bound = kind & BOUND != 0;
            prim.course = course_of(kind & !BOUND)?;
            let mut columns = [0.0; 12];
            for column in &mut columns {
                *column = f64::from_le_bytes(number(&mut rest)?);
            }
            prim.world_from_curves = DAffine3::from_cols_array(&columns);
        }
        rest.is_empty().then_some(GroomCurves { file, curves })
    };
    read().ok_or_else(damaged)
}

#[cfg(test)]
mod tests {
    use glam::{DQuat, DVec3};

    use super::*;

    #[test]
    fn an_origin_comes_back_and_a_damaged_one_is_refused() {
        let of = |placement, points| {
            let groom = GroomCurves { file: "g.hair".to_owned(), curves: Vec::new() };
            Origin { placement, points, groom, in_world: false }
        };
        for up in AXES {
            for facing in AXES.into_iter().filter(|a| a.vector().dot(up.vector()) == 0.0) {
                let unit = Unit { cm: 2.54 };
                let placement = Placement { unit, up, facing, origin: Vec3::new(1.0, -2.0, 3e-7) };
                let bytes = of(placement, (1 << 40) + 5).bytes();
                assert_eq!(bytes.len(), BYTES);
                assert_eq!(from_bytes(&bytes).unwrap(), (placement, (1 << 40) + 5));
            }
        }
        let sound = of(Placement::default(), 9).bytes();
        for (at, byte) in [(3, 0xff), (4, 6), (4, 0), (8, 3), (15, 0x7f)] {
            let mut bytes = sound.clone();
            bytes[at] = byte;
            if at == 15 {
                bytes[14] = 0xc0;
            }
            let refused = from_bytes(&bytes).unwrap_err().to_string();
            assert!(refused.starts_with("attribute origin: ") && refused.ends_with("damaged"), "{at}: {refused}");
        }
    }

    #[test]
    fn the_curves_of_a_groom_come_back_and_a_damaged_list_is_refused() {
        let prim = |path: &str, points, course, world_from_curves| {
            let path = path.to_owned();
            CurvePrim { bound: points == 3, path, points, course, world_from_curves }
        };
        let far = DVec3::new(0.0, 150.0, -123_456.789);
        let turned = DAffine3::from_rotation_translation(DQuat::from_rotation_x(0.4), far);
        let cubic = BASES[1..].iter().flat_map(|&basis| [false, true].map(|pinned| Course { basis, pinned }));
        for (course, world_from_curves) in cubic.chain([Course::LINEAR]).zip([turned, DAffine3::IDENTITY].repeat(4)) {
            let second = prim("/head/\u{30d2}\u{30b2}", 3, course, world_from_curves);
            let curves = vec![prim("/head/hair", 1 << 40, Course::LINEAR, DAffine3::IDENTITY), second];
            let groom = GroomCurves { file: "grooms/a b.usdc".to_owned(), curves };
            let bytes = groom_bytes(&groom).unwrap();
            assert_eq!(groom_from_bytes(&bytes).unwrap(), groom);
            for length in 0..bytes.len() {
                assert!(groom_from_bytes(&bytes[..length]).is_err(), "{length} bytes");
            }
            assert!(groom_from_bytes(&[&bytes[..], &[0]].concat()).is_err());
        }
        // Pinned straight lines, and a basis beyond the fourth.
        assert_eq!([PINNED, 4, 64].map(course_of), [None; 3]);
    }
}
