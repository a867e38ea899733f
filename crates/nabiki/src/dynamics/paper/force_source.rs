//! The force of one frame for the fast step: one for all hair, or evaluated at every node.

use super::rows::{SegmentState, ShapeRow, extend};
use super::surroundings::{Force, Surroundings};
use crate::dynamics::field_frame::FieldFrame;
use crate::dynamics::row::{LANES, PointRow, Row, lane as lane_of, set_lane};
use crate::dynamics::{ForceSpace, FrameInput};

/// The source of forces in one frame.
pub(super) trait ForceSource: Copy {
    /// The forces on a segment of each strand of a block.
    type Forces: Forces;

    /// The forces on a segment of each strand of a block, which begins at `start` (head space).
    fn at<const TILTED: bool>(
        &self,
        start: &PointRow,
        state: &SegmentState,
        shape: &ShapeRow,
        surroundings: &Surroundings,
    ) -> Self::Forces;
}

/// The force on each of sixteen segments.
pub(super) trait Forces {
    fn lane(&self, lane: usize) -> Force;
}

impl ForceSource for Force {
    type Forces = Self;

    #[inline(always)]
    fn at<const TILTED: bool>(&self, _: &PointRow, _: &SegmentState, _: &ShapeRow, _: &Surroundings) -> Self::Forces {
        *self
    }
}

impl Forces for Force {
    #[inline(always)]
    fn lane(&self, _: usize) -> Force {
        *self
    }
}

impl ForceSource for FieldFrame<'_> {
    type Forces = ForceRow;

    #[inline(always)]
    fn at<const TILTED: bool>(
        &self,
        start: &PointRow,
        state: &SegmentState,
        shape: &ShapeRow,
        surroundings: &Surroundings,
    ) -> Self::Forces {
        let mut points = PointRow::default();
        extend::<TILTED>(start, &mut points, state, shape, surroundings);
        let in_head = self.at_row(&points);
        let mut row = ForceRow::default();
        for lane in 0..LANES {
            row.set(lane, Force::new(lane_of(&in_head, lane), surroundings));
        }
        row
    }
}

/// The force on each of sixteen segments.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct ForceRow {
    in_half_axes: PointRow,
    in_polar: PointRow,
    azimuth: [Row; 2],
    threshold: Row,
}

impl ForceRow {
    #[inline(always)]
    fn set(&mut self, lane: usize, force: Force) {
        set_lane(&mut self.in_half_axes, lane, force.in_half_axes);
        set_lane(&mut self.in_polar, lane, force.in_polar);
        self.azimuth[0].0[lane] = force.azimuth[0];
        self.azimuth[1].0[lane] = force.azimuth[1];
        self.threshold.0[lane] = force.threshold;
    }
}

impl Forces for ForceRow {
    #[inline(always)]
    fn lane(&self, lane: usize) -> Force {
        Force {
            in_half_axes: lane_of(&self.in_half_axes, lane),
            in_polar: lane_of(&self.in_polar, lane),
            azimuth: [self.azimuth[0].0[lane], self.azimuth[1].0[lane]],
            threshold: self.threshold.0[lane],
        }
    }
}

/// The source of the force of one frame.
#[derive(Clone, Copy, Debug)]
pub(super) enum AnySource<'a> {
    /// The same everywhere.
    Uniform(Force),
    /// Evaluated at every node.
    Local(FieldFrame<'a>),
}

impl<'a> AnySource<'a> {
    pub fn new(input: &FrameInput<'a>, space: ForceSpace, surroundings: &Surroundings) -> Self {
        let field = FieldFrame::new(input, space);
        match field.uniform() {
            Some(in_head) => Self::Uniform(Force::new(in_head, surroundings)),
            None => Self::Local(field),
        }
    }
}
