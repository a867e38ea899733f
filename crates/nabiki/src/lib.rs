//! Hair in the wind, after K. Anjyo, Y. Usami and T. Kurihara, "A computer animation method for hair dynamics
//! description" (Trans. IPSJ, 1993).
//!
//! # Spaces and units
//!
//! *Head space* is right-handed with y up. The face looks along +x, so +z is the character's right. The origin lies
//! within the skull: at the centre of the head ellipsoid, unless documented otherwise. Lengths are in centimetres,
//! angles in radians and times in frames. Forces have a direction and a strength, but no physical unit. Only their
//! product with the gain c_i of equation (8) moves hair.
//!
//! # Words
//!
//! | word | meaning |
//! |---|---|
//! | strand, segment, root, tip | a polyline of hair; one straight piece of it; its end on the skin; its free end |
//! | joint, node | where two segments meet, the first one at the root; the end of a segment |
//! | groom | hair at rest with its attributes |
//! | guide | one of the first 256 strands of the farthest-first order, see [`subset`] |
//! | clump, lock | neighbouring strands gathered toward one line; a clump as it moves, see [`locks`] |
//! | F | the unit of force: a direction with a strength, without a physical unit |
//! | field, keyframe | a force at every point and frame; a vector and the last frame that feels it |
//! | form | the equations that move hair: the paper's or the free form's |
//! | gain c | what turns a force into an increment of angle, equation (8); the paper's form |
//! | push A | the acceleration of a node under a force of 1; the free form |
//! | E, C, `shell` | the head ellipsoid; E times `shell`, in which the pseudo-force may act |
//! | polar axis | the axis of the angle theta: the vertical of frame 0, carried by the head |
//! | inertia length floor | shorter hair has the inertia of hair of this length |
//! | settle, drag | frames in which a swing falls to 1/e; how far a moving head leaves hair behind |
//! | substep | one of the steps that the free form divides a frame into |
//! | skin, place | a mesh that carries roots and may deform; where on it a root belongs, see [`skin`] |
//! | body, clearance | what hair does not enter; how far a node is kept from its skin |
//! | gap | a lower bound of a node's distance to the nearest body, which saves asking |
//! | fold | a place that a ball of 3 cm does not reach, as behind an ear; filled where hair touches the head |
//! | carrier | a strand that leaves density and velocity in the grid that its neighbours feel |
//! | wish, nail | what should be where in a frame; what should stay, see [`solve`] |
//! | unknown | what may change to meet a wish |
//! | twin | one of the two steppers of a form: the readable f64 one and the fast one |
//!
//! # Where to start
//!
//! [`Head::from_mesh`] and [`Strands::push`] take your own head and hair; the crate `nabiki_groom` grows hair.
//! [`Simulation`](dynamics::Simulation) moves it one frame at a time, as an engine needs it
//! (`crates/nabiki/examples/engine.rs`). [`Timeline`](dynamics::Timeline) computes all frames, as an editor needs them.
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

pub mod aim;
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
mod nearest;
pub mod obstacle;
pub mod pose;
mod prefetch;
pub mod profile;
pub mod pseudo_force;
pub mod random;
pub mod region;
mod scalar;
pub mod setting;
#[cfg(test)]
mod sketch;
pub mod skin;
pub mod smoothing;
pub mod solve;
pub mod strands;
pub mod subset;
mod vector;

pub use ellipsoid::Ellipsoid;
pub use error::SettingError;
/// The vector types in this crate's interface, in the version of `glam` that your program resolves.
pub use glam;
pub use hair::Hair;
pub use head::Head;
pub use mesh::Mesh;
pub use pose::Pose;
pub use profile::Profile;
pub use skin::Skin;
pub use strands::Strands;

/// Version of the computed motion. It increases whenever the same scene moves differently, even by one bit. Caches and
/// saved states store it, so motion of another version is recognised.
pub const METHOD_VERSION: u32 = 4;
