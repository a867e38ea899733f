//! One octave of turbulence: shear waves of random directions (R. H. Kraichnan, "Diffusion by a random velocity field",
//! Physics of Fluids 13, 1970).
//!
//! A wave is v = s(z) e, where z = kappa . p + phase counts wavelengths and e lies across kappa: so its divergence is 0 for
//! any profile s. It is the curl of psi = S(z) (e x kappa) / |kappa|^2 with S' = s. The profile is the parabola that is taken
//! for a sine where a sine is too dear,
//!
//! ```text
//! s(z) = 8 z (1 - 2 |z|),    S(z) = z^2 (4 - 16/3 |z|) - 1/6,    -1/2 <= z <= 1/2
//! ```
//!
//! once and twice continuously differentiable as z goes round. Perlin's noise with its derivatives, on eight vertices or on
//! four, takes two to three times as many operations.

use glam::{DQuat, DVec3};

use super::super::sine::{cos_turns, sin_turns};
use crate::random;
use crate::vector::{add, dot, scale_add};

/// Waves of an octave.
pub(super) const WAVES: usize = 8;

/// Mean of s^2: the integral of 64 z^2 (1 - 2 |z|)^2.
const MEAN_SQUARE: f64 = 8.0 / 15.0;

/// Above the root of the largest s^2 + (6 S)^2, which would be 1 for a sine. The test searches for it.
const LARGEST_PROFILE: f64 = 1.02;

/// Number of pulses after which every wave repeats.
pub(super) const LOOP: f64 = 16.0;

/// Adding it to a number up to 2^22 rounds that to a whole one. Wavelengths are 1.6 times as long as the smallest swirls at least,
/// which settings keep from being so small that more are counted within 600 m.
const ROUND: f32 = 12_582_912.0;

/// A wave without its phase.
#[derive(Clone, Copy, Debug, Default)]
struct Wave {
    /// kappa (wavelengths a cm).
    kappa: [f32; 3],
    /// 8 e, of the wave's strength.
    velocity: [f32; 3],
    /// 4 e x kappa / |kappa|^2.
    potential: [f32; 3],
}

/// The motion of a wave's phase.
#[derive(Clone, Copy, Debug, Default)]
struct Clock {
    kappa: DVec3,
    /// At frame 0.
    phase: f64,
    /// Wavelengths per pulse.
    rate: f64,
}

/// The waves of an octave.
#[derive(Clone, Debug)]
pub(super) struct Octave {
    waves: [Wave; WAVES],
    clocks: [Clock; WAVES],
    /// The constant of S in the potential, summed over all waves.
    constant: [f32; 3],
}

/// Phases of the waves of an octave in one frame.
pub(super) type Phases = [f32; WAVES];

impl Octave {
    /// Waves of half a wavelength about `swirl_size` (cm), that together have the root mean square `strength`, `hurry` times
    /// as fast as the pulse.
    pub fn new(strength: f64, swirl_size: f64, hurry: f64, seed: u64) -> Self {
        let mut counter = seed;
        let mut chance = || {
            counter = counter.wrapping_add(random::GOLDEN_GAMMA);
            random::unit(random::mix(counter))
        };
        let turn = rotation([chance(), chance(), chance()]);
        let amplitude = strength / (MEAN_SQUARE * WAVES as f64).sqrt();
        let mut octave = Self { waves: Default::default(), clocks: Default::default(), constant: [0.0; 3] };
        let mut sum = DVec3::ZERO;
        for m in 0..WAVES {
            // Directions spread evenly over half of the sphere, and turned as a whole: no side is left without a wave.
            let y = (m as f64 + 0.5) / WAVES as f64;
            let azimuth = m as f64 * 0.381_966_011_250_105 + 0.1 * chance();
            let level = (1.0 - y * y).sqrt();
            let (along_azimuth, across_azimuth) = (
                DVec3::new(cos_turns(azimuth), 0.0, sin_turns(azimuth)),
                DVec3::new(-sin_turns(azimuth), 0.0, cos_turns(azimuth)),
            );
            let direction = level * along_azimuth + y * DVec3::Y;
            let upward = level * DVec3::Y - y * along_azimuth;
            let slant = chance();
            let e = turn * (cos_turns(slant) * across_azimuth + sin_turns(slant) * upward) * amplitude;
            let kappa = turn * direction * (0.75 + 0.5 * chance()) / (2.0 * swirl_size);
            let rate = hurry * (9 + 2 * m) as f64 / LOOP;
            octave.clocks[m] = Clock { kappa, phase: chance(), rate: if chance() < 0.5 { rate } else { -rate } };
            let potential = e.cross(kappa) / kappa.length_squared();
            sum += potential;
            octave.waves[m] = Wave {
                kappa: kappa.as_vec3().to_array(),
                velocity: (8.0 * e).as_vec3().to_array(),
                potential: (4.0 * potential).as_vec3().to_array(),
            };
        }
        octave.constant = (sum / -6.0).as_vec3().to_array();
        octave
    }

