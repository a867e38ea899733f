//! The paper's form of the motion: two angles a segment, equation (7).

mod angles;
mod kernel;
mod packed;
mod polar;
mod reference;
mod runner;
mod turn;
mod wind;

pub(super) use polar::PolarAxis;
pub(super) use reference::{Reference, Setting, Strand};
pub(super) use runner::Runner;
pub(super) use wind::{Force, Surroundings};
