//! An angle that is carried as its sine and cosine, and turned by its increment.
//!
//! Carried so, an angle loses nothing by growing: a strand that has swung round a hundred times is as exact as at rest,
//! and its sines are at hand when the next frame begins.

use crate::dynamics::trigonometry::sin_cos;

/// The largest turn that the short polynomials of [`turn_little`] are made for (rad).
const LITTLE: f32 = 1.0 / 3.0;

/// How far sin^2 + cos^2 may drift from 1 before the next turn corrects it. Twice the rounding error of an exact pair,
/// so that hair at rest does not change.
const DRIFT: f32 = 2e-7;

/// (sin, cos) of an angle.
pub(super) type Turn = [f32; 2];

/// Whether an angle is too large for [`turn_little`].
#[inline(always)]
pub(super) fn is_far(angle: f32) -> bool {
    angle * angle > LITTLE * LITTLE
}

/// The pair of the angle plus `angle`, exact only within -[`LITTLE`]..[`LITTLE`] (3e-9 before rounding). For an angle
/// of 0, a pair that has not drifted keeps its bits.
#[inline(always)]
pub(super) fn turn_little([sin, cos]: Turn, angle: f32) -> Turn {
    let square = angle * angle;
    let s = (angle * square).mul_add(square.mul_add(0.008_300_574, -0.166_665_4), angle);
    // cos(angle) - 1 keeps the digits that the 1 would cost, and includes the drift of the pair. That of s, at most a
    // third of it, is below rounding. The drift is known long before the angle, so nothing waits for it.
    let c = square.mul_add(square.mul_add(square.mul_add(-0.001_384_600_4, 0.041_666_49), -0.5), drift([sin, cos]));
    [cos.mul_add(s, sin.mul_add(c, sin)), sin.mul_add(-s, cos.mul_add(c, cos))]
}

/// The same for angles of up to 1000 rad, within 2e-7.
#[inline(always)]
pub(super) fn turn_far([sin, cos]: Turn, angle: f32) -> Turn {
    let share = drift([sin, cos]);
    let (sin, cos) = (share.mul_add(sin, sin), share.mul_add(cos, cos));
    let (s, c) = sin_cos(angle);
    [cos.mul_add(s, sin * c), sin.mul_add(-s, cos * c)]
}

/// The relative error of a pair's length against 1, by one step of Newton's method; 0 if it has not drifted.
#[inline(always)]
fn drift([sin, cos]: Turn) -> f32 {
    let excess = sin.mul_add(sin, cos.mul_add(cos, -1.0));
    if excess.abs() > DRIFT { -0.5 * excess } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pair(angle: f64) -> Turn {
        [angle.sin() as f32, angle.cos() as f32]
    }

    fn distance(turn: Turn, angle: f64) -> f64 {
        (f64::from(turn[0]) - angle.sin()).hypot(f64::from(turn[1]) - angle.cos())
    }

    #[test]
    fn a_turn_is_the_sum_of_the_angles() {
        for i in -3000..=3000 {
            let start = f64::from(i) * 0.0021;
            for angle in [LITTLE, -LITTLE, 0.1, -0.01, 3e-5, -1e-9] {
                // Both parts rounded before and after, 3e-8 each, and the polynomials' 3e-9.
                let error = distance(turn_little(pair(start), angle), start + f64::from(angle));
                assert!(error < 1.5e-7, "{start} + {angle}: {error}");
            }
            for angle in [0.4_f32, -2.0, 7.0, -100.0] {
                // The sine and cosine of the turn are within 1.5e-7 each.
                let error = distance(turn_far(pair(start), angle), start + f64::from(angle));
                assert!(error < 4e-7, "{start} + {angle}: {error}");
            }
        }
    }

    #[test]
    fn turning_by_nothing_keeps_every_bit() {
        for i in 0..100_000 {
            let start = pair(f64::from(i) * 1e-3);
            assert_eq!(turn_little(start, 0.0), start);
        }
    }

    #[test]
    fn a_million_turns_keep_the_length_and_lose_the_angle_by_no_more_than_their_roundings() {
        let (mut turn, mut far, mut angle) = (pair(0.3), pair(0.3), 0.3_f64);
        for i in 0..1_000_000 {
            let step = 0.1 * (i as f32 * 0.01).sin();
            turn = turn_little(turn, step);
            far = turn_far(far, 3.0 + step);
            angle += f64::from(step);
            let length = |turn: Turn| f64::from(turn[0]).hypot(f64::from(turn[1]));
            // Half of DRIFT, and the roundings of one turn: of its sine and cosine too where it is far.
            assert!((length(turn) - 1.0).abs() < 2e-7, "turn {i}: length {}", length(turn));
            assert!((length(far) - 1.0).abs() < 3.5e-7, "far turn {i}: length {}", length(far));
        }
        // A million errors of at most 6e-8, independent: a random walk is 6e-5 long. The polynomials' own 3e-9 per turn
        // may add up to 3e-3.
        assert!(distance(turn, angle) < 3.1e-3, "{}", distance(turn, angle));
    }
}
