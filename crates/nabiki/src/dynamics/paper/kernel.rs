//! The fast step of one block of strands: equation (7) for sixteen strands at a time, f32.
//!
//! Every lane does the same operations whatever the machine's vectors hold, and multiplies and adds are fused by
//! name, never at the compiler's choice: so the bits do not depend on the vector width, nor on the other lanes.

use super::angles;
use super::force_source::{ForceSource, Forces};
use super::rows::{SegmentState, ShapeRow, extend};
use super::surroundings::{Force, Surroundings};
use super::turn::{Turn, is_far, turn_far, turn_little};
use crate::dynamics::row::{LANES, PointRow, Row, beyond};

/// Moves segment i of every strand of a block from frame n to n + 1. `before` holds the points p_(i-1) of frame n on
/// entry, and p_i on return; `from` and `to` are those of frame n + 1. `TILTED`: whether the polar axis is not y.
#[inline(always)]
pub(super) fn step_segment<const TILTED: bool>(
    state: &mut SegmentState,
    shape: &ShapeRow,
    surroundings: &Surroundings,
    source: &impl ForceSource,
    before: &mut PointRow,
    from: &PointRow,
    to: &mut PointRow,
) {
    let forces = source.at::<TILTED>(before, state, shape, surroundings);
    let (was, mut far) = (*state, 0);
    // A single loop, with none between it and the points of the segment before. Rows written by halves in one loop and
    // read whole in the next stall the machine for longer than a step takes.
    for lane in 0..LANES {
        let (force, length) = (forces.lane(lane), shape.length.0[lane]);
        let direction = surroundings.direction::<TILTED>(was.theta.lane(lane), was.phi.lane(lane));
        let p = beyond(before, lane, length, direction);
        [before[0].0[lane], before[1].0[lane], before[2].0[lane]] = p;
        // Not a choice between two rows, which the compiler would turn into a gather.
        let eps = if surroundings.weaken(p, &force) { shape.eps.0[lane] } else { 1.0 };
        let c = eps * shape.gain.0[lane];

        let (theta, phi) = (was.theta.lane(lane), freed(&was, lane, &force));
        let ([sin_theta, cos_theta], [sin_phi, cos_phi]) = (theta, phi);
        let [fx, fy, fz] = force.in_polar;
        let outward = fx.mul_add(sin_phi, fz * cos_phi);
        let around = fx.mul_add(cos_phi, -(fz * sin_phi));
        let f_theta = cos_theta.mul_add(outward, -(fy * sin_theta));
        let theta_increment = c.mul_add(f_theta, was.theta_increment.0[lane]);
        let phi_increment = c.mul_add(sin_theta * around, was.phi_increment.0[lane]);
        far |= u32::from(is_far(theta_increment) | is_far(phi_increment));

        let (theta, phi) = (turn_little(theta, theta_increment), turn_little(phi, phi_increment));
        state.theta.set(lane, theta);
        state.phi.set(lane, phi);
        state.theta_increment.0[lane] = theta_increment;
        state.phi_increment.0[lane] = phi_increment;
        let p = beyond(from, lane, length, surroundings.direction::<TILTED>(theta, phi));
        [to[0].0[lane], to[1].0[lane], to[2].0[lane]] = p;
    }
    if far != 0 {
        // Lanes that turn little are done. The bits of a lane do not depend on its block.
        for lane in 0..LANES {
            let (theta, phi) = (was.theta.lane(lane), freed(&was, lane, &forces.lane(lane)));
            let (theta_increment, phi_increment) = (state.theta_increment.0[lane], state.phi_increment.0[lane]);
            let (theta, phi) = (turn_far(theta, theta_increment), turn_far(phi, phi_increment));
            state.theta.set(lane, if is_far(theta_increment) { theta } else { state.theta.lane(lane) });
            state.phi.set(lane, if is_far(phi_increment) { phi } else { state.phi.lane(lane) });
        }
        extend::<TILTED>(from, to, state, shape, surroundings);
    }
}

/// phi of one segment: the force's azimuth where the segment rests parallel to the polar axis (section 4.2).
#[inline(always)]
fn freed(state: &SegmentState, lane: usize, force: &Force) -> Turn {
    let free = force.has_azimuth()
        & (state.theta.lane(lane)[0].abs() < angles::POLE_SINE as f32)
        & (state.theta_increment.0[lane].abs() < angles::POLE_REST as f32);
    let (phi, azimuth) = (state.phi.lane(lane), force.azimuth);
    [if free { azimuth[0] } else { phi[0] }, if free { azimuth[1] } else { phi[1] }]
}

/// Turns a segment of every strand by angles of any size. Its increments do not change.
#[inline(always)]
pub(super) fn disturb_segment(state: &mut SegmentState, theta: &Row, phi: &Row, along: &Row) {
    for lane in 0..LANES {
        state.theta.set(lane, turn_far(state.theta.lane(lane), theta.0[lane] * along.0[lane]));
        state.phi.set(lane, turn_far(state.phi.lane(lane), phi.0[lane] * along.0[lane]));
    }
}
