//! Sines and roots of our own, so that a field has the same bits on every machine.

/// cos(2 pi x), to rounding.
pub(super) fn cos_turns(x: f64) -> f64 {
    let r = (x - x.round()).abs();
    let (r, sign) = if r > 0.25 { (0.5 - r, -1.0) } else { (r, 1.0) };
    let y = std::f64::consts::TAU * r;
    // The series up to y^20; the next term is (pi / 2)^22 / 22! < 2e-17.
    let mut sum = 0.0;
    for k in (1..=10).rev() {
        sum = (1.0 + sum) * -(y * y) / f64::from((2 * k) * (2 * k - 1));
    }
    sign * (1.0 + sum)
}

/// sin(2 pi x), to rounding.
pub(super) fn sin_turns(x: f64) -> f64 {
    cos_turns(x - 0.25)
}

/// The cube root of a number of at least 0, to rounding.
pub(super) fn cube_root(x: f64) -> f64 {
    if x <= 0.0 {
        return 0.0;
    }
    // A third of the exponent, right to 6 %; each step squares the error.
    let mut y = f64::from_bits(x.to_bits() / 3 + 0x2a9f_7893_0000_0000);
    for _ in 0..5 {
        y = (2.0 * y + x / (y * y)) / 3.0;
    }
    y
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    #[test]
    fn they_are_the_functions_that_their_names_say() {
        for i in -400..400 {
            let x = f64::from(i) / 97.0;
            // The library's argument is rounded: 2 pi x to 2^-53 of itself, and so is the answer.
            let tolerance = 4.0 * f64::EPSILON * (1.0 + (TAU * x).abs());
            assert!((cos_turns(x) - (TAU * x).cos()).abs() < tolerance, "{x}");
            assert!((sin_turns(x) - (TAU * x).sin()).abs() < tolerance, "{x}");
        }
        assert_eq!([cos_turns(0.0), cos_turns(0.5), sin_turns(0.25)], [1.0, -1.0, 1.0]);
        for exponent in -30..30 {
            let x = 1.7 * 10.0_f64.powi(exponent);
            assert!((cube_root(x).powi(3) / x - 1.0).abs() < 8.0 * f64::EPSILON);
        }
        assert_eq!(cube_root(0.0), 0.0);
    }
}
