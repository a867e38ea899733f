//! The motion of a mesh in a point cache: the rigid motion that fits its points best.

use std::path::Path;

use glam::{DMat3, DQuat, DVec3, Vec3};

use super::source::MotionSource;
use super::track::{Sample, Track};
use super::world::HeadMotion;
use crate::error::{Error, Result};
use crate::point_cache::PointFrames;

/// The best rigid motion of a mesh with these points at rest, in a point cache of the same mesh (the cache's unit and axes).
///
/// # Errors
/// A cache that cannot be read, or is of another mesh.
pub fn of_points(source: &MotionSource, mesh: &Path, rest: &[Vec3], frame_rate: f64) -> Result<HeadMotion> {
    let named = |e: Error| e.in_file(&source.file);
    source.check().map_err(named)?;
    let mut cache = PointFrames::open(&source.file)?;
    if cache.points() != rest.len() {
        let line = format!(
            "holds {} points, but {} has {}: give the cache of this mesh",
            cache.points(),
            mesh.display(),
            rest.len()
        );
        return Err(named(Error::new(line)));
    }
    let rate = source.frames_per_second.unwrap_or(frame_rate);
    let mut turn = DQuat::IDENTITY;
    let samples = (0..cache.frames()).map(|n| {
        let fit = fitted(rest, &cache.frame(n)?, turn);
        turn = fit.rotation;
        Ok(fit)
    });
    let samples: Vec<Sample> = samples.collect::<Result<_>>().map_err(named)?;
    let track = Track {
        times: cache.times(rate),
        samples,
        what: format!("{} points", rest.len()),
        bound: Some(Sample { position: DVec3::ZERO, rotation: DQuat::IDENTITY }),
        ..Track::default()
    };
    track.head_motion(source, frame_rate)
}

/// The rigid motion that takes some points nearest to others. `from`: a rotation to begin at.
///
/// The rotation is found as M. Müller, J. Bender, N. Chentanez and M. Macklin extract it from a matrix (2016): turning by
/// the moment of the matrix's columns about its own.
fn fitted(rest: &[Vec3], now: &[Vec3], from: DQuat) -> Sample {
    let middle = |of: &[Vec3]| of.iter().map(|p| p.as_dvec3()).sum::<DVec3>() / of.len() as f64;
    let (before, after) = (middle(rest), middle(now));
    let mut spread = DMat3::ZERO;
    for (a, b) in rest.iter().zip(now) {
        let (a, b) = (a.as_dvec3() - before, b.as_dvec3() - after);
        spread += DMat3::from_cols(b * a.x, b * a.y, b * a.z);
    }
    // A rotation by half a turn from the best one may also be in balance.
    let halves = [DVec3::X, DVec3::Y, DVec3::Z].map(|axis| DQuat::from_axis_angle(axis, std::f64::consts::PI) * from);
    let mut best = turned_to(&spread, from);
    for other in halves {
        let found = turned_to(&spread, other);
        // Only one that is clearly better, so that rounding does not choose.
        if found.1 > best.1 + 1e-9 * best.1.abs() {
            best = found;
        }
    }
    let mut rotation = best.0;
    // Points that have not moved are carried by exactly nothing.
    if rest == now {
        rotation = DQuat::IDENTITY;
    }
    let position = if rest == now { DVec3::ZERO } else { after - rotation * before };
    Sample { position, rotation }
}

/// The rotation in balance that is reached from one, and how well it fits: the sum of the lengths along it.
fn turned_to(spread: &DMat3, from: DQuat) -> (DQuat, f64) {
    const ROUNDS: usize = 200;
    let mut rotation = from;
    let mut fit = f64::NEG_INFINITY;
    for _ in 0..ROUNDS {
        let own = DMat3::from_quat(rotation);
        let pairs = [(own.x_axis, spread.x_axis), (own.y_axis, spread.y_axis), (own.z_axis, spread.z_axis)];
        let moment: DVec3 = pairs.iter().map(|(a, b)| a.cross(*b)).sum();
        fit = pairs.iter().map(|(a, b)| a.dot(*b)).sum();
        let turn = moment / (fit.abs() + f64::MIN_POSITIVE);
        let angle = turn.length();
        if angle < 1e-14 || !angle.is_finite() {
            break;
        }
        rotation = (DQuat::from_axis_angle(turn / angle, angle) * rotation).normalize();
    }
    (rotation, fit)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A box that is turned by half a turn is found there, though that, too, is in balance.
    #[test]
    fn half_a_turn_is_found() {
        let corner = |i: usize| Vec3::new((i & 1) as f32 * 4.0, (i >> 1 & 1) as f32 * 2.0, (i >> 2) as f32);
        let rest: Vec<Vec3> = (0..8).map(corner).collect();
        for axis in [Vec3::X, Vec3::Y, Vec3::Z] {
            let now: Vec<Vec3> = rest.iter().map(|&p| 2.0 * p.dot(axis) * axis - p).collect();
            let Sample { position, rotation } = fitted(&rest, &now, DQuat::IDENTITY);
            for (a, b) in rest.iter().zip(&now) {
                assert!((rotation * a.as_dvec3() + position).distance(b.as_dvec3()) < 1e-6, "{axis}");
            }
        }
    }

    #[test]
    fn points_that_move_rigidly_are_carried_to_rounding() {
        let rest: Vec<Vec3> = (0..40).map(|i| Vec3::new((i % 5) as f32, (i / 5) as f32, (i * i % 7) as f32)).collect();
        let mut before = DQuat::IDENTITY;
        for n in 0..30 {
            let turn = DQuat::from_axis_angle(DVec3::new(0.6, 0.0, 0.8), 0.2 * f64::from(n));
            let shift = DVec3::new(f64::from(n), 3.0, -1.0);
            let now: Vec<Vec3> = rest.iter().map(|p| (turn * p.as_dvec3() + shift).as_vec3()).collect();
            let Sample { position, rotation } = fitted(&rest, &now, before);
            before = rotation;
            // Points of 40 cm are rounded by 2e-6.
            assert!(
                rotation.dot(turn).abs() > 1.0 - 1e-12 && position.distance(shift) < 1e-5,
                "{n}: {rotation} {position}"
            );
        }
    }
}
