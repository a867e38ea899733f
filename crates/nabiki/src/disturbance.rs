//! Small random disturbances of the hair every so many frames, section 4.4 (the running scene).

use serde::{Deserialize, Serialize};

use crate::error::{SettingError, check_positive};
use crate::random::mix;

/// Turns every strand a little, at random, every so many frames.
///
/// The paper names neither its size nor its law. Here a strand is given one random turn of theta and one of phi,
/// uniform within `amplitude` at the tip and falling to nothing at the root, so that it stays a smooth curve; the
/// segments' speeds are left alone. The numbers depend on seed, strand and frame only.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields, default)]
pub struct Disturbance {
    /// Frames from one disturbance to the next (at least 1). The paper: 10; every frame would be too much.
    pub every: u32,
    /// First frame that may be disturbed (frames). The paper disturbs the last 60 of 100.
    pub from: u32,
    /// Largest turn at the tip (rad).
    pub amplitude: f32,
    /// Seed of the random numbers.
    pub seed: u64,
}

impl Default for Disturbance {
    fn default() -> Self {
        Self { every: 10, from: 1, amplitude: 0.03, seed: 1 }
    }
}

impl Disturbance {
    /// Refuses `every = 0` and amplitudes that are not above 0.
    pub fn check(&self) -> Result<(), SettingError> {
        if self.every == 0 {
            return Err(SettingError::new("disturbance.every", 0, "must be at least 1 frame"));
        }
        check_positive("disturbance.amplitude", self.amplitude)
    }

    /// Whether the hair is disturbed on arriving at this frame.
    pub fn falls_on(&self, frame: u32) -> bool {
        frame >= self.from && frame.is_multiple_of(self.every)
    }

    /// The turns (theta, phi) of strand `id`'s tip at this frame, each within `amplitude` (rad).
    pub fn turn(&self, id: u32, frame: u32) -> [f32; 2] {
        let key = mix(self.seed ^ mix((u64::from(id) << 32) | u64::from(frame)));
        [key, mix(key)].map(|bits| {
            let unit = (bits >> 40) as f32 / (1u64 << 24) as f32;
            self.amplitude * (2.0 * unit - 1.0)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn turns_are_uniform_within_the_amplitude_and_differ_by_strand_frame_and_seed() {
        let disturbance = Disturbance { amplitude: 0.5, ..Default::default() };
        let turns: Vec<f32> = (0..10_000).flat_map(|id| disturbance.turn(id, 40)).collect();
        assert!(turns.iter().all(|t| t.abs() <= 0.5));
        let mean = turns.iter().sum::<f32>() / turns.len() as f32;
        let variance = turns.iter().map(|t| t * t).sum::<f32>() / turns.len() as f32;
        // Uniform on +-a: deviation a / sqrt 3; five standard errors of the mean and of the variance of 20,000.
        let standard_error = 0.5 / (3.0 * turns.len() as f32).sqrt();
        assert!(mean.abs() < 5.0 * standard_error, "{mean}");
        let variance_error = 0.25 * (4.0 / 45.0 / turns.len() as f32).sqrt();
        assert!((variance - 0.25 / 3.0).abs() < 5.0 * variance_error, "{variance}");
        assert_ne!(disturbance.turn(1, 40), disturbance.turn(2, 40));
        assert_ne!(disturbance.turn(1, 40), disturbance.turn(1, 50));
        assert_ne!(disturbance.turn(1, 40), Disturbance { seed: 2, ..disturbance.clone() }.turn(1, 40));
    }

    #[test]
    fn it_falls_on_every_tenth_frame_from_its_first_on() {
        let disturbance = Disturbance { from: 41, ..Default::default() };
        let frames: Vec<u32> = (0..=100).filter(|&n| disturbance.falls_on(n)).collect();
        assert_eq!(frames, [50, 60, 70, 80, 90, 100]);
    }
}
