//! Smoothing: of values over frames with a bell, and of a rise from 0 to 1.

/// Largest standard deviation of the bell (frames).
pub const MOST: f32 = 240.0;

/// From this deviation on (steps), a bell is smooth enough to widen by steps twice as long: it has weakened what these
/// would leave at a step's own wavelength by exp(-8 pi^2).
const SMOOTH: f64 = 4.0;

/// A smooth rise from 0 to 1 for t in 0..1, level at both ends: 3 t^2 - 2 t^3.
pub(crate) fn rise(t: f64) -> f64 {
    t * t * (3.0 - 2.0 * t)
}

/// Smooths `values`, one per frame, with a bell of this standard deviation (frames). Beyond both ends, values are
/// mirrored. A deviation of 0 returns them unchanged. `mean(before, now, after, b)` is (1 - 2 b) now + b before + b
/// after.
pub fn smoothed<T: Copy>(values: &[T], deviation: f64, mean: impl Fn(T, T, T, f64) -> T) -> Vec<T> {
    let mut now = values.to_vec();
    if deviation == 0.0 {
        return now;
    }
    let (mut next, mirrored) = (now.clone(), Mirrored { count: values.len() as i64 });
    let (mut done, mut step) = (0.0, 1);
    // With one round per squared frame, a wide bell would take hours.
    while done < deviation {
        let wide = deviation.min(SMOOTH * step as f64);
        // In steps squared. A sequence of parabolas makes a bell: the binomial weights of a long one, (1 + x)^(2 k),
        // have variance k / 2.
        let variance = (wide * wide - done * done) / (step * step) as f64;
        let rounds = (2.0 * variance).ceil().max(1.0);
        // A fractional round makes the deviation exact: its weights are b, 1 - 2 b, b with variance 2 b.
        let b = variance / rounds / 2.0;
        for _ in 0..rounds as u64 {
            for n in 0..now.len() {
                let beside = |by: i64| now[mirrored.at(n as i64 + by)];
                next[n] = mean(beside(-step), now[n], beside(step), b);
            }
            std::mem::swap(&mut now, &mut next);
        }
        (done, step) = (wide, 2 * step);
    }
    now
}

/// Values beyond both ends mirror those inside.
struct Mirrored {
    count: i64,
}

impl Mirrored {
    fn at(&self, n: i64) -> usize {
        let n = n.rem_euclid(2 * self.count);
        n.min(2 * self.count - 1 - n) as usize
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn mean(before: f64, now: f64, after: f64, b: f64) -> f64 {
        now + b * (before - now + (after - now))
    }

    #[test]
    fn an_impulse_becomes_a_bell_of_its_deviation_however_wide() {
        for deviation in [2.5, 4.0, 9.7, 60.0, 500.0_f64] {
            let half = (8.0 * deviation).ceil() as usize;
            let mut impulse = vec![0.0; 2 * half + 1];
            impulse[half] = 1.0;
            let bell = smoothed(&impulse, deviation, mean);
            let moment =
                |k: i32| -> f64 { bell.iter().enumerate().map(|(n, w)| w * (n as f64 - half as f64).powi(k)).sum() };
            assert!((moment(0) - 1.0).abs() < 1e-9 && moment(1).abs() < 1e-9 * deviation, "{deviation}");
            assert!((moment(2) / (deviation * deviation) - 1.0).abs() < 1e-9, "{deviation}");
            // k rounds have the excess kurtosis -1 / k at most, and miss the peak by an eighth of that; the first stage
            // has at least twelve.
            let peak = 1.0 / (deviation * std::f64::consts::TAU.sqrt());
            for (n, weight) in bell.iter().enumerate() {
                let x = (n as f64 - half as f64) / deviation;
                assert!((weight - peak * (-0.5 * x * x).exp()).abs() < peak / (8.0 * 12.0), "{deviation}: {n}");
            }
        }
    }

    #[test]
    fn the_mean_of_all_stays_and_a_bell_wider_than_all_leaves_little_else() {
        let values: Vec<f64> = (0..37).map(|n| f64::from(n * n % 23)).collect();
        let whole = values.iter().sum::<f64>() / 37.0;
        for deviation in [0.7, 5.0, 1e5] {
            let smooth = smoothed(&values, deviation, mean);
            assert!((smooth.iter().sum::<f64>() / 37.0 - whole).abs() < 1e-9, "{deviation}");
            if deviation > 1e4 {
                assert!(smooth.iter().all(|x| (x - whole).abs() < 1e-9));
            }
        }
    }
}
