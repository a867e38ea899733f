//! From one start to the solution: other starts, borders at whole frames, rounded numbers.

use std::sync::Arc;

use glam::DVec3;

use super::{Brake, Damping, Place, Solver};
use crate::dynamics::Form;
use crate::error::SettingError;
use crate::random::{GOLDEN_GAMMA, mix, unit};
use crate::solve::keyed_wind::KeyedWind;
use crate::solve::report::{Report, WishLeft};
use crate::solve::unknowns::Answer;

/// The limits of a search.
#[derive(Clone, Copy, Debug, PartialEq, serde::Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Search {
    /// Largest number of steps from each start.
    pub iterations: usize,
    /// Largest number of starts: that of the problem, and random ones around it.
    pub starts: usize,
    /// A motion this near to the wishes is near enough (root mean square, cm): the search tries no other start.
    #[serde(rename = "near")]
    pub near_cm: f64,
    /// Seed of the other starts.
    pub seed: u64,
}

impl Default for Search {
    fn default() -> Self {
        Self { iterations: 30, starts: 4, near_cm: 0.1, seed: 1 }
    }
}

/// Receives each step, and may stop the search.
struct Watched<'a> {
    goes_on: &'a mut dyn FnMut(f64) -> bool,
    stopped: bool,
}

/// Starts drawn for each one followed; the nearest of them is.
const DRAWN: usize = 8;

impl Solver {
    /// Searches from here, and from other starts if that does not lead near enough.
    pub fn solve(&mut self, search: &Search) -> Report {
        self.solve_watched(search, &mut |_| true)
    }

    /// Like [`solve`](Self::solve). After each step it calls `goes_on` with the smallest distance from the wishes so
    /// far (cm). If that returns `false`, it stops and reports the best result so far.
    pub fn solve_watched(&mut self, search: &Search, goes_on: &mut dyn FnMut(f64) -> bool) -> Report {
        let (mut starts, near) = (1, search.near_cm.powi(2));
        let mut watched = Watched { goes_on, stopped: false };
        self.descend_by_most(search.iterations, near, &mut watched);
        let mut best = self.at.clone();
        let mut counter = mix(search.seed);
        while starts < search.starts && self.aims.mean_square(&best.places) > near && !watched.stopped {
            starts += 1;
            if let Some(start) = self.drawn(&mut counter) {
                self.at = start;
                self.damping = Damping::default();
                self.descend_by_most(search.iterations, near, &mut watched);
                if self.at.cost < best.cost {
                    best = self.at.clone();
                }
            }
        }
        self.at = best;
        self.damping = Damping::default();
        self.set_borders_to_frames(search.iterations, &mut watched);
        let left = self.rounded();
        let wish = |(&before_cm, after_cm): (&f64, f64)| WishLeft { before_cm, after_cm };
        Report {
            answer: self.answer(),
            before_cm: self.before_cm,
            after_cm: self.aims.mean_square(&left).sqrt(),
            wishes: self.left_before.iter().zip(self.aims.left(&left)).map(wish).collect(),
            iterations: self.iterations,
            starts,
            runs: self.runs,
        }
    }

    /// Sets a brake: while it returns `true`, every search of this solver ends after the current motion.
    pub fn set_brake(&mut self, brake: impl Fn() -> bool + Send + Sync + 'static) {
        self.brake = Some(Brake(Arc::new(brake)));
    }

    /// Continues the search for a goal that does not move. It takes steps until they gain nothing. Then it tries other
    /// starts, alternately around the nearest motion so far and around the problem's, farther and farther away. It ends
    /// when the remaining distance and the preferences together are at most `enough_cm` (root of the sum of squares).
    /// Borders do not change. It returns `false` if it was [braked](Self::set_brake). Either way, the solver is at the
    /// nearest motion found.
    pub fn pursue(&mut self, search: &Search, enough_cm: f64) -> bool {
        let (near, enough) = (search.near_cm.powi(2), enough_cm.powi(2));
        self.too_strong = false;
        self.damping = Damping::default();
        let mut best = self.at.clone();
        self.descend_to(search.iterations, near, &mut best);
        let mut counter = mix(search.seed);
        for start in 1..search.starts {
            if best.cost <= enough || self.is_braked() {
                break;
            }
            let about = if start % 2 == 1 { best.x.clone() } else { self.start.clone() };
            if let Some(place) = self.drawn_about(&about, 1.0 + start as f64, &mut counter) {
                self.at = place;
                self.damping = Damping::default();
                self.descend_to(search.iterations, near, &mut best);
            }
        }
        self.at = best;
        self.damping = Damping::default();
        !self.is_braked()
    }

    /// Steps until they hardly gain; at the goal, until they hardly make the changes smaller. `best` is the nearest
    /// motion so far.
    fn descend_to(&mut self, iterations: usize, near: f64, best: &mut Place) {
        let mut slow = 0;
        for _ in 0..iterations {
            if self.at.cost < best.cost {
                *best = self.at.clone();
            }
            let before = self.at.cost;
            let patience = if self.aims.mean_square(&self.at.places) <= near { 0 } else { 3 };
            if slow > patience || !self.descend_once() {
                break;
            }
            slow = if self.at.cost > 0.98 * before { slow + 1 } else { 0 };
        }
        if self.at.cost < best.cost {
            *best = self.at.clone();
        }
    }

