//! Locks: neighbouring strands that move together, and how they differ.
//!
//! The lock of a strand depends only on its root, so a preview has the same locks as all the hair.

use glam::{DVec3, IVec3, Vec3};

use crate::chance::Chance;
use crate::settings;

/// The locks of a groom. Their centres are scattered over space, one in each cell of a grid. A strand belongs to the
/// centre nearest to its root.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Locks {
    /// Edge of a cell (cm), about the width of a lock at the scalp.
    pub size: f32,
    /// Seed of the centres and of the random numbers of locks and strands.
    pub seed: u64,
}

impl Default for Locks {
    fn default() -> Self {
        Self { size: 1.2, seed: 0 }
    }
}

/// A lock.
#[derive(Clone, Copy, Debug)]
pub struct Lock {
    /// The centre (head space, cm).
    pub middle: Vec3,
    /// The random numbers of this lock.
    pub chance: Chance,
}

impl Locks {
    /// The lock of a strand that grows from `root`, or leaves its band there (head space, cm).
    pub fn of(&self, root: Vec3) -> Lock {
        let home = (root / self.size).floor().as_ivec3();
        let mut nearest = (f32::INFINITY, Lock { middle: root, chance: Chance::at_cell(self.seed, home) });
        for n in 0..27 {
            let cell = home.saturating_add(IVec3::new(n % 3, n / 3 % 3, n / 9) - 1);
            let chance = Chance::at_cell(self.seed, cell);
            let inside = DVec3::new(chance.unit(100), chance.unit(101), chance.unit(102)).as_vec3();
            let middle = (cell.as_vec3() + inside) * self.size;
            let far = middle.distance_squared(root);
            if far < nearest.0 {
                nearest = (far, Lock { middle, chance });
            }
        }
        nearest.1
    }
}

settings! {
    /// How locks differ, so that they part in the wind instead of moving as one.
    ///
    /// A lock is the hair of a clump of the groom. Its differences are drawn from its place on the head and the seed,
    /// so they are the same in each take. Hair that catches n times as much air is pushed n times as hard by the wind
    /// and settles n times as fast.
    #[derive(Copy)]
    pub struct LockVariation in "free.variation" {
        /// How much locks differ in the air they catch, so that they part in changing wind. It is the standard
        /// deviation of the logarithm: at 0.35, a sixth of the locks catches at least 1.4 times the air, and a sixth at
        /// most 0.7 times.
        pub air: f32 = 0.35 => "Air", least 0.0, most 1.0;
        /// How much the wind on a lock varies by itself. It changes in strength and direction (root mean square, in
        /// radians), in the lock's own rhythm. This is what parts locks in a steady wind.
        pub flutter: f32 = 0.3 => "Flutter", least 0.0, most 0.5;
        /// Approximate number of frames of one flutter.
        pub flutter_frames: f32 = 24.0 => "Flutter period", unit "frames", least 2.0, most 10000.0;
        /// How much locks differ in stiffness: the standard deviation of its logarithm.
        pub stiffness: f32 = 0.2 => "Stiffness", least 0.0, most 1.0;
        /// How much the strands within a lock differ, as a share of how locks differ. Large values fray locks to frizz.
        pub strands: f32 = 0.2 => "Strands", least 0.0, most 1.0;
        /// Share of strands that catch three times as much air.
        pub flyaways: f32 = 0.02 => "Flyaways", least 0.0, most 1.0;
        /// Width of a lock at the scalp. By default that of the groom's clumps, so that clumps are locks, or 1.2 cm for
        /// hair from a file.
        #[serde(skip_serializing_if = "Option::is_none")]
        pub size: Option<f32> = None => "Lock size", unit "cm", least 0.1, most 100.0, open "the groom's clumps";
        /// Random seed. Change it to make other locks catch the wind.
        pub seed: u64 = 0 => "Seed";
    }
}

/// How one strand differs from the settings.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Own {
    /// Factor on the air: on the force of the field and on how fast the strand settles.
    pub air: f64,
    /// Factor on the stiffness.
    pub stiffness: f64,
    /// Factor on the force of the field alone.
    pub wind: f64,
    /// Factor on the weight.
    pub weight: f64,
    /// Factor on the distance that it keeps from bodies.
    pub margin: f64,
    /// How much the wind on the strand varies in strength and direction.
    pub flutter: f64,
    /// The rhythm of that variation: of its strength, and of the three axes of its turns.
    pub(crate) rhythm: [[Wave; 2]; 4],
}

