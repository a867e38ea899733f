//! Sixteen consecutive strands, packed side by side, and the way along them.

use std::ops::Range;

use glam::Vec3;

use super::row::{LANES, PointRow, Row};
use super::transpose::write_points;

/// Rows of points kept on the stack before they are written out strand by strand.
const ROWS: usize = 16;

/// Up to sixteen consecutive strands. Shorter ones are filled up with segments of no length, and missing ones with
/// strands of such segments: they go through the motions and are not written.
#[derive(Clone, Debug)]
pub(super) struct Block {
    pub roots: PointRow,
    /// Points of each strand; 0 for a missing one.
    points: [u32; LANES],
    /// Segments of the longest strand.
    pub segments: u32,
    /// Number of its first segment among those of all blocks.
    first_segment: u32,
    /// Number of its first strand.
    pub first_strand: u32,
}

impl Block {
    /// Packs strands given by root and number of segments, at most sixteen, behind `first_segment` rows of others.
    pub fn new(first_strand: usize, first_segment: usize, strands: impl Iterator<Item = (Vec3, usize)>) -> Self {
        let mut block = Self {
            roots: [Row::default(); 3],
            points: [0; LANES],
            segments: 0,
            first_segment: first_segment as u32,
            first_strand: first_strand as u32,
        };
        for (lane, (root, segments)) in strands.enumerate() {
            for axis in 0..3 {
                block.roots[axis].0[lane] = root[axis];
            }
            block.points[lane] = segments as u32 + 1;
            block.segments = block.segments.max(segments as u32);
        }
        block
    }

    /// Where its segments lie among those of all blocks.
    pub fn rows(&self) -> Range<usize> {
        let first = self.first_segment as usize;
        first..first + self.segments as usize
    }

    /// Points of all its strands.
    pub fn point_count(&self) -> usize {
        self.points.iter().map(|&n| n as usize).sum()
    }

    /// Goes from `start`, which is `roots` but for walks through another space, to the tips, and writes the points where
    /// they are wanted.
    #[inline(always)]
    pub fn walk<State, Shape>(
        &self,
        start: &PointRow,
        states: &mut [State],
        shapes: &[Shape],
        mut points: Option<&mut [Vec3]>,
        mut pass: impl Pass<State, Shape>,
    ) {
        let mut rows = [[Row::default(); 3]; ROWS];
        rows[0] = *start;
        let (mut filled, mut written) = (1, 0);
        let mut rest = &mut states[..shapes.len()];
        for (i, shape) in shapes.iter().enumerate() {
            let Some((state, after)) = std::mem::take(&mut rest).split_first_mut() else { break };
            if filled == ROWS {
                if let Some(points) = &mut points {
                    write_points(&rows, written, &self.points, points);
                }
                // The last row is the first of the next ones, and written once more.
                rows[0] = rows[ROWS - 1];
                written += ROWS - 1;
                filled = 1;
            }
            let (done, next) = rows.split_at_mut(filled);
            pass.segment(state, shape, after.first().zip(shapes.get(i + 1)), &done[filled - 1], &mut next[0]);
            filled += 1;
            rest = after;
        }
        if let Some(points) = &mut points {
            write_points(&rows[..filled], written, &self.points, points);
        }
    }
}

/// What is done to each segment on the way to the tips: takes the points p_(i-1) of the new frame, `from`, to p_i. `next`
/// is the segment after it, which has not been moved yet.
///
/// A trait where a closure would do: only a named function can be forced into its caller, and so be compiled for
/// the vectors chosen there.
pub(super) trait Pass<State, Shape> {
    fn segment(
        &mut self,
        state: &mut State,
        shape: &Shape,
        next: Option<(&State, &Shape)>,
        from: &PointRow,
        to: &mut PointRow,
    );
}
