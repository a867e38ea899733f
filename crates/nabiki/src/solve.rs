//! Which wind makes the hair do this? The solver finds the wind that comes nearest to wishes for single strands in
//! single frames.
//!
//! A [`Problem`] has the hair, what moves it, the [`Wish`]es (where some of its nodes should be), and the [`Unknown`]s
//! that may change. [`Solver`] searches for them. [`Drag`] follows a moving wish, a little with each call.
//! docs/solve.md describes what is solved and how it is differentiated.

mod aims;
mod cut;
mod drag;
mod gusts;
mod keyed_wind;
mod linear;
mod more_wind;
mod problem;
mod report;
mod solver;
#[cfg(test)]
mod tests;
mod track;
mod unknowns;
mod wish;

pub use cut::{Cut, change, cut_for_pull, felt};
pub use drag::Drag;
pub use keyed_wind::{KeyedWind, OpenAir, Surroundings, with_interval};
pub use problem::{Prior, Problem};
pub use report::{Report, Step, WishLeft};
pub use solver::{Preroll, Search, Solver, Stop};
pub use unknowns::{Answer, Unknown};
pub use wish::{Goal, Node, Wish, nodes_near, nodes_of};
