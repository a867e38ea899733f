//! Openings of a head's mesh, and whether they are where hair grows.

use glam::{DVec3, Vec3};

use super::fit::is_scalp;
use crate::distance::{SkinDistance, rims};
use crate::{Ellipsoid, Mesh};

/// A rim with this share of its vertices on the scalp opens the skull.
const ON_SCALP: f64 = 0.25;

/// Vertices between these multiples of the ellipsoid's radius from its centre belong to the scalp, because E runs
/// through it.
const NEAR: std::ops::RangeInclusive<f32> = 0.85..=1.2;

/// A hole in a head's mesh, or the rim where it was cut off. A fan around the middle of its rim closes it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Opening {
    /// Edges of its rim.
    pub edges: usize,
    /// Mean of the rim's vertices (head space, cm).
    pub middle: Vec3,
    /// Largest distance of the rim from `middle` (cm).
    pub radius: f32,
    /// How far the ellipsoid E extends beyond `middle` (cm) if the rim runs through the scalp: how much of the skull is
    /// missing. `None` for other openings, such as neck, eyes and mouth.
    pub missing: Option<f32>,
}

/// The openings of a mesh whose triangles face outward, in the order of their vertices.
pub(super) fn of(mesh: &Mesh, ellipsoid: &Ellipsoid, skin: &SkinDistance) -> Vec<Opening> {
    let is_fitted = runs_through_scalp(ellipsoid, skin);
    let reach = |p: Vec3| (p - ellipsoid.center) / ellipsoid.half_axes;
    let on_scalp = |p: Vec3| is_fitted && NEAR.contains(&reach(p).length()) && is_scalp(reach(p).as_dvec3());
    rims::of(mesh)
        .into_iter()
        .map(|rim| {
            let middle = rims::middle(&rim, &mesh.positions);
            let vertices = || rim.iter().map(|&v| mesh.positions[v as usize]);
            let share = vertices().filter(|&p| on_scalp(p)).count() as f64 / rim.len() as f64;
            let radius = vertices().map(|p| p.distance(middle)).fold(0.0, f32::max);
            // Along the ray from the centre; from the centre itself, upward.
            let out = reach(middle).try_normalize().unwrap_or(Vec3::Y);
            let bulge =
                ((out - reach(middle)) * ellipsoid.half_axes).length() * (1.0 - reach(middle).length()).signum();
            Opening { edges: rim.len(), middle, radius, missing: (share >= ON_SCALP).then_some(bulge.max(0.0)) }
        })
        .collect()
}

/// Whether E belongs to the scalp and not to a whole body: half of its points where hair grows are near the skin.
fn runs_through_scalp(ellipsoid: &Ellipsoid, skin: &SkinDistance) -> bool {
    // Share of the mean half axis; a fitted E is off by 0.02 to 0.05.
    const FITTED: f32 = 0.1;
    const POINTS: usize = 200;
    let directions = (0..POINTS).map(|i| {
        // Fibonacci's spiral, even over the sphere.
        let (y, turn) = (1.0 - (2 * i + 1) as f64 / POINTS as f64, i as f64 * 2.399_963);
        let r = (1.0 - y * y).sqrt();
        DVec3::new(r * turn.cos(), y, r * turn.sin())
    });
    let points = directions.filter(|&u| is_scalp(u)).map(|u| ellipsoid.center + ellipsoid.half_axes * u.as_vec3());
    let mut off: Vec<f32> = points.map(|p| skin.at(p).abs()).collect();
    off.sort_by(f32::total_cmp);
    off.get(off.len() / 2).is_some_and(|&off| off <= FITTED * ellipsoid.half_axes.element_product().cbrt())
}
