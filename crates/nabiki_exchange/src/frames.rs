//! The frames of a motion whose samples may be at any times.

/// Largest number of frames of a motion: three hours.
pub const MOST_FRAMES: usize = 1 << 18;

/// Times apart by no more than this, as a share of a frame, are the same: files round them to a few digits.
const SAME_TIME: f64 = 1e-3;

/// The frames of a motion, in the time unit of its file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Frames {
    /// Times of the frames.
    pub times: Vec<f64>,
    /// Interval between frames; 0 if there is only one.
    pub step: f64,
    /// Number of samples that are not at a frame.
    pub between: usize,
}

impl Frames {
    /// Evenly spaced samples as frames; `None` if they are not evenly spaced.
    pub fn as_sampled(samples: &[f64]) -> Option<Self> {
        let (&first, &last) = (samples.first()?, samples.last()?);
        let step = (last - first) / (samples.len() - 1).max(1) as f64;
        let even = |(n, &time): (usize, &f64)| (time - (first + n as f64 * step)).abs() <= SAME_TIME * step;
        let even = samples.len() == 1 || step > 0.0 && samples.iter().enumerate().all(even);
        even.then(|| Self { times: samples.to_vec(), step, between: 0 })
    }

    /// The whole frames, `step` apart from time 0 on, between the first and the last sample. If there is none between
    /// them, the first sample. `None` for more than [`MOST_FRAMES`].
    pub fn whole(samples: &[f64], step: f64) -> Option<Self> {
        let Some((&first, &last)) = samples.first().zip(samples.last()) else { return Some(Self::default()) };
        let (from, to) = ((first / step - SAME_TIME).ceil(), (last / step + SAME_TIME).floor());
        if to - from >= MOST_FRAMES as f64 {
            return None;
        }
        let count = (to - from + 1.0).max(0.0) as usize;
        // Within the samples, of which rounding may have put the outermost frames out.
        let mut times: Vec<f64> = (0..count).map(|n| ((from + n as f64) * step).max(first).min(last)).collect();
        if times.is_empty() {
            times.push(first);
        }
        let at_frame = |time: &&f64| (**time / step - (**time / step).round()).abs() <= SAME_TIME;
        let met = if count == 0 { 1 } else { samples.iter().filter(at_frame).count() };
        let between = samples.len() - met;
        Some(Self { times, step, between })
    }

    /// Whether whole frames, as counted by [`whole`](Self::whole), are among these.
    pub fn are_whole(&self) -> bool {
        let number = self.times.first().map_or(0.0, |first| first / self.step);
        self.step > 0.0 && (number - number.round()).abs() <= SAME_TIME
    }

    /// Frames per second, where `second` is the length of a second. A rate that is whole up to rounding is returned as
    /// whole.
    pub fn rate(&self, second: f64) -> f64 {
        let rate = second / self.step;
        if (rate - rate.round()).abs() < 1e-9 * rate.round() { rate.round() } else { rate }
    }

    /// Phrases about samples that are not read.
    pub fn unread(&self, second: f64) -> Vec<String> {
        let between = (self.between > 0).then(|| {
            let samples = if self.between == 1 { "1 sample".to_owned() } else { format!("{} samples", self.between) };
            format!("{samples} between frames, at {} frames a second", self.rate(second))
        });
        let first = self.times.first().map_or(0.0, |first| first / self.step);
        let off = (self.times.len() > 1 && !self.are_whole()).then(|| {
            // As many digits as `SAME_TIME` tells apart.
            format!("the time of its samples between frames: {first:.3} is written as frame {}", first.round())
        });
        between.into_iter().chain(off).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn samples_that_files_round_are_frames_as_they_are() {
        let samples: Vec<f64> = (0..5000).map(|n| f64::from((1001 + n) as f32 / 24.0)).collect();
        let frames = Frames::as_sampled(&samples).unwrap();
        assert_eq!((&frames.times, frames.between), (&samples, 0));
        assert_eq!(Frames::as_sampled(&[0.0, 1.0, 2.1]), None);
        assert_eq!(Frames::as_sampled(&[0.0, 0.0]), None);
    }

    #[test]
    fn samples_off_whole_frames_are_said_with_the_frame_as_which_the_first_goes_out() {
        let frames = |first: f64, step: f64| {
            Frames::as_sampled(&[0.0, 1.0, 2.0].map(|n| first + n * step)).unwrap().unread(24.0)
        };
        assert_eq!(frames(1001.5, 1.0), ["the time of its samples between frames: 1001.500 is written as frame 1002"]);
        // Two to a frame are frames themselves.
        assert_eq!(frames(1001.5, 0.5), Vec::<String>::new());
        assert_eq!(frames(1001.0, 1.0), Vec::<String>::new());
        assert_eq!(Frames::as_sampled(&[1001.5]).unwrap().unread(24.0), Vec::<String>::new());
    }

    #[test]
    fn whole_frames_lie_among_the_samples_and_count_those_they_miss() {
        for (samples, times, between) in [
            (&[0.0, 0.25, 1.0, 1.25][..], &[0.0, 1.0][..], 2),
            (&[-0.25, 0.25], &[0.0], 2),
            (&[0.25, 0.5], &[0.25], 1),
            (&[1.0, 4.0, 5.0], &[1.0, 2.0, 3.0, 4.0, 5.0], 0),
            (&[2.0, 1.0], &[2.0], 1),
            (&[], &[], 0),
        ] {
            let frames = Frames::whole(samples, 1.0).unwrap();
            assert_eq!((&frames.times[..], frames.between), (times, between));
        }
        assert_eq!(Frames::whole(&[0.0, 1e9], 1.0), None);
    }
}
