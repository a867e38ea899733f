//! The pictures of a scene, drawn one after another.

use std::ops::RangeInclusive;
use std::path::PathBuf;

use glam::{Quat, Vec3};
use nabiki::dynamics::ForceSpace;
use nabiki::{SettingError, Strands};
use nabiki_render::{Bounds, Draft, Frame, FrameToDraw, Moment, Picture, RenderError, Renderer, ToneMapping, View};

use crate::built::BuiltScene;
use crate::error::{Error, Result};
use crate::frames::FrameSource;
use crate::memory;
use crate::motion_summary::MotionSummary;
use crate::outputs::{PictureOutputs, Stills};
use crate::watch::{Watch, each_frame};

/// Draws one frame after another and keeps none.
pub(crate) struct Film<'a> {
    built: &'a BuiltScene,
    picture: Picture,
    renderer: Renderer,
    tone_mapping: ToneMapping,
    bounds: Bounds,
    /// The file of the motion: a cache, or the scene.
    motion: PathBuf,
    /// The frame before, if the shutter is open.
    previous: Option<Strands>,
}

impl<'a> Film<'a> {
    /// A film of the scene as in `picture`, framed to show the hair of all its `frames`.
    pub fn new(
        built: &'a BuiltScene,
        picture: &Picture,
        frames: &mut dyn FrameSource,
        watch: &mut dyn Watch,
    ) -> Result<Self> {
        let mut film = Self::of_head(built, picture, frames)?;
        let bounds = &mut film.bounds;
        if !picture.camera.is_automatic() {
            // Nothing needs framing.
        } else if let Some([low, high]) = frames.bounds(built.frames()) {
            bounds.include(low);
            bounds.include(high);
        } else {
            each_frame(watch, "framing", 0..=built.frames(), |n| {
                let turn = built.pose(n).rotation;
                let strands = frames.frame(n)?;
                if built.head_moves() {
                    strands.points().iter().for_each(|&p| bounds.include(turn * p));
                } else {
                    bounds.include_strands(strands);
                }
                Ok(())
            })?;
        }
        Ok(film)
    }

    /// A film of the scene, moved by `frames`, as in `picture`, framed to show the head.
    fn of_head(built: &'a BuiltScene, picture: &Picture, frames: &dyn FrameSource) -> Result<Self> {
        let (head, strands) = (&built.model.head, built.strands().len());
        if let Some(short) = memory::short_of(Renderer::least_bytes(picture, strands, built.scene.output.exr_frames)) {
            let [width, height] = picture.size;
            let remedy = format!("a picture of {strands} strands {short}: give a smaller one, or fewer strands");
            return Err(built
                .scene
                .refusal(SettingError::new("picture.size", format!("[{width}, {height}]"), remedy))
                .into());
        }
        let renderer = Renderer::new(picture, &head.mesh)?.with_face(head).with_bodies(built.drawn_bodies())?;
        let mut bounds = Bounds::default();
        bounds.include_head(&head.mesh, &head.ellipsoid);
        Ok(Self {
            built,
            picture: picture.clone(),
            renderer: if built.scene.output.exr_frames { renderer.with_layers() } else { renderer },
            tone_mapping: ToneMapping::new(picture),
            bounds,
            motion: frames.file().unwrap_or(built.scene.file()).to_owned(),
            previous: None,
        })
    }

    /// The same with the layers that compositors need for hair, even if the scene does not ask for files with them.
    pub fn with_layers(mut self) -> Self {
        self.renderer = self.renderer.with_layers();
        self
    }

    /// The same, in the light of a draft.
    pub fn drafted(mut self, draft: Draft) -> Self {
        self.renderer = self.renderer.drafted(draft);
        self
    }

    /// Draws all frames into `outputs`, and reports the statistics of the motion.
    pub fn shoot(
        &mut self,
        frames: &mut dyn FrameSource,
        outputs: &mut PictureOutputs,
        watch: &mut dyn Watch,
    ) -> Result<MotionSummary> {
        let mut summary = MotionSummary::default();
        let built = self.built;
        each_frame(watch, "drawing", 0..=built.frames(), |n| {
            let strands = frames.frame(n)?;
            summary.add(built, n, strands);
            let (frame, view) = self.draw(n, strands)?;
            outputs.push(n, &frame, &view)
        })?;
        Ok(summary)
    }

    /// Draws only frame `n`.
    pub fn still(&mut self, n: u32, frames: &mut dyn FrameSource) -> Result<Frame> {
        self.begin_at(n, frames)?;
        Ok(self.draw(n, frames.frame(n)?)?.0)
    }

    /// Draws the `wanted` frames, each into its own files, as in the whole film.
    pub fn stills(
        &mut self,
        wanted: RangeInclusive<u32>,
        frames: &mut dyn FrameSource,
        stills: &Stills,
        watch: &mut dyn Watch,
    ) -> Result<()> {
        self.begin_at(*wanted.start(), frames)?;
        each_frame(watch, "drawing", wanted, |n| {
            let (frame, _) = self.draw(n, frames.frame(n)?)?;
            stills.write(n, &frame, &self.tone_mapping)
        })
    }

