//! Sine and cosine of f32 angles, branch-free, with the same bits on every machine.
//!
//! The platform's own functions differ between platforms and keep loops from being vectorised.

/// 1.5 * 2^23: added to a small number, it rounds it to an integer that its low bits then hold.
const ROUND: f32 = 12_582_912.0;
// pi / 2 in two parts; with a fused multiply-add the first product is exact, so two parts are enough.
const HALF_PI_HIGH: f32 = std::f32::consts::FRAC_PI_2;
const HALF_PI_LOW: f32 = -4.371_139e-8;

/// (sin x, cos x), each within 1.5e-7 for |x| <= 1000 rad.
///
/// The polynomials are least-maximum fits on -pi/4..pi/4, within 2e-9 before rounding.
#[inline(always)]
pub(super) fn sin_cos(x: f32) -> (f32, f32) {
    let rounded = x.mul_add(std::f32::consts::FRAC_2_PI, ROUND);
    let quadrant = rounded.to_bits();
    let turns = rounded - ROUND;
    let r = turns.mul_add(-HALF_PI_LOW, turns.mul_add(-HALF_PI_HIGH, x));
    let r2 = r * r;
    let sin = r2.mul_add(-0.000_194_948_57, 0.008_331_972).mul_add(r2, -0.166_666_5);
    let sin = (r * r2).mul_add(sin, r);
    let cos = r2.mul_add(2.443_761_4e-5, -0.001_388_736).mul_add(r2, 0.041_666_646);
    let cos = (r2 * r2).mul_add(cos, r2.mul_add(-0.5, 1.0));
    let swap = quadrant & 1 != 0;
    let (s, c) = if swap { (cos, sin) } else { (sin, cos) };
    let sign = |value: f32, flip: u32| f32::from_bits(value.to_bits() ^ ((flip & 2) << 30));
    (sign(s, quadrant), sign(c, quadrant.wrapping_add(1)))
}

#[cfg(test)]
mod tests {
    use super::sin_cos;

    #[test]
    fn within_an_ulp_or_so_of_the_f64_functions() {
        for i in -2_000_000..=2_000_000 {
            let x = i as f32 * 0.0005;
            let (sin, cos) = sin_cos(x);
            let error = (f64::from(sin) - f64::from(x).sin()).abs().max((f64::from(cos) - f64::from(x).cos()).abs());
            // Near 1 a result is rounded to within 6e-8; evaluation and the reduced argument add about as much again.
            assert!(error < 1.5e-7, "{x}: {error}");
        }
    }

    #[test]
    fn odd_and_even() {
        for i in 0..100_000 {
            let x = i as f32 * 0.00137;
            let ((s, c), (sm, cm)) = (sin_cos(x), sin_cos(-x));
            assert_eq!((s, c), (-sm, cm), "{x}");
        }
    }
}
