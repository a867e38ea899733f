//! The results of a search, for display.

use std::fmt;

use nabiki::solve::{Report, Unknown, WishLeft};
use nabiki_io::screen::OneLine;

/// A wish is met if its remaining distance is at most this (cm, root mean square over its nodes).
pub const MET_CM: f64 = 0.5;

/// The results of a search.
#[derive(Clone, Debug, PartialEq)]
pub struct Solved {
    /// The solver's report.
    pub report: Report,
    /// The name of each wish in its file.
    pub names: Vec<String>,
    /// The unknowns.
    pub unknowns: Vec<Unknown>,
    /// Number of strands in the wishes.
    pub strands: usize,
    /// Duration of the search.
    pub seconds: f64,
}

impl Solved {
    /// Whether every wish is met within [`MET_CM`].
    pub fn all_met(&self) -> bool {
        self.report.wishes.iter().all(|wish| wish.after_cm <= MET_CM)
    }
}

impl fmt::Display for Solved {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { report, names, unknowns, strands, seconds } = self;
        let numbers: usize = unknowns.iter().map(|unknown| unknown.numbers()).sum();
        let some = |n: usize, what: &str| if n == 1 { format!("1 {what}") } else { format!("{n} {what}s") };
        write!(
            f,
            "  solved  rms {:.2} cm before, {:.2} cm after: {}, {}, {} from {}, {seconds:.2} s",
            report.before_cm,
            report.after_cm,
            some(numbers, "number"),
            some(*strands, "strand"),
            some(report.iterations, "step"),
            some(report.starts, "start"),
        )?;
        let answer = &report.answer;
        let mut first = 1;
        for (j, key) in answer.keyframes.iter().enumerate() {
            let changed = unknowns.iter().any(|u| *u == Unknown::Vector(j) || *u == Unknown::Border(j))
                || (j > 0 && unknowns.contains(&Unknown::Border(j - 1)));
            if changed {
                let [x, y, z] = key.vector.to_array();
                write!(f, "\n          force[{j}], frames {first} to {}: [{x}, {y}, {z}]", key.through)?;
            }
            first = key.through.saturating_add(1);
        }
        for unknown in unknowns {
            match unknown {
                Unknown::Gust => {
                    let intensity = answer.gust.as_ref().map_or(0.0, |gust| gust.intensity);
                    write!(f, "\n          gust.intensity: {intensity}")?;
                }
                Unknown::Stiffness => profile(f, "stiffness", answer.stiffness.as_ref())?,
                Unknown::Settle => profile(f, "settle", answer.settle.as_ref())?,
                Unknown::Vector(_) | Unknown::Border(_) => {}
            }
        }
        for (name, wish) in names.iter().zip(&report.wishes) {
            if wish.after_cm > MET_CM {
                let WishLeft { before_cm, after_cm } = wish;
                // A nail is at its goal before the search.
                let far = match *before_cm == 0.0 {
                    true => format!("has moved by {after_cm:.1} cm"),
                    false => format!("is not reached: {after_cm:.1} cm are left of {before_cm:.1}"),
                };
                write!(
                    f,
                    "\n  far     {} {far}; found no closer motion in {} steps",
                    OneLine(name),
                    report.iterations
                )?;
            }
        }
        Ok(())
    }
}

fn profile(f: &mut fmt::Formatter<'_>, name: &str, profile: Option<&nabiki::Profile>) -> fmt::Result {
    match profile.map(nabiki::Profile::values) {
        None => Ok(()),
        Some([value]) => write!(f, "\n          free.{name}: {value}"),
        Some(values) => write!(f, "\n          free.{name}: {values:?}"),
    }
}
