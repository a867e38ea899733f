//! The surroundings of hair in the paper's form, and a force in the terms of its equations.

use glam::Vec3;

use super::polar::PolarAxis;
use crate::dynamics::Dynamics;
use crate::dynamics::row::rotate;
use crate::ellipsoid::Ellipsoid;
use crate::vector::dot;

/// The surroundings in every frame: Gamma except for the force, and the polar axis.
#[derive(Clone, Copy, Debug)]
pub(in crate::dynamics) struct Surroundings {
    /// 1 / half axis.
    inverse: [f32; 3],
    /// Its square.
    inverse_squared: [f32; 3],
    /// The centre of E in units of its half axes.
    center: [f32; 3],
    /// C as a squared radius, where E's is 1.
    shell_squared: f32,
    /// alpha |alpha|: (4) with both sides multiplied by their absolute values, which saves the roots.
    alpha_squared: f32,
    /// Columns of the rotation from head space to the space whose y is the polar axis.
    polar_from_head: [[f32; 3]; 3],
    head_from_polar: [[f32; 3]; 3],
}

impl Surroundings {
    pub(super) fn new(dynamics: &Dynamics, axis: &PolarAxis) -> Self {
        let Ellipsoid { center, half_axes } = dynamics.ellipsoid;
        let alpha = dynamics.pseudo_force.alpha;
        let polar_from_head = axis.polar_from_head().as_mat3();
        Self {
            inverse: half_axes.recip().to_array(),
            inverse_squared: (half_axes * half_axes).recip().to_array(),
            center: (center / half_axes).to_array(),
            shell_squared: dynamics.shell * dynamics.shell,
            alpha_squared: alpha * alpha.abs(),
            polar_from_head: polar_from_head.to_cols_array_2d(),
            head_from_polar: polar_from_head.transpose().to_cols_array_2d(),
        }
    }

    /// For users that need no angles.
    pub fn upright(dynamics: &Dynamics) -> Self {
        Self::new(dynamics, &PolarAxis::new(Vec3::Y))
    }

    /// Equation (4), see [`Gamma::contains`](crate::pseudo_force::Gamma::contains).
    #[inline(always)]
    pub fn weaken(&self, p: [f32; 3], force: &Force) -> bool {
        // In units of the half axes, where the normal of the ellipsoid is q divided by them once more.
        let q = [0, 1, 2].map(|axis| p[axis].mul_add(self.inverse[axis], -self.center[axis]));
        let squares = q.map(|v| v * v);
        let radius_squared = squares[0] + squares[1] + squares[2];
        let against = dot(q, force.in_half_axes);
        (radius_squared > 1.0)
            & (radius_squared <= self.shell_squared)
            & (against * against.abs() <= force.threshold * dot(squares, self.inverse_squared))
    }

    /// The direction of given sines and cosines in head space. `TILTED`: whether the polar axis is not y.
    #[inline(always)]
    pub fn direction<const TILTED: bool>(&self, theta: [f32; 2], phi: [f32; 2]) -> [f32; 3] {
        let direction = [theta[0] * phi[0], theta[1], theta[0] * phi[1]];
        if TILTED { rotate(&self.head_from_polar, direction) } else { direction }
    }
}

/// F(n+1) at one point.
#[derive(Clone, Copy, Debug)]
pub(in crate::dynamics) struct Force {
    /// For Gamma: divided by the half axes of E, in head space.
    pub in_half_axes: [f32; 3],
    /// For the equations: in the space whose y is the polar axis.
    pub in_polar: [f32; 3],
    /// Sine and cosine of its azimuth about the polar axis; (0, 0) if it has none.
    pub azimuth: [f32; 2],
    /// alpha |alpha| |F|^2.
    pub threshold: f32,
}

impl Force {
    #[inline(always)]
    pub fn new(in_head: [f32; 3], surroundings: &Surroundings) -> Self {
        let in_polar = rotate(&surroundings.polar_from_head, in_head);
        let [x, _, z] = in_polar;
        let level = x.mul_add(x, z * z).sqrt();
        let azimuth = if level > 0.0 { [x / level, z / level] } else { [0.0; 2] };
        let threshold = surroundings.alpha_squared * dot(in_head, in_head);
        let in_half_axes = [0, 1, 2].map(|axis| in_head[axis] * surroundings.inverse[axis]);
        Self { in_half_axes, in_polar, azimuth, threshold }
    }

    #[inline(always)]
    pub fn has_azimuth(&self) -> bool {
        (self.azimuth[0] != 0.0) | (self.azimuth[1] != 0.0)
    }
}
