//! Vectors of three numbers for the loops over lanes.
//!
//! No closure and no operator stands in what those loops call: only a named function can be forced into its caller, and so
//! be compiled for the vectors chosen there. Sums of products are fused by name, so that the bits are the same for any
//! width.

/// a + b
#[inline(always)]
pub(crate) fn add(a: [f32; 3], b: [f32; 3]) -> [f32; 3] {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

/// a - b
#[inline(always)]
pub(crate) fn subtract(a: [f32; 3], b: [f32; 3]) -> [f32; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

/// s a
#[inline(always)]
pub(crate) fn scale(s: f32, a: [f32; 3]) -> [f32; 3] {
    [s * a[0], s * a[1], s * a[2]]
}

/// s a + b, each number rounded once.
#[inline(always)]
pub(crate) fn scale_add(s: f32, a: [f32; 3], b: [f32; 3]) -> [f32; 3] {
    [s.mul_add(a[0], b[0]), s.mul_add(a[1], b[1]), s.mul_add(a[2], b[2])]
}

/// a . b
#[inline(always)]
pub(crate) fn dot(a: [f32; 3], b: [f32; 3]) -> f32 {
    a[0].mul_add(b[0], a[1].mul_add(b[1], a[2] * b[2]))
}

/// a x b; exactly 0 where one of them is.
#[inline(always)]
pub(crate) fn cross(a: [f32; 3], b: [f32; 3]) -> [f32; 3] {
    [a[1].mul_add(b[2], -(a[2] * b[1])), a[2].mul_add(b[0], -(a[0] * b[2])), a[0].mul_add(b[1], -(a[1] * b[0]))]
}
