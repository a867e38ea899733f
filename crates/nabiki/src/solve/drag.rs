//! A wish that moves, as under a hand.

use glam::Vec3;

use super::problem::Problem;
use super::report::Step;
use super::solver::Solver;
use super::unknowns::Answer;
use super::wish::Goal;
use crate::error::SettingError;

/// Follows a wish that moves: one or a few steps a call, from where the last call ended.
#[derive(Debug)]
pub struct Drag {
    solver: Solver,
}

impl Drag {
    /// Takes hold: the problem's wishes are the lock that is held and the nails.
    ///
    /// # Errors
    /// As [`Solver::new`].
    pub fn new(problem: Problem) -> Result<Self, SettingError> {
        Ok(Self { solver: Solver::new(problem)? })
    }

    /// Pulls: a wish has a new goal, and the wind follows it by a step or two.
    ///
    /// # Errors
    /// As [`Solver::set_goal`].
    pub fn pull(&mut self, wish: usize, goal: Goal) -> Result<Step, SettingError> {
        self.solver.set_goal(wish, goal)?;
        Ok(self.solver.step())
    }

    /// Where the nodes of a wish are now (head space, cm): the hair's end of the thread from the hand.
    pub fn places(&self, wish: usize) -> Vec<Vec3> {
        self.solver.places(wish)
    }

    /// The settings as they are now.
    pub fn answer(&self) -> Answer {
        self.solver.answer()
    }

    /// The search behind it.
    pub fn solver(&self) -> &Solver {
        &self.solver
    }

    /// The search behind it, to go on from here.
    pub fn into_solver(self) -> Solver {
        self.solver
    }
}
