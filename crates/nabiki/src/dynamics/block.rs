//! Sixteen consecutive strands, packed side by side, and their step.

use std::ops::Range;

use glam::Vec3;

use super::gain::SegmentShape;
use super::kernel::{LANES, PointRow, Row, SegmentState, ShapeRow, Wind, place_segment, step_segment};

/// Rows of points kept on the stack before they are written out strand by strand.
const ROWS: usize = 8;

/// Up to sixteen consecutive strands. Shorter ones are filled up with segments of no length, and missing ones with
/// strands of such segments: they go through the motions and are not written.
#[derive(Clone, Debug)]
pub(super) struct Block {
    roots: PointRow,
    /// Points of each strand; 0 for a missing one.
    points: [u32; LANES],
    /// Segments of the longest strand.
    pub segments: u32,
    shapes: Shapes,
}

/// Where a block's shapes lie in [`ShapeTable`].
#[derive(Clone, Debug)]
enum Shapes {
    Shared(Range<usize>),
    EachLane(Range<usize>),
}

/// Lengths and gains of all blocks. Blocks of equal strands share one list, which then stays in the nearest cache.
#[derive(Clone, Debug, Default)]
pub(super) struct ShapeTable {
    shared: Vec<[f32; 3]>,
    each_lane: Vec<[Row; 3]>,
    last_shared: Range<usize>,
}

impl ShapeTable {
    fn push(&mut self, strands: &[Vec<SegmentShape>], segments: usize) -> Shapes {
        let narrow = |shape: &SegmentShape| [shape.length, shape.gain, shape.gain_in_gamma].map(|v| v as f32);
        let first: Vec<[f32; 3]> = strands[0].iter().map(narrow).collect();
        if strands.iter().all(|other| other.iter().map(narrow).eq(first.iter().copied())) {
            if self.shared[self.last_shared.clone()] != first {
                self.last_shared = self.shared.len()..self.shared.len() + first.len();
                self.shared.extend(first);
            }
            return Shapes::Shared(self.last_shared.clone());
        }
        let start = self.each_lane.len();
        for i in 0..segments {
            let mut row = [Row::default(); 3];
            for (lane, strand) in strands.iter().enumerate() {
                let shape = strand.get(i).map(narrow).unwrap_or_default();
                for (values, value) in row.iter_mut().zip(shape) {
                    values.0[lane] = value;
                }
            }
            self.each_lane.push(row);
        }
        Shapes::EachLane(start..self.each_lane.len())
    }
}

impl Block {
    /// Packs strands given by root and shapes, at most sixteen.
    pub fn new(roots: &[Vec3], strands: &[Vec<SegmentShape>], table: &mut ShapeTable) -> Self {
        let segments = strands.iter().map(Vec::len).max().unwrap_or(0);
        let mut block = Self {
            roots: [Row::default(); 3],
            points: [0; LANES],
            segments: segments as u32,
            shapes: table.push(strands, segments),
        };
        for (lane, (root, strand)) in roots.iter().zip(strands).enumerate() {
            for axis in 0..3 {
                block.roots[axis].0[lane] = root[axis];
            }
            block.points[lane] = strand.len() as u32 + 1;
        }
        block
    }

    /// Points of all its strands.
    pub fn point_count(&self) -> usize {
        self.points.iter().map(|&n| n as usize).sum()
    }

    /// Moves the block by one frame and writes its points.
    #[inline(always)]
    pub fn step(&self, states: &mut [SegmentState], table: &ShapeTable, wind: &Wind, points: &mut [Vec3]) {
        let before = self.roots;
        match &self.shapes {
            Shapes::Shared(range) => self.walk(states, &table.shared[range.clone()], points, Step { wind, before }),
            Shapes::EachLane(range) => {
                self.walk(states, &table.each_lane[range.clone()], points, Step { wind, before });
            }
        }
    }

    /// Writes the points of the angles as they are.
    #[inline(always)]
    pub fn place(&self, states: &mut [SegmentState], table: &ShapeTable, points: &mut [Vec3]) {
        match &self.shapes {
            Shapes::Shared(range) => self.walk(states, &table.shared[range.clone()], points, Place),
            Shapes::EachLane(range) => self.walk(states, &table.each_lane[range.clone()], points, Place),
        }
    }

    /// Goes from the roots to the tips.
    #[inline(always)]
    fn walk<S: ShapeRow>(&self, states: &mut [SegmentState], shapes: &[S], points: &mut [Vec3], mut pass: impl Pass) {
        let mut after = self.roots;
        let mut rows = [[Row::default(); 3]; ROWS];
        rows[0] = after;
        let (mut filled, mut written) = (1, 0);
        for (state, shape) in states.iter_mut().zip(shapes) {
            if filled == ROWS {
                self.write(&rows, written, points);
                written += ROWS;
                filled = 0;
            }
            pass.segment(state, shape, &mut after);
            rows[filled] = after;
            filled += 1;
        }
        self.write(&rows[..filled], written, points);
    }

    /// Writes rows of points, the first of them point number `first` of every strand.
    #[inline(always)]
    fn write(&self, rows: &[PointRow], first: usize, points: &mut [Vec3]) {
        let mut rest = points;
        for (lane, &count) in self.points.iter().enumerate() {
            let (strand, others) = rest.split_at_mut(count as usize);
            rest = others;
            let strand = strand.get_mut(first..).unwrap_or_default();
            for (point, row) in strand.iter_mut().zip(rows) {
                *point = Vec3::new(row[0].0[lane], row[1].0[lane], row[2].0[lane]);
            }
        }
    }
}

/// What is done to each segment on the way to the tips: takes the points p_(i-1) of the new frame to p_i.
///
/// A trait where a closure would do: only a named function can be forced into its caller, and so be compiled for
/// the vectors chosen there.
trait Pass {
    fn segment<S: ShapeRow>(&mut self, state: &mut SegmentState, shape: &S, after: &mut PointRow);
}

struct Step<'a> {
    wind: &'a Wind,
    before: PointRow,
}

impl Pass for Step<'_> {
    #[inline(always)]
    fn segment<S: ShapeRow>(&mut self, state: &mut SegmentState, shape: &S, after: &mut PointRow) {
        step_segment(state, shape, self.wind, &mut self.before, after);
    }
}

struct Place;

impl Pass for Place {
    #[inline(always)]
    fn segment<S: ShapeRow>(&mut self, state: &mut SegmentState, shape: &S, after: &mut PointRow) {
        place_segment(state, shape, after);
    }
}
