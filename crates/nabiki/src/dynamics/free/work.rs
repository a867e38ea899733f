//! Room for one block of strands on its way through a step: each thread has its own, and keeps it.

use std::cell::RefCell;

use crate::dynamics::row::{LANES, PointRow, Row};

/// What a step makes of one segment of every strand of a block.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub(super) struct Work {
    /// How field and neighbours accelerate the node in this frame (cm a frame^2).
    pub blown: PointRow,
    /// beta_i: what air and neighbours take of its speed (1 a frame).
    pub drag: Row,
    /// b_i: how all but the chain and the air accelerate it.
    pub pushed: PointRow,
    /// Where R_(i-1) carries the weight at rest.
    pub weight: PointRow,
    /// R_(i-1) r_i.
    pub carried: PointRow,
    /// M_i, the moment of the joint at its beginning; after a first solve, by how much the joints' force on the segment changes in the step.
    pub moment: PointRow,
    /// kappa_i, the part of a turn of the segment before it about itself that the joint hands on.
    pub handed: Row,
    /// Where the node is (head space, cm), how it goes (cm a frame), and how the head's turn has moved it in this step.
    pub end: PointRow,
    pub velocity: PointRow,
    pub shifted: PointRow,
    /// How far it is from touching a body at the beginning of the step, where it was asked for; else infinity.
    pub clear: Row,
    /// d_i / l_i.
    pub end_way: PointRow,
    /// s_i.
    pub shear: PointRow,
    /// What a tridiagonal system is solved for, and how it depends on the next one: by how much the segment turns about itself, and then its
    /// tension.
    pub tension: Row,
    pub above: Row,
    /// The square of the sine of the bend of the joint after it.
    pub bent: Row,
    /// What drives the increment, and then the increment; how it depends on the next two.
    pub driven: PointRow,
    pub next: Row,
    pub after: Row,
}

impl Work {
    const ROW: Row = Row([0.0; LANES]);
    const ROWS: PointRow = [Self::ROW; 3];

    pub const NONE: Self = Self {
        blown: Self::ROWS,
        drag: Self::ROW,
        pushed: Self::ROWS,
        weight: Self::ROWS,
        carried: Self::ROWS,
        moment: Self::ROWS,
        handed: Self::ROW,
        end: Self::ROWS,
        velocity: Self::ROWS,
        shifted: Self::ROWS,
        clear: Self::ROW,
        end_way: Self::ROWS,
        shear: Self::ROWS,
        tension: Self::ROW,
        above: Self::ROW,
        bent: Self::ROW,
        driven: Self::ROWS,
        next: Self::ROW,
        after: Self::ROW,
    };
}

thread_local! {
    static ROOM: RefCell<Vec<Work>> = const { RefCell::new(Vec::new()) };
}

/// Takes this thread's room out, for so many segments: it is given back by [`keep`]. What is in it is of no use.
#[inline(always)]
pub(super) fn room(segments: usize) -> Vec<Work> {
    let mut room = ROOM.with(RefCell::take);
    if room.len() < segments {
        room.resize(segments, Work::NONE);
    }
    room
}

/// Gives it back.
#[inline(always)]
pub(super) fn keep(room: Vec<Work>) {
    ROOM.with(|of_thread| of_thread.replace(room));
}
