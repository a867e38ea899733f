//! What a frame is drawn from: hair, head and camera now, and at the frame before.

use nabiki::{Mesh, Pose, Strands};

use crate::camera::View;

/// A body that is drawn besides the head.
#[derive(Clone, Debug, PartialEq)]
pub struct DrawnBody {
    /// Its surface (its own space, cm).
    pub mesh: Mesh,
    /// Its colour (sRGB, 0..1).
    pub colour: [f32; 3],
}

/// Hair, head and camera at one frame.
#[derive(Clone, Copy, Debug)]
pub struct Moment<'a> {
    /// The hair (head space, cm).
    pub strands: &'a Strands,
    /// Where the head is in the world.
    pub pose: Pose,
    /// The camera, in the world.
    pub view: View,
    /// Where the renderer's bodies are in the world, in their order.
    pub bodies: &'a [Pose],
}

/// All that one frame is drawn from.
#[derive(Clone, Copy, Debug)]
pub struct FrameToDraw<'a> {
    /// The frame itself: the shutter closes here.
    pub now: Moment<'a>,
    /// The frame before, of the same strands; none for the first. Without it, or with a shutter of 0, the picture is sharp.
    pub before: Option<Moment<'a>>,
}

impl<'a> FrameToDraw<'a> {
    /// Hair on a head that stands still in the world, sharp.
    pub fn at_rest(strands: &'a Strands, view: View) -> Self {
        Self { now: Moment { strands, pose: Pose::STILL, view, bodies: &[] }, before: None }
    }
}
