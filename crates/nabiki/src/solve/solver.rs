//! The search: the Levenberg-Marquardt method with derivatives from the specification. The fast stepper judges the
//! steps.

mod preroll;
mod search;
mod slopes;
mod stop;

use std::sync::Arc;

use glam::{DVec3, Vec3};

use super::aims::{Aims, check_goal};
use super::gusts::Gusts;
use super::linear::Normal;
use super::problem::Problem;
use super::report::Step;
use super::unknowns::{Answer, Guess, Layout, Unknown};
use super::wish::Goal;
use crate::dynamics::{Dynamics, Form, Stability, Standing, Timeline};
use crate::error::SettingError;
use crate::field::{Field, FieldSum, Keyframe, KeyframedField};
use crate::profile::Profile;
use crate::strands::{Strands, length};

pub use preroll::Preroll;
pub use search::Search;
pub use stop::Stop;

/// A problem with the best settings found so far.
#[derive(Debug)]
pub struct Solver {
    problem: Problem,
    layout: Layout,
    aims: Aims,
    gusts: Gusts,
    /// The effect of a wind of 1 along each axis.
    of_wind: [Arc<dyn Field>; 3],
    /// The strands in wishes, with their numbers.
    strands: Strands,
    ids: Vec<u32>,
    /// Their state at the last frame before any unknown is felt, where each motion begins.
    begin: Timeline,
    /// The same hair, being moved.
    run: Timeline,
    /// The same for the specification, once it is needed.
    standing: Option<Standing>,
    /// Positions of the spots observed up to that frame.
    early: Vec<DVec3>,
    /// Distance of each spot from its root along the strand (cm).
    reaches: Vec<f64>,
    /// Whether [most of the strands](Aims::usual) judge steps.
    by_most: bool,
    /// The field limit for all hair of the problem, with the current settings.
    steady: Stability,
    frames: Vec<u32>,
    large: Vec<f64>,
    /// The values of the problem, from which changes are measured.
    start: Vec<f64>,
    at: Place,
    before_cm: f64,
    left_before: Vec<f64>,
    damping: Damping,
    /// The largest step, in large changes: it grows while tangents are right that far.
    reach: f64,
    /// Whether tangents are differences between motions.
    by_differences: bool,
    /// Numbers that are fixed.
    held: Vec<usize>,
    /// Ends a search after the current motion.
    brake: Option<Brake>,
    /// Whether a step was refused since the search began because the force was too strong to step the hair.
    too_strong: bool,
    runs: usize,
    iterations: usize,
}

/// Settings, and their motion.
#[derive(Clone, Debug)]
struct Place {
    x: Vec<f64>,
    /// For the spots.
    places: Vec<DVec3>,
    /// Mean square of the remaining distances and preferences (cm^2).
    cost: f64,
}

/// Asked between two motions: is there something more urgent?
#[derive(Clone)]
struct Brake(Arc<dyn Fn() -> bool + Send + Sync>);

impl std::fmt::Debug for Brake {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str("Brake")
    }
}

/// The initial damping of each step, and its growth when steps fail.
#[derive(Clone, Copy, Debug)]
struct Damping {
    amount: f64,
    growth: f64,
}

impl Default for Damping {
    fn default() -> Self {
        Self { amount: 1e-3, growth: 2.0 }
    }
}

/// Trials per step, each with more damping than the one before: by factors of 2, 4, 8, ..., so that the last step is almost 0.
const TRIALS: usize = 8;

/// Limit of a step, in large changes.
const FARTHEST: f64 = 32.0;

/// Smallest damping.
const LEAST: f64 = 1e-6;

impl Solver {
    /// A solver at the settings of the problem.
    ///
    /// # Errors
    /// Wishes or unknowns that refer to something that does not exist, invalid weights, no wishes, no unknowns; and as
    /// for [`Timeline::new`](crate::dynamics::Timeline::new).
    pub fn new(problem: Problem) -> Result<Self, SettingError> {
        Self::after(problem, None)
    }

