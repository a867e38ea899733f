//! Working memory for one block of strands in a step; each thread keeps its own.

use std::cell::RefCell;

use crate::dynamics::row::{LANES, PointRow, Row};

/// The working values of one segment of every strand of a block.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub(super) struct Work {
    /// The acceleration of the node by field and neighbours in this frame (cm per frame^2).
    pub blown: PointRow,
    /// beta_i: the share of its speed that air and neighbours take (1 per frame).
    pub drag: Row,
    /// b_i: its acceleration by all but the chain and the air.
    pub pushed: PointRow,
    /// Where R_(i-1) carries the weight at rest.
    pub weight: PointRow,
    /// R_(i-1) r_i.
    pub carried: PointRow,
    /// M_i, the moment of the joint at its beginning; after a first solve, the change of the joints' force on the segment during the step.
    pub moment: PointRow,
    /// kappa_i, the share of a turn of the segment before it about itself that the joint passes on.
    pub handed: Row,
    /// Position of the node (head space, cm), its velocity (cm per frame), and its motion by the head's turn in this
    /// step.
    pub end: PointRow,
    pub velocity: PointRow,
    pub shifted: PointRow,
    /// Its motion with skin that moves, in this step; unused without.
    pub ridden: PointRow,
    /// Its distance from touching a body at the beginning of the step, if it was computed; else infinity.
    pub clear: Row,
    /// d_i / l_i.
    pub end_way: PointRow,
    /// s_i.
    pub shear: PointRow,
    /// The unknown of a tridiagonal system, and its dependence on the next one: first the turn of the segment about
    /// itself, then its tension.
    pub tension: Row,
    pub above: Row,
    /// The squared sine of the bend of the joint after it.
    pub bent: Row,
    /// What drives the increment, and then the increment; its dependence on the next two.
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
        ridden: Self::ROWS,
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

/// Takes this thread's memory, for this many segments; [`keep`] returns it. Its contents are stale.
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
