//! Derivatives of the spots by each number: tangents of the specification, or differences between motions of the fast stepper.

use std::sync::Arc;

use super::Solver;
use crate::dynamics::{Change, Crowds, Form, Moved, Points, Standing, tangents};
use crate::error::SettingError;
use crate::solve::gusts::WindTable;
use crate::solve::linear::Normal;
use crate::solve::more_wind::MoreWind;
use crate::solve::unknowns::Unknown;

impl Solver {
    /// The normal equations at the current numbers.
    ///
    /// `usual`: what most strands have left, if those that have much more are to count little.
    pub(super) fn normal(&mut self, held: bool, usual: Option<&[f64]>) -> Result<Normal, SettingError> {
        let mut points = if self.by_differences { self.differences(held)? } else { self.tangents()? };
        self.doubt(&mut points.tangents);
        let mut normal = Normal::new(self.layout.numbers);
        self.aims.add_to(&mut normal, &self.at.places, &points, usual);
        self.add_prior(&mut normal);
        self.held.iter().for_each(|&i| normal.hold(i));
        Ok(normal)
    }

    /// Weakens tangents of the free form, by the square, if a large change of one number would move a spot farther than
    /// its strand reaches. They belong to hair about to fall to the other side of what it lies on, and mislead.
    fn doubt(&self, tangents: &mut [f64]) {
        if self.problem.dynamics.form == Form::Paper {
            return;
        }
        let n = self.layout.numbers;
        for (rows, reach) in tangents.chunks_exact_mut(3 * n).zip(&self.reaches) {
            let of = |(i, large): (usize, &f64)| (0..3).map(|axis| (rows[axis * n + i] * large).powi(2)).sum::<f64>();
            let beyond = self.large.iter().enumerate().map(of).fold(0.0, f64::max) / reach.powi(2);
            if beyond > 1.0 {
                rows.iter_mut().for_each(|d| *d /= beyond);
            }
        }
    }

    /// Derivatives of the spots by each number, from a motion in a wind with a little more of it, or less if the hair cannot be stepped
    /// with more. `held`: as for the specification's tangents, what depends on the wind but is not linear in it is constant: drifting
    /// swirls would make the derivatives rough.
    fn differences(&mut self, held: bool) -> Result<Points, SettingError> {
        /// Part of a large change: far above the rounding of a motion of a few dozen frames, and large enough that one
        /// strand of ten which contact throws 1 cm aside does not hide the answer of the others. That is 0.1 cm of
        /// their mean over a wind of 10, 0.01 cm per unit; free hair of 18 cm moves by 0.01 to 0.07.
        const PART: f64 = 0.1;
        let n = self.layout.numbers;
        let guess = self.layout.guess(&self.problem.wind, &self.at.x);
        let by_number = self.gusts.by_number(&guess, &self.layout);
        let surroundings = self.problem.surroundings.clone();
        let field = surroundings.field(Arc::new(self.gusts.table(&guess)))?;
        let mut tangents = vec![0.0; 3 * n * self.aims.spots.len()];
        for i in 0..n {
            let by = PART * self.large[i];
            let mut moved = |by: f64| {
                if !held {
                    let mut x = self.at.x.clone();
                    x[i] += by;
                    let wind = Arc::new(self.gusts.table(&self.layout.guess(&self.problem.wind, &x)));
                    return Ok((self.simulated(wind, None)?, by));
                }
                let more = surroundings.of_wind(Arc::new(WindTable::of(by_number.iter().map(|of| by * of[i]))))?;
                let field = Arc::new(MoreWind { field: field.clone(), more });
                Ok::<_, SettingError>((self.moved_in(field)?, by))
            };
            let (places, by) = moved(by).or_else(|_| moved(-by))?;
            for (spot, (place, was)) in places.iter().zip(&self.at.places).enumerate() {
                for (axis, moved) in ((*place - *was) / by).to_array().into_iter().enumerate() {
                    tangents[(3 * spot + axis) * n + i] = moved;
                }
            }
        }
        Ok(Points { places: self.at.places.clone(), tangents })
    }

    /// Derivatives of the spots by each number, from the specification.
    fn tangents(&mut self) -> Result<Points, SettingError> {
        let guess = self.layout.guess(&self.problem.wind, &self.at.x);
        let now = self.dynamics(&guess);
        let dynamics = now.as_ref().unwrap_or(&self.problem.dynamics);
        let field = self.problem.surroundings.field(Arc::new(self.gusts.table(&guess)))?;
        let frame = self.begin.frame();
        let at_rest = Moved {
            strands: &self.strands,
            ids: &self.ids,
            dynamics,
            poses: &self.problem.poses,
            standing: None,
            crowds: None,
        };
        if frame > 0 && self.standing.is_none() {
            let mut timeline = self.begin.clone();
            timeline.rewind();
            self.standing = Some(Standing::at(frame, &at_rest, &*field, timeline)?);
        }
        // The carriers of the current motion: its field was set for the last motion tried, which may be another.
        self.run.stand_where(&self.begin);
        self.run.set_field_onward(field.clone())?;
        let crowds = Crowds::of(&mut self.run, self.frames.last().copied().unwrap_or(frame));
        let moved = Moved { standing: self.standing.as_ref(), crowds: crowds.as_ref(), ..at_rest };
        let unknown =
            |wanted: Unknown| self.layout.unknowns.iter().find(|(unknown, _)| *unknown == wanted).map(|&(_, at)| at);
        let change = Change {
            field: &*field,
            of_wind: &self.of_wind,
            wind: &self.gusts.by_number(&guess, &self.layout),
            stiffness: unknown(Unknown::Stiffness),
            settle: unknown(Unknown::Settle),
        };
        self.runs += 1;
        tangents(&moved, &change, &self.aims.spots)
    }
}
