//! Where a segment is.

use glam::DVec3;

use crate::dynamics::free::grid::Crowd;
use crate::dynamics::free::head_frame::HeadFrame;
use crate::dynamics::free::segment::FreeSegment;
use crate::scalar::{Turn, Vector};

/// Where a segment is, as forces on it ask.
pub struct At<'a, S> {
    pub segment: &'a FreeSegment,
    /// d.
    pub direction: Vector<S>,
    /// p_i (head space, cm), and what the increments move it by in a frame (cm).
    pub end: Vector<S>,
    pub velocity: Vector<S>,
    /// R_(i-1).
    pub frame: Turn<S>,
    pub head: &'a HeadFrame,
    /// The weight under which hair lies in balance at rest.
    pub rest_weight: DVec3,
    pub crowd: Option<&'a Crowd>,
}
