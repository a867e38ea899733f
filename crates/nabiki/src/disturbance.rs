//! Small random disturbances of the hair at regular intervals: section 4.4 of the paper (the running scene).

use crate::error::SettingError;
use crate::random::mix;
use crate::setting::{Place, refused};
use crate::settings;
use crate::smoothing::rise;

settings! {
    /// Turns each strand a little, at random and at regular intervals, in the paper's form.
    ///
    /// The paper gives neither size nor law. Here a strand gets one random turn of theta and one of phi, uniform within
    /// `amplitude` at the tip and falling to 0 at the root. It therefore stays a smooth curve. The speeds of the
    /// segments do not change. The random numbers depend only on seed, strand and frame.
    pub struct Disturbance in "disturbance" where does_not_overlap {
        /// Frames between two disturbances. The paper uses 10; a disturbance in each frame is too much.
        pub every: u32 = 10 => "Every", unit "frames", least 1.0;
        /// First frame that may be disturbed. The paper disturbs the last 60 of 100 frames.
        pub from: u32 = 1 => "First frame", unit "frame";
        /// Largest turn at the tip.
        pub amplitude: f32 = 0.03 => "Amplitude", unit "rad", above 0.0, most std::f64::consts::PI;
        /// Number of frames over which a disturbance builds up, at most `every`. At 1, as in the paper, it is a visible
        /// jump. More frames make it smooth, with the same end result.
        pub over: u32 = 1 => "Build-up", unit "frames", least 1.0;
        /// Random seed of the turns.
        pub seed: u64 = 1 => "Seed";
    }
}

/// The part of a disturbance that falls into one frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Part {
    /// The frame in which the disturbance starts.
    pub falls_on: u32,
    /// The share of the turn in this frame. The shares of all its frames add up to 1.
    pub share: f32,
}

impl Disturbance {
    /// Refuses disturbances that are still running when the next one begins.
    fn does_not_overlap(&self, at: &Place) -> Result<(), SettingError> {
        if self.over <= self.every {
            return Ok(());
        }
        let remedy = format!("must lie in 1..{}, the number of frames between disturbances", self.every);
        refused(&at.key("over"), self.over, remedy)
    }

    /// The refusal of disturbances in the free form, which has no angles to turn.
    pub fn refused_in_the_free_form(&self) -> SettingError {
        let remedy = "disturbances turn the angles of the paper's form; in the free form use turbulence, or a gust";
        SettingError::new("disturbance.every", self.every, remedy)
    }

    /// Whether a disturbance starts in this frame.
    pub fn falls_on(&self, frame: u32) -> bool {
        frame >= self.from && frame.is_multiple_of(self.every)
    }

    /// The part of a disturbance in this frame, if any.
    pub fn part(&self, frame: u32) -> Option<Part> {
        let since = frame % self.every;
        let falls_on = frame - since;
        let share = self.arrived(since + 1) - self.arrived(since);
        (since < self.over && self.falls_on(falls_on)).then_some(Part { falls_on, share: share as f32 })
    }

    /// The part of a turn done after this many of its frames: 3 t^2 - 2 t^3, which begins and ends at rest.
    fn arrived(&self, frames: u32) -> f64 {
        rise(f64::from(frames) / f64::from(self.over))
    }

    /// The turns (theta, phi) of the tip of strand `id` in this part of a disturbance (rad). All parts together stay
    /// within `amplitude`.
    pub fn turn(&self, id: u32, part: &Part) -> [f32; 2] {
        let key = mix(self.seed ^ mix((u64::from(id) << 32) | u64::from(part.falls_on)));
        [key, mix(key)].map(|bits| {
            let unit = (bits >> 40) as f32 / (1u64 << 24) as f32;
            part.share * (self.amplitude * (2.0 * unit - 1.0))
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn turns_are_uniform_within_the_amplitude_and_differ_by_strand_frame_and_seed() {
        let disturbance = Disturbance { amplitude: 0.5, ..Default::default() };
        let at = |falls_on| Part { falls_on, share: 1.0 };
        let turns: Vec<f32> = (0..10_000).flat_map(|id| disturbance.turn(id, &at(40))).collect();
        assert!(turns.iter().all(|t| t.abs() <= 0.5));
        let mean = turns.iter().sum::<f32>() / turns.len() as f32;
        let variance = turns.iter().map(|t| t * t).sum::<f32>() / turns.len() as f32;
        // Uniform on +-a: deviation a / sqrt 3; five standard errors of the mean and of the variance of 20,000.
        let standard_error = 0.5 / (3.0 * turns.len() as f32).sqrt();
        assert!(mean.abs() < 5.0 * standard_error, "{mean}");
        let variance_error = 0.25 * (4.0 / 45.0 / turns.len() as f32).sqrt();
        assert!((variance - 0.25 / 3.0).abs() < 5.0 * variance_error, "{variance}");
        assert_ne!(disturbance.turn(1, &at(40)), disturbance.turn(2, &at(40)));
        assert_ne!(disturbance.turn(1, &at(40)), disturbance.turn(1, &at(50)));
        assert_ne!(disturbance.turn(1, &at(40)), Disturbance { seed: 2, ..disturbance.clone() }.turn(1, &at(40)));
    }

    #[test]
    fn it_falls_on_every_tenth_frame_from_its_first_on() {
        let disturbance = Disturbance { from: 41, ..Default::default() };
        let frames: Vec<u32> = (0..=100).filter(|&n| disturbance.falls_on(n)).collect();
        assert_eq!(frames, [50, 60, 70, 80, 90, 100]);
    }

    #[test]
    fn the_paper_disturbs_in_one_frame() {
        let disturbance = Disturbance { from: 41, ..Default::default() };
        for frame in 0..=100 {
            let whole = Part { falls_on: frame, share: 1.0 };
            assert_eq!(disturbance.part(frame), disturbance.falls_on(frame).then_some(whole), "frame {frame}");
        }
    }

    #[test]
    fn a_disturbance_over_many_frames_comes_smoothly_and_whole() {
        for over in 1..=10 {
            let disturbance = Disturbance { over, ..Default::default() };
            let shares: Vec<Option<Part>> = (8..23).map(|frame| disturbance.part(frame)).collect();
            let first: Vec<f32> = shares.iter().flatten().filter(|p| p.falls_on == 10).map(|p| p.share).collect();
            assert_eq!(first.len(), over as usize);
            // Each share is rounded to f32.
            assert!((first.iter().sum::<f32>() - 1.0).abs() < over as f32 * 6e-8, "{first:?}");
            // Second differences of the sum are differences of the shares; the second derivative of 3 t^2 - 2 t^3 is at
            // most 6, and t advances by 1 / over.
            let bound = (6.0 / (over * over) as f32).min(1.0) + 1e-6;
            let padded: Vec<f32> = std::iter::once(0.0).chain(first).chain([0.0]).collect();
            assert!(padded.windows(2).all(|w| (w[1] - w[0]).abs() <= bound), "over {over}: {padded:?}");
        }
    }

    #[test]
    fn disturbances_that_overlap_or_take_no_time_are_refused() {
        for over in [0, 11] {
            let refused = Disturbance { over, ..Default::default() }.check().unwrap_err();
            assert_eq!(refused.thing, "disturbance.over");
        }
        for amplitude in [0.0, 3.2, f32::NAN] {
            let refused = Disturbance { amplitude, ..Default::default() }.check().unwrap_err();
            assert_eq!(refused.thing, "disturbance.amplitude");
        }
    }
}
