//! The input of a frame: hair, head and camera in this frame and in the previous one.

use nabiki::{Mesh, Pose, Strands};

use crate::camera::View;

/// A body to draw in addition to the head.
#[derive(Clone, Debug, PartialEq)]
pub struct DrawnBody {
    /// Its surface (body space, cm).
    pub mesh: Mesh,
    /// Its colour (sRGB, 0..1).
    pub colour: [f32; 3],
}

/// Hair, head and camera at one frame.
#[derive(Clone, Copy, Debug)]
pub struct Moment<'a> {
    /// The hair (head space, cm).
    pub strands: &'a Strands,
    /// The pose of the head in the world.
    pub pose: Pose,
    /// The camera, in the world.
    pub view: View,
    /// World poses of the renderer's bodies, in order.
    pub bodies: &'a [Pose],
}

/// The input of a frame.
#[derive(Clone, Copy, Debug)]
pub struct FrameToDraw<'a> {
    /// The frame itself, at which the shutter closes.
    pub now: Moment<'a>,
    /// The previous frame of the same strands; `None` for the first. Without it, or with a shutter of 0, there is no
    /// motion blur.
    pub before: Option<Moment<'a>>,
}

impl<'a> FrameToDraw<'a> {
    /// Hair on a head that does not move, without motion blur.
    pub fn at_rest(strands: &'a Strands, view: View) -> Self {
        Self { now: Moment { strands, pose: Pose::STILL, view, bodies: &[] }, before: None }
    }
}
