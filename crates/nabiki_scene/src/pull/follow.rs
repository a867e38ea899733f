//! The search behind a pull, without a clock: quick steps while the mouse moves, the full search when it rests.
//!
//! Steps are computed for a few strands of the lock and the carriers around them, which takes a fraction of the time.
//! They are checked with the full lock among all hair. The difference between the two is added to the goal, so a few
//! checks bring the full lock there.

use std::ops::RangeInclusive;
use std::sync::Arc;
use std::thread::{Builder, JoinHandle};

use glam::Vec3;
use nabiki::SettingError;
use nabiki::field::Keyframe;
use nabiki::solve::{
    Cut, Goal, KeyedWind, Preroll, Prior, Problem, Search, Solver, Stop, Unknown, change, cut_for_pull, felt,
};

use super::few::few;
use super::{Lock, Pulled};
use crate::BuiltScene;

/// Weight of a nail relative to the lock in the hand.
const NAIL_WEIGHT: f32 = 2.0;
/// A step that leaves more than this share of the remaining distance gains nothing.
const WORTH: f64 = 0.98;
/// This near to the hand counts as arrived (cm).
const THERE_CM: f64 = 0.1;
/// At this distance, no other ways are searched (cm).
const NEAR_CM: f64 = 0.2;
/// A change of the wind by 100 counts as much as this distance (cm), because a strong wind throws all hair about. At a
/// wind this gentle, no gentler one is searched.
const ROUGH_CM: f64 = 0.015;
const GENTLE: f64 = 250.0;
/// The cost of a change of another interval's vector (cm).
const ANOTHER_CM: f64 = 0.05;
/// Farther from the hand than this, the reason is given (cm).
const SHORT_CM: f64 = 0.3;
/// Approximate lengths in frames of a pull's own interval: a moving hand begins with the first; the others are tried if
/// that does not arrive.
const LENGTHS: [u32; 3] = [12, 20, 7];
/// How often the full lock checks what was found for a few of its strands, before it searches itself.
const TRUSTED: usize = 3;
/// Most checks per try.
const ROUNDS: usize = 12;
/// Steps between two checks, and in a complete search.
const SHORT: usize = 5;
const LONG: usize = 30;
/// A few strands below this share of their earlier remaining distance are still on their way.
const ON_ITS_WAY: f64 = 0.8;
/// Starts of a search if none arrives from the current one.
const STARTS: usize = 4;

/// What may change for a pull.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Freedom {
    /// Another interval before the pull's.
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
    /// Once it has begun.
    solvers: Option<Solvers>,
}

/// The solvers that find a wind, and the one that checks it.
#[derive(Debug)]
struct Solvers {
    few: Solver,
    /// Once the whole hair is at the frame where a pull begins.
    whole: Option<Solver>,
    /// From the middle of the full lock to that of its few strands, in the last motion of both (cm).
    shift: Vec3,
}

/// Hair in the frame in which pulls begin, once it is computed.
enum Begin {
    Awaited(JoinHandle<Result<Preroll, SettingError>>),
    There(Box<Preroll>),
}

/// Asked between two motions: is there something more urgent?
type Brake = Arc<dyn Fn() -> bool + Send + Sync>;

/// Follows the mouse.
pub struct Follower {
    /// With the current wind.
    problem: Problem,
    /// The same for a few strands.
    of_few: Problem,
    /// The middle of the lock, and its goal (head space, cm).
    middle: Vec3,
    goal: Vec3,
    /// No try is felt before the frame after this one.
    from: u32,
    begin: Option<Begin>,
    few_begin: Option<Preroll>,
    tries: Vec<Try>,
    /// The try that has led nearest.
    at: usize,
    brake: Option<Brake>,
}

impl std::fmt::Debug for Follower {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Follower").field("tries", &self.tries.len()).field("at", &self.at).finish_non_exhaustive()
    }
}

