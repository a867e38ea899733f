//! Smooth shapes and how they are blended: functions of the place, negative inside, about a distance (cm) near zero.

use glam::{Quat, Vec3};

/// An axis-aligned ellipsoid; the distance is right on the surface and of first order near it.
pub(crate) fn ellipsoid(p: Vec3, center: Vec3, half_axes: Vec3) -> f32 {
    let q = (p - center) / half_axes;
    let (k0, k1) = (q.length(), (q / half_axes).length());
    if k1 > 0.0 { k0 * (k0 - 1.0) / k1 } else { -half_axes.min_element() }
}

/// An ellipsoid whose axes are turned by `turn`.
pub(crate) fn turned_ellipsoid(p: Vec3, center: Vec3, half_axes: Vec3, turn: Quat) -> f32 {
    ellipsoid(turn.inverse() * (p - center), Vec3::ZERO, half_axes)
}

/// A capsule from `a` to `b` whose radius runs from `ra` to `rb`.
pub(crate) fn capsule(p: Vec3, a: Vec3, b: Vec3, ra: f32, rb: f32) -> f32 {
    let (ap, ab) = (p - a, b - a);
    let t = (ap.dot(ab) / ab.length_squared()).clamp(0.0, 1.0);
    (ap - ab * t).length() - (ra + (rb - ra) * t)
}

/// A bow through points with the radius there: Catmull and Rom's curve, as short capsules end to end.
pub(crate) fn chain(p: Vec3, points: &[(Vec3, f32)]) -> f32 {
    links(p, points, f32::min)
}

/// The same as one smooth body, whose parts are blended over the length `k`: it is thicker by a quarter of that.
pub(crate) fn limb(p: Vec3, points: &[(Vec3, f32)], k: f32) -> f32 {
    links(p, points, |a, b| if a.is_finite() { join(a, b, k) } else { b })
}

/// The capsules of a bow, put together.
fn links(p: Vec3, points: &[(Vec3, f32)], put: impl Fn(f32, f32) -> f32) -> f32 {
    const PARTS: usize = 8;
    let point = |i: usize| points[i].0.extend(points[i].1);
    let last = points.len() - 1;
    let on_bow = |link: usize, part: usize| {
        let (from, to) = (point(link), point(link + 1));
        let slope = |i: usize| 0.5 * (point((i + 1).min(last)) - point(i.saturating_sub(1)));
        let t = part as f32 / PARTS as f32;
        let (t2, t3) = (t * t, t * t * t);
        from + (3.0 * t2 - 2.0 * t3) * (to - from) + (t3 - 2.0 * t2 + t) * slope(link) + (t3 - t2) * slope(link + 1)
    };
    let mut nearest = f32::INFINITY;
    for link in 0..last {
        for part in 0..PARTS {
            let (a, b) = (on_bow(link, part), on_bow(link, part + 1));
            nearest = put(nearest, capsule(p, a.truncate(), b.truncate(), a.w, b.w));
        }
    }
    nearest
}

/// The union of two shapes, rounded where they meet over about the length `k`.
pub(crate) fn join(a: f32, b: f32, k: f32) -> f32 {
    let h = (k - (a - b).abs()).max(0.0) / k;
    a.min(b) - h * h * k * 0.25
}

/// What of `a` lies outside `b`, the edge rounded over about the length `k`.
pub(crate) fn carve(a: f32, b: f32, k: f32) -> f32 {
    -join(-a, b, k)
}

/// 1 at `center`, falling smoothly to 0 on the ellipsoid of these half axes and beyond: by how much of its height
/// a swelling or hollow moves the skin.
pub(crate) fn swell(p: Vec3, center: Vec3, half_axes: Vec3) -> f32 {
    let left = 1.0 - ((p - center) / half_axes).length_squared();
    if left > 0.0 { left * left * left } else { 0.0 }
}

/// 1 on a line, falling smoothly to 0 at the distance `width` from it and beyond, of a place `off` it.
pub(crate) fn ridge(off: f32, width: f32) -> f32 {
    let left = 1.0 - (off / width) * (off / width);
    if left > 0.0 { left * left * left } else { 0.0 }
}