    /// Draws one frame from `views` directions around it: the camera moves around its target together with the lamps
    /// fixed to it. Motion is not blurred.
    pub fn turntable(
        built: &'a BuiltScene,
        (n, views): (u32, u32),
        frames: &mut dyn FrameSource,
        mut push: impl FnMut(u32, &Frame) -> Result<()>,
        watch: &mut dyn Watch,
    ) -> Result<()> {
        let picture = Picture { shutter: 0.0, ..built.scene.picture.clone() };
        let mut film = Self::of_head(built, &picture, frames)?;
        let strands = frames.frame(n)?.clone();
        let pose = built.pose(n);
        strands.points().iter().for_each(|&p| film.bounds.include(pose.rotation * p));
        let camera = picture.camera.at(n as f32 / built.frames() as f32);
        let views = View::around(&camera, picture.size, &film.bounds, views);
        let bodies = built.drawn_poses(n);
        film.renderer.bend(built.bent(n));
        each_frame(watch, "drawing", 0..=views.len() as u32 - 1, |k| {
            let view = views[k as usize];
            let view = View { eye: view.eye + pose.position_cm, ..view };
            let now = Moment { strands: &strands, pose, view, bodies: &bodies };
            let drawn = film.renderer.draw(&FrameToDraw { now, before: None });
            push(k, &drawn.map_err(|refused| film.in_frame(n, refused))?)
        })
    }

    /// Prepares for a film that begins with frame `n`.
    fn begin_at(&mut self, n: u32, frames: &mut dyn FrameSource) -> Result<()> {
        if self.picture.shutter > 0.0 && n > 0 {
            self.previous = Some(frames.frame(n - 1)?.clone());
        }
        Ok(())
    }

    /// The view of frame `n`, from the head's origin along the world's axes.
    fn view(&self, n: u32) -> View {
        let progress = n as f32 / self.built.frames() as f32;
        View::new(&self.picture.camera.at(progress), self.picture.size, &self.bounds)
    }

    /// The view of frame `n` in the world. The camera follows the head, and does not turn with it.
    fn view_in_world(&self, n: u32) -> View {
        let view = self.view(n);
        View { eye: view.eye + self.built.pose(n).position_cm, ..view }
    }

    /// The frame, and the view in the space of the forces.
    fn draw(&mut self, n: u32, strands: &Strands) -> Result<(Frame, View)> {
        let previous = self.previous.take();
        let built = self.built;
        self.renderer.bend(built.bent(n));
        let (bodies, bodies_before) = (built.drawn_poses(n), built.drawn_poses(n.saturating_sub(1)));
        let moment = |n, strands, bodies| Moment { strands, pose: built.pose(n), view: self.view_in_world(n), bodies };
        let now = moment(n, strands, bodies.as_slice());
        let before = previous.as_ref().filter(|_| n > 0).map(|previous| moment(n - 1, previous, &bodies_before));
        let drawn = self.renderer.draw(&FrameToDraw { now, before });
        let frame = drawn.map_err(|refused| self.in_frame(n, refused))?;
        let view = match self.built.dynamics.motion.force_space {
            ForceSpace::World => now.view,
            ForceSpace::Head => {
                let eye = now.view.eye - now.pose.position_cm;
                turned(View { eye, ..now.view }, now.pose.rotation.inverse())
            }
        };
        if self.picture.shutter > 0.0 {
            self.previous = Some(kept(previous, strands));
        }
        Ok((frame, view))
    }

    /// Adds to the error the frame and the motion with what cannot be drawn, or the setting's line.
    fn in_frame(&self, n: u32, refused: RenderError) -> Error {
        match refused {
            // A scene made in code has no file.
            RenderError::Geometry(what) if self.motion.as_os_str().is_empty() => {
                Error::refused(format!("frame {n}: {what}"))
            }
            RenderError::Geometry(what) => Error::refused(format!("{}: frame {n}: {what}", self.motion.display())),
            RenderError::Setting(refused) => self.built.scene.refusal(refused).into(),
            other => other.into(),
        }
    }
}

/// Copies a frame for the blur of the next, into the memory of the one before.
fn kept(before: Option<Strands>, now: &Strands) -> Strands {
    match before {
        Some(mut room) if room.starts() == now.starts() => {
            room.points_mut().copy_from_slice(now.points());
            room
        }
        _ => now.clone(),
    }
}

/// The view from a camera rotated about the origin.
fn turned(view: View, turn: Quat) -> View {
    let [eye, right, up, forward] = [view.eye, view.right, view.up, view.forward].map(|v: Vec3| turn * v);
    View { eye, right, up, forward, ..view }
}

#[cfg(test)]
#[path = "film/tests.rs"]
mod tests;
