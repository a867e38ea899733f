//! Gusts: a slow random factor on the wind.

use std::sync::Arc;

use glam::Vec3;

use super::sine::{cos_turns, cube_root};
use super::{Field, VectorRow};
use crate::error::SettingError;
use crate::random;
use crate::settings;

settings! {
    /// Gusts: a random factor around 1 on the wind of the intervals, which rises and falls like natural wind.
    ///
    /// It has the spectrum of wind along its direction by T. von Karman ("Progress in the statistical theory of
    /// turbulence", PNAS 34, 1948) as engineers write it, `S(f) = 4 T / (1 + 70.8 (f T)^2)^(5/6)`, up to a highest
    /// frequency. Faster changes do not reach all the hair at once; use turbulence for them.
    pub struct Gust in "gust" {
        /// How much the wind changes: 0.15 for open country, 0.4 for a town. It is the root mean square of the change
        /// of the factor; above 0.4 the wind sometimes reverses.
        pub intensity: f32 = 0.3 => "Intensity", least 0.0;
        /// How long a gust takes. T is the length scale of the turbulence over the mean wind speed.
        pub time_scale: f32 = 2.0 => "Time scale", unit "s", above 0.0;
        /// Highest frequency of the changes. Faster ones do not reach all the hair at once.
        pub highest: f32 = 1.0 => "Max frequency", unit "Hz", above 0.0;
        /// Random seed of the gusts.
        pub seed: u64 = 1 => "Seed";
    }
}

/// A part of the factor: amplitude cos(2 pi (rate n + phase)).
#[derive(Clone, Copy, Debug)]
struct Wave {
    amplitude: f64,
    /// Turns a frame.
    rate: f64,
    /// Turns.
    phase: f64,
}

/// A field multiplied by gusts.
#[derive(Clone, Debug)]
pub struct GustField {
    wind: Arc<dyn Field>,
    waves: Vec<Wave>,
}

impl GustField {
    /// Bands of frequencies, each with a wave of its own.
    const BANDS: i32 = 24;
    /// Ratio of a band's upper limit to that of the band below; the lowest begins at 0.
    const RATIO: f64 = 1.25;

    /// Multiplies `wind` by gusts. `frame_rate` is in frames per second, above 0.
    ///
    /// # Errors
    /// Settings out of range.
    pub fn new(settings: &Gust, wind: Arc<dyn Field>, frame_rate: f64) -> Result<Self, SettingError> {
        settings.check()?;
        if !(frame_rate.is_finite() && frame_rate > 0.0) {
            let remedy = "must be a finite number of frames a second, above 0";
            return Err(SettingError::new("motion.frame_rate", frame_rate, remedy));
        }
        let (time, highest) = (f64::from(settings.time_scale), f64::from(settings.highest));
        let mut counter = settings.seed;
        let mut chance = || {
            counter = counter.wrapping_add(random::GOLDEN_GAMMA);
            random::unit(random::mix(counter))
        };
        let mut waves = Vec::new();
        let mut above = highest;
        for band in (0..Self::BANDS).rev() {
            let below = if band > 0 { above / Self::RATIO } else { 0.0 };
            let frequency = below + chance() * (above - below);
            let power = power(time, below, above);
            waves.push(Wave { amplitude: power.sqrt(), rate: frequency / frame_rate, phase: chance() });
            above = below;
        }
        // A cosine of amplitude a has the mean square a^2 / 2.
        let whole = (waves.iter().map(|wave| wave.amplitude.powi(2)).sum::<f64>() / 2.0).sqrt();
        for wave in &mut waves {
            wave.amplitude *= f64::from(settings.intensity) / whole;
        }
        Ok(Self { wind, waves })
    }

    /// The factor on the wind in a frame.
    pub fn factor(&self, frame: u32) -> f32 {
        let time = f64::from(frame);
        let sum: f64 = self.waves.iter().map(|wave| wave.amplitude * cos_turns(wave.rate * time + wave.phase)).sum();
        (1.0 + sum) as f32
    }

    /// A bound on the absolute value of the factor.
    pub fn largest_factor(&self) -> f32 {
        let sum: f64 = self.waves.iter().map(|wave| wave.amplitude).sum();
        // A little more, for the rounding of products with it.
        ((1.0 + sum) * (1.0 + 1e-6)) as f32
    }
}

