//! Hair in the wind, after K. Anjyo, Y. Usami and T. Kurihara, "A computer animation method for hair dynamics
//! description" (Trans. IPSJ, 1993).
//!
//! # Spaces and units
//!
//! *Head space*: right-handed, y up, the face looks along +x, so +z is the character's right-hand side; the origin
//! lies within the skull (the centre of the head ellipsoid unless said otherwise). Lengths are centimetres, angles
//! radians, time is counted in frames. Forces are directions with a strength, not newtons: only their product with
//! the gain c_i of equation (8) moves hair.

#![forbid(unsafe_code)]

pub mod distance;
pub mod disturbance;
pub mod dynamics;
pub mod ellipsoid;
pub mod error;
pub mod field;
pub mod groom;
pub mod hair;
pub mod head;
pub mod mesh;
pub mod pose;
pub mod pseudo_force;
mod random;
pub mod roots;
pub mod strands;
pub mod subset;

pub use ellipsoid::Ellipsoid;
pub use error::SettingError;
pub use hair::Hair;
pub use head::Head;
pub use mesh::Mesh;
pub use pose::Pose;
pub use strands::Strands;

/// What the method computes, by number. It is raised when the same scene moves otherwise than before, be it by a bit:
/// motion that was computed by another version is then known as such.
pub const METHOD_VERSION: u32 = 1;
