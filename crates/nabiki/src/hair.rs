//! Hair as tools exchange it: strands, and all other data that a file has for them.

mod join;
mod other;
mod resample;
mod turn;

use std::collections::{BTreeMap, BTreeSet};

use glam::{DAffine3, Vec3};

use crate::Strands;

pub use other::{Other, Per, Role, Stored, Values};

/// Strands and their attributes.
///
/// Readers return it in the file's unit and axes; [`transformed`](Self::transformed) takes it to head space.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Hair {
    /// The polylines, root first.
    pub strands: Strands,
    /// Everything except the points.
    pub attributes: Attributes,
}

/// The attributes of a groom. `None` means that the source has no such data.
///
/// Arrays *by strand* have one entry per strand, arrays *by point* one per point of [`Strands::points`].
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Attributes {
    /// Persistent id of the strand in its source, by strand.
    pub id: Option<Vec<i64>>,
    /// Texture coordinates of the root on the skin, by strand.
    pub root_uv: Option<Vec<[f32; 2]>>,
    /// Clump or group number, by strand.
    pub group: Option<Vec<i32>>,
    /// Names of groups, if the source has them.
    pub group_names: BTreeMap<i32, String>,
    /// Whether the strand is a guide and not drawn itself, by strand.
    pub guide: Option<Vec<bool>>,
    /// Diameter, by point (same unit as the points).
    pub width: Option<Vec<f32>>,
    /// Linear RGB, by point.
    pub colour: Option<Vec<[f32; 3]>>,
    /// 0 opaque .. 1 invisible, by point.
    pub transparency: Option<Vec<f32>>,
    /// Texture coordinates, by point.
    pub point_uv: Option<Vec<[f32; 2]>>,
    /// TressFX's w, by point: 0 if the skin holds the point, 1 if it is free.
    pub inverse_mass: Option<Vec<f32>>,
    /// Whether the source stores the strand from tip to root, by strand. Here, strands always start at the root;
    /// [`Hair::as_in_source`] turns them back.
    pub tip_first: Option<Vec<bool>>,
    /// All other attributes of the source, under their names there.
    pub other: Vec<Other>,
    /// Data of the source that could not be kept, a phrase each.
    pub unread: Vec<String>,
    /// Values that apply where there is no array.
    pub constant: Constants,
}

/// Values for all points of a groom. An array of [`Attributes`] takes precedence.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Constants {
    /// Diameter (same unit as the points).
    pub width: Option<f32>,
    /// Linear RGB.
    pub colour: Option<[f32; 3]>,
    /// 0 opaque .. 1 invisible.
    pub transparency: Option<f32>,
}

/// What [`Hair::without_degenerate`] removed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize)]
pub struct Degenerate {
    /// Points that were joined with the point before them.
    pub joined_points: usize,
    /// Strands that were dropped because they had no segment left.
    pub dropped_strands: usize,
}

/// An attribute array whose length does not match the strands or points.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("attribute {name}: {found} values where the hair has {expected}")]
pub struct LengthError {
    /// Name of the field of [`Attributes`].
    pub name: String,
    /// Entries found.
    pub found: usize,
    /// Strands or points of the hair.
    pub expected: usize,
}

impl From<Strands> for Hair {
    fn from(strands: Strands) -> Self {
        Self { strands, attributes: Attributes::default() }
    }
}

impl Hair {
    /// Refuses attribute arrays whose lengths are not those of the strands or points.
    pub fn check_lengths(&self) -> Result<(), LengthError> {
        fn check<T>(name: &str, values: &Option<Vec<T>>, expected: usize) -> Result<(), LengthError> {
            match values {
                Some(v) if v.len() != expected => Err(LengthError { name: name.to_owned(), found: v.len(), expected }),
                _ => Ok(()),
            }
        }
        let (strands, points, a) = (self.strands.len(), self.strands.points().len(), &self.attributes);
        check("id", &a.id, strands)?;
        check("root_uv", &a.root_uv, strands)?;
        check("group", &a.group, strands)?;
        check("guide", &a.guide, strands)?;
        check("tip_first", &a.tip_first, strands)?;
        check("width", &a.width, points)?;
        check("colour", &a.colour, points)?;
        check("transparency", &a.transparency, points)?;
        check("point_uv", &a.point_uv, points)?;
        check("inverse_mass", &a.inverse_mass, points)?;
        for other in &a.other {
            let (found, expected) = (other.values.len(), other.expected(strands, points));
            if found != expected {
                return Err(LengthError { name: other.name.clone(), found, expected });
            }
        }
        Ok(())
    }

