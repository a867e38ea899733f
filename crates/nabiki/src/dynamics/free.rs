//! The free form of the motion: a chain of directions and increments, in head space.
//!
//! The equations, with the functions that hold them, are in docs/motion-forms.md. Read `reference/strand.rs` first.
//!
//! | file | holds |
//! |---|---|
//! | `segment.rs`, `head_frame.rs`, `grid.rs` | used by both twins: what moves a segment; what the head does in a frame; the grid of the carriers |
//! | `pulls.rs`, `pulls/` | one file for each force or moment, in f64 over any `Scalar` and for one lane |
//! | `reference.rs` | the f64 stepper: hair, carriers, frames |
//! | `reference/strand.rs` | one strand and its way through a frame |
//! | `reference/chain.rs` | the three systems of a step: torsion, tensions, increments |
//! | `reference/contact.rs` | a body in a step: it pushes a node before the solve, and turns a segment out after it |
//! | `kernel.rs`, `solve.rs` | the fast chain: the passes to and fro along sixteen strands, joints and turns in one, systems in the other |
//! | `frame.rs` | which passes a block takes in a frame, in which order |
//! | `passes.rs` | the passes that see surroundings: `Blown` once a frame, `Stepped` before the solve, `Go` after it |
//! | `contact.rs` | bodies for the fast step, and the numbers of contact that both twins use |
//! | `packed.rs`, `work.rs` | what no frame changes, in blocks; room for one block, kept by each thread |
//! | `runner.rs` | hair and carriers through the frames; saved states |
//! | `aimed.rs` | the aims that lead the strands of a block |
//! | `own.rs` | what each strand makes of the wind, by its lock |
//!
//! Carriers are packed apart from the hair that is shown. Both read the grid of the frame before while the carriers
//! fill the next one. Where many frames are asked for, the carriers go through all of them first.

mod aimed;
mod along;
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
mod ride_row;
mod rotate;
mod runner;
mod segment;
mod solve;
mod work;

use contact::{ANSWER, FAN, NEAR, PUSHES, ROUNDS, TOLERANCE_CM, TURN};
pub(super) use grid::Crowd;
pub(super) use head_frame::{HeadFrame, HeadWay};
pub(super) use pulls::pulls;
pub(super) use reference::{Common, Reference, Springs, Strand};
pub(super) use runner::Runner;
pub(super) use segment::shapes;
pub use segment::substeps;
