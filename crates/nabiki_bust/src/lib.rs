//! The built-in bust as it is sculpted: blended shapes, meshed, measured and written in few bytes.
//!
//! Measures follow adult anthropometry (22.3 cm from chin to crown, 15.4 cm broad, 19 cm deep) and the canons of
//! proportion, to which `tests/canons.rs` holds it. One shape a file; each takes the skin so far and gives it back
//! with its own part blended in.

#![forbid(unsafe_code)]

pub mod characters;
mod ear;
mod eyes;
mod face;
mod grid;
// How the numbers follow each other is known to the reader, too, and written down there.
#[path = "../../nabiki_groom/src/bust/layout.rs"]
#[allow(dead_code, reason = "a part concerns the reader alone")]
mod layout;
mod measure;
mod mouth;
mod neck;
mod nose;
#[path = "../../nabiki_groom/src/bust/numbers.rs"]
#[allow(dead_code, reason = "a part concerns the reader alone")]
mod numbers;
#[path = "../../nabiki_groom/src/bust/read.rs"]
mod read;
mod shapes;
mod skull;
mod torso;
mod write;

use glam::Vec3;

/// The content of `bust.bin`.
pub fn bake() -> Vec<u8> {
    let mut bust = grid::cut(&field);
    // The distance is that of the mesh as it will be read.
    let mesh = read::mesh(&read::numbers(&write::all(&mut bust)));
    measure::distance(&mut bust, mesh);
    write::all(&mut bust)
}

/// The bust as one function of the place: negative inside, zero on the skin, and near it about the distance (cm).
/// The same on both sides of z = 0, to the bit.
pub fn field(p: Vec3) -> f32 {
    let p = one_side(p);
    torso::cut_off(p, uncut(p))
}

/// The place on her right, |z| rounded off at the middle, which keeps what both halves share smooth there.
fn one_side(p: Vec3) -> Vec3 {
    Vec3::new(p.x, p.y, (p.z * p.z + 0.01).sqrt())
}

/// The bust before it is cut off below, on [`one_side`].
fn uncut(p: Vec3) -> f32 {
    let mut skin = skull::add(p);
    skin = face::add(p, skin);
    skin = neck::add(p, skin);
    skin = torso::add(p, skin);
    skin = eyes::add(p, skin);
    skin = nose::add(p, skin);
    skin = mouth::add(p, skin);
    ear::add(p, skin)
}