impl Follower {
    /// Starts to pull a lock. Nails stay in place as well as possible. `middle` is the middle of the lock in the motion
    /// of the scene (head space, cm).
    pub fn new(built: &BuiltScene, held: &Lock, middle: Vec3, nails: &[Lock], freedom: Freedom) -> Self {
        let mut wishes = vec![held.wish(Goal::MeanMoved(Vec3::ZERO), 1.0)];
        wishes.extend(nails.iter().map(|nail| nail.wish(Goal::Stay, NAIL_WEIGHT)));
        let mut problem = built.problem(Vec::new(), wishes);
        problem.prior = Prior { keep: ROUGH_CM as f32, ..Prior::default() };
        // Two intervals in sequence, where one is not enough; one if there is no frame for two.
        let of_two = if freedom.another { &LENGTHS[..] } else { &LENGTHS[..1] };
        let two = of_two.iter().filter_map(|&length| two_intervals(&problem.wind, held.frame, length, freedom));
        let mut all: Vec<Try> = two.collect();
        if all.is_empty() || !freedom.another {
            let one = LENGTHS.map(|length| own_interval(&problem.wind, held.frame, length, freedom));
            all.splice(0..0, one);
        }
        let mut tries: Vec<Try> = Vec::new();
        for new in all {
            let known = |known: &Try| known.keyframes == new.keyframes && known.unknowns == new.unknowns;
            if !tries.iter().any(known) {
                tries.push(new);
            }
        }
        let from = tries.iter().map(|of| *of.felt.start()).min().unwrap_or(1).saturating_sub(1);
        let of_few = few(&problem);
        // With neighbours the preroll takes long: meanwhile the first steps are found for a few strands.
        let whole = Problem { unknowns: Vec::new(), ..problem.clone() };
        let new = move || Preroll::new(&whole, from);
        let begin = Builder::new().name("begin of a pull".to_owned()).spawn(new).ok().map(Begin::Awaited);
        Self { problem, of_few, middle, goal: middle, from, begin, few_begin: None, tries, at: 0, brake: None }
    }

    /// Whether another interval fits before that of a pull in this frame.
    pub fn has_room_for_another(built: &BuiltScene, frame: u32) -> bool {
        let wind =
            KeyedWind { keyframes: built.forces.intervals().to_vec(), ease: built.scene.field.wind.ease, gust: None };
        LENGTHS.into_iter().any(|length| two_intervals(&wind, frame, length, Freedom::default()).is_some())
    }

    /// Sets a brake: while it returns `true`, the search stops between two motions.
    pub fn set_brake(&mut self, brake: impl Fn() -> bool + Send + Sync + 'static) {
        self.brake = Some(Arc::new(brake));
    }

    /// Takes one quick step toward the goal (head space, cm), and returns whether it gained anything.
    ///
    /// # Errors
    /// Hair that cannot be moved, or a goal that is not finite.
    pub fn step(&mut self, goal: Vec3) -> Result<(Pulled, bool), SettingError> {
        self.goal = goal;
        let solvers = self.solvers(self.at, false)?;
        solvers.aim(goal)?;
        let before = solvers.judge().left_cm();
        solvers.few.step();
        solvers.compare();
        let gained = solvers.judge().left_cm() < WORTH * before;
        Ok((self.pulled(self.at), gained))
    }

    /// Runs the full search. `found` is called with every motion that is nearer than all before; a stronger wind counts
    /// as farther away. Returns the final result with the reason why it stops there, or `None` if the brake stopped it.
    ///
    /// # Errors
    /// As [`step`](Self::step).
    pub fn search(&mut self, goal: Vec3, found: &mut dyn FnMut(Pulled)) -> Result<Option<Pulled>, SettingError> {
        self.goal = goal;
        let first = self.at;
        let order = std::iter::once(first).chain((0..self.tries.len()).filter(|&i| i != first));
        let mut turns: Vec<(usize, usize)> = order.flat_map(|i| [(1, i), (STARTS, i)]).collect();
        // First each try from its current numbers; other starts, which take long, only if none arrives with a gentle
        // wind.
        turns.sort_by_key(|&(starts, _)| starts);
        let (mut best, mut nearest) = (f64::INFINITY, f64::INFINITY);
        for (turn, (starts, i)) in turns.into_iter().enumerate() {
            let iterations = if starts > 1 { LONG } else { SHORT };
            let limits = Search { iterations, starts, near_cm: 0.5 * THERE_CM, seed: 1 };
            let solvers = self.solvers(i, false)?;
            solvers.aim(goal)?;
            if turn == 0 {
                // A hand that is followed has this already.
                nearest = self.score(i);
            }
            let came = self.search_of(i, goal, &limits, &mut nearest, found)?;
            let left = self.solvers(i, came)?.judge().left_cm();
            let score = self.score(i);
            if score < best {
                (best, self.at) = (score, i);
            }
            if !came {
                return Ok(None);
            }
            if left <= NEAR_CM && self.change(i) <= GENTLE {
                break;
            }
        }
        let pulled = self.pulled(self.at);
        let stop = if pulled.left_cm > SHORT_CM { Some(self.stopped_by(goal, pulled.left_cm)?) } else { None };
        Ok(Some(Pulled { ended: true, stop, ..pulled }))
    }

