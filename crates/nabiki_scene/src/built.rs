//! A scene with everything loaded: the head, the hair, and what moves them.

mod bodies;
mod build;
mod dynamics;
mod forces;
mod groom;
mod identity;
mod model;
mod stage;
#[cfg(test)]
mod tests;
mod way;

use std::borrow::Cow;
use std::sync::Arc;

use glam::Vec3;
use nabiki::dynamics::{Dynamics, Form, FrameInput, Motion, Reference, Simulation, Timeline};
use nabiki::field::Keyframe;
use nabiki::{Hair, Head, Mesh, Pose, SettingError, Strands};
use nabiki_io::cache::{Origin, Shard};
use nabiki_render::DrawnBody;

use crate::advice::Advice;
use crate::error::{Error, Result};
use crate::memory;
use crate::scene::{FieldBound, ForceSettings, Scene};
use crate::seat::{self, LikelyRoots, Seat};

pub use forces::Forces;
pub use groom::{Groom, Imported, ShardOf};
pub use model::Model;
pub use way::Way;

pub(crate) use way::holds_scenes;

use bodies::BuiltBody;
use model::ModelInputs;
use stage::{At, Stage};

/// All that a scene names, loaded and in head space, ready to be stepped. Scenes that have parts of it alike share them
/// ([`changed_to`](Self::changed_to)).
#[derive(Clone, Debug)]
pub struct BuiltScene {
    /// The scene it was built from.
    pub scene: Scene,
    /// The head.
    pub model: Arc<Model>,
    /// Where the head is in each frame.
    pub way: Arc<Way>,
    /// The hair at rest.
    pub groom: Arc<Groom>,
    /// What pushes the hair.
    pub forces: Arc<Forces>,
    /// How the hair answers a force.
    pub dynamics: Dynamics,
    /// The scene's bodies, in their order; none in the paper's form.
    pub(crate) bodies: Vec<Arc<BuiltBody>>,
    /// How strong a wind of 1 cm/s is, in the free form.
    of_speed: f64,
}

impl Scene {
    /// Loads the head, grows or imports the hair, reads the head's motion.
    ///
    /// # Errors
    /// One line: file, thing, value and the way out.
    pub fn build(self, shown: Shown) -> Result<BuiltScene> {
        build::build(self, shown, None, &[], &|_| true)
    }

    /// The same, or what [`BuiltScene::changed_to`] gives of scenes that are `known`, the first of those that have a part alike, for
    /// whoever may want it no more: between the files that are read, while roots are chosen and while hair grows, `goes_on` is told again and again, by any thread, how much is
    /// grown, 0..1, and asked whether to go on.
    ///
    /// # Errors
    /// As [`build`](Self::build); [`Error::Cancelled`] where it was not to go on.
    pub fn build_while(
        self,
        shown: Shown,
        known: &[&BuiltScene],
        goes_on: &(dyn Fn(f32) -> bool + Sync),
    ) -> Result<BuiltScene> {
        build::build(self, shown, None, known, goes_on)
    }

    /// The same, of which one shard of the strands alone is kept, and, where hair is grown, grown: each moves, to the bit,
    /// as it does in the whole.
    ///
    /// # Errors
    /// As [`build`](Self::build); more shards than strands.
    pub fn build_shard(self, shown: Shown, shard: Shard) -> Result<BuiltScene> {
        build::build(self, shown, Some(shard), &[], &|_| true)
    }

    /// What each of the scene's fields can reach, and last `all` of them together; head and motion are loaded for it, and hair where
    /// the wind has a speed.
    ///
    /// # Errors
    /// As [`build`](Self::build).
    pub fn field_bounds(&self) -> Result<Vec<FieldBound>> {
        build::field_bounds(self)
    }

    /// Loads the head alone.
    ///
    /// # Errors
    /// As [`build`](Self::build).
    pub fn load_head(&self) -> Result<Head> {
        Model::make(ModelInputs::of(self), At::new(self, &|_| true)).map(|model| model.head)
    }
}

/// How many of a scene's strands are built: the first of the farthest-first order of its roots, so evenly spread over
/// the scalp. Each moves, to the bit, as it does in the whole.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Shown {
    /// All.
    #[default]
    All,
    /// So many; more than the scene has are refused.
    First(usize),
    /// So many, or all where the scene has fewer.
    AtMost(usize),
}