    /// Like [`new`](Self::new), starting from a known state of the hair. `preroll` must have the same hair, dynamics
    /// and wishes, and the same wind up to its frame.
    ///
    /// # Errors
    /// As for [`new`](Self::new).
    pub fn after(problem: Problem, preroll: Option<&Preroll>) -> Result<Self, SettingError> {
        let Problem { hair, dynamics, wind, surroundings, .. } = &problem;
        let layout = Layout::new(&problem.unknowns, wind, dynamics)?;
        problem.prior.check()?;
        let mut aims = Aims::new(&problem)?;
        let frames = aims.frames();
        let last = frames.last().copied().unwrap_or(1);
        let rate = dynamics.motion.frame_rate;
        let gusts = Gusts::new(wind.gust.as_ref(), rate, dynamics.motion.frames)?;
        let unit = |vector: Vec3| {
            let keyframes = [Keyframe { through: 1, vector }];
            surroundings.of_wind(Arc::new(KeyframedField::new(&keyframes)?))
        };
        let of_wind = [unit(Vec3::X)?, unit(Vec3::Y)?, unit(Vec3::Z)?];
        let steady = Stability::of(hair, dynamics)?;
        let until = (layout.first_felt(wind)? - 1).min(last);
        let Preroll { timeline: begin, early, strands, ids } =
            Preroll::onward(&problem, &aims, &steady, preroll, until)?;
        let start = layout.start(wind);
        let reaches = aims.spots.iter().map(|spot| f64::from(length(&strands.strand(spot.strand)[..=spot.node])));
        let reaches = reaches.collect();
        aims.set_now(&vec![DVec3::ZERO; aims.spots.len()], &problem.wishes);
        let large = layout.large();
        let at = Place { x: start.clone(), places: Vec::new(), cost: f64::INFINITY };
        let mut solver = Self {
            layout,
            aims,
            gusts,
            of_wind,
            strands,
            ids,
            run: begin.clone(),
            begin,
            standing: None,
            early,
            reaches,
            by_most: false,
            steady,
            frames,
            large,
            start,
            at,
            before_cm: 0.0,
            left_before: Vec::new(),
            damping: Damping::default(),
            reach: 1.0,
            by_differences: false,
            held: Vec::new(),
            brake: None,
            too_strong: false,
            runs: 0,
            iterations: 0,
            problem,
        };
        let places = solver.gone_on(None)?;
        solver.aims.set_now(&places, &solver.problem.wishes);
        solver.at.places = places;
        solver.restart();
        Ok(solver)
    }

    /// Uses differences between motions of the fast stepper as derivatives, instead of those of the specification. This
    /// is faster for a few unknowns. It is also correct with neighbour forces, where the other derivatives hold the
    /// carriers constant. If stiffness or settling may change, the specification is used nevertheless, since such
    /// motions must start at rest.
    #[must_use]
    pub fn by_differences(mut self) -> Self {
        let answers = [Unknown::Stiffness, Unknown::Settle];
        self.by_differences = !answers.iter().any(|answer| self.problem.unknowns.contains(answer));
        self
    }

    /// Measures changes from the current values.
    fn restart(&mut self) {
        self.at.cost = self.cost(&self.at.x, &self.at.places);
        self.before_cm = self.left_cm();
        self.left_before = self.aims.left(&self.at.places);
        self.damping = Damping::default();
    }

    /// Weighted root mean square of the remaining distances of all wishes (cm).
    pub fn left_cm(&self) -> f64 {
        self.aims.mean_square(&self.at.places).sqrt()
    }

    /// The remaining distance of one wish (cm): root mean square over its nodes, or the distance of their mean.
    pub fn left_of_wish(&self, wish: usize) -> f64 {
        self.aims.left(&self.at.places)[wish]
    }

    /// The current positions of a wish's nodes (head space, cm).
    pub fn places(&self, wish: usize) -> Vec<Vec3> {
        self.aims.places(wish, &self.at.places)
    }

    /// Sets another goal for a wish. Goals relative to "now" still refer to the motion of the problem.
    ///
    /// # Errors
    /// If the number of places is not the number of nodes, or a place is not finite.
    pub fn set_goal(&mut self, wish: usize, goal: Goal) -> Result<(), SettingError> {
        let given = &mut self.problem.wishes[wish];
        check_goal(&goal, given.nodes.len(), wish)?;
        given.goal = goal;
        self.aims.set_goal(wish, &given.goal);
        self.at.cost = self.cost(&self.at.x, &self.at.places);
        Ok(())
    }

    /// Takes one damped step. A simulation checks it: it is taken only if it leads nearer.
    pub fn step(&mut self) -> Step {
        let before_cm = self.left_cm();
        self.descend_once();
        Step { before_cm, after_cm: self.left_cm() }
    }

    /// The current values of the unknowns, in the order of the problem.
    pub fn numbers(&self) -> &[f64] {
        &self.at.x
    }

