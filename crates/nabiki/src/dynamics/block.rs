//! Sixteen consecutive strands, packed side by side, and the way along them.
//!
//! Strands are not sorted by their number of segments, although mixed hair would then need less filling: consecutive
//! strands need no permutation, so points are written once and in order. Cores share blocks by halves (`rayon::join`),
//! without lists, locks or allocations.

use std::ops::Range;

use glam::Vec3;

use super::row::{LANES, PointRow, Row};
use super::state::Identity;
use super::transpose::write_points;

/// Rows of points kept on the stack before they are written out strand by strand.
const ROWS: usize = RUN + 1;

/// The most segments of a strand in one pass.
pub(super) const RUN: usize = 15;

/// Up to sixteen consecutive strands. Shorter ones are filled up with segments of no length, and missing ones with
/// strands of such segments: they go through the motions and are not written.
#[derive(Clone, Debug)]
pub(super) struct Block {
    pub roots: PointRow,
    /// Points of each strand; 0 for a missing one.
    points: [u32; LANES],
    /// Segments of the longest strand.
    pub segments: u32,
    /// Index of its first segment among those of all blocks.
    first_segment: u32,
    /// Index of its first strand.
    pub first_strand: u32,
}

impl Block {
    /// Packs strands given by root and number of segments, at most sixteen, after `first_segment` rows of others.
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

    /// Adds to the hash that identifies the hair: its roots and its numbers of points.
    pub fn identify(&self, identity: &mut Identity) {
        self.roots.iter().for_each(|row| identity.numbers(&row.0));
        self.points.iter().for_each(|&count| identity.word(count));
    }

    /// The range of its segments among those of all blocks.
    pub fn rows(&self) -> Range<usize> {
        let first = self.first_segment as usize;
        first..first + self.segments as usize
    }

    /// Points of all its strands.
    pub fn point_count(&self) -> usize {
        self.points.iter().map(|&n| n as usize).sum()
    }

    /// Goes to the tips from `start`, which is `roots` except in another space, and writes the points where the caller
    /// wants them.
    #[inline(always)]
    pub fn walk<State, Shape>(
        &self,
        start: &PointRow,
        states: &mut [State],
        shapes: &[Shape],
        mut points: Option<&mut [Vec3]>,
        mut pass: impl RunPass<State, Shape>,
    ) {
        let mut rows = [[Row::default(); 3]; ROWS];
        rows[0] = *start;
        let (mut states, mut shapes, mut written) = (&mut states[..shapes.len()], shapes, 0);
        loop {
            let count = shapes.len().min(RUN);
            let (run, after) = states.split_at_mut(count);
            let (run_shapes, shapes_after) = shapes.split_at(count);
            pass.run(run, run_shapes, after.first().zip(shapes_after.first()), &mut rows[..=count]);
            if let Some(points) = &mut points {
                write_points(&rows[..=count], written, &self.points, points);
            }
            if after.is_empty() {
                break;
            }
            // The last row is the first of the next ones, so it is written again.
            rows[0] = rows[count];
            (states, shapes, written) = (after, shapes_after, written + count);
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

/// Does the same for up to [`RUN`] segments in a row: takes the first of the points to all others, one more than segments.
pub(super) trait RunPass<State, Shape> {
    fn run(&mut self, states: &mut [State], shapes: &[Shape], next: Option<(&State, &Shape)>, points: &mut [PointRow]);
}

impl<State, Shape, P: Pass<State, Shape>> RunPass<State, Shape> for P {
    #[inline(always)]
    fn run(&mut self, states: &mut [State], shapes: &[Shape], next: Option<(&State, &Shape)>, points: &mut [PointRow]) {
        let mut rest = states;
        for (i, (shape, point)) in shapes.iter().zip(1..points.len()).enumerate() {
            let Some((state, after)) = std::mem::take(&mut rest).split_first_mut() else { break };
            let (done, to) = points.split_at_mut(point);
            self.segment(state, shape, after.first().zip(shapes.get(i + 1)).or(next), &done[i], &mut to[0]);
            rest = after;
        }
    }
}
