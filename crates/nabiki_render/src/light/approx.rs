//! Elementary functions without branches, so that loops over many nodes become vector code and give the same bits on
//! every machine.

/// 1.5 * 2^23: added to a number it leaves the nearest whole one in the low bits.
const SHIFT: f32 = 12_582_912.0;

/// e^x for x up to 0 (relative error below 2e-5); within 1e-37 of it below x = -85.
#[inline(always)]
pub fn exp_of_negative(x: f32) -> f32 {
    let y = (x * std::f32::consts::LOG2_E).max(-124.0);
    let shifted = y + SHIFT;
    let f = y - (shifted - SHIFT);
    let whole = shifted.to_bits() << 23;
    // Taylor's series of 2^f for |f| <= 1/2.
    let p = 1.0
        + f * (std::f32::consts::LN_2 + f * (0.240_226_5 + f * (0.055_504_1 + f * (0.009_618_13 + f * 0.001_333_36))));
    f32::from_bits(p.to_bits().wrapping_add(whole))
}

/// ln x for positive normal x, to 2e-6 of 1 + |ln x|.
#[inline(always)]
pub fn ln(x: f32) -> f32 {
    // x = m 2^e with m between 1/sqrt 2 and sqrt 2.
    const ROOT_HALF: u32 = 0x3f35_04f3;
    let shifted = x.to_bits().wrapping_sub(ROOT_HALF);
    let e = (shifted as i32 >> 23) as f32;
    let m = f32::from_bits((shifted & 0x007f_ffff) + ROOT_HALF);
    // The series of 2 artanh t.
    let t = (m - 1.0) / (m + 1.0);
    let s = t * t;
    e * std::f32::consts::LN_2 + 2.0 * t * (1.0 + s * (1.0 / 3.0 + s * (0.2 + s * (1.0 / 7.0 + s * (1.0 / 9.0)))))
}

/// Rounded down, of what lies within four million of 0, or for a whole number the one before; without a conversion, which would keep its
/// loop from being vectorised.
#[inline(always)]
pub fn floor(x: f32) -> i32 {
    (x - 0.5 + SHIFT).to_bits() as i32 - SHIFT.to_bits() as i32
}

/// arccos of x in -1..1 (rad), to 1e-4: Abramowitz and Stegun 4.4.45.
#[inline(always)]
pub fn arccos(x: f32) -> f32 {
    let a = x.abs().min(1.0);
    let p = (1.0 - a).sqrt() * (1.570_728_8 + a * (-0.212_114_4 + a * (0.074_261 - a * 0.018_729_3)));
    if x < 0.0 { std::f32::consts::PI - p } else { p }
}

/// e^-x I_0(x) for x from 0 (relative error below 6e-3): I_0 is the modified Bessel function of order 0.
#[inline(always)]
pub fn scaled_bessel(x: f32) -> f32 {
    let s = x * x;
    let cosh = 0.5 + 0.5 * exp_of_negative(-2.0 * x);
    cosh * (1.0 + 0.242_73 * s) / ((1.0 + 0.430_23 * s) * (1.0 + 0.25 * s).sqrt().sqrt())
}

/// From 0 to 1 as x goes, with no slope at either end.
pub fn smooth(x: f32) -> f32 {
    let x = x.clamp(0.0, 1.0);
    x * x * (3.0 - 2.0 * x)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn approximations_keep_their_promised_errors() {
        for i in 0..=20_000 {
            let x = -85.0 * i as f32 / 20_000.0;
            let exact = f64::from(x).exp();
            assert!((f64::from(exp_of_negative(x)) / exact - 1.0).abs() < 2e-5, "exp {x}");
            let c = i as f32 / 10_000.0 - 1.0;
            assert!((arccos(c) - c.acos()).abs() < 1e-4, "arccos {c}");
            let y = (-x / 4.0).exp() * 1e-6;
            assert!((f64::from(ln(y)) - f64::from(y).ln()).abs() < 2e-6 * (1.0 + f64::from(y).ln().abs()), "ln {y}");
        }
        for i in 0..=400 {
            let x = f64::from(i) / 4.0;
            // e^-x I_0(x) is the mean of e^(x (cos t - 1)) over half a turn.
            let steps = 20_000;
            let mean = (0..steps)
                .map(|k| (x * (((f64::from(k) + 0.5) * std::f64::consts::PI / f64::from(steps)).cos() - 1.0)).exp())
                .sum::<f64>()
                / f64::from(steps);
            assert!((f64::from(scaled_bessel(x as f32)) / mean - 1.0).abs() < 6e-3, "bessel {x}");
        }
    }
}
