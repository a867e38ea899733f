//! The paper's form of the motion: two angles per segment, equation (7).

mod angles;
mod force_source;
mod kernel;
mod packed;
mod polar;
mod reference;
mod rows;
mod runner;
mod surroundings;
mod turn;

pub(super) use polar::PolarAxis;
pub(super) use reference::{Common, Reference, Strand};
pub(super) use runner::Runner;
pub(super) use surroundings::{Force, Surroundings};
