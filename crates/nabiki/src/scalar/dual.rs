//! Numbers with derivatives.

use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub};

use glam::{DMat3, DVec3};

use super::{Scalar, Vector};

/// A number, and its derivatives by N unknowns. Loops over N are meant for vector code, so every operation is inlined
/// into its vectorised callers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Dual<const N: usize> {
    pub value: f64,
    pub tangents: [f64; N],
}

impl<const N: usize> Dual<N> {
    /// value, and `scale` times the tangents: f(x) with f' = `scale`.
    #[inline(always)]
    fn chained(self, value: f64, scale: f64) -> Self {
        let mut tangents = self.tangents;
        for t in &mut tangents {
            *t *= scale;
        }
        Self { value, tangents }
    }
}

impl<const N: usize> From<f64> for Dual<N> {
    #[inline(always)]
    fn from(value: f64) -> Self {
        Self { value, tangents: [0.0; N] }
    }
}

impl<const N: usize> Add for Dual<N> {
    type Output = Self;

    #[inline(always)]
    fn add(mut self, other: Self) -> Self {
        self += other;
        self
    }
}

impl<const N: usize> AddAssign for Dual<N> {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        self.value += other.value;
        for i in 0..N {
            self.tangents[i] += other.tangents[i];
        }
    }
}

impl<const N: usize> Sub for Dual<N> {
    type Output = Self;

    #[inline(always)]
    fn sub(mut self, other: Self) -> Self {
        self.value -= other.value;
        for i in 0..N {
            self.tangents[i] -= other.tangents[i];
        }
        self
    }
}

impl<const N: usize> Mul for Dual<N> {
    type Output = Self;

    #[allow(clippy::needless_range_loop, reason = "a loop over lanes, as in the kernels")]
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        let mut tangents = [0.0; N];
        for i in 0..N {
            tangents[i] = self.value * other.tangents[i] + self.tangents[i] * other.value;
        }
        Self { value: self.value * other.value, tangents }
    }
}

impl<const N: usize> Div for Dual<N> {
    type Output = Self;

    #[allow(clippy::needless_range_loop, reason = "a loop over lanes, as in the kernels")]
    #[inline(always)]
    fn div(self, other: Self) -> Self {
        let value = self.value / other.value;
        let inverse = 1.0 / other.value;
        let mut tangents = [0.0; N];
        for i in 0..N {
            tangents[i] = (self.tangents[i] - value * other.tangents[i]) * inverse;
        }
        Self { value, tangents }
    }
}

impl<const N: usize> Neg for Dual<N> {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        self.chained(-self.value, -1.0)
    }
}

impl<const N: usize> Scalar for Dual<N> {
    #[inline(always)]
    fn value(self) -> f64 {
        self.value
    }

    #[inline(always)]
    fn times(self, factor: f64) -> Self {
        self.chained(self.value * factor, factor)
    }

    /// At 0, where the root has no derivative, use that of a constant.
    #[inline(always)]
    fn sqrt(self) -> Self {
        let root = self.value.sqrt();
        self.chained(root, if root > 0.0 { 0.5 / root } else { 0.0 })
    }

    #[inline(always)]
    fn sin_cos(self) -> (Self, Self) {
        let (sin, cos) = self.value.sin_cos();
        (self.chained(sin, cos), self.chained(cos, -sin))
    }

    #[inline(always)]
    fn known(value: f64, at: Vector<Self>, gradient: impl FnOnce() -> DVec3) -> Self {
        let gradient = gradient();
        let change = at.x.times(gradient.x) + at.y.times(gradient.y) + at.z.times(gradient.z);
        Self { value, tangents: change.tangents }
    }

    #[inline(always)]
    fn known_vector(value: DVec3, at: Vector<Self>, jacobian: impl FnOnce() -> DMat3) -> Vector<Self> {
        let jacobian = jacobian();
        let along = |row: DVec3| at.x.times(row.x) + at.y.times(row.y) + at.z.times(row.z);
        let (x, y, z) = (along(jacobian.row(0)), along(jacobian.row(1)), along(jacobian.row(2)));
        Vector::new(Self { value: value.x, ..x }, Self { value: value.y, ..y }, Self { value: value.z, ..z })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two numbers that depend on one unknown each.
    fn pair(a: f64, b: f64) -> [Dual<2>; 2] {
        [Dual { value: a, tangents: [1.0, 0.0] }, Dual { value: b, tangents: [0.0, 1.0] }]
    }

    #[test]
    fn derivatives_are_those_of_differences() {
        type Function = fn([Dual<2>; 2]) -> Dual<2>;
        let functions: [Function; 7] = [
            |[a, b]| a * b + a,
            |[a, b]| (a - b) / (a * a + b),
            |[a, b]| -(a * b).sqrt(),
            |[a, b]| a.sin_cos().0 * b.sin_cos().1,
            |[a, b]| Vector::new(a, b, a * b).normalized_or(Vector::zero()).y,
            |[a, b]| Vector::new(a, b, b).cross(Vector::new(b, a, a * b)).dot(Vector::new(b, b, a)),
            |[a, b]| {
                let unit = |v: Vector<Dual<2>>| v.normalized_or(Vector::zero());
                let from = unit(Vector::new(a, b, a));
                let turn = super::super::Turn::smallest(from, unit(Vector::new(b, a, a * b)));
                turn.of(Vector::new(a, a, b)).x
            },
        ];
        let (a, b, h) = (0.7, 1.9, 1e-6);
        for (n, f) in functions.into_iter().enumerate() {
            let exact = f(pair(a, b)).tangents;
            let by_a = (f(pair(a + h, b)).value - f(pair(a - h, b)).value) / (2.0 * h);
            let by_b = (f(pair(a, b + h)).value - f(pair(a, b - h)).value) / (2.0 * h);
            // The error of differences of step h is h^2 plus rounding over h.
            assert!((exact[0] - by_a).abs() < 1e-8 && (exact[1] - by_b).abs() < 1e-8, "{n}: {exact:?} {by_a} {by_b}");
        }
    }
}
