//! Follows a moving wish, such as a mouse that pulls hair.

use glam::Vec3;

use super::problem::Problem;
use super::report::Step;
use super::solver::Solver;
use super::unknowns::Answer;
use super::wish::Goal;
use crate::error::SettingError;

/// Follows a moving wish: a few steps with each call, starting where the last call ended.
#[derive(Debug)]
pub struct Drag {
    solver: Solver,
}

impl Drag {
    /// Starts a drag. The wishes of the problem are the lock that is held and the nails.
    ///
    /// # Errors
    /// As for [`Solver::new`].
    pub fn new(problem: Problem) -> Result<Self, SettingError> {
        Ok(Self { solver: Solver::new(problem)? })
    }

    /// Sets a new goal for a wish and takes a few steps toward it.
    ///
    /// # Errors
    /// As for [`Solver::set_goal`].
    pub fn pull(&mut self, wish: usize, goal: Goal) -> Result<Step, SettingError> {
        self.solver.set_goal(wish, goal)?;
        Ok(self.solver.step())
    }

    /// The current positions of a wish's nodes (head space, cm).
    pub fn places(&self, wish: usize) -> Vec<Vec3> {
        self.solver.places(wish)
    }

    /// The current settings.
    pub fn answer(&self) -> Answer {
        self.solver.answer()
    }

    /// The underlying solver.
    pub fn solver(&self) -> &Solver {
        &self.solver
    }

    /// The underlying solver, to continue from here.
    pub fn into_solver(self) -> Solver {
        self.solver
    }
}
