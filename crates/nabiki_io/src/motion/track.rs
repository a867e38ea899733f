//! Poses at the times of a file, and interpolation between them.

use glam::{DQuat, DVec3};

use super::source::Interpolation;
use crate::axis::Axis;
use crate::error::{Error, Result};

/// The pose of a joint in its file's world and unit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample {
    /// Position (file's unit).
    pub position: DVec3,
    /// Rotation from its rest pose (unit quaternion).
    pub rotation: DQuat,
}

/// Samples of one joint over time.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Track {
    /// Times (s), ascending, one per sample.
    pub times: Vec<f64>,
    /// The samples.
    pub samples: Vec<Sample>,
    /// What the samples belong to, for the report: "joint Head".
    pub what: String,
    /// The part of the joint's transform that the samples do not include, for the report.
    pub left_out: Option<&'static str>,
    /// The number of frames that were read, if the file declares another number, for the report.
    pub unlike: Option<String>,
    /// The pose of the joint when meshes were bound to it, if the file has it.
    pub bound: Option<Sample>,
    /// Length of the file's unit (cm), if declared.
    pub unit_cm: Option<f64>,
    /// Up axis, if declared.
    pub up: Option<Axis>,
}

impl Track {
    /// Refuses times that do not grow.
    pub(super) fn check_times(&self) -> Result<()> {
        let grows = |w: &[f64]| w[0] < w[1] && w[0].is_finite() && w[1].is_finite();
        match self.times.windows(2).position(|w| !grows(w)) {
            None => Ok(()),
            Some(i) => {
                let (a, b) = (self.times[i], self.times[i + 1]);
                Err(Error::new(format!("sample {}: time {b} s follows {a} s, but times must increase", i + 1)))
            }
        }
    }

    /// The pose at `time`, which lies between sample `key` and the next, or beyond the end by rounding.
    pub(super) fn at(&self, key: usize, time: f64, positions: Interpolation) -> Sample {
        let (t, s) = (&self.times, &self.samples);
        if key + 1 >= s.len() {
            return s[key];
        }
        let span = t[key + 1] - t[key];
        let u = ((time - t[key]) / span).clamp(0.0, 1.0);
        let (p0, p1) = (s[key].position, s[key + 1].position);
        let position = match positions {
            Interpolation::Linear => p0.lerp(p1, u),
            Interpolation::Cubic => {
                let (m0, m1) = (self.velocity(key), self.velocity(key + 1));
                hermite(p0, m0 * span, p1, m1 * span, u)
            }
        };
        Sample { position, rotation: s[key].rotation.slerp(s[key + 1].rotation, u) }
    }

    /// Velocity at sample `i` (file's unit a second): slope of the parabola through it and its neighbours, which
    /// makes the cubic exact for uniform acceleration.
    fn velocity(&self, i: usize) -> DVec3 {
        let (t, s) = (&self.times, &self.samples);
        let last = s.len() - 1;
        if last < 2 {
            return (s[last].position - s[0].position) / (t[last] - t[0]).max(f64::MIN_POSITIVE);
        }
        let j = i.clamp(1, last - 1);
        let (before, after) = (t[j] - t[j - 1], t[j + 1] - t[j]);
        let slope_before = (s[j].position - s[j - 1].position) / before;
        let slope_after = (s[j + 1].position - s[j].position) / after;
        let bend = (slope_after - slope_before) / (before + after);
        slope_before + bend * (before + 2.0 * (t[i] - t[j]))
    }
}

/// The cubic with the values `p0`, `p1` and the derivatives `m0`, `m1` (by u) at u = 0 and 1.
pub(super) fn hermite(p0: DVec3, m0: DVec3, p1: DVec3, m1: DVec3, u: f64) -> DVec3 {
    let (u2, u3) = (u * u, u * u * u);
    p0 * (2.0 * u3 - 3.0 * u2 + 1.0) + m0 * (u3 - 2.0 * u2 + u) + p1 * (3.0 * u2 - 2.0 * u3) + m1 * (u3 - u2)
}
