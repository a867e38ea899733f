//! Neighbours: pressure out of places fuller than at rest, and cohesion toward the mean velocity, from the grid of the carriers.

use glam::{DMat3, DVec3};

use crate::dynamics::free::grid::Crowd;
use crate::scalar::{Scalar, Vector};

/// The force of the neighbours on a point at rest (head space), and their drag on its velocity, in the unit of the
/// force per cm per frame.
#[inline(never)]
pub fn force<S: Scalar>(crowd: &Crowd, p: Vector<S>) -> (Vector<S>, S) {
    /// In a grid of centimetres, read in f32.
    const STEP_CM: f64 = 0.03;
    let at = p.value();
    let slope = |e: DVec3| {
        let (ahead, behind) = (crowd.at(at + STEP_CM * e), crowd.at(at - STEP_CM * e));
        ((ahead.0 - behind.0) / (2.0 * STEP_CM), (ahead.1 - behind.1) / (2.0 * STEP_CM))
    };
    let (force, held) = crowd.at(at);
    let of_force = || DMat3::from_cols(slope(DVec3::X).0, slope(DVec3::Y).0, slope(DVec3::Z).0);
    let of_held = || DVec3::new(slope(DVec3::X).1, slope(DVec3::Y).1, slope(DVec3::Z).1);
    (S::known_vector(force, p, of_force), S::known(held, p, of_held))
}
