//! What moves a segment of the free form.

use glam::{DVec3, Vec3};

use crate::dynamics::Dynamics;
use crate::dynamics::gain::{SegmentShape, held, segment_shapes};
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
    let shapes = segment_shapes(dynamics, strand, s)?;
    // What is tied goes with the head, as its roots do.
    let held = held(dynamics, strand);
    let total: f64 = shapes[held..].iter().map(|shape| shape.length).sum();
    let mut before = shapes[0].length;
    let segments = shapes.into_iter().zip(strand.windows(2)).enumerate().map(|(i, (shape, w))| {
        // Curvature is an angle for the length between two middles, and it is its change over such a length that pulls:
        // finer cuts bend as coarse ones do.
        // The first joint, at the root or at the band, has no segment before it that bends.
        let between = if i == held { shape.length } else { 0.5 * (before + shape.length) };
        before = shape.length;
        let cut = (f64::from(dynamics.segment_length) / between).powi(2);
        let (begin, middle) = match i < held {
            true => (0.0, 0.0),
            false => (shape.along - shape.length / total, shape.along - 0.5 * shape.length / total),
        };
        FreeSegment {
            shape,
            rest: (w[1].as_dvec3() - w[0].as_dvec3()).normalize(),
            stiffness: cut * form.stiffness.at(begin),
            hold: form.hold.at(middle),
            decay: form.decay(middle),
            lag: 1.0 - form.share_of_turn(middle),
        }
    });
    Ok(segments.collect())
}
