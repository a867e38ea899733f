//! What moves a segment of the free form.

use glam::{DVec3, Vec3};

use crate::dynamics::Dynamics;
use crate::dynamics::gain::{SegmentShape, segment_shapes};
use crate::error::SettingError;
use crate::free_form::FreeForm;

/// What moves one segment; strengths in the unit of the force, directions in head space.
#[derive(Clone, Copy, Debug)]
pub(super) struct FreeSegment {
    pub shape: SegmentShape,
    /// r_i, of length 1.
    pub rest: DVec3,
    /// K.
    pub stiffness: f64,
    /// H.
    pub hold: f64,
    /// What is left of an increment after a frame.
    pub decay: f64,
    /// The part of the head's turn that it lags behind.
    pub lag: f64,
}

/// Every segment of one strand, root first.
///
/// # Errors
/// As [`segment_shapes`].
pub(super) fn free_segments(
    dynamics: &Dynamics,
    form: &FreeForm,
    strand: &[Vec3],
    s: usize,
) -> Result<Vec<FreeSegment>, SettingError> {
    let shapes = segment_shapes(dynamics, strand, s)?;
    let total: f64 = shapes.iter().map(|shape| shape.length).sum();
    let segments = shapes.into_iter().zip(strand.windows(2)).map(|(shape, w)| {
        let middle = shape.along - 0.5 * shape.length / total;
        FreeSegment {
            shape,
            rest: (w[1].as_dvec3() - w[0].as_dvec3()).normalize(),
            stiffness: form.stiffness.at(middle),
            hold: form.hold.at(middle),
            decay: form.decay(middle),
            lag: 1.0 - form.share_of_turn(middle),
        }
    });
    Ok(segments.collect())
}
