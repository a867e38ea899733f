//! All frames of a motion at once, again and again, for an editor or for trying many fields.
//!
//! Each block of strands goes through all frames before the next block starts, so its state stays in the nearest cache.
//! Nothing is rebuilt between two runs. The frames are the same, bit by bit, as those of
//! [`Simulation`](super::Simulation).
//!
//! With neighbour forces, the carriers move first, frame by frame. The grid that they leave is then a field for all
//! other strands, which go block by block.

use std::sync::Arc;

use glam::Vec3;

use super::runner::Runner;
use super::sweep::Pages;
use super::{Dynamics, FrameInput, VectorWidth, free};
use crate::error::SettingError;
use crate::field::Field;
use crate::pose::{self, Pose};
use crate::strands::Strands;

/// Hair, its field, and its frames from rest to the last.
///
/// A timeline is at one [`frame`](Self::frame) and shows its hair. [`advance`](Self::advance) and [`seek`](Self::seek)
/// go to another frame and keep no others. [`play`](Self::play) computes all frames into storage that it keeps. Work
/// runs on the rayon pool of the calling thread.
#[derive(Clone, Debug)]
pub struct Timeline {
    /// The hair at rest as it was given.
    hair: Strands,
    runner: Runner,
    field: Arc<dyn Field>,
    /// One per frame; empty for a head that does not move.
    poses: Vec<Pose>,
    frames: u32,
    width: VectorWidth,
    frame: u32,
    strands: Strands,
    /// The points of frame 0, then those of frame 1, ...
    film: Vec<Vec3>,
    played: bool,
}

impl Timeline {
    /// Hair at rest in this shape, at frame 0, with `frames` more frames. `poses` are those of the head in the world
    /// from frame 0 on; empty for a head that stays at the origin.
    ///
    /// # Errors
    /// As for [`Simulation::new`](super::Simulation::new); too few poses, or invalid ones.
    pub fn new(
        strands: &Strands,
        dynamics: &Dynamics,
        field: Arc<dyn Field>,
        poses: Vec<Pose>,
        frames: u32,
    ) -> Result<Self, SettingError> {
        let ids: Vec<u32> = (0..strands.len() as u32).collect();
        Self::with_ids(strands, &ids, dynamics, field, poses, frames)
    }

    /// Like [`new`](Self::new), for a part of a larger set of strands: `ids` are their indices in that set.
    ///
    /// # Errors
    /// As for [`new`](Self::new).
    ///
    /// # Panics
    /// If the number of ids is not the number of strands.
    pub fn with_ids(
        strands: &Strands,
        ids: &[u32],
        dynamics: &Dynamics,
        field: Arc<dyn Field>,
        poses: Vec<Pose>,
        frames: u32,
    ) -> Result<Self, SettingError> {
        check_poses(&poses, frames)?;
        let runner = Runner::new(strands, ids, dynamics, &*field)?;
        let mut timeline = Self {
            hair: strands.clone(),
            runner,
            field,
            poses,
            frames,
            width: VectorWidth::default(),
            frame: 0,
            strands: strands.clone(),
            film: Vec::new(),
            played: false,
        };
        timeline.rewind();
        Ok(timeline)
    }

    /// The same timeline with another vector width.
    #[must_use]
    pub fn with_vector_width(mut self, width: VectorWidth) -> Self {
        self.width = width;
        self
    }

    /// The number of the last frame.
    pub fn frames(&self) -> u32 {
        self.frames
    }

    /// The frame that [`strands`](Self::strands) shows; 0 at rest.
    pub fn frame(&self) -> u32 {
        self.frame
    }

    /// The hair at this frame (head space, cm).
    pub fn strands(&self) -> &Strands {
        &self.strands
    }

    /// The field.
    pub fn field(&self) -> &Arc<dyn Field> {
        &self.field
    }

    /// The settings of the motion.
    pub fn dynamics(&self) -> &Dynamics {
        self.runner.dynamics()
    }

