//! Random numbers that do not depend on the order of drawing. Each is a hash of a seed, a place and a channel.

use glam::{DVec3, IVec3, Vec3};

use crate::random::{GOLDEN_GAMMA, finalise, unit};

/// The random numbers of one place, usually a root. They do not depend on the other strands.
#[derive(Clone, Copy, Debug)]
pub struct Chance(u64);

fn hash(seed: u64, words: [u32; 3]) -> u64 {
    let word = |h: u64, &word: &u32| finalise(h.wrapping_add(GOLDEN_GAMMA) ^ (u64::from(word) << 17));
    words.iter().fold(finalise(seed ^ GOLDEN_GAMMA), word)
}

impl Chance {
    /// The random numbers of a point, from the bits of its coordinates.
    pub fn at_point(seed: u64, p: Vec3) -> Self {
        // Adding 0 turns -0 into 0.
        Self(hash(seed, (p + 0.0).to_array().map(f32::to_bits)))
    }

    /// The random numbers of a grid cell.
    pub fn at_cell(seed: u64, cell: IVec3) -> Self {
        Self(hash(seed.wrapping_add(1), cell.to_array().map(|i| i as u32)))
    }

    /// The same place under another seed.
    #[must_use]
    pub fn again(self, seed: u64) -> Self {
        Self(finalise(self.0 ^ seed.wrapping_mul(GOLDEN_GAMMA)))
    }

    /// Uniform in 0..1, one number per channel.
    pub fn unit(self, channel: u64) -> f64 {
        unit(finalise(self.0.wrapping_add(channel.wrapping_mul(0xD134_2543_DE82_EF95))))
    }

    /// Bell-shaped (the sum of three uniform draws), mean 0, standard deviation 1, within -3..3.
    pub fn bell(self, channel: u64) -> f64 {
        let draw = |i| self.unit(3 * channel + 1_000 + i);
        2.0 * (draw(0) + draw(1) + draw(2)) - 3.0
    }

    /// A vector of three bell-shaped components.
    pub fn vector(self, channel: u64) -> DVec3 {
        DVec3::new(self.bell(3 * channel + 500), self.bell(3 * channel + 501), self.bell(3 * channel + 502))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn draws_are_uniform_and_bell_shaped() {
        let n = 20_000;
        let places = (0..n).map(|i| Chance::at_point(7, Vec3::new(i as f32 * 0.01, 1.0, -2.0)));
        let (mut mean, mut bell, mut square) = (0.0, 0.0, 0.0);
        for c in places {
            mean += c.unit(0) / f64::from(n);
            bell += c.bell(3) / f64::from(n);
            square += c.bell(3).powi(2) / f64::from(n);
        }
        // Standard errors: 0.29, 1 and 1 (fourth moment of three uniforms: 2.6) over sqrt(n), times four.
        assert!((mean - 0.5).abs() < 0.009, "{mean}");
        assert!(bell.abs() < 0.03, "{bell}");
        assert!((square - 1.0).abs() < 0.04, "{square}");
    }

    #[test]
    fn places_seeds_and_channels_are_apart() {
        let at = |seed, x, channel| Chance::at_point(seed, Vec3::new(x, 0.0, 0.0)).unit(channel);
        assert_eq!(at(1, 0.0, 2), at(1, -0.0, 2));
        let draws = [at(1, 0.0, 2), at(1, 0.0, 3), at(2, 0.0, 2), at(1, 1e-6, 2)];
        for (i, a) in draws.iter().enumerate() {
            assert!(draws[..i].iter().all(|b| (a - b).abs() > 1e-6), "{draws:?}");
        }
    }
}
