//! Carlson's R_D, and the functions of the potential flow around an ellipsoid built from it.

use crate::field::sine::cos_turns;

/// R_D(x, y, z) = 3/2 times the integral over t > 0 of 1 / (sqrt(t + x) sqrt(t + y) (t + z)^(3/2)), for numbers above 0, by
/// duplication (B. C. Carlson, "Numerical computation of real or complex elliptic integrals", 1995, algorithm 4).
pub(super) fn r_d(mut x: f64, mut y: f64, mut z: f64) -> f64 {
    let (mut sum, mut factor) = (0.0, 1.0);
    loop {
        let mean = (x + y + 3.0 * z) / 5.0;
        let [dx, dy, dz] = [x, y, z].map(|v| 1.0 - v / mean);
        // The series below leaves out the sixth power of these.
        if dx.abs().max(dy.abs()).max(dz.abs()) < 2e-3 {
            let (e_a, e_b) = (dx * dy, dz * dz);
            let (e_c, e_d) = (e_a - e_b, e_a - 6.0 * e_b);
            let e_e = e_d + 2.0 * e_c;
            let series = 1.0 - 3.0 / 14.0 * e_d + 9.0 / 88.0 * e_d * e_d - 9.0 / 52.0 * dz * e_d * e_e
                + dz * (e_e / 6.0 + dz * (-9.0 / 22.0 * e_c + dz * 3.0 / 26.0 * e_a));
            return 3.0 * sum + factor * series / (mean * mean.sqrt());
        }
        let lambda = (x * y).sqrt() + (y * z).sqrt() + (z * x).sqrt();
        sum += factor / (z.sqrt() * (z + lambda));
        factor /= 4.0;
        [x, y, z] = [x, y, z].map(|v| (v + lambda) / 4.0);
    }
}

/// alpha_i(lambda) = a b c times the integral over s > lambda of 1 / ((a_i^2 + s) Delta(s)), with Delta the root of
/// (a^2 + s)(b^2 + s)(c^2 + s) (H. Lamb, "Hydrodynamics", 114).
pub(super) fn alpha(half_axes: [f64; 3], i: usize, lambda: f64) -> f64 {
    let squares = half_axes.map(|a| a * a + lambda);
    let product = half_axes[0] * half_axes[1] * half_axes[2];
    product * 2.0 / 3.0 * r_d(squares[(i + 1) % 3], squares[(i + 2) % 3], squares[i])
}

/// Most terms of an expansion.
const MOST: usize = 40;

/// alpha_i over tau^3 as a Chebyshev series in 2 tau^2 - 1, where tau^2 = R^2 / (R^2 + lambda) and R^2 is the mean square of
/// the half axes: for a sphere it is 2/3 everywhere. `None` for half axes so unlike that the series does not end.
pub(super) fn expansion(half_axes: [f64; 3], i: usize) -> Option<Vec<f32>> {
    let squared = mean_square(half_axes);
    let node = |k: usize| cos_turns((k as f64 + 0.5) / (2 * MOST) as f64);
    let values: Vec<f64> = (0..MOST)
        .map(|k| {
            let tau2 = 0.5 + 0.5 * node(k);
            alpha(half_axes, i, squared * (1.0 / tau2 - 1.0)) / (tau2 * tau2.sqrt())
        })
        .collect();
    let coefficient = |j: usize| {
        let cosine = |k: usize| cos_turns(j as f64 * (k as f64 + 0.5) / (2 * MOST) as f64);
        let sum: f64 = values.iter().enumerate().map(|(k, value)| value * cosine(k)).sum();
        sum * if j == 0 { 1.0 } else { 2.0 } / MOST as f64
    };
    let coefficients: Vec<f64> = (0..MOST).map(coefficient).collect();
    // What is left out is below a tenth of the rounding of f32.
    let mut tail = 0.0;
    let terms = (0..MOST).rev().find(|&j| {
        tail += coefficients[j].abs();
        tail > 1e-8
    })? + 1;
    (terms < MOST - 2).then(|| coefficients[..terms].iter().map(|&c| c as f32).collect())
}

/// R^2.
pub(super) fn mean_square(half_axes: [f64; 3]) -> f64 {
    half_axes.iter().map(|a| a * a).sum::<f64>() / 3.0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn r_d_is_the_published_one_and_homogeneous() {
        // Carlson's own values.
        for ([x, y, z], value) in
            [([1e-300, 2.0, 1.0], 1.797_210_352_103_388_3), ([2.0, 3.0, 4.0], 0.165_105_272_942_610_53)]
        {
            assert!((r_d(x, y, z) / value - 1.0).abs() < 1e-14, "{}", r_d(x, y, z));
        }
        assert!((r_d(0.7, 0.7, 0.7) * 0.7_f64.powf(1.5) - 1.0).abs() < 1e-15);
        assert!((r_d(1.0, 2.0, 5.0) - 8.0 * r_d(4.0, 8.0, 20.0)).abs() < 1e-15);
    }

    #[test]
    fn the_three_alphas_of_a_surface_add_up_to_two() {
        // The integral of d(-2/Delta): Lamb, 114 (11).
        for axes in [[9.5, 11.0, 8.0], [1.0, 1.0, 1.0], [3.0, 1.0, 2.0]] {
            let sum: f64 = (0..3).map(|i| alpha(axes, i, 0.0)).sum();
            assert!((sum - 2.0).abs() < 1e-14, "{sum}");
        }
        assert!((alpha([2.0; 3], 0, 0.0) - 2.0 / 3.0).abs() < 1e-15);
    }
}
