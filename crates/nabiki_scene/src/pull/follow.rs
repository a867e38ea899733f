//! The wind that follows a hand, without a clock: quick steps while it moves, the whole search where it rests.

use std::ops::RangeInclusive;
use std::sync::Arc;

use glam::Vec3;
use nabiki::SettingError;
use nabiki::field::Keyframe;
use nabiki::solve::{Cut, Drag, Goal, Problem, Search, Solver, Unknown, Wind, cut_for_pull, felt};

use super::{Lock, Pulled};
use crate::BuiltScene;

/// How much a nail counts beside the lock in the hand.
const NAIL_WEIGHT: f32 = 2.0;
/// A quick step that leaves more than this part of what was left gains nothing.
const WORTH: f64 = 0.98;
/// So near to the hand is there (cm).
pub const THERE_CM: f64 = 0.1;
/// What is farther from the hand is told why (cm).
const SHORT_CM: f64 = 0.3;
/// About how many frames long the interval is that a pull has for its own: the first is what a hand that moves begins with, the others
/// are tried where that does not arrive.
const LENGTHS: [u32; 3] = [12, 20, 7];

/// What may change for a pull.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Freedom {
    /// One interval more, before the pull's own.
    pub another: bool,
    /// The stiffness of the hair.
    pub stiffness: bool,
}

/// One choice of what may change.
#[derive(Debug)]
struct Try {
    keyframes: Vec<Keyframe>,
    unknowns: Vec<Unknown>,
    interval: usize,
    felt: RangeInclusive<u32>,
    drag: Option<Drag>,
}

/// Asked between two motions: is there something more urgent?
type Brake = Arc<dyn Fn() -> bool + Send + Sync>;

/// Follows a hand.
pub struct Follower {
    /// With the wind as it is.
    problem: Problem,
    tries: Vec<Try>,
    /// The one that has led nearest.
    at: usize,
    limits: Search,
    brake: Option<Brake>,
}

impl std::fmt::Debug for Follower {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Follower").field("tries", &self.tries.len()).field("at", &self.at).finish_non_exhaustive()
    }
}

impl Follower {
    /// Takes hold of a lock, while nails stay where they are as well as they can.
    pub fn new(built: &BuiltScene, held: &Lock, nails: &[Lock], freedom: Freedom) -> Self {
        let mut wishes = vec![held.wish(Goal::MeanMoved(Vec3::ZERO), 1.0)];
        wishes.extend(nails.iter().map(|nail| nail.wish(Goal::Stay, NAIL_WEIGHT)));
        let problem = built.problem(Vec::new(), wishes);
        let mut tries: Vec<Try> = Vec::new();
        let mut add = |new: Try| {
            let known = |known: &Try| known.keyframes == new.keyframes && known.unknowns == new.unknowns;
            if !tries.iter().any(known) {
                tries.push(new);
            }
        };
        for (i, length) in LENGTHS.into_iter().enumerate() {
            let one = own_interval(&problem.wind, held.frame, length, freedom);
            // Two, one after the other, where one does not do; one where there is no frame for two.
            let two = (i == 0 || freedom.another).then(|| two_intervals(&problem.wind, held.frame, length, freedom));
            match two.flatten() {
                Some(two) if freedom.another => add(two),
                Some(two) => [one, two].into_iter().for_each(&mut add),
                None => add(one),
            }
        }
        let limits = Search { iterations: 30, starts: 4, near_cm: THERE_CM, seed: 1 };
        Self { problem, tries, at: 0, limits, brake: None }
    }

    /// Gives way to something more urgent between any two motions, while the answer to this is yes.
    pub fn set_brake(&mut self, brake: impl Fn() -> bool + Send + Sync + 'static) {
        self.brake = Some(Arc::new(brake));
    }

    /// One quick step toward where the lock should be (head space, cm), and whether it gained anything.
    ///
    /// # Errors
    /// Hair that cannot be moved, and places that are no numbers.
    pub fn step(&mut self, goal: Vec3) -> Result<(Pulled, bool), SettingError> {
        let step = self.drag(self.at)?.0.pull(0, Goal::MeanAt(goal))?;
        Ok((self.pulled(self.at)?, step.after_cm < WORTH * step.before_cm))
    }

