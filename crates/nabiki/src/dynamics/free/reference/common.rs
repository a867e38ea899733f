//! What all strands have in common in one frame.

use glam::DVec3;

use super::contact::PlacedBody;
use crate::dynamics::free::head_frame::{HeadFrame, weight};
use crate::dynamics::{Dynamics, FrameInput};
use crate::free_form::FreeMotion;
use crate::pseudo_force::Gamma;

/// All that surrounds a strand in one frame, but for the air and its neighbours.
pub(in crate::dynamics) struct Common<'a> {
    pub(super) gamma: Gamma,
    pub(super) head: HeadFrame,
    /// The weight under which hair lies in balance at rest.
    pub(super) rest_weight: DVec3,
    pub(super) bodies: Vec<PlacedBody<'a>>,
}

impl<'a> Common<'a> {
    /// That of the frame of `input`.
    pub fn new(dynamics: &Dynamics, free: &'a FreeMotion, input: &FrameInput) -> Self {
        let gravity = f64::from(free.form.weight());
        Self {
            gamma: dynamics.gamma(),
            head: HeadFrame::new(input, &free.form, dynamics.motion.frame_rate),
            rest_weight: weight(&free.rest_pose, gravity),
            bodies: free.bodies.iter().enumerate().map(|(b, body)| PlacedBody::new(b, body, input)).collect(),
        }
    }
}
