//! The unknowns of a problem, and their numbers.

use glam::DVec3;

use super::keyed_wind::KeyedWind;
use super::track::Track;
use crate::dynamics::{Dynamics, Form};
use crate::error::SettingError;
use crate::field::{Gust, Keyframe, KeyframedField};
use crate::free_form::FreeForm;
use crate::profile::Profile;

/// Something that the solver may change. Intervals are counted from 0, like `force[j]`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Unknown {
    /// The vector of an interval: three numbers.
    Vector(usize),
    /// The last frame of an interval, after which the next one begins. The last interval has no border.
    Border(usize),
    /// The intensity of the gusts.
    Gust,
    /// The stiffness of the free form: one common factor.
    Stiffness,
    /// The settling of the free form: one common factor.
    Settle,
}

impl Unknown {
    /// How many numbers this unknown has.
    pub fn numbers(self) -> usize {
        match self {
            Self::Vector(_) => 3,
            _ => 1,
        }
    }

    /// Size of a large change of one of its numbers.
    pub(super) fn large(self) -> f64 {
        match self {
            Self::Vector(_) => 100.0,
            Self::Border(_) => 20.0,
            Self::Gust | Self::Stiffness | Self::Settle => 1.0,
        }
    }
}

/// The settings that the solver found. Settings that were not unknown are unchanged.
#[derive(Clone, Debug, PartialEq)]
pub struct Answer {
    /// The intervals.
    pub keyframes: Vec<Keyframe>,
    /// The gusts.
    pub gust: Option<Gust>,
    /// `free.stiffness`. `None` in the paper's form.
    pub stiffness: Option<Profile>,
    /// `free.settle`. `None` in the paper's form.
    pub settle: Option<Profile>,
}

/// The largest change of stiffness and settling: by e^3, about twenty times.
const MOST: f64 = 3.0;

/// The unknowns of a problem as a list of numbers. Factors are counted by their logarithms, from what the problem has.
#[derive(Clone, Debug)]
pub(super) struct Layout {
    /// Each unknown with the index of its first number.
    pub unknowns: Vec<(Unknown, usize)>,
    /// The number of numbers.
    pub numbers: usize,
}

/// The meaning of a list of numbers.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Guess {
    pub track: Track,
    /// Intensity of the gusts.
    pub gust: f64,
    /// Factors on the values of the problem.
    pub stiffness: f64,
    pub settle: f64,
}

impl Layout {
    /// Refuses unknowns that do not exist, an empty list, and duplicates.
    pub fn new(unknowns: &[Unknown], wind: &KeyedWind, dynamics: &Dynamics) -> Result<Self, SettingError> {
        if unknowns.is_empty() {
            let remedy = "is empty, so nothing may change: free a vector, a border, the gusts, stiffness or settle";
            return Err(SettingError::new("unknowns", "", remedy));
        }
        let (mut placed, mut numbers) = (Vec::with_capacity(unknowns.len()), 0);
        let intervals = wind.keyframes.len();
        for (i, &unknown) in unknowns.iter().enumerate() {
            check(unknown, intervals, wind, dynamics)?;
            if unknowns[..i].contains(&unknown) {
                return Err(SettingError::new("unknowns", format!("{unknown:?}"), "is given twice: give it once"));
            }
            placed.push((unknown, numbers));
            numbers += unknown.numbers();
        }
        Ok(Self { unknowns: placed, numbers })
    }

    /// The numbers of the problem.
    pub fn start(&self, wind: &KeyedWind) -> Vec<f64> {
        let mut x = Vec::with_capacity(self.numbers);
        for &(unknown, _) in &self.unknowns {
            match unknown {
                Unknown::Vector(j) => x.extend(wind.keyframes[j].vector.as_dvec3().to_array()),
                Unknown::Border(j) => x.push(f64::from(wind.keyframes[j].through)),
                Unknown::Gust => x.push(wind.gust.as_ref().map_or(0.0, |gust| f64::from(gust.intensity))),
                Unknown::Stiffness | Unknown::Settle => x.push(0.0),
            }
        }
        x
    }

