//! Fitting the head ellipsoid E to the part of a mesh where hair grows.
//!
//! The skull is found without knowing the unit: going down from the highest point, the depth at which the head is as
//! deep below the top as half its breadth lies above ears and brows on any human head. From this first guess the
//! ellipsoid is fitted by reweighted least squares to what looks like scalp of the ellipsoid before: above the ears
//! and behind the face, turned outward, and near the surface.

use glam::DVec3;

use crate::{Ellipsoid, Mesh, SettingError};

/// Passes of the reweighted fit; it settles to 1e-4 of the size in about ten.
const PASSES: usize = 25;

/// Horizontal sections in which the skull is looked for.
const LEVELS: usize = 600;

/// A vertex with its share of the surface.
struct Sample {
    place: DVec3,
    normal: DVec3,
    area: f64,
}

/// The ellipsoid through the scalp of a mesh that [`super::check_mesh`] accepts (the mesh's unit).
pub(super) fn scalp(mesh: &Mesh) -> Result<Ellipsoid, SettingError> {
    let none = || {
        let remedy =
            "found no skull at its top (+y): correct head.unit, head.up or head.groups, or give head.ellipsoid";
        super::refused_mesh(mesh, "no skull", remedy)
    };
    let samples = samples(mesh);
    let mut guess = first_guess(mesh).ok_or_else(none)?;
    for pass in 0..PASSES {
        // The net is drawn in from 30 % of the mean half axis to 20 %.
        let tolerance = (0.3 * 0.85_f64.powi(pass as i32)).max(0.2);
        guess = refit(&samples, &guess, tolerance).ok_or_else(none)?;
    }
    Ok(Ellipsoid { center: guess.center.as_vec3(), half_axes: guess.half_axes.as_vec3() })
}

struct Guess {
    center: DVec3,
    half_axes: DVec3,
}

fn samples(mesh: &Mesh) -> Vec<Sample> {
    let mut area = vec![0.0_f64; mesh.positions.len()];
    let mut normal = vec![DVec3::ZERO; mesh.positions.len()];
    for triangle in &mesh.triangles {
        let [a, b, c] = triangle.map(|v| mesh.positions[v as usize].as_dvec3());
        let vector = 0.5 * (b - a).cross(c - a);
        for &v in triangle {
            area[v as usize] += vector.length() / 3.0;
            normal[v as usize] += vector;
        }
    }
    (mesh.positions.iter().zip(area).zip(normal))
        .filter(|((_, area), _)| *area > 0.0)
        .map(|((p, area), n)| Sample { place: p.as_dvec3(), normal: n.normalize_or_zero(), area })
        .collect()
}

/// An ellipsoid of a head's usual proportions at the top of the mesh.
fn first_guess(mesh: &Mesh) -> Option<Guess> {
    let heights = mesh.triangles.iter().flatten().map(|&v| f64::from(mesh.positions[v as usize].y));
    let (bottom, top) = heights.fold((f64::INFINITY, f64::NEG_INFINITY), |(b, t), y| (b.min(y), t.max(y)));
    let step = (top - bottom) / LEVELS as f64;
    let level = |p: DVec3| (top - p.y) / step;
    let mut sections = vec![(DVec3::INFINITY, DVec3::NEG_INFINITY); LEVELS];
    for triangle in &mesh.triangles {
        let corners = triangle.map(|v| mesh.positions[v as usize].as_dvec3());
        for (i, j) in [(0, 1), (1, 2), (2, 0)] {
            let (a, b) = if corners[i].y > corners[j].y { (corners[i], corners[j]) } else { (corners[j], corners[i]) };
            let (first, last) = (level(a).ceil() as usize, level(b).floor() as usize);
            for (k, section) in sections.iter_mut().enumerate().take(last + 1).skip(first) {
                let along = if b.y < a.y { (k as f64 - level(a)) / (level(b) - level(a)) } else { 0.0 };
                let p = a.lerp(b, along);
                *section = (section.0.min(p), section.1.max(p));
            }
        }
    }
    let (mut low, mut high) = sections[0];
    for (k, section) in sections.iter().enumerate().skip(1) {
        (low, high) = (low.min(section.0), high.max(section.1));
        let (depth, r) = (step * k as f64, 0.5 * (high.z - low.z));
        if depth >= r && r > 0.0 {
            let middle = 0.5 * (low + high);
            return Some(Guess {
                center: DVec3::new(middle.x, top - 1.4 * r, middle.z),
                half_axes: r * DVec3::new(1.2, 1.4, 1.02),
            });
        }
    }
    None
}