    /// The strands with these `indices`, in that order, with their attributes.
    pub fn select(&self, indices: &[usize]) -> Self {
        let points: Vec<usize> = indices.iter().flat_map(|&s| self.strands.range(s)).collect();
        Self { strands: self.strands.select(indices), attributes: self.attributes.gather(indices, &points) }
    }

    /// Joins each point with the last kept point if they are at most `tolerance` apart (in the unit of the points),
    /// drops strands without a segment, and counts both. The root always stays.
    pub fn without_degenerate(self, tolerance: f32) -> (Self, Degenerate) {
        let mut kept_strands = Vec::with_capacity(self.strands.len());
        let mut kept_points = Vec::with_capacity(self.strands.points().len());
        let mut strands = Strands::with_capacity(self.strands.len(), self.strands.points().len());
        let mut found = Degenerate::default();
        for s in 0..self.strands.len() {
            let (range, first) = (self.strands.range(s), kept_points.len());
            let mut last: Option<Vec3> = None;
            for p in range.clone() {
                let point = self.strands.points()[p];
                if last.is_none_or(|last| point.distance(last) > tolerance) {
                    kept_points.push(p);
                    last = Some(point);
                }
            }
            if kept_points.len() - first < 2 {
                kept_points.truncate(first);
                found.dropped_strands += 1;
            } else {
                found.joined_points += range.len() - (kept_points.len() - first);
                kept_strands.push(s);
                strands.push(kept_points[first..].iter().map(|&p| self.strands.points()[p]));
            }
        }
        if found == Degenerate::default() {
            return (self, found);
        }
        let attributes = self.attributes.gather(&kept_strands, &kept_points);
        (Self { strands, attributes }, found)
    }

    /// The hair in another space: points are mapped by `target_from_source`, widths multiplied by its scale (the cube
    /// root of its determinant). Points are f32 before and after, but the transform is computed in f64, so a distant
    /// origin costs no digits.
    pub fn transformed(mut self, target_from_source: &DAffine3) -> Self {
        if *target_from_source == DAffine3::IDENTITY {
            return self;
        }
        let scale = target_from_source.matrix3.determinant().abs().cbrt() as f32;
        for p in self.strands.points_mut() {
            *p = target_from_source.transform_point3(p.as_dvec3()).as_vec3();
        }
        let widths = self.attributes.width.iter_mut().flatten();
        widths.chain(&mut self.attributes.constant.width).for_each(|width| *width *= scale);
        self
    }
}

impl Attributes {
    /// Number of strands that repeat the id of an earlier strand.
    pub fn repeated_ids(&self) -> usize {
        let ids = self.id.as_deref().unwrap_or_default();
        ids.len() - ids.iter().collect::<BTreeSet<_>>().len()
    }

