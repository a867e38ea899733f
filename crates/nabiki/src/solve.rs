//! Which wind makes the hair do this? Wishes about single strands in single frames, met by the wind that comes nearest.
//!
//! A [`Problem`] is hair with what moves it, [`Wish`]es of where some of its nodes should be, and the [`Unknown`]s that may
//! change for it. [`Solver`] finds them; [`Drag`] follows a wish that moves, a little each time it is asked. What is solved,
//! and what is differentiated how, is in docs/solve.md.

mod aims;
mod cut;
mod drag;
mod gusts;
mod keyed_wind;
mod linear;
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
