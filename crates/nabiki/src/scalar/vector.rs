//! Vectors and rotations of any [`Scalar`]. With `f64` each operation has the bits of glam's of the same name.

use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub};

use glam::{DAffine3, DMat3, DQuat, DVec3};

use super::Scalar;

/// Three numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Vector<S> {
    pub x: S,
    pub y: S,
    pub z: S,
}

impl<S: Scalar> From<DVec3> for Vector<S> {
    #[inline(always)]
    fn from(v: DVec3) -> Self {
        Self { x: v.x.into(), y: v.y.into(), z: v.z.into() }
    }
}

impl<S: Scalar> Vector<S> {
    #[inline(always)]
    pub fn new(x: S, y: S, z: S) -> Self {
        Self { x, y, z }
    }

    #[inline(always)]
    pub fn zero() -> Self {
        DVec3::ZERO.into()
    }

    /// The numbers themselves.
    #[inline(always)]
    pub fn value(self) -> DVec3 {
        DVec3::new(self.x.value(), self.y.value(), self.z.value())
    }

    /// Times a constant.
    #[inline(always)]
    pub fn times(self, factor: f64) -> Self {
        Self { x: self.x.times(factor), y: self.y.times(factor), z: self.z.times(factor) }
    }

    #[inline(always)]
    pub fn dot(self, other: Self) -> S {
        self.x * other.x + self.y * other.y + self.z * other.z
    }

    #[inline(always)]
    pub fn cross(self, other: Self) -> Self {
        Self {
            x: self.y * other.z - other.y * self.z,
            y: self.z * other.x - other.z * self.x,
            z: self.x * other.y - other.x * self.y,
        }
    }

    #[inline(always)]
    pub fn length_squared(self) -> S {
        self.dot(self)
    }

    #[inline(always)]
    pub fn length(self) -> S {
        self.dot(self).sqrt()
    }

    /// Normalised, or `fallback` if it has no direction.
    #[inline(always)]
    pub fn normalized_or(self, fallback: Self) -> Self {
        let length = self.length();
        let inverse = 1.0 / length.value();
        if inverse.is_finite() && inverse > 0.0 { self * (S::from(1.0) / length) } else { fallback }
    }

    /// The interpolation to another, at `t`.
    #[inline(always)]
    pub fn lerp(self, other: Self, t: f64) -> Self {
        self.times(1.0 - t) + other.times(t)
    }

    /// Transformed by a constant matrix.
    #[inline(always)]
    pub fn by(self, matrix: &DMat3) -> Self {
        let [a, b, c] = [matrix.x_axis, matrix.y_axis, matrix.z_axis];
        let row = |a: f64, b: f64, c: f64| self.x.times(a) + self.y.times(b) + self.z.times(c);
        Self { x: row(a.x, b.x, c.x), y: row(a.y, b.y, c.y), z: row(a.z, b.z, c.z) }
    }

    /// A point transformed by a constant map.
    #[inline(always)]
    pub fn taken_by(self, map: &DAffine3) -> Self {
        self.by(&map.matrix3) + map.translation.into()
    }
}

impl<S: Scalar> Add for Vector<S> {
    type Output = Self;

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self { x: self.x + other.x, y: self.y + other.y, z: self.z + other.z }
    }
}

impl<S: Scalar> AddAssign for Vector<S> {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl<S: Scalar> Sub for Vector<S> {
    type Output = Self;

    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self { x: self.x - other.x, y: self.y - other.y, z: self.z - other.z }
    }
}

impl<S: Scalar> Neg for Vector<S> {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        Self { x: -self.x, y: -self.y, z: -self.z }
    }
}

impl<S: Scalar> Mul<S> for Vector<S> {
    type Output = Self;

    #[inline(always)]
    fn mul(self, factor: S) -> Self {
        Self { x: self.x * factor, y: self.y * factor, z: self.z * factor }
    }
}

impl<S: Scalar> Div<S> for Vector<S> {
    type Output = Self;

    #[inline(always)]
    fn div(self, by: S) -> Self {
        Self { x: self.x / by, y: self.y / by, z: self.z / by }
    }
}

/// A rotation: a quaternion of length 1.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Turn<S> {
    along: Vector<S>,
    w: S,
}

impl<S: Scalar> From<DQuat> for Turn<S> {
    #[inline(always)]
    fn from(q: DQuat) -> Self {
        Self { along: q.xyz().into(), w: q.w.into() }
    }
}

