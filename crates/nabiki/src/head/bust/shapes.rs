//! Smooth shapes and how they are blended: functions of the place, negative inside, about a distance (cm) near zero.

use glam::Vec3;

/// An axis-aligned ellipsoid; the distance is right on the surface and of first order near it.
pub(super) fn ellipsoid(p: Vec3, center: Vec3, half_axes: Vec3) -> f32 {
    let q = (p - center) / half_axes;
    let (k0, k1) = (q.length(), (q / half_axes).length());
    if k1 > 0.0 { k0 * (k0 - 1.0) / k1 } else { -half_axes.min_element() }
}

/// A capsule from `a` to `b` whose radius runs from `ra` to `rb`.
pub(super) fn capsule(p: Vec3, a: Vec3, b: Vec3, ra: f32, rb: f32) -> f32 {
    let (ap, ab) = (p - a, b - a);
    let t = (ap.dot(ab) / ab.length_squared()).clamp(0.0, 1.0);
    (ap - ab * t).length() - (ra + (rb - ra) * t)
}

/// The union of two shapes, rounded where they meet over about the length `k`.
pub(super) fn smooth_union(a: f32, b: f32, k: f32) -> f32 {
    let h = (k - (a - b).abs()).max(0.0) / k;
    a.min(b) - h * h * k * 0.25
}