    /// The pose of the head in a frame.
    pub fn pose(&self, frame: u32) -> Pose {
        self.poses.get(frame as usize).copied().unwrap_or_default()
    }

    /// Puts the hair back to rest, at frame 0.
    pub fn rewind(&mut self) {
        self.go(0, true);
    }

    /// Moves the hair by one frame. At the last frame it returns `false` and does nothing.
    pub fn advance(&mut self) -> bool {
        let more = self.frame < self.frames;
        if more {
            self.go(self.frame + 1, false);
        }
        more
    }

    /// Goes to a frame and returns its hair (head space, cm). It computes from the current frame, or from rest to go
    /// backward.
    ///
    /// # Panics
    /// If there is no such frame.
    pub fn seek(&mut self, frame: u32) -> &Strands {
        assert!(frame <= self.frames, "frame {frame} of {}", self.frames);
        if frame != self.frame {
            self.go(frame, frame < self.frame);
        }
        &self.strands
    }

    /// Computes all frames and goes to the last one. If nothing was set since the last call, it returns at once.
    pub fn play(&mut self) -> Played<'_> {
        if !self.played {
            let points = self.strands.points().len();
            self.film.resize((self.frames as usize + 1) * points, Vec3::ZERO);
            let mut film = std::mem::take(&mut self.film);
            self.play_into(&mut film);
            (self.film, self.played) = (film, true);
        } else if self.frame < self.frames {
            let points = self.strands.points_mut();
            points.copy_from_slice(&self.film[self.film.len() - points.len()..]);
            // The states are still those of another frame, so continuing from them is wrong: going back starts at rest.
            self.frame = self.frames;
        }
        Played { points: &self.film, hair: &self.hair }
    }

    /// Computes all frames into the caller's storage and goes to the last one: the points of frame 0, then those of
    /// frame 1, and so on, in the order of [`Strands::points`]. Use it for films that go to another thread.
    ///
    /// # Panics
    /// If the number of points is wrong.
    pub fn play_into(&mut self, film: &mut [Vec3]) {
        self.play_into_while(film, self.frames + 1, || true);
    }

    /// Like [`play_into`](Self::play_into), `stretch` frames at a time. Between stretches it calls `goes_on`. If that
    /// returns `false`, the timeline stays at the last frame of the last stretch, the film holds the frames up to it,
    /// and the result is `false`. Use it when the computation is long and the user may cancel it.
    ///
    /// # Panics
    /// If the number of points is wrong or `stretch` is 0.
    pub fn play_into_while(&mut self, film: &mut [Vec3], stretch: u32, mut goes_on: impl FnMut() -> bool) -> bool {
        let points = self.strands.points().len();
        let frames = self.frames as usize + 1;
        assert_eq!(film.len(), frames * points, "a film has room for every point of every frame");
        assert!(stretch > 0, "a stretch has at least one frame");
        let mut first = 0;
        while first < frames && (first == 0 || goes_on()) {
            let end = (first + stretch as usize).min(frames);
            let pages = film[first * points..end * points].chunks_exact_mut(points).collect();
            self.sweep(first as u32..=end as u32 - 1, Pages::All(pages));
            first = end;
        }
        self.strands.points_mut().copy_from_slice(&film[(first - 1) * points..first * points]);
        self.frame = first as u32 - 1;
        first == frames
    }

    /// Sets another field and puts the hair back to rest.
    ///
    /// # Errors
    /// A field too strong for the step. The timeline is unchanged then.
    pub fn set_field(&mut self, field: Arc<dyn Field>) -> Result<(), SettingError> {
        self.runner.check_field(&self.hair, &*field)?;
        self.field = field;
        self.forget();
        Ok(())
    }

    /// The carriers' grid in this frame; none if hair feels no neighbours.
    pub(super) fn crowd(&self) -> Option<&free::Crowd> {
        self.runner.crowd()
    }

    /// Takes the state of another timeline of the same hair; `false`, and no change, if that is other hair. Its field stays.
    pub(crate) fn stand_where(&mut self, of: &Self) -> bool {
        let (own, shown) = (self.strands.points_mut(), of.strands.points());
        let is_same = self.runner.set_state(&of.runner, self.width, own, shown).is_ok();
        if is_same {
            (self.frame, self.played) = (of.frame, false);
        }
        is_same
    }

    /// Replaces the field and keeps the state. The caller knows that both fields agree up to the current frame.
    ///
    /// # Errors
    /// As [`set_field`](Self::set_field).
    pub(crate) fn set_field_onward(&mut self, field: Arc<dyn Field>) -> Result<(), SettingError> {
        self.runner.check_field(&self.hair, &*field)?;
        (self.field, self.played) = (field, false);
        Ok(())
    }

    /// Sets other settings of the motion and puts the hair back to rest.
    ///
    /// # Errors
    /// As for [`new`](Self::new). The timeline is unchanged then.
    pub fn set_dynamics(&mut self, dynamics: &Dynamics) -> Result<(), SettingError> {
        self.runner = self.runner.with_dynamics(&self.hair, dynamics, &*self.field)?;
        self.forget();
        Ok(())
    }

    /// Sets another motion of the head and number of frames, and puts the hair back to rest.
    ///
    /// # Errors
    /// As for [`new`](Self::new). The timeline is unchanged then.
    pub fn set_poses(&mut self, poses: Vec<Pose>, frames: u32) -> Result<(), SettingError> {
        check_poses(&poses, frames)?;
        (self.poses, self.frames) = (poses, frames);
        self.forget();
        Ok(())
    }

    fn forget(&mut self) {
        self.played = false;
        self.rewind();
    }

    /// Goes to a frame that is not before the current one, or starts `from_rest`.
    fn go(&mut self, frame: u32, from_rest: bool) {
        let first = if from_rest { 0 } else { self.frame + 1 };
        let mut strands = std::mem::take(&mut self.strands);
        self.sweep(first..=frame, Pages::Last(strands.points_mut()));
        (self.strands, self.frame) = (strands, frame);
    }

    /// Takes the hair through some frames, of which 0 is rest.
    fn sweep(&mut self, frames: std::ops::RangeInclusive<u32>, pages: Pages) {
        let Self { runner, field, poses, .. } = self;
        let (from_rest, last) = (*frames.start() == 0, *frames.end());
        let first = (*frames.start()).max(1);
        let inputs: Vec<FrameInput> = (first..=last).map(|frame| FrameInput::new(frame, poses, &**field)).collect();
        runner.run(from_rest, &inputs, self.width, pages);
    }
}

