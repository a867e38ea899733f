//! Polar coordinates of a segment (figure 1): theta from +y, phi in the zx plane from +z toward +x.

use std::f64::consts::PI;

use glam::DVec3;

/// Below this sine of theta a segment counts as parallel to y, where phi is undefined (section 4.2).
pub(super) const POLE_SINE: f64 = 1e-6;

/// Below this increment of theta (rad per frame) a segment counts as at rest, so that the force may choose its
/// theta plane; a segment that swings through the pole keeps the plane it swings in.
pub(super) const POLE_REST: f64 = 1e-6;

/// (theta, phi) of a direction of any length but 0; phi = 0 where it is undefined. Directions within `straighten`
/// (rad) of the y axis are laid on it.
pub(super) fn from_direction(s: DVec3, straighten: f64) -> (f64, f64) {
    let theta = s.x.hypot(s.z).atan2(s.y);
    if theta <= straighten {
        (0.0, 0.0)
    } else if PI - theta <= straighten {
        (PI, 0.0)
    } else {
        (theta, s.x.atan2(s.z))
    }
}

/// The unit direction (sin theta sin phi, cos theta, sin theta cos phi).
pub(super) fn to_direction(theta: f64, phi: f64) -> DVec3 {
    let ((sin_theta, cos_theta), (sin_phi, cos_phi)) = (theta.sin_cos(), phi.sin_cos());
    DVec3::new(sin_theta * sin_phi, cos_theta, sin_theta * cos_phi)
}

/// The azimuth of a force, where it has one.
pub(super) fn azimuth(force: DVec3) -> Option<f64> {
    (force.x != 0.0 || force.z != 0.0).then(|| force.x.atan2(force.z))
}