    /// Goes to the values of another solver with the same unknowns. If the hair cannot be stepped there, it returns
    /// `false` and changes nothing.
    pub fn set_numbers(&mut self, numbers: &[f64]) -> bool {
        debug_assert_eq!(numbers.len(), self.layout.numbers);
        let place = self.place(numbers.to_vec());
        place.map(|place| self.at = place).is_some()
    }

    /// The current settings.
    pub fn answer(&self) -> Answer {
        let Problem { wind, dynamics, .. } = &self.problem;
        self.layout.guess(wind, &self.at.x).rounded(wind, dynamics)
    }

    /// Whether there is something more urgent than to go on.
    fn is_braked(&self) -> bool {
        self.brake.as_ref().is_some_and(|brake| (brake.0)())
    }

    /// Takes one step of the method and returns whether it led nearer.
    fn descend_once(&mut self) -> bool {
        self.iterations += 1;
        // If the constant parts mislead, as among swirls, full differences may lead on.
        self.descend_with(true) || self.by_differences && !self.is_braked() && self.descend_with(false)
    }

    /// `held`: whether what is not linear in the wind counts as constant for derivatives.
    fn descend_with(&mut self, held: bool) -> bool {
        let usual = self.by_most.then(|| self.aims.usual(&self.at.places));
        let Ok(normal) = self.normal(held, usual.as_deref()) else { return false };
        let here = self.judged(&self.at, usual.as_deref());
        // Numbers that hardly matter are damped as if they mattered a little, so that they stay.
        let most = (0..normal.n).map(|i| normal.diagonal(i) * self.large[i].powi(2)).fold(0.0, f64::max);
        for _ in 0..TRIALS {
            if self.is_braked() {
                return false;
            }
            let amount = self.damping.amount;
            let damping: Vec<f64> = (0..normal.n)
                .map(|i| amount * (normal.diagonal(i) + 1e-3 * most / self.large[i].powi(2)).max(f64::MIN_POSITIVE))
                .collect();
            if let Some(mut step) = normal.solved(&damping) {
                let length = step.iter().zip(&self.large).map(|(d, large)| (d / large).abs()).fold(0.0, f64::max);
                let shorter = (self.reach / length).min(1.0);
                step.iter_mut().for_each(|d| *d *= shorter);
                let expected = normal.expected(&step);
                if let Some(next) = self.tried(&step) {
                    let there = self.judged(&next, usual.as_deref());
                    let gained = (here - there) / expected.max(f64::MIN_POSITIVE);
                    if there < here {
                        self.at = next;
                        // Tangents were right up to the limit: the next step may go farther.
                        if shorter < 1.0 && gained > 0.5 {
                            self.reach = (2.0 * self.reach).min(FARTHEST);
                        }
                        let factor = (1.0 - (2.0 * gained.min(1.0) - 1.0).powi(3)).max(1.0 / 3.0);
                        self.damping = Damping { amount: (amount * factor).max(LEAST), growth: 2.0 };
                        return true;
                    }
                }
            }
            self.reach = (0.5 * self.reach).max(1.0);
            self.damping.amount = (amount * self.damping.growth).min(1e9);
            self.damping.growth *= 2.0;
        }
        false
    }

    /// The measure of a step: the cost, or that of [most strands](Aims::usual).
    fn judged(&self, place: &Place, usual: Option<&[f64]>) -> f64 {
        let Some(usual) = usual else { return place.cost };
        place.cost - self.aims.mean_square(&place.places) + self.aims.mean_square_of_most(&place.places, usual)
    }

    /// The result of a step; `None` if the hair cannot be stepped there.
    fn tried(&mut self, step: &[f64]) -> Option<Place> {
        let mut x: Vec<f64> = self.at.x.iter().zip(step).map(|(x, d)| x + d).collect();
        self.layout.keep_in_range(&self.problem.wind, &mut x);
        self.place(x)
    }

    /// Some settings with their motion.
    fn place(&mut self, x: Vec<f64>) -> Option<Place> {
        let guess = self.layout.guess(&self.problem.wind, &x);
        let wind = Arc::new(self.gusts.table(&guess));
        let dynamics = self.dynamics(&guess);
        let places = self.simulated(wind, dynamics).ok()?;
        let cost = self.cost(&x, &places);
        cost.is_finite().then_some(Place { x, places, cost })
    }

