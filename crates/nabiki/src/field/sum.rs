//! Sums of fields.

use std::sync::Arc;

use glam::Vec3;

use super::{Field, ROW, VectorRow};

/// Name of the part of a sum that is the wind: the one that a solver changes.
pub const WIND: &str = "wind";

/// The sum of fields, added in order. Without fields there is no force.
#[derive(Clone, Debug, Default)]
pub struct FieldSum {
    parts: Vec<Arc<dyn Field>>,
    /// Of the parts; none if they have no names.
    names: Vec<String>,
}

impl FieldSum {
    /// The sum of `parts`.
    pub fn new(parts: Vec<Arc<dyn Field>>) -> Self {
        Self { parts, names: Vec::new() }
    }

    /// The sum of parts with names, which hair may feel more or less of.
    pub fn named(parts: Vec<(String, Arc<dyn Field>)>) -> Self {
        let (names, parts) = parts.into_iter().unzip();
        Self { parts, names }
    }
}

impl Field for FieldSum {
    fn at(&self, point: Vec3, frame: u32) -> Vec3 {
        self.parts.iter().map(|part| part.at(point, frame)).reduce(|sum, part| sum + part).unwrap_or_default()
    }

    fn strongest(&self) -> f32 {
        // An empty sum of floats would be -0.
        self.parts.iter().fold(0.0, |sum, part| sum + part.strongest())
    }

    /// A part that is too strong by itself, or else the sum of all.
    fn first_above(&self, limit: f64) -> Option<(String, String)> {
        let alone = self.parts.iter().find_map(|part| part.first_above(limit));
        alone.or_else(|| {
            let sum: f64 = self.parts.iter().map(|part| f64::from(part.strongest())).sum();
            (sum > limit).then(|| ("force".to_owned(), format!("{sum} in all fields together")))
        })
    }

    fn uniform(&self, frame: u32) -> Option<Vec3> {
        self.parts.iter().map(|part| part.uniform(frame)).sum()
    }

    fn at_row(&self, points: &VectorRow, frame: u32, forces: &mut VectorRow) {
        let Some((first, others)) = self.parts.split_first() else {
            *forces = VectorRow::default();
            return;
        };
        first.at_row(points, frame, forces);
        let mut of_part = VectorRow::default();
        for part in others {
            part.at_row(points, frame, &mut of_part);
            for (sum, part) in forces.iter_mut().zip(&of_part) {
                for i in 0..ROW {
                    sum[i] += part[i];
                }
            }
        }
    }

    fn parts(&self) -> &[String] {
        &self.names
    }

    fn at_shared(&self, point: Vec3, frame: u32, share: &dyn Fn(&str) -> f32) -> Vec3 {
        if self.names.is_empty() {
            return self.at(point, frame);
        }
        let parts = self.parts.iter().zip(&self.names);
        parts.map(|(part, name)| share(name) * part.at(point, frame)).reduce(|sum, part| sum + part).unwrap_or_default()
    }

    fn at_row_shared(
        &self,
        points: &VectorRow,
        frame: u32,
        share: &dyn Fn(&str) -> Option<[f32; ROW]>,
        forces: &mut VectorRow,
    ) {
        if self.names.is_empty() {
            return self.at_row(points, frame, forces);
        }
        *forces = VectorRow::default();
        let mut of_part = VectorRow::default();
        for (n, (part, name)) in self.parts.iter().zip(&self.names).enumerate() {
            part.at_row(points, frame, &mut of_part);
            if let Some(share) = share(name) {
                of_part
                    .iter_mut()
                    .for_each(|axis| axis.iter_mut().zip(share).for_each(|(force, share)| *force *= share));
            }
            for (sum, part) in forces.iter_mut().zip(&of_part) {
                for i in 0..ROW {
                    // The first one as it is: a sum from 0 on would lose the sign of -0.
                    sum[i] = if n == 0 { part[i] } else { sum[i] + part[i] };
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::field::{Keyframe, KeyframedField};

    /// Turns about y, as fast as one likes.
    #[derive(Debug)]
    struct Whirl(f32);

    impl Field for Whirl {
        fn at(&self, p: Vec3, _frame: u32) -> Vec3 {
            self.0 * Vec3::new(p.z, 0.0, -p.x).normalize_or_zero()
        }

        fn strongest(&self) -> f32 {
            self.0
        }
    }

    fn wind(strength: f32) -> Arc<dyn Field> {
        Arc::new(KeyframedField::new(&[Keyframe { through: 10, vector: Vec3::new(0.0, -strength, 0.0) }]).unwrap())
    }

    #[test]
    fn fields_add_up_at_points_in_rows_and_where_they_are_uniform() {
        let sum = FieldSum::new(vec![wind(3.0), Arc::new(Whirl(2.0)), wind(4.0)]);
        let points: VectorRow = std::array::from_fn(|axis| std::array::from_fn(|i| (i * (axis + 2)) as f32 - 9.5));
        let mut forces = VectorRow::default();
        sum.at_row(&points, 5, &mut forces);
        for i in 0..ROW {
            let p = Vec3::new(points[0][i], points[1][i], points[2][i]);
            let expected = Vec3::new(0.0, -7.0, 0.0) + Whirl(2.0).at(p, 5);
            assert_eq!(sum.at(p, 5), expected);
            assert_eq!([forces[0][i], forces[1][i], forces[2][i]], expected.to_array());
        }
        assert_eq!(sum.uniform(5), None);
        assert_eq!(FieldSum::new(vec![wind(3.0), wind(4.0)]).uniform(5), Some(Vec3::new(0.0, -7.0, 0.0)));
        assert_eq!(FieldSum::default().uniform(5), Some(Vec3::ZERO));
    }

    #[test]
    fn the_part_that_is_too_strong_is_named_before_the_sum() {
        let sum = FieldSum::new(vec![wind(3.0), Arc::new(Whirl(2.0))]);
        assert_eq!(sum.strongest(), 5.0);
        assert_eq!(sum.first_above(5.0), None);
        assert_eq!(sum.first_above(4.0).unwrap(), ("force".to_owned(), "5 in all fields together".to_owned()));
        assert_eq!(sum.first_above(2.5).unwrap().0, "force[0].vector");
    }
}