    /// The meaning of some numbers.
    pub fn guess(&self, wind: &KeyedWind, x: &[f64]) -> Guess {
        let mut guess = Guess {
            track: Track {
                vectors: wind.keyframes.iter().map(|key| key.vector.as_dvec3()).collect(),
                borders: wind.keyframes.iter().map(|key| f64::from(key.through)).collect(),
                ease: wind.ease,
            },
            gust: wind.gust.as_ref().map_or(0.0, |gust| f64::from(gust.intensity)),
            stiffness: 1.0,
            settle: 1.0,
        };
        for &(unknown, at) in &self.unknowns {
            match unknown {
                Unknown::Vector(j) => guess.track.vectors[j] = DVec3::from_slice(&x[at..at + 3]),
                Unknown::Border(j) => guess.track.borders[j] = x[at],
                Unknown::Gust => guess.gust = x[at],
                Unknown::Stiffness => guess.stiffness = x[at].exp(),
                Unknown::Settle => guess.settle = x[at].exp(),
            }
        }
        guess
    }

    /// Brings numbers into their ranges: borders at least a frame apart, gusts of no negative strength, bounded
    /// factors. `wind`: the positions of fixed borders.
    pub fn keep_in_range(&self, wind: &KeyedWind, x: &mut [f64]) {
        for &(unknown, at) in &self.unknowns {
            match unknown {
                Unknown::Gust => x[at] = x[at].max(0.0),
                Unknown::Stiffness | Unknown::Settle => x[at] = x[at].clamp(-MOST, MOST),
                Unknown::Vector(_) | Unknown::Border(_) => {}
            }
        }
        let place =
            |j: usize| self.unknowns.iter().find(|(unknown, _)| *unknown == Unknown::Border(j)).map(|&(_, at)| at);
        let count = wind.keyframes.len();
        // Upward each comes after the one before; then downward, from the last, which stays, each before the one after.
        let mut least = 1.0;
        for j in 0..count {
            match place(j) {
                Some(at) => {
                    x[at] = x[at].max(least);
                    least = x[at] + 1.0;
                }
                None => least = f64::from(wind.keyframes[j].through) + 1.0,
            }
        }
        let mut most = f64::INFINITY;
        for j in (0..count).rev() {
            match place(j) {
                Some(at) => {
                    x[at] = x[at].min(most);
                    most = x[at] - 1.0;
                }
                None => most = f64::from(wind.keyframes[j].through) - 1.0,
            }
        }
    }

    /// The first frame that feels any of them.
    pub fn first_felt(&self, wind: &KeyedWind) -> Result<u32, SettingError> {
        let mut first = u32::MAX;
        for &(unknown, _) in &self.unknowns {
            first = first.min(match unknown {
                Unknown::Vector(j) => KeyframedField::new(&wind.keyframes)?.eased(wind.ease).first_felt(j),
                // Borders may meet others on their way, and everything else is felt from the first frame on.
                _ => 1,
            });
        }
        Ok(first)
    }

    /// Size of a large change of each number.
    pub fn large(&self) -> Vec<f64> {
        let each = |&(unknown, _): &(Unknown, usize)| std::iter::repeat_n(unknown.large(), unknown.numbers());
        self.unknowns.iter().flat_map(each).collect()
    }

    /// The numbers that are borders.
    pub fn borders(&self) -> impl Iterator<Item = usize> {
        self.unknowns.iter().filter(|(unknown, _)| matches!(unknown, Unknown::Border(_))).map(|&(_, at)| at)
    }
}

impl Guess {
    /// Rounded as in a scene file: frames whole, other numbers with few digits.
    pub fn rounded(&self, wind: &KeyedWind, dynamics: &Dynamics) -> Answer {
        let thousandth = |x: f64| ((x * 1000.0).round() / 1000.0) as f32;
        let as_it_was = |now: f32, x: f64| if f64::from(now) == x { now } else { thousandth(x) };
        let keyframes = wind.keyframes.iter().enumerate().map(|(j, key)| {
            let (now, v) = (key.vector.to_array(), self.track.vectors[j].to_array());
            Keyframe {
                through: self.track.borders[j].round() as u32,
                vector: [0, 1, 2].map(|axis| as_it_was(now[axis], v[axis])).into(),
            }
        });
        let form = match &dynamics.form {
            Form::Paper => None,
            Form::Free(free) => Some(&free.form),
        };
        Answer {
            keyframes: keyframes.collect(),
            gust: wind.gust.clone().map(|gust| Gust { intensity: as_it_was(gust.intensity, self.gust), ..gust }),
            stiffness: form.map(|form| times(&form.stiffness, self.stiffness)),
            settle: form.map(|form| times(&form.settle, self.settle)),
        }
    }
}