impl<S: Scalar> Turn<S> {
    /// The smallest rotation from one direction to another; the identity if they are opposite.
    #[inline(always)]
    pub fn smallest(from: Vector<S>, to: Vector<S>) -> Self {
        if from == to {
            return DQuat::IDENTITY.into();
        }
        let (cross, cosine) = (from.cross(to), S::from(1.0) + from.dot(to));
        let cosine = if cosine.value() < 1e-12 { S::from(1e-12) } else { cosine };
        let squared = cross.x * cross.x + cross.y * cross.y + cross.z * cross.z + cosine * cosine;
        let inverse = S::from(1.0) / squared.sqrt();
        Self { along: cross * inverse, w: cosine * inverse }
    }

    /// A rotation about a direction, by twice the angle whose tangent is half of this (rad), which is nearly this
    /// angle.
    #[inline(always)]
    pub fn about(direction: Vector<S>, angle: S) -> Self {
        let half = angle.times(0.5);
        let inverse = S::from(1.0) / (S::from(1.0) + half * half).sqrt();
        Self { along: direction * (half * inverse), w: inverse }
    }

    /// A vector rotated.
    #[inline(always)]
    pub fn of(self, v: Vector<S>) -> Vector<S> {
        let Self { along: b, w } = self;
        v * (w * w - b.dot(b)) + b * v.dot(b).times(2.0) + b.cross(v) * w.times(2.0)
    }

    /// A constant vector rotated.
    #[inline(always)]
    pub fn of_known(self, v: DVec3) -> Vector<S> {
        let Self { along: b, w } = self;
        let scaled = |by: S| Vector { x: by.times(v.x), y: by.times(v.y), z: by.times(v.z) };
        let dot = b.x.times(v.x) + b.y.times(v.y) + b.z.times(v.z);
        let cross = Vector {
            x: b.y.times(v.z) - b.z.times(v.y),
            y: b.z.times(v.x) - b.x.times(v.z),
            z: b.x.times(v.y) - b.y.times(v.x),
        };
        scaled(w * w - b.dot(b)) + b * dot.times(2.0) + cross * w.times(2.0)
    }

    /// This rotation after another.
    #[inline(always)]
    pub fn after(self, first: Self) -> Self {
        let (Vector { x: x0, y: y0, z: z0 }, w0) = (self.along, self.w);
        let (Vector { x: x1, y: y1, z: z1 }, w1) = (first.along, first.w);
        Self {
            along: Vector {
                x: w0 * x1 + x0 * w1 + y0 * z1 - z0 * y1,
                y: w0 * y1 - x0 * z1 + y0 * w1 + z0 * x1,
                z: w0 * z1 + x0 * y1 - y0 * x1 + z0 * w1,
            },
            w: w0 * w1 - x0 * x1 - y0 * y1 - z0 * z1,
        }
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn bits(v: impl Into<DVec3>) -> [u64; 3] {
        v.into().to_array().map(f64::to_bits)
    }

    impl From<Vector<f64>> for DVec3 {
        fn from(v: Vector<f64>) -> Self {
            v.value()
        }
    }

    proptest! {
        #[test]
        fn plain_numbers_have_the_bits_of_glam(
            a in prop::array::uniform3(-2.0_f64..2.0), b in prop::array::uniform3(-2.0_f64..2.0), t in -2.0_f64..2.0
        ) {
            let (a, b) = (DVec3::from_array(a), DVec3::from_array(b));
            prop_assume!(a.length() > 1e-3 && b.length() > 1e-3);
            let (x, y): (Vector<f64>, Vector<f64>) = (a.into(), b.into());
            prop_assert_eq!(bits(x.cross(y)), bits(a.cross(b)));
            prop_assert_eq!(x.dot(y).to_bits(), a.dot(b).to_bits());
            prop_assert_eq!(bits(x.normalized_or(y)), bits(a.normalize_or(b)));
            prop_assert_eq!(bits(x.lerp(y, t)), bits(a.lerp(b, t)));
            prop_assert_eq!(bits(x * t - y / t), bits(a * t - b / t));
            let matrix = DMat3::from_cols(a, b, a.cross(b));
            prop_assert_eq!(bits(x.by(&matrix)), bits(matrix * a));
            let map = DAffine3 { matrix3: matrix, translation: b };
            prop_assert_eq!(bits(x.taken_by(&map)), bits(map.transform_point3(a)));
            let (p, q) = (DQuat::from_axis_angle(a.normalize(), t), DQuat::from_axis_angle(b.normalize(), 1.0));
            let (u, v): (Turn<f64>, Turn<f64>) = (p.into(), q.into());
            prop_assert_eq!(bits(u.of(y)), bits(p * b));
            prop_assert_eq!(bits(u.of_known(b)), bits(p * b));
            let both = u.after(v);
            prop_assert_eq!(bits(both.along), bits((p * q).xyz()));
            prop_assert_eq!(both.w.to_bits(), (p * q).w.to_bits());
        }
    }
}