    /// The whole search; `found` hears of every motion that is nearer than all before. What it has come to in the end, and what stops it
    /// there; none where the brake was pulled.
    ///
    /// # Errors
    /// As [`step`](Self::step).
    pub fn search(&mut self, goal: Vec3, found: &mut dyn FnMut(Pulled)) -> Result<Option<Pulled>, SettingError> {
        let first = self.at;
        let order = std::iter::once(first).chain((0..self.tries.len()).filter(|&i| i != first));
        let mut best = f64::INFINITY;
        for i in order.collect::<Vec<_>>() {
            let limits = self.limits;
            let (drag, interval, felt) = self.drag(i)?;
            // A hand that is followed has this already.
            let mut nearest = if i == first { drag.solver().left_of_wish(0) } else { best };
            let mut tell = |solver: &Solver| {
                let left_cm = solver.left_of_wish(0);
                if left_cm < nearest {
                    nearest = left_cm;
                    let (answer, felt) = (solver.answer(), felt.clone());
                    found(Pulled { answer, interval, felt, left_cm, ended: false, stop: None });
                }
            };
            let whole = drag.search(0, Goal::MeanAt(goal), &limits, &mut tell)?;
            let left = drag.solver().left_of_wish(0);
            if left < best {
                (best, self.at) = (left, i);
            }
            if !whole {
                return Ok(None);
            }
            if best <= SHORT_CM.min(2.0 * THERE_CM) {
                break;
            }
        }
        let stop = self.drag(self.at)?.0.stopped_by(0, SHORT_CM);
        Ok(Some(Pulled { ended: true, stop, ..self.pulled(self.at)? }))
    }

    fn pulled(&mut self, i: usize) -> Result<Pulled, SettingError> {
        let (drag, interval, felt) = self.drag(i)?;
        let (answer, left_cm) = (drag.answer(), drag.solver().left_of_wish(0));
        Ok(Pulled { answer, interval, felt, left_cm, ended: false, stop: None })
    }

    /// The drag of a try, the interval that it has for its own, and the frames that feel it.
    fn drag(&mut self, i: usize) -> Result<(&mut Drag, usize, RangeInclusive<u32>), SettingError> {
        let Try { keyframes, unknowns, interval, felt, drag } = &mut self.tries[i];
        let drag = match drag {
            Some(drag) => drag,
            None => {
                let mut problem = self.problem.clone();
                problem.wind.keyframes = keyframes.clone();
                problem.unknowns = unknowns.clone();
                let mut new = Drag::new(problem)?;
                if let Some(brake) = self.brake.clone() {
                    new.set_brake(move || brake());
                }
                drag.insert(new)
            }
        };
        Ok((drag, *interval, felt.clone()))
    }
}

/// A wind with an interval for the pull, whose vector is free.
fn own_interval(wind: &Wind, frame: u32, length: u32, freedom: Freedom) -> Try {
    let Cut { keyframes, interval, felt } = cut_for_pull(&wind.keyframes, wind.ease, frame, length);
    Try { keyframes, unknowns: unknowns(&[interval], freedom), interval, felt, drag: None }
}

/// The same with another interval before it, that is free, too; none where there is no frame for it.
fn two_intervals(wind: &Wind, frame: u32, length: u32, freedom: Freedom) -> Option<Try> {
    let own = cut_for_pull(&wind.keyframes, wind.ease, frame, length);
    let last = own.interval.checked_sub(1).map(|before| own.keyframes[before].through)?;
    let Cut { keyframes, interval: before, .. } = cut_for_pull(&own.keyframes, wind.ease, last, length);
    let interval = keyframes.iter().position(|key| key.through >= frame)?;
    if interval == before {
        return None;
    }
    let felt = felt(&wind.keyframes, &keyframes, wind.ease, &[before, interval]);
    Some(Try { keyframes, unknowns: unknowns(&[before, interval], freedom), interval, felt, drag: None })
}

fn unknowns(intervals: &[usize], freedom: Freedom) -> Vec<Unknown> {
    let vectors = intervals.iter().map(|&interval| Unknown::Vector(interval));
    vectors.chain(freedom.stiffness.then_some(Unknown::Stiffness)).collect()
}
