//! Numbers of sixteen strands, side by side.

use crate::vector::scale_add;

/// Strands in a block: two vectors of eight, or one of sixteen.
pub(super) const LANES: usize = 16;

/// One number for each strand of a block.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C, align(64))]
pub(super) struct Row(pub [f32; LANES]);

/// A point or vector for each strand of a block: rows of x, y, z (cm).
pub(super) type PointRow = [Row; 3];

/// That of one strand.
#[inline(always)]
pub(super) fn lane([x, y, z]: &PointRow, lane: usize) -> [f32; 3] {
    [x.0[lane], y.0[lane], z.0[lane]]
}

/// Sets that of one strand.
#[inline(always)]
pub(super) fn set_lane(row: &mut PointRow, lane: usize, [x, y, z]: [f32; 3]) {
    (row[0].0[lane], row[1].0[lane], row[2].0[lane]) = (x, y, z);
}

/// The point of one strand at `length` from its point in a row.
#[inline(always)]
pub(super) fn beyond([x, y, z]: &PointRow, lane: usize, length: f32, direction: [f32; 3]) -> [f32; 3] {
    scale_add(length, direction, [x.0[lane], y.0[lane], z.0[lane]])
}

/// `v` rotated; the rotation is given by its columns.
#[inline(always)]
pub(super) fn rotate([x, y, z]: &[[f32; 3]; 3], v: [f32; 3]) -> [f32; 3] {
    [
        x[0].mul_add(v[0], y[0].mul_add(v[1], z[0] * v[2])),
        x[1].mul_add(v[0], y[1].mul_add(v[1], z[1] * v[2])),
        x[2].mul_add(v[0], y[2].mul_add(v[1], z[2] * v[2])),
    ]
}