/// Where hair grows, by the direction from the centre in units of the half axes.
pub(super) fn is_scalp(u: DVec3) -> bool {
    let u = u.normalize_or_zero();
    let forehead_free = u.y > 0.45 || u.x < 0.6;
    let above_ears = if u.x < -0.35 { -0.4 } else { 0.1 };
    forehead_free && u.y > above_ears
}

/// One least-squares pass: A x^2 + B y^2 + C z^2 + D x + E y + F z = 1 through the scalp of `guess`, each vertex
/// weighted by its area, by 1 / slope^2 (so that distances count, not values of the quadric), and by Tukey's biweight
/// of its distance over `tolerance` (a share of the mean half axis). None if the outcome is not an ellipsoid.
fn refit(samples: &[Sample], guess: &Guess, tolerance: f64) -> Option<Guess> {
    let mut normal_matrix = [[0.0_f64; 7]; 6];
    for s in samples {
        let q = (s.place - guess.center) / guess.half_axes;
        let slope = q / guess.half_axes;
        if q.length_squared() == 0.0 || !is_scalp(q) || s.normal.dot(slope.normalize()) < 0.6 {
            continue;
        }
        let mean = guess.half_axes.element_sum() / 3.0;
        let distance = 0.5 * (q.length_squared() - 1.0) / slope.length() / mean;
        let off = distance / tolerance;
        if off.abs() >= 1.0 {
            continue;
        }
        let weight = s.area * (1.0 - off * off).powi(2) / (slope * mean).length_squared();
        let row = [q.x * q.x, q.y * q.y, q.z * q.z, q.x, q.y, q.z, 1.0];
        for (line, a) in normal_matrix.iter_mut().zip(row) {
            for (sum, b) in line.iter_mut().zip(row) {
                *sum += weight * a * b;
            }
        }
    }
    let [a, b, c, d, e, f] = solve(normal_matrix)?;
    let squares = DVec3::new(a, b, c);
    if squares.min_element() <= 0.0 {
        return None;
    }
    let middle = -0.5 * DVec3::new(d, e, f) / squares;
    let level = 1.0 + (squares * middle * middle).element_sum();
    let half_axes = (level / squares).map(f64::sqrt);
    (half_axes.max_element() < 4.0 * half_axes.min_element())
        .then(|| Guess { center: guess.center + middle * guess.half_axes, half_axes: half_axes * guess.half_axes })
}

/// Solves six linear equations given with their right-hand sides, by elimination with row exchange.
fn solve(mut m: [[f64; 7]; 6]) -> Option<[f64; 6]> {
    let size = m.iter().flatten().fold(0.0_f64, |s, x| s.max(x.abs()));
    for column in 0..6 {
        let pivot = (column..6).max_by(|&i, &j| m[i][column].abs().total_cmp(&m[j][column].abs()))?;
        m.swap(column, pivot);
        if m[column][column].abs() <= 1e-10 * size {
            return None;
        }
        let line = m[column];
        for (_, other) in m.iter_mut().enumerate().filter(|(row, _)| *row != column) {
            let factor = other[column] / line[column];
            for (x, y) in other.iter_mut().zip(line) {
                *x -= factor * y;
            }
        }
    }
    Some(std::array::from_fn(|i| m[i][6] / m[i][i]))
}
