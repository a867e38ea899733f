//! The builtin bust: blended shapes, meshed.
//!
//! Measures follow adult anthropometry: 22.7 cm from chin to crown, 15.4 cm broad, 19 cm deep, eyes at half the
//! height, nose and ears between there and the chin. One shape a file; each takes the skin so far and gives it back
//! with its own part blended in.

mod ear;
mod eyes;
mod face;
mod mesher;
mod mouth;
mod neck;
mod nose;
mod shapes;
mod skull;
mod torso;

use glam::Vec3;

use crate::{Ellipsoid, Mesh};

/// E of the builtin bust: the half axes that make the paper's unit of length a centimetre.
pub(super) const ELLIPSOID: Ellipsoid = Ellipsoid { center: Vec3::ZERO, half_axes: Vec3::new(9.5, 11.0, 7.8) };

/// The bust's surface.
pub(super) fn mesh() -> Mesh {
    mesher::mesh(&field)
}

/// The bust as one function of the place: negative inside, zero on the skin, and near it about the distance (cm).
/// The same on both sides of z = 0, to the bit.
pub(super) fn field(p: Vec3) -> f32 {
    // Rounding |z| off at the middle keeps what both halves share smooth there.
    let p = Vec3::new(p.x, p.y, (p.z * p.z + 0.01).sqrt());
    let mut skin = skull::add(p);
    skin = face::add(p, skin);
    skin = neck::add(p, skin);
    skin = torso::add(p, skin);
    skin = eyes::add(p, skin);
    skin = nose::add(p, skin);
    skin = mouth::add(p, skin);
    skin = ear::add(p, skin);
    torso::cut_off(p, skin)
}