impl Shown {
    /// Strands shown of `of_scene`, which are `grown` or a file's.
    pub(crate) fn of(self, of_scene: usize, grown: bool) -> Result<usize> {
        match self {
            Self::All => Ok(of_scene),
            Self::AtMost(count) => Ok(count.min(of_scene)),
            Self::First(count) if count <= of_scene => Ok(count),
            Self::First(count) => {
                let more = if grown { format!(", or grow more with hair.strands = {count}") } else { String::new() };
                let line = format!("{count} strands requested, but the scene has {of_scene}: request fewer{more}");
                Err(Error::refused(line))
            }
        }
    }
}

impl BuiltScene {
    /// Those of the bodies that hair feels that have openings, by number, and how many edges these have.
    pub(crate) fn open_bodies(&self) -> impl Iterator<Item = (usize, usize)> {
        let felt = self.bodies.iter().zip(&self.scene.bodies).enumerate().filter(|(_, (_, settings))| settings.solid);
        let edges = felt.map(|(i, (body, _))| (i, body.mesh.clone().turn_outward().open_edges));
        edges.filter(|(_, edges)| *edges > 0 && matches!(self.dynamics.form, Form::Free(_)))
    }

    /// What [`Scene::build`] gives, for an editor in which a scene changes a little at a time: what the two scenes have
    /// alike is not read, grown or sampled again, so that files count as they were when this one was built.
    ///
    /// # Errors
    /// As there.
    pub fn changed_to(&self, scene: Scene, shown: Shown) -> Result<Self> {
        build::build(scene, shown, None, &[self], &|_| true)
    }

    /// The fast stepper, at rest.
    ///
    /// # Errors
    /// A field too strong for the hair; strands that cannot be moved.
    pub fn simulation(&self) -> Result<Simulation> {
        self.check_memory(1)?;
        let built = Simulation::with_ids(self.strands(), &self.groom.ids, &self.dynamics, &*self.forces.field);
        built.map_err(|refused| self.refusal(refused))
    }

    /// Refuses hair whose motion takes more memory than there is, `times` what the fast stepper takes.
    fn check_memory(&self, times: u64) -> Result<()> {
        let strands = self.strands();
        let Some(short) = memory::short_of(times * Simulation::least_bytes(strands, &self.dynamics)) else {
            return Ok(());
        };
        let key = if self.scene.hair.grown().is_some() { "hair.strands" } else { "hair.file" };
        let what = format!("{} strands of {} segments in all", strands.len(), strands.segment_count());
        let remedy = format!("to move them {short}: show fewer of them, or simulate them in shards");
        Err(self.scene.refusal(SettingError::new(key, what, remedy)).into())
    }

    /// The f64 stepper, at rest.
    ///
    /// # Errors
    /// As [`simulation`](Self::simulation).
    pub fn reference(&self) -> Result<Reference> {
        // Its numbers are twice as long.
        self.check_memory(2)?;
        let built = Reference::with_ids(self.strands(), &self.groom.ids, &self.dynamics, &*self.forces.field);
        built.map_err(|refused| self.refusal(refused))
    }

    /// All frames at hand, any of them again and again, under any field: for an editor, and for whatever tries many winds.
    ///
    /// # Errors
    /// As [`simulation`](Self::simulation).
    pub fn timeline(&self) -> Result<Timeline> {
        self.check_memory(1)?;
        let (field, poses) = (self.forces.field.clone(), self.given_poses());
        let built = Timeline::with_ids(self.strands(), &self.groom.ids, &self.dynamics, field, poses, self.frames());
        built.map_err(|refused| self.refusal(refused))
    }

    /// The poses that a timeline is given: those of all frames, or none for a head that stands still.
    pub fn given_poses(&self) -> Vec<Pose> {
        if self.head_moves() { self.way.poses[..=self.frames() as usize].to_vec() } else { Vec::new() }
    }

    /// Intervals of `[[force]]` by their strength, as they would blow here.
    pub fn strengths_of(&self, force: &[ForceSettings]) -> Vec<Keyframe> {
        force.iter().map(|force| force.keyframe(self.of_speed)).collect()
    }

    /// The strands at rest: all of the scene's, or those asked for.
    pub fn strands(&self) -> &Strands {
        &self.groom.hair.strands
    }

