//! What came of it.

use super::unknowns::Answer;

/// One step of the solver. Distances are the root mean square over wishes, by weight, of what is left of each (cm).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Step {
    /// Before it.
    pub before_cm: f64,
    /// After it; the same where none was found that leads nearer.
    pub after_cm: f64,
}

/// What is left of one wish: the root mean square distance of its nodes, or of their mean, from where they should be (cm).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WishLeft {
    /// Before anything was solved.
    pub before_cm: f64,
    /// In the motion of the answer.
    pub after_cm: f64,
}

/// What a search found.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Report {
    /// The settings, rounded as a scene file holds them. All distances here are of the motion that they make.
    pub answer: Answer,
    /// Root mean square over wishes by weight, before (cm).
    pub before_cm: f64,
    /// The same after (cm).
    pub after_cm: f64,
    /// Of each wish, in order.
    pub wishes: Vec<WishLeft>,
    /// Steps from the start that led to the answer, and from all others.
    pub iterations: usize,
    /// Starts tried.
    pub starts: usize,
    /// Motions computed, with tangents or without.
    pub runs: usize,
}
