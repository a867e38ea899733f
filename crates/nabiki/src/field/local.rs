//! What point, vortex and fan have in common.

use glam::{DVec3, Vec3};

use super::falloff::{self, EnvelopeKey, Falloff};
use crate::error::SettingError;

#[cfg(test)]
mod tests;

/// The default strength.
pub(super) fn strength() -> f32 {
    50.0
}

/// The default axis.
pub(super) fn up() -> Vec3 {
    Vec3::Y
}

/// Refuses what no local field has.
pub(super) fn check_place(
    name: &str,
    position: Vec3,
    strength: f32,
    falloff: &Falloff,
    envelope: &[EnvelopeKey],
) -> Result<(), SettingError> {
    if !position.is_finite() {
        return Err(SettingError::new(format!("{name}.position"), position, "must be finite numbers (cm)"));
    }
    if !strength.is_finite() {
        return Err(SettingError::new(format!("{name}.strength"), strength, "must be a finite number"));
    }
    falloff.check(&format!("{name}.falloff"))?;
    falloff::check_envelope(name, envelope)
}

/// A direction of length 1.
///
/// # Errors
/// Names `name.key`, where it has none.
pub(super) fn unit(name: &str, key: &str, direction: Vec3) -> Result<Vec3, SettingError> {
    let unit = direction.as_dvec3().try_normalize().map(DVec3::as_vec3);
    unit.ok_or_else(|| SettingError::new(format!("{name}.{key}"), direction, "must be a direction, not (0, 0, 0)"))
}

/// What |F| is at most.
pub(super) fn strongest(strength: f32, envelope: &[EnvelopeKey]) -> f32 {
    // A little more, for the rounding of r^.
    strength.abs() * falloff::largest(envelope) * (1.0 + 1e-6)
}

/// See [`Field::first_above`](super::Field::first_above).
pub(super) fn first_above(name: &str, strength: f32, envelope: &[EnvelopeKey], limit: f64) -> Option<(String, String)> {
    let strongest = strongest(strength, envelope);
    (f64::from(strongest) > limit).then(|| (format!("{name}.strength"), strength.to_string()))
}