/// A sine over frames.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Wave {
    /// Turns per frame.
    pub frequency: f32,
    /// Its phase in frame 0, in turns.
    pub phase: f32,
}

impl Wave {
    /// Its angle, within half a turn of 0 (rad).
    pub fn angle(self, frame: u32) -> f64 {
        let turns = f64::from(self.frequency) * f64::from(frame) + f64::from(self.phase);
        (turns - turns.round()) * std::f64::consts::TAU
    }
}

impl Default for Own {
    fn default() -> Self {
        let rhythm = [[Wave::default(); 2]; 4];
        Self { air: 1.0, stiffness: 1.0, wind: 1.0, weight: 1.0, margin: 1.0, flutter: 0.0, rhythm }
    }
}

impl Own {
    /// Factor on the air that a flyaway catches, which is the most that any strand does.
    const MOST_AIR: f64 = 3.0;

    /// Factor on the force of the field, before it flutters.
    pub(crate) fn share(&self) -> f64 {
        self.wind * self.air
    }

    /// The effective force of a field's force F in a frame: s (F + b x F), with these s and b.
    pub(crate) fn wind(&self, frame: u32) -> (f64, DVec3) {
        let [swells, turns @ ..] =
            self.rhythm.map(|waves| waves.map(|wave| wave.angle(frame).sin()).iter().sum::<f64>());
        (self.share() * self.flutter.mul_add(swells, 1.0), self.flutter * DVec3::from(turns))
    }

    /// The largest factor on a force.
    pub(crate) fn most_wind(&self) -> f64 {
        let most = 2.0 * self.flutter;
        self.share() * (1.0 + most) * (3.0 * most).mul_add(most, 1.0).sqrt()
    }
}

impl LockVariation {
    /// How the strand with these random numbers differs, in this lock.
    pub fn of(&self, lock: &Lock, strand: Chance) -> Own {
        let [lock, strand] = [lock.chance, strand].map(|chance| chance.again(self.seed));
        let factor = |spread: f32, channel: u64| {
            (f64::from(spread) * (lock.bell(channel) + f64::from(self.strands) * strand.bell(channel))).exp()
        };
        let flies = strand.unit(0) < f64::from(self.flyaways);
        let air = factor(self.air, 1) * if flies { Own::MOST_AIR } else { 1.0 };
        let wave = |i: u64| Wave {
            frequency: ((0.5 + lock.unit(200 + 2 * i)) / f64::from(self.flutter_frames)) as f32,
            phase: lock.unit(201 + 2 * i) as f32,
        };
        Own {
            air: air.min(Own::MOST_AIR),
            stiffness: factor(self.stiffness, 2),
            flutter: self.flutter.into(),
            rhythm: std::array::from_fn(|i| std::array::from_fn(|j| wave(2 * i as u64 + j as u64))),
            ..Own::default()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Over many periods each sine has a mean of 0 and a mean square of 1/2, and they are apart in frequency.
    #[test]
    fn flutter_is_as_strong_as_asked_for_and_never_stronger_than_its_bound() {
        let variation = LockVariation { flutter: 0.3, flutter_frames: 20.0, ..LockVariation::default() };
        let own = variation.of(&Locks::default().of(Vec3::X), Chance::at_point(0, Vec3::X));
        let frames = 100_000;
        let (mut mean, mut square, mut most) = ([0.0; 4], [0.0; 4], 0.0_f64);
        for frame in 0..frames {
            let (scale, turn) = own.wind(frame);
            let of = [scale / own.air - 1.0, turn.x, turn.y, turn.z];
            for i in 0..4 {
                mean[i] += of[i] / f64::from(frames);
                square[i] += of[i] * of[i] / f64::from(frames);
            }
            most = most.max(scale * turn.length_squared().mul_add(1.0, 1.0).sqrt());
        }
        // The sum of a sine over any number of frames is at most that over half a period, 2 / 2 pi f; two frequencies drawn from 1/40 to 3/40
        // beat within some thousand frames.
        for i in 0..4 {
            assert!(mean[i].abs() < 1e-3 && (square[i].sqrt() - 0.3).abs() < 0.01, "{i}: {} {}", mean[i], square[i]);
        }
        assert!(most <= own.most_wind(), "{most}");
    }
}
