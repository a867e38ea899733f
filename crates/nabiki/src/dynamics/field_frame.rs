//! A field in one frame, seen from hair in head space.

use glam::{Mat3, Vec3};

use super::row::{LANES, PointRow, Row, rotate};
use super::{ForceSpace, FrameInput};
use crate::field::{Field, VectorRow};

/// A field in one frame.
#[derive(Clone, Copy, Debug)]
pub(super) struct FieldFrame<'a> {
    field: &'a dyn Field,
    frame: u32,
    /// Columns of the rotation from head space to the space of the field.
    field_from_head: [[f32; 3]; 3],
    head_origin: [f32; 3],
    head_from_field: [[f32; 3]; 3],
}

impl<'a> FieldFrame<'a> {
    pub fn new(input: &FrameInput<'a>, space: ForceSpace) -> Self {
        let FrameInput { frame, pose, field, .. } = *input;
        let (turn, head_origin) = match space {
            ForceSpace::World => (Mat3::from_quat(pose.rotation), pose.position_cm),
            ForceSpace::Head => (Mat3::IDENTITY, Vec3::ZERO),
        };
        Self {
            field,
            frame,
            field_from_head: turn.to_cols_array_2d(),
            head_origin: head_origin.to_array(),
            head_from_field: turn.transpose().to_cols_array_2d(),
        }
    }

    /// The force if it is the same everywhere (head space).
    pub fn uniform(&self) -> Option<[f32; 3]> {
        self.field.uniform(self.frame).map(|force| rotate(&self.head_from_field, force.to_array()))
    }

    /// The forces at sixteen points, both in head space.
    #[inline(always)]
    pub fn at_row(&self, points: &PointRow) -> PointRow {
        self.by_row(points, |there, force| self.field.at_row(there, self.frame, force))
    }

    /// The same on strands with these shares in the parts of the field.
    #[inline(never)]
    pub fn at_row_shared(&self, points: &PointRow, share: &dyn Fn(&str) -> Option<[f32; LANES]>) -> PointRow {
        self.by_row(points, |there, force| self.field.at_row_shared(there, self.frame, share, force))
    }

    #[allow(clippy::needless_range_loop, reason = "a loop over lanes, as in the kernels")]
    #[inline(always)]
    fn by_row(&self, points: &PointRow, at: impl Fn(&VectorRow, &mut VectorRow)) -> PointRow {
        let mut there = [[0.0; LANES]; 3];
        for lane in 0..LANES {
            let [x, y, z] = rotate(&self.field_from_head, [points[0].0[lane], points[1].0[lane], points[2].0[lane]]);
            there[0][lane] = x + self.head_origin[0];
            there[1][lane] = y + self.head_origin[1];
            there[2][lane] = z + self.head_origin[2];
        }
        let mut force = [[0.0; LANES]; 3];
        at(&there, &mut force);
        let mut in_head = [Row::default(); 3];
        for lane in 0..LANES {
            let [x, y, z] = rotate(&self.head_from_field, [force[0][lane], force[1][lane], force[2][lane]]);
            (in_head[0].0[lane], in_head[1].0[lane], in_head[2].0[lane]) = (x, y, z);
        }
        in_head
    }
}
