//! Hair in the wind, after K. Anjyo, Y. Usami and T. Kurihara, "A computer animation method for hair dynamics
//! description" (Trans. IPSJ, 1993).
//!
//! # Spaces and units
//!
//! *Head space*: right-handed, y up, the face looks along +x, so +z is the character's right-hand side; the origin
//! lies within the skull (the centre of the head ellipsoid unless said otherwise). Lengths are centimetres, angles
//! radians, time is counted in frames. Forces are directions with a strength, not newtons: only their product with
//! the gain c_i of equation (8) moves hair.
//!
//! # Where to begin
//!
//! [`Head::from_mesh`] and [`Strands::push`] take a head and hair of one's own, the crate `nabiki_groom` grows some;
//! [`Simulation`](dynamics::Simulation) moves it frame by frame, as an engine does (`crates/nabiki/examples/engine.rs`), and
//! [`Timeline`](dynamics::Timeline) has all frames at hand, as an editor does.
//!
//! # A program
//!
//! ```
//! use std::sync::Arc;
//!
//! use nabiki::dynamics::{Dynamics, Timeline};
//! use nabiki::field::{Keyframe, KeyframedField};
//! use nabiki::glam::Vec3;
//! use nabiki::{Ellipsoid, SettingError, Strands};
//!
//! fn main() -> Result<(), SettingError> {
//!     let head = Ellipsoid { center: Vec3::ZERO, half_axes: Vec3::new(9.5, 11.0, 7.8) };
//!     // All about it, from the root on 18 segments of a centimetre.
//!     let mut hair = Strands::default();
//!     for around in [0.0_f32, 1.5, 3.0, 4.5] {
//!         let out = Vec3::new(around.cos(), 0.0, around.sin());
//!         hair.push((0..=18).map(|i| head.half_axes * out + i as f32 * (0.3 * out - Vec3::Y).normalize()));
//!     }
//!     let gust = KeyframedField::new(&[Keyframe { through: 50, vector: Vec3::new(-100.0, 0.0, 0.0) }])?;
//!     let mut timeline = Timeline::new(&hair, &Dynamics::new(head), Arc::new(gust), Vec::new(), 50)?;
//!     let film = timeline.play();
//!     let tip = |frame: u32| film.strand(frame, 0)[18];
//!     assert!(tip(50).x < tip(0).x, "hair goes where the wind blows");
//!     Ok(())
//! }
//! ```

#![deny(unsafe_code)]

// What reads the bust calls this crate by its name, in its tests, too.
#[cfg(test)]
extern crate self as nabiki;

pub mod body;
#[cfg(test)]
mod bust;
pub mod chance;
pub mod distance;
pub mod disturbance;
pub mod dynamics;
pub mod ellipsoid;
pub mod error;
pub mod field;
pub mod free_form;
pub mod hair;
pub mod head;
mod key;
pub mod locks;
pub mod mesh;
pub mod obstacle;
pub mod pose;
mod prefetch;
pub mod profile;
pub mod pseudo_force;
pub mod random;
mod scalar;
pub mod setting;
#[cfg(test)]
mod sketch;
pub mod smoothing;
pub mod solve;
pub mod strands;
pub mod subset;
mod vector;

pub use ellipsoid::Ellipsoid;
pub use error::SettingError;
/// The vectors of this crate's interface: of whichever of the versions that it allows the program has.
pub use glam;
pub use hair::Hair;
pub use head::Head;
pub use mesh::Mesh;
pub use pose::Pose;
pub use profile::Profile;
pub use strands::Strands;

/// What the method computes, by number. It is raised when the same scene moves otherwise than before, be it by a bit:
/// motion that was computed by another version is then known as such.
pub const METHOD_VERSION: u32 = 2;
