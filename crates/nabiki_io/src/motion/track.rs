//! Poses at the times a file gives them, and those between.

use glam::{DQuat, DVec3};

use super::{Door, HeadMotion, Interpolation, MotionSource, frame_count, poses};
use crate::error::{Error, Result};
use crate::info::Short;

/// A joint in its file's own world and unit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample {
    /// Where it is (file's unit).
    pub position: DVec3,
    /// How it is turned from its unturned pose (unit quaternion).
    pub rotation: DQuat,
}

/// Samples of one joint over time.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Track {
    /// Times (s), growing, one for each sample.
    pub times: Vec<f64>,
    /// The samples.
    pub samples: Vec<Sample>,
    /// What the samples are, for the report: "joint Head".
    pub what: String,
    /// Length of the file's unit (cm) where the file says it.
    pub unit_cm: Option<f64>,
    /// Up axis where the file says it.
    pub up: Option<super::Axis>,
}

impl Track {
    /// The head's poses at `frame_rate` frames a second, in the scene's world.
    ///
    /// # Errors
    /// No sample left after `source.skip`, times that do not grow, a unit or axis that nobody gives.
    pub fn head_motion(mut self, source: &MotionSource, frame_rate: f64) -> Result<HeadMotion> {
        let named = |e: Error| e.in_file(&source.file);
        if source.skip >= self.samples.len() {
            let problem = format!("skip = {}: the file has {} samples", source.skip, self.samples.len());
            return Err(named(Error::new(problem)));
        }
        self.times.drain(..source.skip);
        self.samples.drain(..source.skip);
        if let Some(i) = self.times.windows(2).position(|w| !(w[0] < w[1] && w[0].is_finite() && w[1].is_finite())) {
            let (a, b) = (self.times[i], self.times[i + 1]);
            let problem = format!("sample {}: time {b} s follows {a} s, but times must grow", i + 1);
            return Err(named(Error::new(problem)));
        }
        let door = Door::new(source.unit_cm.or(self.unit_cm), source.up.or(self.up), source.facing).map_err(named)?;
        let duration = self.times[self.times.len() - 1] - self.times[0];
        let frames = frame_count(duration, frame_rate).map_err(named)?;
        let mut key = 0;
        let samples = (0..frames).map(|n| {
            let time = self.times[0] + n as f64 / frame_rate;
            while key + 2 < self.times.len() && self.times[key + 1] <= time {
                key += 1;
            }
            self.at(key, time, source.positions)
        });
        let poses = poses(&door, samples, source.start_at_origin).map_err(named)?;
        let rate = (self.times.len() - 1) as f64 / duration.max(f64::MIN_POSITIVE);
        let report = format!(
            "{}: {}, {} samples at {} Hz ({:.3} s) -> {} frames at {} Hz (positions {}, rotations slerp; unit {} cm, \
             up {}, face {})",
            source.file.display(),
            self.what,
            self.times.len(),
            Rate(rate),
            duration,
            frames,
            Rate(frame_rate),
            match source.positions {
                Interpolation::Linear => "linear",
                Interpolation::Cubic => "cubic",
            },
            Short(door.unit_cm as f32),
            door.up,
            door.facing,
        );
        Ok(HeadMotion { frame_rate, poses, report })
    }

    /// The pose at `time`, which lies between sample `key` and the next, or beyond the end by rounding.
    fn at(&self, key: usize, time: f64, positions: Interpolation) -> Sample {
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

/// A rate for reading: at most four decimals, and none that say nothing.
struct Rate(f64);

impl std::fmt::Display for Rate {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let text = format!("{:.4}", self.0);
        f.write_str(text.trim_end_matches('0').trim_end_matches('.'))
    }
}
