//! The results of a search.

use super::unknowns::Answer;

/// The result of one step. Distances are the weighted root mean square of the remaining distances of all wishes (cm).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Step {
    /// Before the step.
    pub before_cm: f64,
    /// After the step. The same as before if no better step was found.
    pub after_cm: f64,
}

/// The remaining distance of one wish: the root mean square distance of its nodes, or the distance of their mean, from
/// the goal (cm).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WishLeft {
    /// Before the search.
    pub before_cm: f64,
    /// After the search.
    pub after_cm: f64,
}

/// The result of a search.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Report {
    /// The settings, rounded as in a scene file. All distances here are for the motion with these rounded settings.
    pub answer: Answer,
    /// Weighted root mean square over the wishes before the search (cm).
    pub before_cm: f64,
    /// The same after the search (cm).
    pub after_cm: f64,
    /// The remaining distances of each wish, in order.
    pub wishes: Vec<WishLeft>,
    /// Number of steps, from all starts.
    pub iterations: usize,
    /// Number of starts.
    pub starts: usize,
    /// Number of motions computed, with or without derivatives.
    pub runs: usize,
}
