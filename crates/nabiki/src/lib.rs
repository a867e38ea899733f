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
//! [`Head::from_mesh`] and [`Strands::push`] take a head and hair of one's own, [`groom::grow`] grows some;
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
//! use nabiki::groom::{Growth, Style, grow};
//! use nabiki::roots::Hairline;
//! use nabiki::{Head, SettingError};
//!
//! fn main() -> Result<(), SettingError> {
//!     let head = Head::builtin();
//!     let (hairline, style) = (Hairline::default(), Style::default());
//!     let growth =
//!         Growth { hairline: &hairline, style: &style, strands: 2_000, segments: 18, segment_length: 1.0, seed: 1 };
//!     // The first 20 of the 2,000, which move as they do among all.
//!     let hair = grow(&head, &growth, 20)?;
//!     let mut dynamics = Dynamics::new(head.ellipsoid);
//!     dynamics.motion.inertia_length_floor = 18.0;
//!     let gust = KeyframedField::new(&[Keyframe { through: 50, vector: Vec3::new(-100.0, 0.0, 0.0) }])?;
//!     let mut timeline = Timeline::new(&hair.strands, &dynamics, Arc::new(gust), Vec::new(), 50)?;
//!     let film = timeline.play();
//!     let tip = |frame: u32| film.strand(frame, 0)[film.strand(frame, 0).len() - 1];
//!     assert!(tip(50).x < tip(0).x, "hair goes where the wind blows");
//!     Ok(())
//! }
//! ```

#![deny(unsafe_code)]

pub mod body;
pub mod distance;
pub mod disturbance;
pub mod dynamics;
pub mod ellipsoid;
pub mod error;
pub mod field;
pub mod free_form;
pub mod groom;
pub mod hair;
pub mod head;
pub mod mesh;
pub mod obstacle;
pub mod pose;
mod prefetch;
pub mod profile;
pub mod pseudo_force;
mod random;
pub mod roots;
mod scalar;
pub mod setting;
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
pub const METHOD_VERSION: u32 = 1;
