//! What moves a segment of the free form.

use glam::{DVec3, Vec3};

use super::pulls::joints::Stiffness;
use crate::dynamics::Dynamics;
use crate::dynamics::gain::{SegmentShape, segment_shapes};
use crate::error::SettingError;
use crate::free_form::FreeForm;

/// What moves one segment; strengths in the unit of the force, directions in head space.
#[derive(Clone, Copy, Debug)]
pub(in crate::dynamics) struct FreeSegment {
    pub shape: SegmentShape,
    /// r_i, of length 1.
    pub rest: DVec3,
    /// K of the joint at its beginning, for its length.
    pub stiffness: f64,
    /// H.
    pub hold: f64,
    /// What is left of an increment after a frame.
    pub decay: f64,
    /// The part of the head's turn that it lags behind.
    pub lag: f64,
}

/// How many segments of a strand are held where it is tied.
pub(in crate::dynamics) fn held(form: &FreeForm, strand: &[Vec3]) -> usize {
    form.tie.map_or(0, |tie| tie.held(strand))
}

/// Every segment of one strand, root first.
///
/// # Errors
/// As [`segment_shapes`].
pub(in crate::dynamics) fn free_segments(
    dynamics: &Dynamics,
    form: &FreeForm,
    strand: &[Vec3],
    s: usize,
) -> Result<Vec<FreeSegment>, SettingError> {
    let shapes = segment_shapes(dynamics, strand, s, held(form, strand))?;
    let stiffness = Stiffness(&form.stiffness);
    let segments = shapes.into_iter().zip(strand.windows(2)).map(|(shape, w)| FreeSegment {
        rest: (w[1].as_dvec3() - w[0].as_dvec3()).normalize(),
        stiffness: stiffness.of(&shape),
        hold: form.hold.at(shape.middle),
        decay: form.decay(shape.middle),
        lag: 1.0 - form.share_of_turn(shape.middle),
        shape,
    });
    Ok(segments.collect())
}
