//! Polar coordinates of a segment (figure 1): theta from +y, phi in the zx plane from +z toward +x, where y is the polar
//! axis (see `polar.rs`).

use glam::DVec3;

use crate::scalar::{Scalar, Vector};

/// Below this sine of theta a segment counts as parallel to y, where phi is undefined (section 4.2). The direction
/// of a segment of half a centimetre between two f32 points 32 cm from the origin is not known any better.
pub(super) const POLE_SINE: f64 = 1e-5;

/// Below this increment of theta (rad per frame) a segment counts as at rest, so the force may choose its theta plane.
/// A segment that swings through the pole keeps its plane.
pub(super) const POLE_REST: f64 = 1e-6;

/// (theta, phi) of a direction of any length but 0; phi = 0 where it is undefined.
pub(super) fn from_direction(s: DVec3) -> (f64, f64) {
    (s.x.hypot(s.z).atan2(s.y), s.x.atan2(s.z))
}

/// Sine and cosine of theta and of phi of a direction of any length but 0; phi = 0 where it is undefined.
pub(super) fn direction_turns(s: DVec3) -> [[f64; 2]; 2] {
    let (level, length) = (s.x.hypot(s.z), s.length());
    let phi = if level > 0.0 { [s.x / level, s.z / level] } else { [0.0, 1.0] };
    [[level / length, s.y / length], phi]
}

/// The azimuth of a force, if it has one.
pub(super) fn azimuth<S: Scalar>(force: Vector<S>) -> Option<S> {
    let level = force.value();
    (level.x != 0.0 || level.z != 0.0).then(|| {
        let azimuth = level.x.atan2(level.z);
        let across = (level.x * level.x + level.z * level.z).recip();
        S::known(azimuth, force, || DVec3::new(level.z * across, 0.0, -level.x * across))
    })
}