    /// Frames after the rest frame 0.
    pub fn frames(&self) -> u32 {
        self.scene.motion.frames
    }

    /// Where the head is in a frame.
    pub fn pose(&self, frame: u32) -> Pose {
        self.way.poses.get(frame as usize).copied().unwrap_or_default()
    }

    /// The bodies that are shown: the number of each, its surface (its own space, cm) and where it is in the world in a frame.
    pub fn shown_bodies(&self, frame: u32) -> impl Iterator<Item = (usize, &Mesh, Pose)> {
        let head = self.pose(frame);
        let all = self.scene.bodies.iter().zip(&self.bodies).enumerate().filter(|(_, (settings, _))| settings.shown);
        all.map(move |(i, (_, body))| (i, &body.mesh, body.way.pose(frame, &head)))
    }

    /// The bodies that are shown, to be drawn.
    pub fn drawn_bodies(&self) -> Vec<DrawnBody> {
        let all = self.shown_bodies(0);
        all.map(|(i, mesh, _)| DrawnBody { mesh: mesh.clone(), colour: self.scene.bodies[i].colour }).collect()
    }

    /// Where the bodies that are shown are in the world in a frame, in the order of [`drawn_bodies`](Self::drawn_bodies).
    pub fn drawn_poses(&self, frame: u32) -> Vec<Pose> {
        self.shown_bodies(frame).map(|(_, _, pose)| pose).collect()
    }

    /// What a step to a frame needs to know of it.
    pub fn input(&self, frame: u32) -> FrameInput<'_> {
        FrameInput::new(frame, &self.way.poses, &*self.forces.field)
    }

    /// The force at a point (cm) in a frame, both in the space that the scene gives its forces in.
    pub fn force_at(&self, point: Vec3, frame: u32) -> Vec3 {
        self.forces.field.at(point, frame)
    }

    /// Where imported hair sits.
    pub(crate) fn seat(&self) -> Option<Seat<'_>> {
        let imported = self.groom.imported.as_ref().zip(self.scene.hair.imported());
        imported.map(|(Imported { declared, of_head, judged, .. }, settings)| Seat {
            head: &self.model.head,
            strands: judged,
            settings,
            head_placement: &self.model.placement,
            declared: seat::heeded(*declared, *of_head),
            of_head: *of_head,
            ends: LikelyRoots::default(),
        })
    }

    /// Whether the head moves.
    pub fn head_moves(&self) -> bool {
        !self.way.poses.is_empty()
    }

    /// How imported hair lay in its file and goes back into it, for exports and for a motion cache to remember.
    pub fn hair_origin(&self) -> Option<Origin> {
        let Imported { placement, report, curves, .. } = self.groom.imported.as_ref()?;
        let in_world = self.scene.head.motion.as_ref().is_some_and(|motion| !motion.start_at_origin);
        let (placement, groom) = (*placement, curves.clone());
        Some(Origin { placement, points: report.points_in_file as u64, groom, in_world })
    }

    /// The hair at rest with its points in the order of its file, which may have strands tip first.
    pub(crate) fn hair_in_source(&self) -> Cow<'_, Hair> {
        match self.groom.hair.attributes.tip_first {
            Some(_) => Cow::Owned(self.groom.hair.clone().as_in_source()),
            None => Cow::Borrowed(&self.groom.hair),
        }
    }

    /// Number of frame 0 on the time line of the shot, from which exports go on: as the scene says, or else as the head's motion, or
    /// else the hair's file begins; 0 where neither is of a shot.
    pub fn first_frame(&self) -> i32 {
        let of_hair = || {
            let first = (self.groom.imported.as_ref()?.begins? * self.scene.frame_rate()).round() as i32;
            // A number that no shot has is a program's way of saying none.
            (first.unsigned_abs() <= Motion::MOST_FRAMES).then_some(first)
        };
        self.scene.output.first_frame.or(self.way.begins).or_else(of_hair).unwrap_or(0)
    }

    /// A refused setting as an error that names the scene's file and line, and the unit to mend where hair or head have the
    /// size of neither: no other setting would help then.
    pub fn refusal(&self, mut refused: SettingError) -> Error {
        let units = self.advice().into_iter().filter(Advice::is_of_unit);
        units.for_each(|advice| refused.remedy += &format!("; look first at the size: {advice}"));
        self.scene.refusal(refused).into()
    }
}