    /// The attributes of the strands and points named, in that order.
    fn gather(&self, strands: &[usize], points: &[usize]) -> Self {
        fn pick<T: Copy>(values: &Option<Vec<T>>, indices: &[usize]) -> Option<Vec<T>> {
            values.as_ref().map(|v| indices.iter().map(|&i| v[i]).collect())
        }
        let group = pick(&self.group, strands);
        // A name is dropped with the last strand of its group; the name of a group without strands stays.
        let all = self.group.as_deref().unwrap_or_default();
        let left: BTreeSet<i32> = group.iter().flatten().copied().collect();
        let gone: BTreeSet<i32> = all.iter().copied().filter(|number| !left.contains(number)).collect();
        let named = self.group_names.iter().filter(|(number, _)| !gone.contains(number));
        Self {
            id: pick(&self.id, strands),
            root_uv: pick(&self.root_uv, strands),
            group,
            group_names: named.map(|(&number, name)| (number, name.clone())).collect(),
            guide: pick(&self.guide, strands),
            tip_first: pick(&self.tip_first, strands),
            width: pick(&self.width, points),
            colour: pick(&self.colour, points),
            transparency: pick(&self.transparency, points),
            point_uv: pick(&self.point_uv, points),
            inverse_mass: pick(&self.inverse_mass, points),
            other: self.other.iter().map(|other| other.gather(strands, points)).collect(),
            unread: self.unread.clone(),
            constant: self.constant,
        }
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;

    /// Three strands: one sound, one with a point met twice, one without any extent.
    fn mixed() -> Hair {
        let mut strands = Strands::default();
        strands.push([Vec3::ZERO, Vec3::X, 2.0 * Vec3::X]);
        strands.push([Vec3::ZERO, Vec3::ZERO, Vec3::Y]);
        strands.push([Vec3::Z, Vec3::Z]);
        let attributes = Attributes {
            id: Some(vec![10, 11, 12]),
            width: Some((0..8).map(|i| i as f32).collect()),
            ..Attributes::default()
        };
        Hair { strands, attributes }
    }

    #[test]
    fn degenerate_points_and_strands_are_dropped_with_their_attributes_and_counted() {
        let (hair, found) = mixed().without_degenerate(0.0);
        assert_eq!(found, Degenerate { joined_points: 1, dropped_strands: 1 });
        assert_eq!(hair.strands.starts(), [0, 3, 5]);
        assert_eq!(hair.strands.strand(1), [Vec3::ZERO, Vec3::Y]);
        assert_eq!(hair.attributes.id, Some(vec![10, 11]));
        assert_eq!(hair.attributes.width, Some(vec![0.0, 1.0, 2.0, 3.0, 5.0]));
    }

    #[test]
    fn selected_strands_keep_their_attributes() {
        let chosen = mixed().select(&[2, 0]);
        assert_eq!(chosen.attributes.id, Some(vec![12, 10]));
        assert_eq!(chosen.attributes.width, Some(vec![6.0, 7.0, 0.0, 1.0, 2.0]));
        assert_eq!(chosen.check_lengths(), Ok(()));
    }

    #[test]
    fn names_of_groups_go_with_their_last_strands() {
        let mut hair = mixed();
        hair.attributes.group = Some(vec![1, 2, 1]);
        hair.attributes.group_names =
            [(1, "fringe"), (2, "nape"), (7, "of no strand")].map(|(g, n)| (g, n.into())).into();
        let names = |hair: Hair| hair.attributes.group_names.into_keys().collect::<Vec<_>>();
        assert_eq!(names(hair.select(&[0, 2])), [1, 7]);
        assert_eq!(names(hair.select(&[1, 0])), [1, 2, 7]);
    }

    /// Repeated: the same number as a strand before.
    #[test]
    fn ids_that_tell_no_strands_apart_are_counted() {
        let mut hair = mixed();
        assert_eq!(hair.attributes.repeated_ids(), 0);
        hair.attributes.id = Some(vec![4, 4, 4]);
        assert_eq!(hair.attributes.repeated_ids(), 2);
        hair.attributes.id = None;
        assert_eq!(hair.attributes.repeated_ids(), 0);
    }

    #[test]
    fn an_attribute_of_the_wrong_length_is_named() {
        let mut hair = mixed();
        hair.attributes.width = Some(vec![0.1; 7]);
        let error = hair.check_lengths().unwrap_err();
        assert_eq!(error.to_string(), "attribute width: 7 values where the hair has 8");
    }

    #[test]
    fn widths_scale_with_the_points() {
        let hair = mixed().transformed(&DAffine3::from_scale(DVec3::splat(100.0)));
        assert_eq!(hair.strands.strand(0)[1], Vec3::new(100.0, 0.0, 0.0));
        let error = (hair.attributes.width.unwrap()[3] - 300.0).abs();
        assert!(error <= 300.0 * 4.0 * f32::EPSILON, "a cube root and two products, each within an ulp: {error}");
    }
}
