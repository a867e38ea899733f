//! Segments of sixteen strands side by side: their angles, and what moves them.

use super::surroundings::Surroundings;
use super::turn::Turn;
use crate::dynamics::gain::SegmentShape;
use crate::dynamics::row::{LANES, PointRow, Row, beyond};

/// Sine and cosine of one angle of every strand of a block.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub(super) struct TurnRow {
    sin: Row,
    cos: Row,
}

impl TurnRow {
    #[inline(always)]
    pub fn lane(&self, lane: usize) -> Turn {
        [self.sin.0[lane], self.cos.0[lane]]
    }

    #[inline(always)]
    pub fn set(&mut self, lane: usize, [sin, cos]: Turn) {
        (self.sin.0[lane], self.cos.0[lane]) = (sin, cos);
    }
}

/// Angles and increments (rad per frame) of one segment of every strand of a block.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub(super) struct SegmentState {
    pub theta: TurnRow,
    pub phi: TurnRow,
    pub theta_increment: Row,
    pub phi_increment: Row,
}

impl SegmentState {
    /// Of all its rows.
    pub const NUMBERS: usize = 6 * LANES;

    pub fn rows(&self) -> [&Row; 6] {
        let Self { theta, phi, theta_increment, phi_increment } = self;
        [&theta.sin, &theta.cos, &phi.sin, &phi.cos, theta_increment, phi_increment]
    }

    pub fn rows_mut(&mut self) -> [&mut Row; 6] {
        let Self { theta, phi, theta_increment, phi_increment } = self;
        [&mut theta.sin, &mut theta.cos, &mut phi.sin, &mut phi.cos, theta_increment, phi_increment]
    }
}

impl Default for SegmentState {
    fn default() -> Self {
        let zero = TurnRow { sin: Row::default(), cos: Row([1.0; LANES]) };
        Self { theta: zero, phi: zero, theta_increment: Row::default(), phi_increment: Row::default() }
    }
}

/// What moves one segment of every strand of a block. All 0 where a strand has no such segment.
#[derive(Clone, Copy, Debug, Default)]
#[repr(C)]
pub(super) struct ShapeRow {
    /// cm.
    pub length: Row,
    /// c_i.
    pub gain: Row,
    /// eps_i.
    pub eps: Row,
}

impl ShapeRow {
    /// Sets what moves the segment of one strand.
    pub fn set(&mut self, lane: usize, shape: &SegmentShape) {
        self.length.0[lane] = shape.length as f32;
        self.gain.0[lane] = shape.gain as f32;
        self.eps.0[lane] = shape.eps() as f32;
    }
}

/// Places segment i of every strand of a block at its p_(i-1), and returns p_i.
#[inline(always)]
pub(super) fn extend<const TILTED: bool>(
    from: &PointRow,
    to: &mut PointRow,
    state: &SegmentState,
    shape: &ShapeRow,
    surroundings: &Surroundings,
) {
    for lane in 0..LANES {
        let direction = surroundings.direction::<TILTED>(state.theta.lane(lane), state.phi.lane(lane));
        let p = beyond(from, lane, shape.length.0[lane], direction);
        [to[0].0[lane], to[1].0[lane], to[2].0[lane]] = p;
    }
}
