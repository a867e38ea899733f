//! Force fields: what pulls at a point in a frame.

mod keyframed;
mod sum;

use std::fmt::Debug;

use glam::Vec3;

pub use keyframed::{Keyframe, KeyframedField};
pub use sum::FieldSum;

/// Points or vectors of a [row](Field::at_row).
pub const ROW: usize = 16;

/// Sixteen points or vectors: their x, their y, their z.
pub type VectorRow = [[f32; ROW]; 3];

/// A force at every point and in every frame.
///
/// A force is a direction with a strength, without a unit (section 4.3 of the paper: only c_i |F| moves hair). Points
/// are in the world (cm, y up), or in head space where `motion.force_space` says that forces turn with the head. The
/// answer depends on point and frame only and is finite: hair moves to the same bits whoever asks, and in whatever
/// order.
pub trait Field: Debug + Send + Sync {
    /// The force at a point (cm) in a frame.
    fn at(&self, point: Vec3, frame: u32) -> Vec3;

    /// A bound on |F| over all points and frames, by which a field too strong for the step is refused before the
    /// first one.
    fn strongest(&self) -> f32;

    /// What to change where |F| may exceed `limit`: the name and value of the first setting that is to blame. `None` where
    /// it stays at or below it.
    fn first_above(&self, limit: f64) -> Option<(String, String)> {
        let strongest = self.strongest();
        (f64::from(strongest) > limit).then(|| ("force".to_owned(), strongest.to_string()))
    }

    /// The vector that holds everywhere in this frame, if there is one: the steppers are then spared the asking.
    fn uniform(&self, _frame: u32) -> Option<Vec3> {
        None
    }

    /// The forces at sixteen points in a frame, each the very bits of [`at`](Self::at).
    fn at_row(&self, points: &VectorRow, frame: u32, forces: &mut VectorRow) {
        for i in 0..ROW {
            let force = self.at(Vec3::new(points[0][i], points[1][i], points[2][i]), frame);
            [forces[0][i], forces[1][i], forces[2][i]] = force.to_array();
        }
    }
}
