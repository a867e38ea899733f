//! What moves a segment of the free form.

use glam::{DVec3, Vec3};

use super::pulls::{hold, joints, weight};
use crate::aim::swing;
use crate::dynamics::Dynamics;
use crate::dynamics::gain::{SegmentShape, push, segment_shapes};
use crate::error::SettingError;
use crate::free_form::{FreeForm, FreeMotion};
use crate::profile::Profile;
use crate::region::Region;

/// What moves one segment, and the node at its end. Directions are in head space; moments and forces are for hair of
/// weight 1 per cm.
#[derive(Clone, Copy, Debug)]
pub(in crate::dynamics) struct FreeSegment {
    pub shape: SegmentShape,
    /// r_i, of length 1.
    pub rest: DVec3,
    /// A: the acceleration of the node by a force of 1 (cm per frame^2). 0 if the segment is held.
    pub push: f64,
    /// 1/m_i, of the node (1/cm). 0 if the segment is held: infinite mass stays in place.
    pub lightness: f64,
    /// B_i of the joint at its beginning: its moment per radian (cm^3 per frame^2).
    pub bending: f64,
    /// u_i and S_i: what supports the weight of it and of all beyond at rest (cm^3 per frame^2).
    pub up: DVec3,
    pub supports: f64,
    /// C_i: the moment per radian with which hold turns it back.
    pub hold: f64,
    /// The moment per radian of an aim of strength 1.
    pub lever: f64,
    /// alpha_i, the share of the node's speed that the air takes (1 per frame).
    pub air: f64,
    /// The share of the head's motion that it is left behind by.
    pub drag: f64,
}

/// Steps that a frame is divided into where [`FreeForm::substeps`] is left open, for hair of this mean length in segments of this one (cm): so
/// many that it swings by its weight by at most a fourteenth of a radian in a step, two at least, and more where segments are fine and stiff.
/// The implicit step bears any stiffness of hair that hardly turns, but where hair is turned far in a step by what presses it, joints as stiff
/// as that throw it. `gravity`: its strength. Real hair of 18 cm in segments of 1 cm takes five at 24 frames a second, two at 120.
pub fn substeps(dynamics: &Dynamics, form: &FreeForm, gravity: f32, [length, segment]: [f64; 2]) -> u32 {
    /// Rad per step. In the gust under the earth's gravity at 24 frames a second, single strands pressed to the head keep moving to and
    /// fro at 0.09 and 0.11, and all lie still at 0.07. Swings come out slower by a fiftieth.
    const SWING: f64 = 0.07;
    /// Limit of the fastest ripple, sqrt(EI / lambda) / l^2, times the step. In the shipped scenes, curls and ponytail
    /// throw single strands at 13; at 10, curls do in a wind four times as strong.
    const RIPPLE: f64 = 6.0;
    let push = push(dynamics, length);
    let swing = (push * f64::from(gravity) * form.most_weight() / length).sqrt();
    let stiffest = form.stiffness.values().iter().fold(0.0_f32, |most, k| most.max(*k));
    let stiffest = f64::from(stiffest) * form.most_stiffened();
    let ripple = joints::bending(dynamics, push, length, stiffest).sqrt() / segment.powi(2);
    (swing / SWING).max(ripple / RIPPLE).ceil().clamp(2.0, 32.0) as u32
}

/// Every segment of one strand, root first, as the check of forces asks: the gain of those that move is A h^2 / L, by which a force of 1
/// moves the strand in a step of h frames, in its own lengths; more where it takes more of the air than others.
///
/// # Errors
/// As [`segment_shapes`].
pub(in crate::dynamics) fn shapes(
    dynamics: &Dynamics,
    free: &FreeMotion,
    strand: &[Vec3],
    s: usize,
) -> Result<Vec<SegmentShape>, SettingError> {
    let held = free.form.held(strand);
    let mut shapes = segment_shapes(dynamics, strand, s, held)?;
    let length = shapes[held..].iter().map(|shape| shape.length).sum();
    let step = 1.0 / f64::from(free.form.steps());
    let most = free.own(strand).most_wind() * f64::from(free.shares(strand[0]).largest());
    let gain = push(dynamics, length) * step.powi(2) / length * most.max(1.0);
    shapes[held..].iter_mut().for_each(|shape| shape.gain = gain);
    Ok(shapes)
}

/// Every segment of one strand, root first.
///
/// # Errors
/// As [`segment_shapes`].
pub(in crate::dynamics) fn free_segments(
    dynamics: &Dynamics,
    free: &FreeMotion,
    strand: &[Vec3],
    s: usize,
) -> Result<Vec<FreeSegment>, SettingError> {
    let form = &free.form;
    let held = form.held(strand);
    let shapes = segment_shapes(dynamics, strand, s, held)?;
    let points: Vec<DVec3> = strand.iter().map(|p| p.as_dvec3()).collect();
    let length: f64 = shapes[held..].iter().map(|shape| shape.length).sum();
    let push = push(dynamics, length);
    let (own, regions) = (free.own(strand), free.regions_of(strand[0]));
    let gravity = own.weight * f64::from(form.gravity);
    let rest_weight = push * weight::on_head(&free.rest_pose, gravity);
    let still = |i: usize| FreeSegment {
        shape: shapes[i],
        rest: (points[i + 1] - points[i]).normalize(),
        push: 0.0,
        lightness: 0.0,
        bending: 0.0,
        up: DVec3::ZERO,
        supports: 0.0,
        hold: 0.0,
        lever: 0.0,
        air: 0.0,
        drag: 0.0,
    };
    let mut segments: Vec<FreeSegment> = (0..shapes.len()).map(still).collect();
    // From the tip: the length of hair that each segment holds by its end.
    let mut beyond = 0.0;
    for i in (held..shapes.len()).rev() {
        let shape = shapes[i];
        let next = shapes.get(i + 1).map_or(0.0, |next| next.length);
        let before = if i == held { 0.0 } else { shapes[i - 1].length };
        let mass = 0.5 * (shape.length + next);
        beyond += mass;
        let rest = still(i).rest;
        let (up, supports) = weight::support(rest, beyond * shape.length * rest_weight);
        let middle = length * shape.middle;
        let at_middle = |first, factor: fn(&Region) -> &Profile| regions.times(first, factor, shape.middle);
        let stiffness = regions.times(own.stiffness, |region| &region.stiffness, shape.begin);
        let settle = at_middle(1.0, |region| &region.settle) * f64::from(dynamics.motion.slow);
        let held = at_middle(1.0, |region| &region.hold) * form.hold.at(shape.middle)
            + weight::held_up(&free.rest_pose, gravity, rest);
        segments[i] = FreeSegment {
            push,
            lightness: 1.0 / mass,
            bending: joints::bending(dynamics, push, length, stiffness * form.stiffness.at(shape.begin))
                / (0.5 * (before + shape.length)),
            up,
            supports,
            hold: hold::moment_per_radian(push, held, length - middle, shape.length),
            lever: hold::moment_per_radian(push, 1.0, length - middle, shape.length),
            air: own.air * form.air(shape.middle) / settle,
            drag: at_middle(1.0, |region| &region.drag) * form.drag.at(shape.middle),
            ..segments[i]
        };
    }
    Ok(segments)
}

/// See [`swing`]; 0 for a strand that is held to its tip.
pub(super) fn swing_of(segments: &[FreeSegment]) -> f64 {
    let free = || segments.iter().filter(|segment| segment.lightness > 0.0);
    let length: f64 = free().map(|segment| segment.shape.length).sum();
    free().next().map_or(0.0, |segment| swing(segment.push, length))
}