/// The integral of the spectrum over a band, by Simpson's rule.
fn power(time: f64, below: f64, above: f64) -> f64 {
    const PARTS: u32 = 16;
    let step = (above - below) / f64::from(PARTS);
    let weight = |i: u32| if i == 0 || i == PARTS { 1.0 } else { f64::from(2 + 2 * (i % 2)) };
    (0..=PARTS).map(|i| weight(i) * spectrum(time, below + f64::from(i) * step)).sum::<f64>() * step / 3.0
}

/// S(f), of variance about 1.
fn spectrum(time: f64, frequency: f64) -> f64 {
    let reduced = frequency * time;
    let x = 1.0 + 70.8 * reduced * reduced;
    // x^(5/6) = x^(1/2) x^(1/3)
    4.0 * time / (x.sqrt() * cube_root(x))
}

impl Field for GustField {
    fn at(&self, point: Vec3, frame: u32) -> Vec3 {
        self.wind.at(point, frame) * self.factor(frame)
    }

    fn strongest(&self) -> f32 {
        self.wind.strongest() * self.largest_factor()
    }

    /// Blames the wind if it is too strong by itself, or else the gusts.
    fn first_above(&self, limit: f64) -> Option<(String, String)> {
        let strongest = self.strongest();
        self.wind.first_above(limit).or_else(|| {
            let value = format!("a wind of {} times {}", self.wind.strongest(), self.largest_factor());
            (f64::from(strongest) > limit).then(|| ("gust".to_owned(), value))
        })
    }

    fn uniform(&self, frame: u32) -> Option<Vec3> {
        self.wind.uniform(frame).map(|wind| wind * self.factor(frame))
    }

