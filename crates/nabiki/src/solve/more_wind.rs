//! A field with a little more of its wind.

use std::sync::Arc;

use glam::Vec3;

use crate::field::{Field, ROW, VectorRow, WIND};

/// A field, and more of the wind in it, which hair feels as much of as of the field's own.
#[derive(Debug)]
pub(super) struct MoreWind {
    pub field: Arc<dyn Field>,
    pub more: Arc<dyn Field>,
}

impl MoreWind {
    fn has_wind(&self) -> bool {
        self.field.parts().iter().any(|name| name == WIND)
    }
}

impl Field for MoreWind {
    fn at(&self, point: Vec3, frame: u32) -> Vec3 {
        self.field.at(point, frame) + self.more.at(point, frame)
    }

    fn strongest(&self) -> f32 {
        self.field.strongest() + self.more.strongest()
    }

    fn uniform(&self, frame: u32) -> Option<Vec3> {
        Some(self.field.uniform(frame)? + self.more.uniform(frame)?)
    }

    fn at_row(&self, points: &VectorRow, frame: u32, forces: &mut VectorRow) {
        self.field.at_row(points, frame, forces);
        self.add(points, frame, [1.0; ROW], forces);
    }

    fn parts(&self) -> &[String] {
        self.field.parts()
    }

    fn at_shared(&self, point: Vec3, frame: u32, share: &dyn Fn(&str) -> f32) -> Vec3 {
        let of_wind = if self.has_wind() { share(WIND) } else { 1.0 };
        self.field.at_shared(point, frame, share) + of_wind * self.more.at(point, frame)
    }

    fn at_row_shared(
        &self,
        points: &VectorRow,
        frame: u32,
        share: &dyn Fn(&str) -> Option<[f32; ROW]>,
        forces: &mut VectorRow,
    ) {
        self.field.at_row_shared(points, frame, share, forces);
        let of_wind = if self.has_wind() { share(WIND) } else { None };
        self.add(points, frame, of_wind.unwrap_or([1.0; ROW]), forces);
    }
}

impl MoreWind {
    fn add(&self, points: &VectorRow, frame: u32, shares: [f32; ROW], forces: &mut VectorRow) {
        let mut more = VectorRow::default();
        self.more.at_row(points, frame, &mut more);
        for (forces, more) in forces.iter_mut().zip(&more) {
            for i in 0..ROW {
                forces[i] += shares[i] * more[i];
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::field::{FieldSum, Keyframe, KeyframedField};

    #[test]
    fn hair_feels_as_much_of_more_wind_as_of_the_wind() {
        let wind = |x: f32| -> Arc<dyn Field> {
            Arc::new(KeyframedField::new(&[Keyframe { through: 9, vector: Vec3::new(x, 1.0, 0.0) }]).unwrap())
        };
        let named = |wind| FieldSum::named(vec![(WIND.to_owned(), wind), ("fan[0]".to_owned(), fan())]);
        let with_more = MoreWind { field: Arc::new(named(wind(8.0))), more: wind(4.0) };
        let at_once = FieldSum::named(vec![
            (WIND.to_owned(), Arc::new(FieldSum::new(vec![wind(8.0), wind(4.0)])) as Arc<dyn Field>),
            ("fan[0]".to_owned(), fan()),
        ]);
        let share = |name: &str| if name == WIND { 0.25 } else { 0.5 };
        let row = |name: &str| Some([share(name); ROW]);
        let points = VectorRow::default();
        let (mut a, mut b) = (VectorRow::default(), VectorRow::default());
        with_more.at_row_shared(&points, 3, &row, &mut a);
        at_once.at_row_shared(&points, 3, &row, &mut b);
        assert_eq!(a, b);
        assert_eq!(with_more.at_shared(Vec3::ZERO, 3, &share), at_once.at_shared(Vec3::ZERO, 3, &share));
        assert_eq!(with_more.at(Vec3::ZERO, 3), at_once.at(Vec3::ZERO, 3));
    }

    fn fan() -> Arc<dyn Field> {
        Arc::new(KeyframedField::new(&[Keyframe { through: 9, vector: Vec3::new(0.0, 0.0, 16.0) }]).unwrap())
    }
}
