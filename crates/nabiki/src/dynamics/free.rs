//! The free form of the motion: a chain of directions and increments, in head space.
//!
//! The equations, with the functions that hold them, are in docs/motion-forms.md.

mod contact;
mod frame;
mod grid;
mod head_frame;
mod kernel;
mod own;
mod packed;
mod passes;
mod pulls;
mod reference;
mod rotate;
mod runner;
mod segment;
mod work;

use contact::{ANSWER, FAN, NEAR, PUSHES, ROUNDS, TOLERANCE_CM, TURN};
pub(super) use grid::Crowd;
pub(super) use pulls::pulls;
pub(super) use reference::{Common, Reference, Springs, Strand};
pub(super) use runner::Runner;
pub(super) use segment::shapes;
pub use segment::substeps;
