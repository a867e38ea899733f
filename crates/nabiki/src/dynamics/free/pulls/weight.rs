//! Weight, which pulls on every node, and what supports it at rest, so that groomed hair does not sag: the moment S (1 - (d u)^2)^2 (d x u)
//! on a segment, with u across its direction at rest. It depends on the segment's direction on the head alone, and so has a potential: no way
//! round the head gains from it. It is gone where hair is turned along u, so hair that is thrown up falls.

use glam::DVec3;

use crate::dynamics::pull::{Name, Pull};
use crate::pose::Pose;
use crate::scalar::{Scalar, Vector};
use crate::vector::{cross, dot, scale};

/// Of `free.gravity`, where regions multiply it most.
pub struct Gravity {
    pub setting: f32,
    pub times: f64,
}

impl Pull for Gravity {
    fn name(&self) -> Name {
        Name { setting: "free.gravity", words: "gravity", term: "gravity" }
    }

    fn setting(&self) -> f32 {
        self.setting
    }

    fn strongest(&self) -> f64 {
        f64::from(self.setting) * self.times
    }
}

/// The force of the weight under a head of this pose (head space). `gravity`: its strength.
pub fn on_head(pose: &Pose, gravity: f64) -> DVec3 {
    pose.rotation.as_dquat().inverse() * DVec3::new(0.0, -gravity, 0.0)
}

/// The strength of hold that a segment needs so that weight does not tip it over: its part along the segment, if the segment stands up.
pub fn held_up(pose: &Pose, gravity: f64, rest: DVec3) -> f64 {
    (-on_head(pose, gravity).dot(rest)).max(0.0)
}

/// u, of length 1, and S, for a segment with this direction at rest and what hangs on it: force times length. Where it hangs straight down,
/// S is 0.
pub fn support(rest: DVec3, hangs: DVec3) -> (DVec3, f64) {
    let across = hangs.dot(rest) * rest - hangs;
    (across.normalize_or_zero(), across.length())
}

/// The moment that supports it.
#[inline(always)]
pub fn moment<S: Scalar>(up: Vector<S>, supports: f64, d: Vector<S>) -> Vector<S> {
    let along = d.dot(up);
    let across = S::from(1.0) - along * along;
    d.cross(up) * (across * across).times(supports)
}

/// The same for one lane.
#[inline(always)]
pub fn moment_lane(up: [f32; 3], supports: f32, d: [f32; 3]) -> [f32; 3] {
    let along = dot(d, up);
    let across = (-along).mul_add(along, 1.0);
    scale(supports * (across * across), cross(d, up))
}

#[cfg(test)]
mod tests {
    use glam::DQuat;

    use super::*;

    /// Of -S (x - 2/3 x^3 + x^5 / 5), with x = d . u: so no turn of a segment and back gains from it.
    #[test]
    fn the_support_has_a_potential() {
        let (up, supports) = support(DVec3::new(0.6, -0.48, 0.64), DVec3::new(0.0, -3.0, 0.5));
        let potential = |d: DVec3| {
            let x = d.dot(up);
            -supports * (x - 2.0 / 3.0 * x.powi(3) + 0.2 * x.powi(5))
        };
        for n in 1..200 {
            let of = |k: f64| (f64::from(n) * k).sin();
            let d = DVec3::new(of(1.1), of(1.7), of(2.3)).normalize();
            let axis = DVec3::new(of(2.9), of(3.1), of(3.7)).normalize();
            let turned = |by: f64| DQuat::from_axis_angle(axis, by) * d;
            let falls = (potential(turned(-1e-4)) - potential(turned(1e-4))) / 2e-4;
            let works = moment::<f64>(up.into(), supports, d.into()).value().dot(axis);
            // Differences leave out a sixth of their square, times third derivatives of up to 7 S.
            assert!((falls - works).abs() < 2e-8 * supports, "{d}: {falls}, not {works}");
        }
    }

    /// Across the segment it takes all weight, and no more than that.
    #[test]
    fn at_rest_it_balances_what_hangs() {
        for (rest, hangs) in
            [(DVec3::X, -DVec3::Y), (DVec3::new(0.6, -0.8, 0.0), DVec3::new(0.0, -2.0, 0.0)), (-DVec3::Y, -DVec3::Y)]
        {
            let (up, supports) = support(rest, hangs);
            let left = rest.cross(hangs) + moment::<f64>(up.into(), supports, rest.into()).value();
            assert!(left.length() < 1e-14, "{rest}: {left}");
        }
    }
}
