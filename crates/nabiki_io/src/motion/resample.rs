//! Resamples the samples of a file to the frames of a scene.

use super::source::{Interpolation, MotionSource};
use super::track::Track;
use super::world::{HeadMotion, WorldFromFile, frame_count, pose_of, poses};
use crate::error::{Error, Result};
use crate::exchange;
use crate::short::Short;

impl Track {
    /// The head's poses at `frame_rate` frames per second, in the scene's world.
    ///
    /// # Errors
    /// If no sample is left after `source.skip`, times do not increase, or a unit or axis is not given.
    pub fn head_motion(mut self, source: &MotionSource, frame_rate: f64) -> Result<HeadMotion> {
        let named = |e: Error| e.in_file(&source.file);
        if self.samples.is_empty() {
            return Err(named(Error::new("has no samples, only its header")));
        }
        if source.skip >= self.samples.len() {
            let problem = format!("skip = {}: the file has {} samples", source.skip, self.samples.len());
            return Err(named(Error::new(problem)));
        }
        self.times.drain(..source.skip);
        self.samples.drain(..source.skip);
        self.check_times().map_err(named)?;
        let (unit_cm, up) = (source.unit_cm.or(self.unit_cm), source.up.or(self.up));
        let world_from_file = WorldFromFile::new(unit_cm, up, source.facing).map_err(named)?;
        let duration = self.times[self.times.len() - 1] - self.times[0];
        let frames = frame_count(duration, frame_rate / source.speed).map_err(named)?;
        let mut key = 0;
        let samples = (0..frames).map(|n| {
            let time = self.times[0] + n as f64 / (frame_rate / source.speed);
            while key + 2 < self.times.len() && self.times[key + 1] <= time {
                key += 1;
            }
            self.at(key, time, source.positions)
        });
        let poses = poses(&world_from_file, samples, source).map_err(named)?;
        let bound = self.bound.map(|bound| pose_of(world_from_file.pose(bound)));
        let rate = (self.times.len() - 1) as f64 / duration.max(f64::MIN_POSITIVE);
        let of_shot = (exchange::is_usd(&source.file) || exchange::is_alembic(&source.file)) && source.speed == 1.0;
        let first_frame = of_shot.then(|| (self.times[0] * frame_rate).round() as i32);
        let shot = first_frame.filter(|&first| first != 0);
        let shot = shot.map_or_else(String::new, |first| format!(" from frame {first} of the shot on"));
        let report = format!(
            "{}: {}, {} samples at {} Hz ({:.3} s) -> {} frames at {} Hz{shot}{} (positions {}, rotations slerp; unit {} cm, \
             up {}, face {}){}{}",
            source.file.display(),
            self.what,
            self.times.len(),
            Rate(rate),
            duration,
            frames,
            Rate(frame_rate),
            source.changes(),
            match source.positions {
                Interpolation::Linear => "linear",
                Interpolation::Cubic => "cubic",
            },
            Short(world_from_file.unit_cm as f32),
            world_from_file.up,
            world_from_file.facing,
            self.left_out.map_or_else(String::new, |what| format!("; ignored: {what}")),
            self.unlike.as_ref().map_or_else(String::new, |unlike| format!("; {unlike}")),
        );
        let times = [self.times[0], source.speed / frame_rate];
        Ok(HeadMotion { frame_rate, poses, bound, times, first_frame, report })
    }
}

/// A rate for reading: at most four decimals, and none that say nothing.
struct Rate(f64);

impl std::fmt::Display for Rate {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let text = format!("{:.4}", self.0);
        f.write_str(text.trim_end_matches('0').trim_end_matches('.'))
    }
}