    fn at_row(&self, points: &VectorRow, frame: u32, forces: &mut VectorRow) {
        self.wind.at_row(points, frame, forces);
        let factor = self.factor(frame);
        forces.as_flattened_mut().iter_mut().for_each(|force| *force *= factor);
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use proptest::prelude::*;

    use super::*;
    use crate::field::{Keyframe, KeyframedField};

    fn gust(settings: &Gust, frame_rate: f64) -> GustField {
        let keys = [Keyframe { through: 9, vector: Vec3::new(3.0, 0.0, -4.0) }];
        GustField::new(settings, Arc::new(KeyframedField::new(&keys).unwrap()), frame_rate).unwrap()
    }

    proptest! {
        #[test]
        fn the_factor_stays_in_its_bound_and_the_wind_uniform(
            seed: u64, intensity in 0.0_f32..1.0, time_scale in 0.1_f32..20.0, frames in prop::collection::vec(0_u32..1_000_000, 50)
        ) {
            let field = gust(&Gust { intensity, time_scale, seed, ..Gust::default() }, 24.0);
            for frame in frames {
                prop_assert!(field.factor(frame).abs() <= field.largest_factor());
                prop_assert!(field.at(Vec3::X, frame).length() <= field.strongest());
                prop_assert_eq!(field.uniform(frame), Some(field.at(Vec3::Y, frame)));
                let mut row = VectorRow::default();
                field.at_row(&VectorRow::default(), frame, &mut row);
                prop_assert_eq!([row[0][7], row[1][7], row[2][7]], field.at(Vec3::ZERO, frame).to_array());
            }
        }
    }

    #[test]
    fn no_intensity_is_no_gust_and_seeds_differ() {
        let still = gust(&Gust { intensity: 0.0, ..Gust::default() }, 24.0);
        assert!((0..200).all(|frame| still.factor(frame) == 1.0));
        let (one, two) = (gust(&Gust::default(), 24.0), gust(&Gust { seed: 2, ..Gust::default() }, 24.0));
        assert!((1..200).any(|frame| (one.factor(frame) - two.factor(frame)).abs() > 0.1));
        // The same moments at another rate.
        let fast = gust(&Gust::default(), 48.0);
        assert!((0..200).all(|frame| (one.factor(frame) - fast.factor(2 * frame)).abs() < 1e-6));
    }

    /// The formula with the library's powers.
    fn von_karman(time: f64, frequency: f64) -> f64 {
        4.0 * time / (1.0 + 70.8 * (frequency * time).powi(2)).powf(5.0 / 6.0)
    }

    /// Its integral, by the rule of the middle.
    fn von_karman_between(time: f64, below: f64, above: f64) -> f64 {
        let step = (above - below) / 4000.0;
        (0..4000).map(|i| step * von_karman(time, below + (f64::from(i) + 0.5) * step)).sum()
    }

    #[test]
    fn the_spectrum_is_von_karmans() {
        // Periodograms of 400 seeds, 4 frames a second, with Hann's window, which keeps a frequency within two lines.
        const FRAMES: usize = 1024;
        const SEEDS: u64 = 400;
        let settings = Gust { time_scale: 2.0, ..Gust::default() };
        let mut power = [0.0; FRAMES / 2];
        for seed in 0..SEEDS {
            let field = gust(&Gust { seed, ..settings.clone() }, 4.0);
            let window = |n: usize| 1.0 - (2.0 * PI * n as f64 / FRAMES as f64).cos();
            let series: Vec<f64> = (0..FRAMES).map(|n| window(n) * (f64::from(field.factor(n as u32)) - 1.0)).collect();
            for (line, power) in power.iter_mut().enumerate() {
                // Goertzel's recurrence.
                let turn = 2.0 * (2.0 * PI * line as f64 / FRAMES as f64).cos();
                let (a, b) = series.iter().fold((0.0, 0.0), |(a, b), x| (x + turn * a - b, a));
                *power += a * a + b * b - turn * a * b;
            }
        }
        let whole: f64 = power.iter().sum();
        let time = f64::from(settings.time_scale);
        for (below, above) in [(0.0, 0.06), (0.06, 0.125), (0.125, 0.25), (0.25, 0.5), (0.5, 1.0)] {
            let lines = (below * 256.0) as usize..(above * 256.0) as usize + usize::from(above == 1.0) * 4;
            let share = power[lines].iter().sum::<f64>() / whole;
            let expected = von_karman_between(time, below, above) / von_karman_between(time, 0.0, 1.0);
            // A band of frequencies that lies across an end of this one gives its power to either side by chance, and not
            // evenly by the slope of the spectrum: half of it, over the root of the seeds, five times; and a tenth of it.
            let across = |f: f64| {
                if f > 0.0 && f < 1.0 {
                    von_karman_between(time, f / 1.25, f * 1.25) / von_karman_between(time, 0.0, 1.0)
                } else {
                    0.0
                }
            };
            let tolerance = (across(below) + across(above)) * (5.0 * 0.5 / (SEEDS as f64).sqrt() + 0.1);
            assert!((share - expected).abs() < tolerance, "{below}..{above} Hz: {share}, {expected} +- {tolerance}");
        }
        // Parseval: the sum over lines of either sign is FRAMES times that of the series, whose window has mean square 1.5.
        let mean_square = 2.0 * whole / (SEEDS as f64 * (FRAMES * FRAMES) as f64 * 1.5);
        let expected = f64::from(settings.intensity).powi(2);
        // Waves nearer to one another than a line, and those that do not go round in the time, add up by chance: at most all
        // of the power, over the root of the seeds.
        assert!((mean_square / expected - 1.0).abs() < 0.05, "{mean_square}, {expected}");
    }

    #[test]
    fn settings_out_of_range_are_refused_by_name() {
        let refused = |settings: Gust| settings.check().unwrap_err().thing;
        assert_eq!(refused(Gust { intensity: -0.1, ..Gust::default() }), "gust.intensity");
        assert_eq!(refused(Gust { time_scale: 0.0, ..Gust::default() }), "gust.time_scale");
        assert_eq!(refused(Gust { highest: f32::NAN, ..Gust::default() }), "gust.highest");
        assert_eq!(Gust::default().check(), Ok(()));
    }

    #[test]
    fn the_wind_is_blamed_before_the_gusts() {
        let field = gust(&Gust::default(), 24.0);
        assert_eq!(field.first_above(4.0).unwrap().0, "force[0].vector");
        assert_eq!(field.first_above(5.5).unwrap().0, "gust");
        assert_eq!(field.first_above(f64::from(field.strongest())), None);
    }
}
