//! Values over frames, averaged by a bell.

use std::ops::RangeInclusive;

use crate::error::{SettingError, check_range};

/// Deviations of the bell that are taken (frames).
const DEVIATIONS: RangeInclusive<f32> = 0.0..=240.0;

/// Refuses a deviation out of its range; `name` is what the setting is called.
///
/// # Errors
/// Names the setting.
pub fn check(name: &str, deviation: f32) -> Result<(), SettingError> {
    check_range(name, deviation, *DEVIATIONS.start(), *DEVIATIONS.end())
}

/// `values`, one a frame, averaged by a bell of this deviation (frames); beyond either end the last value goes on. With 0 they
/// are as they were. `mean(before, now, after, b)` is (1 - 2 b) now + b before + b after.
pub fn smoothed<T: Copy>(values: &[T], deviation: f64, mean: impl Fn(T, T, T, f64) -> T) -> Vec<T> {
    let mut now = values.to_vec();
    if deviation == 0.0 {
        return now;
    }
    // Parabolas in a row make a bell: the binomial weights of a wide enough row, (1 + x)^(2 k), whose variance is k / 2.
    let rounds = (2.0 * deviation * deviation).ceil().max(1.0);
    // A part of a round keeps the deviation exact: its weights are b, 1 - 2 b, b with variance 2 b.
    let b = deviation * deviation / rounds / 2.0;
    let mut next = now.clone();
    for _ in 0..rounds as u64 {
        for n in 0..now.len() {
            next[n] = mean(now[n.saturating_sub(1)], now[n], now[(n + 1).min(now.len() - 1)], b);
        }
        std::mem::swap(&mut now, &mut next);
    }
    now
}
