//! Sixteen consecutive strands, packed side by side, and their way through the frames.

use std::ops::Range;

use glam::Vec3;

use super::gain::SegmentShape;
use super::kernel::{LANES, PointRow, Row, SegmentState, ShapeRow, disturb_segment, extend, step_segment};
use super::transpose::write_points;
use super::wind::{Surroundings, Wind};

/// Rows of points kept on the stack before they are written out strand by strand.
const ROWS: usize = 16;

/// Up to sixteen consecutive strands. Shorter ones are filled up with segments of no length, and missing ones with
/// strands of such segments: they go through the motions and are not written.
#[derive(Clone, Debug)]
pub(super) struct Block {
    roots: PointRow,
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
    /// Packs strands given by root and shapes, at most sixteen, behind the rows of other blocks. `along`: for each
    /// segment, how far along its strand it ends.
    pub fn pack(
        first_strand: usize,
        roots: &[Vec3],
        strands: &[Vec<SegmentShape>],
        shapes: &mut Vec<ShapeRow>,
        along: &mut Vec<Row>,
    ) -> Self {
        let segments = strands.iter().map(Vec::len).max().unwrap_or(0);
        let mut block = Self {
            roots: [Row::default(); 3],
            points: [0; LANES],
            segments: segments as u32,
            first_segment: shapes.len() as u32,
            first_strand: first_strand as u32,
        };
        shapes.resize(shapes.len() + segments, ShapeRow::default());
        along.resize(along.len() + segments, Row::default());
        let rows = block.rows();
        for (lane, (root, strand)) in roots.iter().zip(strands).enumerate() {
            for axis in 0..3 {
                block.roots[axis].0[lane] = root[axis];
            }
            block.points[lane] = strand.len() as u32 + 1;
            for ((row, along), shape) in shapes[rows.clone()].iter_mut().zip(&mut along[rows.clone()]).zip(strand) {
                row.length.0[lane] = shape.length as f32;
                row.gain.0[lane] = shape.gain as f32;
                row.eps.0[lane] = (shape.gain_in_gamma / shape.gain) as f32;
                along.0[lane] = shape.along as f32;
            }
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

    /// Moves the block by one frame, and writes its points where they are wanted.
    #[inline(always)]
    pub fn step<const TILTED: bool>(
        &self,
        states: &mut [SegmentState],
        shapes: &[ShapeRow],
        surroundings: &Surroundings,
        wind: &impl Wind,
        points: Option<&mut [Vec3]>,
    ) {
        // Copies, which nothing that is written can change: they need not be read again at every segment.
        let (surroundings, wind, before) = (*surroundings, *wind, self.roots);
        self.walk(states, shapes, points, Step::<TILTED, _> { surroundings, wind, before });
    }

    /// Writes the points of the angles as they are.
    #[inline(always)]
    pub fn place<const TILTED: bool>(
        &self,
        states: &mut [SegmentState],
        shapes: &[ShapeRow],
        surroundings: &Surroundings,
        points: &mut [Vec3],
    ) {
        self.walk(states, shapes, Some(points), Place::<TILTED> { surroundings });
    }

    /// Turns every strand by its own angles (rad at the tip, less toward the root).
    #[inline(always)]
    pub fn disturb(&self, states: &mut [SegmentState], along: &[Row], turns: impl Iterator<Item = [f32; 2]>) {
        let (mut theta, mut phi) = (Row::default(), Row::default());
        for (lane, turn) in turns.take(LANES).enumerate() {
            (theta.0[lane], phi.0[lane]) = (turn[0], turn[1]);
        }
        for (state, along) in states.iter_mut().zip(along) {
            disturb_segment(state, &theta, &phi, along);
        }
    }

    /// Goes from the roots to the tips.
    #[inline(always)]
    fn walk(
        &self,
        states: &mut [SegmentState],
        shapes: &[ShapeRow],
        mut points: Option<&mut [Vec3]>,
        mut pass: impl Pass,
    ) {
        let mut rows = [[Row::default(); 3]; ROWS];
        rows[0] = self.roots;
        let (mut filled, mut written) = (1, 0);
        for (state, shape) in states.iter_mut().zip(shapes) {
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
            pass.segment(state, shape, &done[filled - 1], &mut next[0]);
            filled += 1;
        }
        if let Some(points) = &mut points {
            write_points(&rows[..filled], written, &self.points, points);
        }
    }
}

/// What is done to each segment on the way to the tips: takes the points p_(i-1) of the new frame, `from`, to p_i.
///
/// A trait where a closure would do: only a named function can be forced into its caller, and so be compiled for
/// the vectors chosen there.
trait Pass {
    fn segment(&mut self, state: &mut SegmentState, shape: &ShapeRow, from: &PointRow, to: &mut PointRow);
}

struct Step<const TILTED: bool, W> {
    surroundings: Surroundings,
    wind: W,
    before: PointRow,
}

impl<const TILTED: bool, W: Wind> Pass for Step<TILTED, W> {
    #[inline(always)]
    fn segment(&mut self, state: &mut SegmentState, shape: &ShapeRow, from: &PointRow, to: &mut PointRow) {
        step_segment::<TILTED>(state, shape, &self.surroundings, &self.wind, &mut self.before, from, to);
    }
}

struct Place<'a, const TILTED: bool> {
    surroundings: &'a Surroundings,
}

impl<const TILTED: bool> Pass for Place<'_, TILTED> {
    #[inline(always)]
    fn segment(&mut self, state: &mut SegmentState, shape: &ShapeRow, from: &PointRow, to: &mut PointRow) {
        extend::<TILTED>(from, to, state, shape, self.surroundings);
    }
}