/// All frames of a motion, from [`Timeline::play`].
#[derive(Clone, Copy, Debug)]
pub struct Played<'a> {
    points: &'a [Vec3],
    hair: &'a Strands,
}

impl<'a> Played<'a> {
    /// The last frame's number.
    pub fn frames(&self) -> u32 {
        (self.points.len() / self.hair.points().len()) as u32 - 1
    }

    /// The points of all strands at a frame (head space, cm), as [`Strands::points`] orders them.
    ///
    /// # Panics
    /// If there is no such frame.
    pub fn points(&self, frame: u32) -> &'a [Vec3] {
        let points = self.hair.points().len();
        &self.points[frame as usize * points..][..points]
    }

    /// The points of one strand at a frame (head space, cm), root first.
    ///
    /// # Panics
    /// If there is no such frame or strand.
    pub fn strand(&self, frame: u32, strand: usize) -> &'a [Vec3] {
        &self.points(frame)[self.hair.range(strand)]
    }
}

/// Refuses head poses that are too few or invalid.
fn check_poses(poses: &[Pose], frames: u32) -> Result<(), SettingError> {
    if poses.is_empty() {
        return Ok(());
    }
    if poses.len() <= frames as usize {
        let remedy = format!(
            "the head's motion ends at frame {}: give a pose for every frame from 0 on, or ask for fewer frames",
            poses.len() - 1
        );
        return Err(SettingError::new("motion.frames", frames, remedy));
    }
    pose::check_poses("head.motion", poses)
}
