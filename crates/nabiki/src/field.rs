//! Force fields: the force at a point in a frame. `docs/fields.md` explains how to choose among them.

mod body_wind;
mod falloff;
mod fan;
mod flow;
mod gust;
mod head_track;
mod keyframed;
mod lanes;
mod local;
mod point;
mod sine;
mod sum;
mod turbulence;
mod uniform;
mod vortex;

use std::fmt::Debug;

use glam::Vec3;

pub use body_wind::{BodyWind, BodyWindField};
pub use falloff::{EnvelopeKey, Falloff, FalloffLaw, envelope};
pub use fan::{Fan, FanField};
pub use flow::{Flow, FlowField};
pub use gust::{Gust, GustField};
pub use keyframed::{Ease, Keyframe, KeyframedField, Wind};
pub use point::{Point, PointField};
pub use sum::{FieldSum, WIND};
pub use turbulence::{Turbulence, TurbulenceField};
pub use uniform::UniformField;
pub use vortex::{Vortex, VortexField};

/// Points or vectors of a [row](Field::at_row).
pub const ROW: usize = 16;

/// Sixteen points or vectors: their x, their y, their z.
pub type VectorRow = [[f32; ROW]; 3];

/// A force at every point and in every frame.
///
/// A force has a direction and a strength, but no physical unit (section 4.3 of the paper: only c_i |F| moves hair).
/// Points are in the world (cm, y up), or in head space if `motion.force_space` makes forces turn with the head. The
/// result must be finite and must depend only on point and frame: hair then moves the same, bit by bit, in any order of
/// calls.
///
/// For wind that changes during a game, use a field that holds the current wind and change it between steps, as
/// [`UniformField`] does. Stay within [`Simulation::strongest_force`](crate::dynamics::Simulation::strongest_force).
pub trait Field: Debug + Send + Sync {
    /// The force at a point (cm) in a frame.
    fn at(&self, point: Vec3, frame: u32) -> Vec3;

    /// A bound on |F| over all points and frames. A field that is too strong for the step is refused before the first
    /// step.
    fn strongest(&self) -> f32;

    /// The name and value of the first setting to change if |F| may exceed `limit`; `None` if it does not.
    fn first_above(&self, limit: f64) -> Option<(String, String)> {
        let strongest = self.strongest();
        (f64::from(strongest) > limit).then(|| ("force".to_owned(), strongest.to_string()))
    }

    /// The force in this frame if it is the same everywhere. Steppers then do not evaluate points.
    fn uniform(&self, _frame: u32) -> Option<Vec3> {
        None
    }

    /// The forces at sixteen points in a frame, with the same bits as [`at`](Self::at).
    fn at_row(&self, points: &VectorRow, frame: u32, forces: &mut VectorRow) {
        if let Some(force) = self.uniform(frame) {
            *forces = force.to_array().map(|along| [along; ROW]);
            return;
        }
        for i in 0..ROW {
            let force = self.at(Vec3::new(points[0][i], points[1][i], points[2][i]), frame);
            [forces[0][i], forces[1][i], forces[2][i]] = force.to_array();
        }
    }

    /// Names of the parts that hair may feel more or less of, see [`Region::fields`](crate::region::Region::fields); none for
    /// a field that all hair feels as a whole.
    fn parts(&self) -> &[String] {
        &[]
    }

    /// The force at a point in a frame on a strand that feels each part times the `share` of its name.
    fn at_shared(&self, point: Vec3, frame: u32, _share: &dyn Fn(&str) -> f32) -> Vec3 {
        self.at(point, frame)
    }

    /// The forces at sixteen points, each on a strand of its own, with the same bits as [`at_shared`](Self::at_shared).
    /// `share` returns the shares of the strands in a part; `None` if they feel it as it is.
    fn at_row_shared(
        &self,
        points: &VectorRow,
        frame: u32,
        _share: &dyn Fn(&str) -> Option<[f32; ROW]>,
        forces: &mut VectorRow,
    ) {
        self.at_row(points, frame, forces);
    }
}

/// Rows and their points, for tests.
#[cfg(test)]
mod rows {
    use glam::Vec3;

    use super::{Field, ROW, VectorRow};

    pub fn row(points: [Vec3; ROW]) -> VectorRow {
        [0, 1, 2].map(|axis| points.map(|p| p[axis]))
    }

    pub fn points(row: &VectorRow) -> [Vec3; ROW] {
        std::array::from_fn(|i| Vec3::new(row[0][i], row[1][i], row[2][i]))
    }

    /// The forces of a row, each with the bits of the force at its point.
    pub fn forces(field: &dyn Field, at: [Vec3; ROW], frame: u32) -> [Vec3; ROW] {
        let mut forces = VectorRow::default();
        field.at_row(&row(at), frame, &mut forces);
        let forces = points(&forces);
        let bits = |force: Vec3| force.to_array().map(f32::to_bits);
        for (p, force) in at.into_iter().zip(forces) {
            assert_eq!(bits(force), bits(field.at(p, frame)), "{field:?} at {p} in frame {frame}");
        }
        forces
    }
}