    /// The phases after this drift of the pattern (cm) and this many pulses.
    pub fn phases(&self, drifted: DVec3, pulses: f64) -> Phases {
        self.clocks.map(|clock| {
            let phase = clock.phase + clock.rate * pulses - clock.kappa.dot(drifted);
            (phase - phase.round()) as f32
        })
    }

    /// Bound on |ramp v + grad ramp x psi|, where `slope` bounds |grad ramp| / (1 - x^2)^2.
    ///
    /// For each wave this is at most the root of (ramp |e|)^2 + (slope (1 - x^2)^2 |e x kappa| / 6 |kappa|^2)^2, times that of
    /// s^2 + (6 S)^2; and ramp^2 + (1 - x^2)^4 is at most 1.
    pub fn largest(&self, slope: f64) -> f64 {
        let length = |vector: [f32; 3]| DVec3::from_array(vector.map(f64::from)).length();
        let of_wave = |wave: &Wave| (length(wave.velocity) / 8.0).max(slope * length(wave.potential) / 24.0);
        LARGEST_PROFILE * self.waves.iter().map(of_wave).sum::<f64>()
    }

    /// Adds velocity and potential at a point (cm).
    #[allow(
        clippy::needless_range_loop,
        reason = "a count known beforehand, so that the loop is unrolled within a lane"
    )]
    #[inline(always)]
    pub fn add(&self, phases: &Phases, p: [f32; 3], velocity: &mut [f32; 3], potential: &mut [f32; 3]) {
        *potential = add(*potential, self.constant);
        for m in 0..WAVES {
            let wave = &self.waves[m];
            let turns = dot(wave.kappa, p) + phases[m];
            let z = turns - ((turns + ROUND) - ROUND);
            let size = z.abs();
            // s / 8 = z - 2 z |z| and (S + 1/6) / 4 = z^2 - 4/3 z^2 |z|.
            let square = z * size;
            let s = square.mul_add(-2.0, z);
            let big_s = (size * (-4.0 / 3.0)).mul_add(square.abs(), square.abs());
            *velocity = scale_add(s, wave.velocity, *velocity);
            *potential = scale_add(big_s, wave.potential, *potential);
        }
    }
}

/// A rotation drawn evenly from all, by three numbers in 0..1 (K. Shoemake, "Uniform random rotations", 1992).
fn rotation([a, b, c]: [f64; 3]) -> DQuat {
    let (r, s) = ((1.0 - a).sqrt(), a.sqrt());
    DQuat::from_xyzw(sin_turns(b) * r, cos_turns(b) * r, sin_turns(c) * s, cos_turns(c) * s)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_profile_and_the_ramp_are_as_large_as_the_bound_has_them() {
        // Slopes of both are below 64: between two of the places looked at they rise by no more than 64 / 20,000 / 2.
        let looked_at = |i: u32| f64::from(i) / 20_000.0;
        for i in 0..=10_000 {
            let z = looked_at(i);
            let (s, big_s) = (8.0 * z * (1.0 - 2.0 * z), z * z * (4.0 - 16.0 / 3.0 * z) - 1.0 / 6.0);
            assert!(s * s + 36.0 * big_s * big_s + 0.0016 < LARGEST_PROFILE * LARGEST_PROFILE, "{z}");
        }
        for i in 0..=20_000 {
            let x = looked_at(i);
            let ramp = x * (1.875 - x * x * (1.25 - 0.375 * x * x));
            // 1 at both ends, and less between: 1 - x^2 / 2 near 0.
            assert!(ramp * ramp + (1.0 - x * x).powi(4) <= 1.0 + 1e-15, "{x}");
        }
    }
}