    /// What keeps the hair from the hand: the reason of the nearest try, or of another one if that finds its interval too short.
    fn stopped_by(&mut self, goal: Vec3, left_cm: f64) -> Result<Stop, SettingError> {
        let at = self.at;
        let others = (0..self.tries.len()).filter(|&i| i != at);
        let mut nearest = None;
        for i in std::iter::once(at).chain(others) {
            let stop = self.solvers(i, true)?.few.stopped_by(0, goal, left_cm);
            if !matches!(stop, Stop::Unknowns { .. }) {
                return Ok(stop);
            }
            nearest.get_or_insert(stop);
        }
        Ok(nearest.expect("a try is the nearest"))
    }

    /// Searches by a try. Returns whether it ended without the brake; it is at its nearest motion either way.
    fn search_of(
        &mut self,
        i: usize,
        goal: Vec3,
        limits: &Search,
        nearest: &mut f64,
        found: &mut dyn FnMut(Pulled),
    ) -> Result<bool, SettingError> {
        let mut limits = *limits;
        let mut tell = |of: &Self| {
            let score = of.score(i);
            if score < *nearest {
                *nearest = score;
                found(of.pulled(i));
            }
        };
        let enough = limits.near_cm.hypot(ROUGH_CM * GENTLE / 100.0);
        let solvers = self.solvers(i, false)?;
        let known = solvers.whole.as_ref().map_or(f64::INFINITY, Solver::left_cm);
        let mut best = (solvers.few.numbers().to_vec(), known);
        let mut judged = 0;
        for _ in 0..ROUNDS {
            if judged == TRUSTED {
                break;
            }
            let solvers = self.solvers(i, false)?;
            solvers.aim(goal)?;
            let before = solvers.few.left_cm();
            let came = solvers.few.pursue(&limits, enough);
            let (left, was) = (solvers.few.left_cm(), solvers.shift);
            // Now the full lock must be ready to check; if the hand has moved on, it does not wait.
            let solvers = self.solvers(i, came)?;
            solvers.aim(goal)?;
            solvers.compare();
            let (left_of_all, shifted) = (solvers.judge().left_cm(), f64::from(solvers.shift.distance(was)));
            if left_of_all < best.1 {
                best = (solvers.few.numbers().to_vec(), left_of_all);
            }
            tell(self);
            if !came || best.1 <= THERE_CM {
                self.solvers(i, came)?.go(&best.0);
                return Ok(came);
            }
            limits.starts = 1;
            if left > THERE_CM && left < ON_ITS_WAY * before {
                continue;
            }
            // If the few do not arrive, and agree with the full lock, going on gains nothing.
            if left > THERE_CM && shifted < 0.2 * left || shifted < 0.1 * THERE_CM {
                break;
            }
            judged += 1;
        }
        self.solvers(i, true)?.go(&best.0);
        if judged < TRUSTED || best.1 <= NEAR_CM {
            return Ok(true);
        }
        // The few represent the lock too poorly here: the full lock searches itself.
        let limits = Search { iterations: LONG, ..limits };
        let came = self.solvers(i, true)?.search_whole(&limits, enough);
        tell(self);
        Ok(came)
    }

    /// The largest change of the wind by a try.
    fn change(&self, i: usize) -> f64 {
        let Try { felt, solvers: Some(solvers), .. } = &self.tries[i] else { return 0.0 };
        let (wind, frame) = (&self.problem.wind, self.problem.wishes[0].frame);
        let now = solvers.judge().answer().keyframes;
        change(&wind.keyframes, &now, wind.ease, *felt.start()..=frame).into()
    }

    /// The remaining distance of a try from the hand, including its cost (cm).
    fn score(&self, i: usize) -> f64 {
        let Try { unknowns, solvers, .. } = &self.tries[i];
        let left = solvers.as_ref().map_or(f64::INFINITY, |solvers| solvers.judge().left_cm());
        let others = unknowns.iter().filter(|unknown| matches!(unknown, Unknown::Vector(_))).count() - 1;
        left.max(NEAR_CM) + ROUGH_CM * self.change(i) / 100.0 + ANOTHER_CM * others as f64
    }

    /// The result of a try.
    fn pulled(&self, i: usize) -> Pulled {
        let Try { interval, felt, solvers, unknowns, .. } = &self.tries[i];
        let judge = solvers.as_ref().expect("a try that has begun").judge();
        let (answer, left_cm) = (judge.answer(), judge.left_of_wish(0));
        // Another stiffness is felt in all frames.
        let felt = if unknowns.contains(&Unknown::Stiffness) { 1..=u32::MAX } else { felt.clone() };
        Pulled { answer, interval: *interval, felt, goal: self.goal, left_cm, ended: false, stop: None }
    }

