//! Sizes of heads and hair, and the units that they suggest.

use glam::Vec3;
use nabiki::Ellipsoid;

/// Mean half axis of a person's head ellipsoid (cm): that of the built-in bust, 9.5 x 11 x 7.8.
pub(crate) const HALF_AXIS: f32 = 9.3;

/// Heads from a newborn's to one and a half times an adult's are accepted: the mean half axis (cm).
pub(crate) const HALF_AXES: [f32; 2] = [5.0, 14.0];

/// The units that a file may have, with their names in a scene and their centimetres.
const UNITS: [(&str, f32); 6] = [("mm", 0.1), ("cm", 1.0), ("in", 2.54), ("dm", 10.0), ("ft", 30.48), ("m", 100.0)];

pub(crate) fn mean_half_axis(ellipsoid: &Ellipsoid) -> f32 {
    // The product of three lengths overflows f32 long before they do.
    ellipsoid.half_axes.as_dvec3().element_product().cbrt() as f32
}

pub(crate) fn middle(points: &[Vec3]) -> Vec3 {
    points.iter().sum::<Vec3>() / points.len().max(1) as f32
}

/// Root mean square distance from the middle.
pub(crate) fn spread(points: &[Vec3]) -> f32 {
    let middle = middle(points);
    (points.iter().map(|p| p.distance_squared(middle)).sum::<f32>() / points.len().max(1) as f32).sqrt()
}

/// The name of the unit in which `size` (file units) is about `wanted` (cm); `None` if no unit has it.
pub(crate) fn named_unit(size: f32, wanted: f32) -> Option<&'static str> {
    // A head off by more than this is in another unit.
    const NEAR: f32 = 1.45;
    let off = |cm: f32| (size * cm / wanted).max(wanted / (size * cm));
    let nearest = UNITS.iter().min_by(|a, b| off(a.1).total_cmp(&off(b.1)));
    nearest.filter(|unit| off(unit.1) < NEAR).map(|(name, _)| *name)
}

/// The unit, in TOML, in which `size` (file units) is about `wanted` (cm): a name, or centimetres if none fits.
pub(crate) fn unit_for(size: f32, wanted: f32) -> String {
    named_unit(size, wanted).map_or_else(|| decimal(wanted / size, 2), |name| format!("\"{name}\""))
}

/// A number with this many digits, in TOML.
pub(crate) fn decimal(number: f32, digits: usize) -> String {
    let text = format!("{number:.*e}", digits.saturating_sub(1));
    text.parse::<f32>().map_or(text, |number| number.to_string())
}

/// A point in TOML.
pub(crate) fn vector(p: Vec3) -> String {
    let [x, y, z] = p.to_array();
    format!("[{x:?}, {y:?}, {z:?}]")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_are_told_by_the_size_of_a_head() {
        for (name, cm) in UNITS {
            assert_eq!(unit_for(HALF_AXIS / cm, HALF_AXIS), format!("\"{name}\""));
        }
        // With a head of 1.85 units, no named unit fits.
        assert_eq!(unit_for(1.85, HALF_AXIS), decimal(HALF_AXIS / 1.85, 2));
    }
}