/// A profile times a factor, each number with four digits; unchanged if the factor is 1.
fn times(profile: &Profile, factor: f64) -> Profile {
    if factor == 1.0 {
        return profile.clone();
    }
    let digits = |value: &f32| {
        let value = f64::from(*value) * factor;
        if value == 0.0 {
            return 0.0;
        }
        let unit = 10.0_f64.powf(value.abs().log10().floor() - 3.0);
        ((value / unit).round() * unit) as f32
    };
    match profile {
        Profile::Even(value) => Profile::Even(digits(value)),
        Profile::RootToTip(values) => Profile::RootToTip(values.iter().map(digits).collect()),
    }
}

fn check(unknown: Unknown, intervals: usize, wind: &KeyedWind, dynamics: &Dynamics) -> Result<(), SettingError> {
    let there = || match intervals {
        0 => "there is no [[force]]: ask for a new interval".to_owned(),
        1 => "the only [[force]] is number 0: name it, or ask for a new interval".to_owned(),
        n => format!("must be one of the {n} [[force]], 0 to {}; or ask for a new interval", n - 1),
    };
    let free = |thing: &str, of: fn(&FreeForm) -> &Profile| match &dynamics.form {
        Form::Free(free) if of(&free.form).values().iter().all(|&value| value == 0.0) => {
            let remedy = "the solver only scales it, but it is 0 everywhere: give it a strength, or remove this";
            Err(SettingError::new(thing, true, remedy))
        }
        Form::Free(_) => Ok(()),
        Form::Paper => {
            let remedy = "the paper's form has none: set motion.form = \"free\", or remove this";
            Err(SettingError::new(thing, true, remedy))
        }
    };
    match unknown {
        Unknown::Vector(j) if j >= intervals => Err(SettingError::new("unknowns.vectors", j, there())),
        Unknown::Border(j) if j >= intervals => Err(SettingError::new("unknowns.borders", j, there())),
        Unknown::Border(j) if j + 1 == intervals => {
            let remedy = "the last interval has no border after it: free the border of an earlier one";
            Err(SettingError::new("unknowns.borders", j, remedy))
        }
        Unknown::Gust if wind.gust.is_none() => {
            Err(SettingError::new("unknowns.gust", true, "the scene has no [gust]: give it one, or remove this"))
        }
        Unknown::Stiffness => free("unknowns.stiffness", |form| &form.stiffness),
        Unknown::Settle => free("unknowns.settle", |form| &form.settle),
        _ => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::*;

    fn wind(frames: &[u32]) -> KeyedWind {
        let keyframes = frames.iter().map(|&through| Keyframe { through, vector: Vec3::X }).collect();
        KeyedWind { keyframes, ..KeyedWind::default() }
    }

    fn layout(unknowns: &[Unknown]) -> Layout {
        let mut numbers = 0;
        let place = |&unknown: &Unknown| {
            numbers += unknown.numbers();
            (unknown, numbers - unknown.numbers())
        };
        Layout { unknowns: unknowns.iter().map(place).collect(), numbers }
    }

    #[test]
    fn borders_stay_in_order_a_frame_apart() {
        let wind = wind(&[10, 20, 30, 40]);
        let layout = layout(&[Unknown::Border(2), Unknown::Border(0), Unknown::Vector(1)]);
        for (given, kept) in [([25.5, 10.5], [25.5, 10.5]), ([90.0, -5.0], [39.0, 1.0]), ([3.0, 24.0], [21.0, 19.0])] {
            let mut x = [given[0], given[1], 1.0, 2.0, 3.0];
            layout.keep_in_range(&wind, &mut x);
            assert_eq!(x, [kept[0], kept[1], 1.0, 2.0, 3.0]);
        }
    }

    #[test]
    fn profiles_keep_four_digits() {
        assert_eq!(times(&Profile::RootToTip(vec![12_000.0, 0.0]), 1.234_567), Profile::RootToTip(vec![14_810.0, 0.0]));
        assert_eq!(times(&Profile::Even(20.0), 0.5), Profile::Even(10.0));
        assert_eq!(times(&Profile::Even(0.1), 1.0), Profile::Even(0.1));
    }
}