    /// The solvers of a try; that of the full lock, too, if it can begin by now or is waited for.
    fn solvers(&mut self, i: usize, wait: bool) -> Result<&mut Solvers, SettingError> {
        let Self { problem, of_few, begin, few_begin, tries, brake, from, middle, .. } = self;
        let Try { keyframes, unknowns, solvers, .. } = &mut tries[i];
        let solver = |problem: &Problem, begin: &Preroll| {
            let mut problem = problem.clone();
            (problem.wind.keyframes, problem.unknowns) = (keyframes.clone(), unknowns.clone());
            let mut solver = Solver::after(problem, Some(begin))?.by_differences();
            if let Some(brake) = brake.clone() {
                solver.set_brake(move || brake());
            }
            Ok::<_, SettingError>(solver)
        };
        let solvers = match solvers {
            Some(solvers) => solvers,
            None => {
                let begin = match few_begin {
                    Some(begin) => begin,
                    None => few_begin.insert(Preroll::new(of_few, *from)?),
                };
                let few = solver(of_few, begin)?;
                let shift = middle_of(&few) - *middle;
                solvers.insert(Solvers { few, whole: None, shift })
            }
        };
        let is_ready = !matches!(begin, Some(Begin::Awaited(thread)) if !thread.is_finished());
        if solvers.whole.is_none() && (wait || is_ready) {
            let there = match begin.take() {
                Some(Begin::There(there)) => there,
                Some(Begin::Awaited(thread)) => {
                    Box::new(thread.join().unwrap_or_else(|_| Preroll::new(problem, *from))?)
                }
                None => Box::new(Preroll::new(problem, *from)?),
            };
            solvers.whole = Some(solver(problem, &there)?);
            *begin = Some(Begin::There(there));
            solvers.compare();
        }
        Ok(solvers)
    }
}

impl Solvers {
    /// The goal of the middle of the full lock (head space, cm).
    fn aim(&mut self, goal: Vec3) -> Result<(), SettingError> {
        if let Some(whole) = &mut self.whole {
            whole.set_goal(0, Goal::MeanAt(goal))?;
        }
        self.few.set_goal(0, Goal::MeanAt(goal + self.shift))
    }

    /// The solver that knows best how near the lock is.
    fn judge(&self) -> &Solver {
        self.whole.as_ref().unwrap_or(&self.few)
    }

    /// Moves the full lock with the wind found for a few strands of it.
    fn compare(&mut self) {
        if let Some(whole) = &mut self.whole
            && whole.set_numbers(self.few.numbers())
        {
            self.shift = middle_of(&self.few) - middle_of(whole);
        }
    }

    /// The full lock searches itself, and the few follow. Returns whether it ended without the brake.
    fn search_whole(&mut self, limits: &Search, enough_cm: f64) -> bool {
        let Some(whole) = &mut self.whole else { return true };
        let came = whole.pursue(limits, enough_cm);
        if self.few.set_numbers(whole.numbers()) {
            self.shift = middle_of(&self.few) - middle_of(whole);
        }
        came
    }

    /// Goes to numbers that one of the two has reached before.
    fn go(&mut self, numbers: &[f64]) {
        if self.few.numbers() != numbers && self.few.set_numbers(numbers) {
            self.compare();
        }
    }
}

/// The middle of the lock in the current motion of a solver (head space, cm).
fn middle_of(solver: &Solver) -> Vec3 {
    let places = solver.places(0);
    places.iter().sum::<Vec3>() / places.len() as f32
}

/// A wind with an interval for the pull, whose vector may change.
fn own_interval(wind: &KeyedWind, frame: u32, length: u32, freedom: Freedom) -> Try {
    let Cut { keyframes, interval, felt } = cut_for_pull(&wind.keyframes, wind.ease, frame, length);
    Try { keyframes, unknowns: unknowns(&[interval], freedom), interval, felt, solvers: None }
}

/// The same with another interval before it that may change, too; `None` if there is no frame for it.
fn two_intervals(wind: &KeyedWind, frame: u32, length: u32, freedom: Freedom) -> Option<Try> {
    let own = cut_for_pull(&wind.keyframes, wind.ease, frame, length);
    let last = own.interval.checked_sub(1).map(|before| own.keyframes[before].through)?;
    let Cut { keyframes, interval: before, .. } = cut_for_pull(&own.keyframes, wind.ease, last, length);
    let interval = keyframes.iter().position(|key| key.through >= frame)?;
    if interval == before {
        return None;
    }
    let felt = felt(&wind.keyframes, &keyframes, wind.ease, &[before, interval]);
    Some(Try { keyframes, unknowns: unknowns(&[before, interval], freedom), interval, felt, solvers: None })
}

fn unknowns(intervals: &[usize], freedom: Freedom) -> Vec<Unknown> {
    let vectors = intervals.iter().map(|&interval| Unknown::Vector(interval));
    vectors.chain(freedom.stiffness.then_some(Unknown::Stiffness)).collect()
}