    /// The spots in the motion of a scene with the answer. Rounded settings may be too strong for the step although
    /// these were not: then the answer changes a little less.
    fn rounded(&mut self) -> Vec<DVec3> {
        const PARTS: usize = 100;
        let x = self.at.x.clone();
        for part in (0..=PARTS).rev() {
            let part = part as f64 / PARTS as f64;
            self.at.x = x.iter().zip(&self.start).map(|(x, start)| start + part * (x - start)).collect();
            if let Ok(places) = self.left_of(&self.answer()) {
                return places;
            }
        }
        self.at.places.clone()
    }

    /// Steps until they hardly gain. If that ends far from the wishes, steps once more by most of the strands, and from
    /// there by all of them. Strands that contact throws to one side or the other by chance make the sum rough, and
    /// steps judged by it stop in any dent; the measure of most strands is smooth.
    fn descend_by_most(&mut self, iterations: usize, near: f64, watched: &mut Watched) {
        self.descend(iterations, near, watched);
        if watched.stopped || self.aims.mean_square(&self.at.places) <= near || !self.aims.tell_most() {
            return;
        }
        let by_all = self.at.clone();
        for by_most in [true, false] {
            self.by_most = by_most;
            self.damping = Damping::default();
            self.descend(iterations, near, watched);
        }
        if by_all.cost < self.at.cost {
            self.at = by_all;
        }
    }

    /// Steps until they hardly gain.
    fn descend(&mut self, iterations: usize, near: f64, watched: &mut Watched) {
        let mut slow = 0;
        for _ in 0..iterations {
            let before = self.at.clone();
            if watched.stopped || !self.descend_once() || slow > 2 || self.at.cost < 1e-3 * near {
                return;
            }
            watched.stopped = !(watched.goes_on)(self.left_cm());
            let usual = self.by_most.then(|| self.aims.usual(&before.places));
            let [before, after] = [&before, &self.at].map(|place| self.judged(place, usual.as_deref()));
            slow = if after > 0.99 * before { slow + 1 } else { 0 };
        }
    }

    /// The spots in the motion of a scene with an answer.
    fn left_of(&mut self, answer: &Answer) -> Result<Vec<DVec3>, SettingError> {
        let Answer { keyframes, gust, stiffness, settle } = answer.clone();
        let wind = KeyedWind { keyframes, gust, ease: self.problem.wind.ease };
        let mut dynamics = self.problem.dynamics.clone();
        // The last trial may have left others, so set these even if they are the problem's own.
        let dynamics = match (&mut dynamics.form, stiffness, settle) {
            (Form::Free(free), Some(stiffness), Some(settle)) => {
                (free.form.stiffness, free.form.settle) = (stiffness, settle);
                Some(dynamics)
            }
            _ => None,
        };
        self.simulated(wind.field(self.problem.dynamics.motion.frame_rate)?, dynamics)
    }

    /// Another start: the nearest of a few drawn around the problem's own.
    fn drawn(&mut self, counter: &mut u64) -> Option<Place> {
        self.drawn_about(&self.start.clone(), 1.0, counter)
    }

    /// The nearest of a few drawn around some numbers, at this many large changes.
    fn drawn_about(&mut self, about: &[f64], spread: f64, counter: &mut u64) -> Option<Place> {
        let mut best: Option<Place> = None;
        for _ in 0..DRAWN {
            if self.is_braked() {
                break;
            }
            let mut x = about.to_vec();
            for (x, large) in x.iter_mut().zip(&self.large) {
                *counter = counter.wrapping_add(GOLDEN_GAMMA);
                *x += spread * large * (2.0 * unit(mix(*counter)) - 1.0);
            }
            self.layout.keep_in_range(&self.problem.wind, &mut x);
            if let Some(place) = self.place(x)
                && best.as_ref().is_none_or(|best| place.cost < best.cost)
            {
                best = Some(place);
            }
        }
        best
    }

    /// Rounds borders to whole frames and lets the other numbers follow: first to the nearest frames, then one more or
    /// less as long as that leads nearer.
    fn set_borders_to_frames(&mut self, iterations: usize, watched: &mut Watched) {
        self.held = self.layout.borders().collect();
        let borders = self.held.clone();
        if borders.is_empty() {
            return;
        }
        let mut x = self.at.x.clone();
        borders.iter().for_each(|&i| x[i] = x[i].round());
        self.layout.keep_in_range(&self.problem.wind, &mut x);
        if let Some(place) = self.place(x) {
            self.at = place;
            self.descend(iterations, 0.0, watched);
        }
        let mut nearer = true;
        while nearer {
            nearer = false;
            for &i in &borders {
                for by in [-1.0, 1.0] {
                    nearer |= self.shift_border(i, by, watched);
                }
            }
        }
        self.held.clear();
    }

    /// Moves a border if that, with a few steps of the other numbers, gains a hundredth.
    fn shift_border(&mut self, i: usize, by: f64, watched: &mut Watched) -> bool {
        const STEPS: usize = 4;
        let before = self.at.clone();
        let mut x = before.x.clone();
        x[i] += by;
        self.layout.keep_in_range(&self.problem.wind, &mut x);
        if x[i] == before.x[i] || x[i].fract() != 0.0 {
            return false;
        }
        if let Some(place) = self.place(x) {
            self.at = place;
            self.damping = Damping::default();
            self.descend(STEPS, 0.0, watched);
        }
        if self.at.cost < 0.99 * before.cost {
            return true;
        }
        self.at = before;
        false
    }
}
