//! Makes almost vertical hair exactly vertical.

use glam::{DVec3, Vec3};

use super::Motion;
use crate::strands::Strands;

/// The rest shape according to [`Motion::straighten`]. Segments within that angle of `polar_axis` (head space, any
/// length except 0; see [`Dynamics::polar_axis`](super::Dynamics::polar_axis)) are aligned with it, up or down as they
/// were, and keep their length. Roots stay; the rest of the strand moves along.
///
/// Steppers do not call this. Call it once, when you make the hair at rest. A second call changes only rounding errors.
pub fn straightened(strands: &Strands, motion: &Motion, polar_axis: Vec3) -> Strands {
    let mut straight = strands.clone();
    if motion.straighten == 0.0 {
        return straight;
    }
    let axis = polar_axis.as_dvec3().normalize();
    let within = f64::from(motion.straighten).to_radians().cos();
    for s in 0..strands.len() {
        for (i, w) in strands.strand(s).windows(2).enumerate() {
            let segment = w[1].as_dvec3() - w[0].as_dvec3();
            let segment = laid_on(axis, within, segment);
            // From the rounded point on, so that a segment along y has exactly the x and z of its neighbour.
            let from = straight.strand(s)[i].as_dvec3();
            straight.strand_mut(s)[i + 1] = (from + segment).as_vec3();
        }
    }
    straight
}

fn laid_on(axis: DVec3, within: f64, segment: DVec3) -> DVec3 {
    let (length, along) = (segment.length(), segment.dot(axis));
    if along.abs() >= within * length { axis * length.copysign(along) } else { segment }
}
