//! Number types of the f64 steppers: plain numbers, or numbers that carry their derivatives along.
//!
//! The specification of the motion is written once, over a [`Scalar`]. With `f64` it is the f64 twin; with [`Dual`] the same
//! lines give what becomes of a small change of the settings: forward-mode differentiation. Decisions (does hair touch, does
//! it slide) are taken by values, so that derivatives are those of the branch taken.

mod dual;
mod vector;

use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub};

pub(crate) use dual::Dual;
pub(crate) use vector::{Turn, Vector};

/// A number.
pub(crate) trait Scalar:
    Copy
    + Send
    + Sync
    + PartialEq
    + From<f64>
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + AddAssign
{
    /// The number itself.
    fn value(self) -> f64;

    /// Times a constant.
    fn times(self, factor: f64) -> Self;

    fn sqrt(self) -> Self;

    fn sin_cos(self) -> (Self, Self);

    /// This number with the chain rule applied: it depends on three others, with this gradient, which is evaluated only
    /// if derivatives are needed.
    fn known(value: f64, at: Vector<Self>, gradient: impl FnOnce() -> glam::DVec3) -> Self;

    /// The same for a vector; the columns of `jacobian` are its derivatives along x, y and z.
    fn known_vector(value: glam::DVec3, at: Vector<Self>, jacobian: impl FnOnce() -> glam::DMat3) -> Vector<Self>;
}

impl Scalar for f64 {
    #[inline(always)]
    fn value(self) -> f64 {
        self
    }

    #[inline(always)]
    fn times(self, factor: f64) -> Self {
        self * factor
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        f64::sqrt(self)
    }

    #[inline(always)]
    fn sin_cos(self) -> (Self, Self) {
        f64::sin_cos(self)
    }

    #[inline(always)]
    fn known(value: f64, _: Vector<Self>, _: impl FnOnce() -> glam::DVec3) -> Self {
        value
    }

    #[inline(always)]
    fn known_vector(value: glam::DVec3, _: Vector<Self>, _: impl FnOnce() -> glam::DMat3) -> Vector<Self> {
        value.into()
    }
}
