//! The fast step of one block of strands: equation (7) for sixteen strands at a time, f32, without a branch.
//!
//! Every lane does the same operations whatever the machine's vectors hold, and multiplies and adds are fused by
//! name, never at the compiler's choice: so the bits do not depend on the vector width.

use glam::Vec3;

use super::angles;
use super::trigonometry::sin_cos;
use crate::pseudo_force::Gamma;

/// Strands in a block: two vectors of eight, or one of sixteen.
pub(super) const LANES: usize = 16;

/// One number for each strand of a block.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C, align(64))]
pub(super) struct Row(pub [f32; LANES]);

/// Angles and increments (rad, rad per frame) of one segment of every strand of a block.
#[derive(Clone, Copy, Debug, Default)]
#[repr(C)]
pub(super) struct SegmentState {
    pub theta: Row,
    pub phi: Row,
    pub theta_increment: Row,
    pub phi_increment: Row,
}

/// Length (cm), c_i and eps_i c_i of one segment of every strand of a block.
pub(super) trait ShapeRow: Copy + Send + Sync {
    fn lane(&self, lane: usize) -> [f32; 3];
}

/// One shape for all sixteen strands.
impl ShapeRow for [f32; 3] {
    #[inline(always)]
    fn lane(&self, _: usize) -> [f32; 3] {
        *self
    }
}

/// A shape for each strand.
impl ShapeRow for [Row; 3] {
    #[inline(always)]
    fn lane(&self, lane: usize) -> [f32; 3] {
        [self[0].0[lane], self[1].0[lane], self[2].0[lane]]
    }
}

/// A point for each strand of a block: rows of x, y, z (cm).
pub(super) type PointRow = [Row; 3];

/// F(n+1) and Gamma, as the kernel wants them.
#[derive(Clone, Copy, Debug)]
pub(super) struct Wind {
    force: [f32; 3],
    /// Azimuth of the force, where it has one, and its sine and cosine.
    azimuth: [f32; 3],
    has_azimuth: bool,
    center: [f32; 3],
    /// 1 / half axis.
    inverse: [f32; 3],
    /// C as a squared radius, where E's is 1.
    shell_squared: f32,
    /// alpha |alpha| |F|^2: (4) with both sides multiplied by their own size, which spares the roots.
    threshold: f32,
}

impl Wind {
    pub fn new(force: Vec3, gamma: &Gamma) -> Self {
        let azimuth = angles::azimuth(force.as_dvec3());
        let angle = azimuth.unwrap_or(0.0) as f32;
        let (sin, cos) = sin_cos(angle);
        Self {
            force: force.to_array(),
            azimuth: [angle, sin, cos],
            has_azimuth: azimuth.is_some(),
            center: gamma.ellipsoid.center.to_array(),
            inverse: gamma.ellipsoid.half_axes.recip().to_array(),
            shell_squared: gamma.shell * gamma.shell,
            threshold: gamma.alpha * gamma.alpha.abs() * force.length_squared(),
        }
    }

    /// Equation (4), see [`Gamma::contains`].
    #[inline(always)]
    fn weakened_at(&self, p: [f32; 3]) -> bool {
        let [ix, iy, iz] = self.inverse;
        let q = [(p[0] - self.center[0]) * ix, (p[1] - self.center[1]) * iy, (p[2] - self.center[2]) * iz];
        let normal = [q[0] * ix, q[1] * iy, q[2] * iz];
        let radius_squared = dot(q, q);
        let against = dot(normal, self.force);
        (radius_squared > 1.0)
            & (radius_squared <= self.shell_squared)
            & (against * against.abs() <= self.threshold * dot(normal, normal))
    }
}

/// Moves segment i of every strand of a block from frame n to n + 1. `before` and `after` hold the points p_(i-1)
/// of the two frames on entry, and p_i on return.
#[inline(always)]
pub(super) fn step_segment<S: ShapeRow>(
    state: &mut SegmentState,
    shape: &S,
    wind: &Wind,
    before: &mut PointRow,
    after: &mut PointRow,
) {
    for lane in 0..LANES {
        let [length, gain, gain_in_gamma] = shape.lane(lane);
        let (theta, theta_increment) = (state.theta.0[lane], state.theta_increment.0[lane]);
        let (phi, phi_increment) = (state.phi.0[lane], state.phi_increment.0[lane]);
        let (sin_theta, cos_theta) = sin_cos(theta);
        let (sin_phi, cos_phi) = sin_cos(phi);

        let p = extend(before, lane, length, [sin_theta * sin_phi, cos_theta, sin_theta * cos_phi]);
        let c = if wind.weakened_at(p) { gain_in_gamma } else { gain };

        let free = wind.has_azimuth
            & (sin_theta.abs() < angles::POLE_SINE as f32)
            & (theta_increment.abs() < angles::POLE_REST as f32);
        let phi = if free { wind.azimuth[0] } else { phi };
        let sin_phi = if free { wind.azimuth[1] } else { sin_phi };
        let cos_phi = if free { wind.azimuth[2] } else { cos_phi };

        let [fx, fy, fz] = wind.force;
        let outward = fx.mul_add(sin_phi, fz * cos_phi);
        let around = fx.mul_add(cos_phi, -(fz * sin_phi));
        let f_theta = cos_theta.mul_add(outward, -(fy * sin_theta));
        let theta_increment = c.mul_add(f_theta, theta_increment);
        let phi_increment = c.mul_add(sin_theta * around, phi_increment);
        let (theta, phi) = (theta + theta_increment, phi + phi_increment);
        state.theta.0[lane] = theta;
        state.phi.0[lane] = phi;
        state.theta_increment.0[lane] = theta_increment;
        state.phi_increment.0[lane] = phi_increment;

        let (sin_theta, cos_theta) = sin_cos(theta);
        let (sin_phi, cos_phi) = sin_cos(phi);
        extend(after, lane, length, [sin_theta * sin_phi, cos_theta, sin_theta * cos_phi]);
    }
}

/// Puts segment i of every strand of a block on its p_(i-1), which becomes p_i.
#[inline(always)]
pub(super) fn place_segment<S: ShapeRow>(state: &SegmentState, shape: &S, after: &mut PointRow) {
    for lane in 0..LANES {
        let (sin_theta, cos_theta) = sin_cos(state.theta.0[lane]);
        let (sin_phi, cos_phi) = sin_cos(state.phi.0[lane]);
        extend(after, lane, shape.lane(lane)[0], [sin_theta * sin_phi, cos_theta, sin_theta * cos_phi]);
    }
}

#[inline(always)]
fn extend(points: &mut PointRow, lane: usize, length: f32, direction: [f32; 3]) -> [f32; 3] {
    let mut p = [0.0; 3];
    for axis in 0..3 {
        p[axis] = length.mul_add(direction[axis], points[axis].0[lane]);
        points[axis].0[lane] = p[axis];
    }
    p
}

#[inline(always)]
fn dot(a: [f32; 3], b: [f32; 3]) -> f32 {
    a[0].mul_add(b[0], a[1].mul_add(b[1], a[2] * b[2]))
}