    /// The hair's settings under a guess; `None` if they are those of the problem.
    fn dynamics(&self, guess: &Guess) -> Option<Dynamics> {
        let mut dynamics = self.problem.dynamics.clone();
        let Form::Free(free) = &mut dynamics.form else { return None };
        let mut changed = false;
        for (unknown, profile, factor) in [
            (Unknown::Stiffness, &mut free.form.stiffness, guess.stiffness),
            (Unknown::Settle, &mut free.form.settle, guess.settle),
        ] {
            if self.problem.unknowns.contains(&unknown) {
                changed = true;
                let values = match profile {
                    Profile::Even(value) => std::slice::from_mut(value),
                    Profile::RootToTip(values) => &mut values[..],
                };
                values.iter_mut().for_each(|value| *value = (f64::from(*value) * factor) as f32);
            }
        }
        changed.then_some(dynamics)
    }

    /// The spots under this wind. `dynamics`: the hair's settings, if they differ from before.
    fn simulated(&mut self, wind: Arc<dyn Field>, dynamics: Option<Dynamics>) -> Result<Vec<DVec3>, SettingError> {
        let field = self.problem.surroundings.field(wind)?;
        if let Some(dynamics) = dynamics {
            // The new settings might be unstable under the old field, and the reverse.
            self.begin.set_field(Arc::new(FieldSum::default()))?;
            self.begin.set_dynamics(&dynamics)?;
            self.run = self.begin.clone();
            self.steady = Stability::of(&self.problem.hair, &dynamics)?;
        }
        self.moved_in(field)
    }

    /// The spots in this field.
    fn moved_in(&mut self, field: Arc<dyn Field>) -> Result<Vec<DVec3>, SettingError> {
        if !self.steady.holds(&*field) {
            self.too_strong = true;
            let remedy = "too strong for some of the hair";
            return Err(SettingError::new("force", field.strongest(), remedy));
        }
        self.gone_on(Some(field))
    }

    /// The spots in the motion continued from the common start, in this field or the current one.
    fn gone_on(&mut self, field: Option<Arc<dyn Field>>) -> Result<Vec<DVec3>, SettingError> {
        self.runs += 1;
        self.run.stand_where(&self.begin);
        if let Some(field) = field {
            self.run.set_field_onward(field)?;
        }
        let mut places = self.early.clone();
        preroll::look(&self.aims, u32::MAX, &mut self.run, &mut places);
        Ok(places)
    }

    /// The remaining distances and preferences (cm^2).
    fn cost(&self, x: &[f64], places: &[DVec3]) -> f64 {
        let mut preferred = 0.0;
        self.preferences(x, |weight, residual, _| preferred += weight * residual * residual);
        self.aims.mean_square(places) + preferred
    }

    fn add_prior(&self, normal: &mut Normal) {
        let mut row = vec![0.0; normal.n];
        let x = &self.at.x;
        self.preferences(x, |weight, residual, derivatives| {
            row.fill(0.0);
            derivatives.iter().for_each(|&(i, d)| row[i] = d);
            normal.add(weight, residual, &row);
        });
    }

    /// The residuals of the prior: weight, residual, and derivatives by number.
    fn preferences(&self, x: &[f64], mut preference: impl FnMut(f64, f64, &[(usize, f64)])) {
        let (keep, alike) = (f64::from(self.problem.prior.keep).powi(2), f64::from(self.problem.prior.alike).powi(2));
        for (i, large) in self.large.iter().enumerate() {
            preference(keep, (x[i] - self.start[i]) / large, &[(i, 1.0 / large)]);
        }
        let guess = self.layout.guess(&self.problem.wind, x);
        let large = Unknown::Vector(0).large();
        let free = |j: usize| self.layout.unknowns.iter().find(|(u, _)| *u == Unknown::Vector(j)).map(|&(_, at)| at);
        for (j, pair) in guess.track.vectors.windows(2).enumerate() {
            let (a, b) = (free(j), free(j + 1));
            for axis in 0..3 {
                let residual = (pair[1] - pair[0])[axis] / large;
                match (a, b) {
                    (None, None) => {}
                    (Some(a), None) => preference(alike, residual, &[(a + axis, -1.0 / large)]),
                    (None, Some(b)) => preference(alike, residual, &[(b + axis, 1.0 / large)]),
                    (Some(a), Some(b)) => {
                        preference(alike, residual, &[(a + axis, -1.0 / large), (b + axis, 1.0 / large)]);
                    }
                }
            }
        }
    }
}
