//! The pictures of a take, drawn one after another.

use std::path::Path;

use glam::{Quat, Vec3};
use nabiki::Strands;
use nabiki::dynamics::{ForceSpace, Simulation, Stepper};
use nabiki_io::cache::Reader;
use nabiki_render::output::png;
use nabiki_render::{Bounds, Frame, FrameToDraw, Moment, Picture, RenderError, Renderer, ToneMapping, View};
use nabiki_scene::Take;

use crate::failure::Failure;
use crate::progress;
use crate::reel::Reel;

/// Where frames come from, one after another from 0 on.
pub trait Frames {
    /// The strands of frame `n` (head space).
    fn frame(&mut self, n: u32) -> Result<&Strands, Failure>;
}

/// Frames as they are simulated.
pub struct Simulated<'a> {
    pub take: &'a Take,
    pub simulation: Simulation,
}

impl Frames for Simulated<'_> {
    fn frame(&mut self, n: u32) -> Result<&Strands, Failure> {
        while self.simulation.frame() < n {
            self.simulation.step_frame_under(self.take.force_in_head(self.simulation.frame() + 1));
        }
        Ok(self.simulation.strands())
    }
}

/// Frames out of a motion cache.
pub struct Cached {
    reader: Reader,
    strands: Strands,
}

impl Cached {
    pub fn new(reader: Reader) -> Self {
        Self { strands: reader.header().strands(), reader }
    }
}

impl Frames for Cached {
    fn frame(&mut self, n: u32) -> Result<&Strands, Failure> {
        self.reader.read(n.into(), &mut self.strands)?;
        Ok(&self.strands)
    }
}

/// Draws one frame after another and keeps none.
pub struct Film<'a> {
    take: &'a Take,
    picture: Picture,
    renderer: Renderer,
    tone_mapping: ToneMapping,
    bounds: Bounds,
    /// The frame before, where the shutter stays open.
    previous: Option<Strands>,
    quiet: bool,
}

impl<'a> Film<'a> {
    /// Shows `take` as `picture` says, framed so that it holds the hair of all its `frames`.
    pub fn new(take: &'a Take, picture: &Picture, frames: &mut dyn Frames, quiet: bool) -> Result<Self, Failure> {
        let head = &take.stage.head;
        let renderer = Renderer::new(picture, &head.mesh)?;
        let mut bounds = Bounds::default();
        bounds.include_head(&head.mesh, &head.ellipsoid);
        if picture.camera.is_automatic() {
            for n in 0..=take.stage.scene.motion.frames {
                let turn = take.pose(n).rotation;
                let strands = frames.frame(n)?;
                if take.head_moves() {
                    strands.points().iter().for_each(|&p| bounds.include(turn * p));
                } else {
                    bounds.include_strands(strands);
                }
            }
        }
        Ok(Self {
            take,
            picture: picture.clone(),
            renderer: if take.stage.scene.output.exr_frames { renderer.with_layers() } else { renderer },
            tone_mapping: ToneMapping::new(picture),
            bounds,
            previous: None,
            quiet,
        })
    }

    /// Draws all frames onto `reel`.
    pub fn shoot(&mut self, frames: &mut dyn Frames, reel: &mut Reel) -> Result<(), Failure> {
        let last = self.take.stage.scene.motion.frames;
        let bar = progress::bar(u64::from(last) + 1, "drawing", self.quiet);
        for n in 0..=last {
            let (frame, view) = self.draw(n, frames.frame(n)?)?;
            reel.push(n, &frame, &view)?;
            bar.inc(1);
        }
        bar.finish_and_clear();
        Ok(())
    }

    /// Draws frame `n` alone, as a PNG at `path`.
    pub fn still(&mut self, n: u32, frames: &mut dyn Frames, path: &Path) -> Result<(), Failure> {
        if self.picture.shutter > 0.0 && n > 0 {
            self.previous = Some(frames.frame(n - 1)?.clone());
        }
        let (frame, _) = self.draw(n, frames.frame(n)?)?;
        Ok(png::write(path, &frame, &self.tone_mapping, png::Depth::Eight)?)
    }

    /// The view of frame `n`, from the head's origin along the world's axes.
    fn view(&self, n: u32) -> View {
        let progress = n as f32 / self.take.stage.scene.motion.frames as f32;
        View::new(&self.picture.camera.at(progress), self.picture.size, &self.bounds)
    }

    /// The view of frame `n` in the world. The camera goes along with the head, and does not turn with it.
    fn view_in_world(&self, n: u32) -> View {
        let view = self.view(n);
        View { eye: view.eye + self.take.pose(n).position_cm, ..view }
    }

    /// The frame, and the view in the space of the forces.
    fn draw(&mut self, n: u32, strands: &Strands) -> Result<(Frame, View), RenderError> {
        let previous = self.previous.take();
        let moment = |n: u32, strands| Moment { strands, pose: self.take.pose(n), view: self.view_in_world(n) };
        let now = moment(n, strands);
        let before = previous.as_ref().filter(|_| n > 0).map(|previous| moment(n - 1, previous));
        let frame = self.renderer.draw(&FrameToDraw { now, before })?;
        if self.picture.shutter > 0.0 {
            self.previous = Some(strands.clone());
        }
        let view = match self.take.stage.dynamics.motion.force_space {
            ForceSpace::World => now.view,
            ForceSpace::Head => turned(now.view, now.pose.rotation.inverse()),
        };
        Ok((frame, view))
    }
}

/// The view from a camera turned about the origin.
fn turned(view: View, turn: Quat) -> View {
    let [eye, right, up, forward] = [view.eye, view.right, view.up, view.forward].map(|v: Vec3| turn * v);
    View { eye, right, up, forward, ..view }
}

#[cfg(test)]
#[path = "film/tests.rs"]
mod tests;
