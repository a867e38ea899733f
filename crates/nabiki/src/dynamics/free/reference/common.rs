//! What all strands have in common in one frame.

use glam::DVec3;

use super::contact::PlacedBody;
use crate::dynamics::free::head_frame::HeadFrame;
use crate::dynamics::free::pulls::weight;
use crate::dynamics::ride::SkinStep;
use crate::dynamics::{Dynamics, FrameInput};
use crate::free_form::FreeMotion;
use crate::pseudo_force::Gamma;

/// The surroundings of all strands in one frame, except the air and their neighbours.
pub(in crate::dynamics) struct Common<'a> {
    /// Number of the frame to compute.
    pub(super) frame: u32,
    pub(super) gamma: Gamma,
    pub(super) head: HeadFrame,
    /// None without skin that carries roots.
    pub(super) skin: Option<SkinStep<'a>>,
    /// The weight that balances the hair at rest.
    pub(super) rest_weight: DVec3,
    /// The bodies at the end of each step of the frame.
    pub(super) bodies: Vec<Vec<PlacedBody<'a>>>,
}

impl<'a> Common<'a> {
    /// That of the frame of `input`.
    pub fn new(dynamics: &'a Dynamics, free: &'a FreeMotion, input: &FrameInput<'a>) -> Self {
        let steps = free.form.steps();
        let bodies = |step| {
            let place = |(b, body)| PlacedBody::new(b, body, input, [step, steps]);
            free.bodies.iter().enumerate().map(place).collect()
        };
        let head = HeadFrame::new(input, &free.form);
        Self {
            frame: input.frame,
            gamma: dynamics.gamma(),
            skin: SkinStep::new(dynamics, input, &head),
            head,
            rest_weight: weight::on_head(&free.rest_pose, f64::from(free.form.gravity)),
            bodies: (1..=steps).map(bodies).collect(),
        }
    }
}
