//! A scene with everything loaded: the head, the hair, and what moves them.

mod aims;
mod bodies;
mod build;
mod dynamics;
mod forces;
mod groom;
mod identity;
mod live_skin;
mod model;
mod skin;
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
use nabiki_io::skin::says_rigid;
use nabiki_render::DrawnBody;

use crate::advice::Advice;
use crate::error::{Error, Result};
use crate::memory;
use crate::scene::{FieldBound, ForceSettings, Scene};
use crate::seat::{self, LikelyRoots, Seat};

pub use forces::Forces;
pub use groom::{Groom, Imported, ShardOf};
pub use live_skin::LiveSkin;
pub use model::Model;
pub use way::Way;

pub(crate) use way::holds_scenes;

use aims::AimFile;
use bodies::BuiltBody;
use model::ModelInputs;
pub(crate) use skin::{Bent, Scalp};
use stage::{At, Stage};

/// Everything that a scene names, loaded and in head space, ready for stepping. Scenes share equal parts
/// ([`changed_to`](Self::changed_to)).
#[derive(Clone, Debug)]
pub struct BuiltScene {
    /// The scene it was built from.
    pub scene: Scene,
    /// The head.
    pub model: Arc<Model>,
    /// The poses of the head.
    pub way: Arc<Way>,
    /// How the head's skin bends.
    pub(crate) bent_head: Arc<Bent>,
    /// The hair at rest.
    pub groom: Arc<Groom>,
    /// The skin under the hair.
    pub(crate) scalp: Arc<Scalp>,
    /// The fields.
    pub forces: Arc<Forces>,
    /// The settings of the motion.
    pub dynamics: Dynamics,
    /// The scene's bodies, in their order; none in the paper's form.
    pub(crate) bodies: Vec<Arc<BuiltBody>>,
    /// The files of its aims, in their order.
    pub(crate) aim_files: Vec<Arc<AimFile>>,
    /// How strong a wind of 1 cm/s is, in the free form.
    of_speed: f64,
}

impl Scene {
    /// Loads the head, grows or imports the hair, and reads the head's motion.
    ///
    /// # Errors
    /// One line: file, subject, value and remedy.
    pub fn build(self, shown: Shown) -> Result<BuiltScene> {
        build::build(self, shown, None, &[], &|_| true)
    }

    /// Like [`build`](Self::build), sharing parts with the `known` scenes as in [`BuiltScene::changed_to`] (of several,
    /// with the first that has an equal part). While files are read, roots chosen and hair grown, any thread calls
    /// `goes_on` regularly with the share of the hair that is grown, 0..1. If it returns `false`, the build stops.
    ///
    /// # Errors
    /// As for [`build`](Self::build); [`Error::Cancelled`] if `goes_on` returned `false`.
    pub fn build_while(
        self,
        shown: Shown,
        known: &[&BuiltScene],
        goes_on: &(dyn Fn(f32) -> bool + Sync),
    ) -> Result<BuiltScene> {
        build::build(self, shown, None, known, goes_on)
    }

    /// Like [`build`](Self::build), for only one shard of the strands. Each strand moves the same, bit by bit, as among
    /// all.
    ///
    /// # Errors
    /// As for [`build`](Self::build); more shards than strands.
    pub fn build_shard(self, shown: Shown, shard: Shard) -> Result<BuiltScene> {
        build::build(self, shown, Some(shard), &[], &|_| true)
    }

    /// The bound of each of the scene's fields, and last of `all` together. Loads head and motion, and also the hair if
    /// the wind has a speed.
    ///
    /// # Errors
    /// As for [`build`](Self::build).
    pub fn field_bounds(&self) -> Result<Vec<FieldBound>> {
        build::field_bounds(self)
    }

    /// Loads only the head.
    ///
    /// # Errors
    /// As for [`build`](Self::build).
    pub fn load_head(&self) -> Result<Head> {
        Model::make(ModelInputs::of(self), At::new(self, &|_| true)).map(|model| model.head)
    }
}

/// How many of a scene's strands to build: the first in the farthest-first order of its roots, which are spread evenly
/// over the scalp. Each moves the same, bit by bit, as among all.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Shown {
    /// All.
    #[default]
    All,
    /// This many. More than the scene has are refused.
    First(usize),
    /// This many, or all if the scene has fewer.
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
    /// The bodies with openings that hair feels: their index, and the number of open edges.
    pub(crate) fn open_bodies(&self) -> impl Iterator<Item = (usize, usize)> {
        let felt = self.bodies.iter().zip(&self.scene.bodies).enumerate().filter(|(_, (_, settings))| settings.solid);
        let edges = felt.map(|(i, (body, _))| (i, body.mesh.clone().turn_outward().open_edges));
        edges.filter(|(_, edges)| *edges > 0 && matches!(self.dynamics.form, Form::Free(_)))
    }

    /// Like [`Scene::build`], for an editor that changes a scene in small steps. Parts that are equal in both scenes
    /// are not read, grown or sampled again. Files therefore count as they were when this scene was built.
    ///
    /// # Errors
    /// As for [`Scene::build`].
    pub fn changed_to(&self, scene: Scene, shown: Shown) -> Result<Self> {
        build::build(scene, shown, None, &[self], &|_| true)
    }

    /// The fast stepper, at rest.
    ///
    /// # Errors
    /// A field too strong for the hair, or strands that cannot be moved.
    pub fn simulation(&self) -> Result<Simulation> {
        self.moved_by(&self.dynamics)
    }

    /// The fast stepper with these settings of the motion, at rest.
    fn moved_by(&self, dynamics: &Dynamics) -> Result<Simulation> {
        self.check_memory(1)?;
        let built = Simulation::with_ids(self.strands(), &self.groom.ids, dynamics, &*self.forces.field);
        built.map_err(|refused| self.refusal(refused))
    }

    /// Refuses hair whose motion needs more memory than there is: `times` what the fast stepper needs.
    fn check_memory(&self, times: u64) -> Result<()> {
        let strands = self.strands();
        let Some(short) = memory::short_of(times * Simulation::least_bytes(strands, &self.dynamics)) else {
            return Ok(());
        };
        let key = if self.scene.hair.grown().is_some() { "hair.strands" } else { "hair.file" };
        let what = format!("{} strands of {} segments in all", strands.len(), strands.segment_count());
        let remedy = format!("moving them {short}: show fewer, or simulate them in shards");
        Err(self.scene.refusal(SettingError::new(key, what, remedy)).into())
    }

    /// The f64 stepper, at rest.
    ///
    /// # Errors
    /// As for [`simulation`](Self::simulation).
    pub fn reference(&self) -> Result<Reference> {
        // Its numbers are twice as long.
        self.check_memory(2)?;
        let built = Reference::with_ids(self.strands(), &self.groom.ids, &self.dynamics, &*self.forces.field);
        built.map_err(|refused| self.refusal(refused))
    }

    /// All frames at once, for an editor or for trying many winds.
    ///
    /// # Errors
    /// As for [`simulation`](Self::simulation).
    pub fn timeline(&self) -> Result<Timeline> {
        self.check_memory(1)?;
        let (field, poses) = (self.forces.field.clone(), self.given_poses());
        let built = Timeline::with_ids(self.strands(), &self.groom.ids, &self.dynamics, field, poses, self.frames());
        built.map_err(|refused| self.refusal(refused))
    }

    /// The poses for a timeline: those of all frames, or none for a head that does not move.
    pub fn given_poses(&self) -> Vec<Pose> {
        if self.head_moves() { self.way.poses[..=self.frames() as usize].to_vec() } else { Vec::new() }
    }

    /// Intervals of `[[force]]` with speeds converted to strengths for this hair.
    pub fn strengths_of(&self, force: &[ForceSettings]) -> Vec<Keyframe> {
        force.iter().map(|force| force.keyframe(self.of_speed)).collect()
    }

    /// The strands at rest: all of the scene's, or the requested ones.
    pub fn strands(&self) -> &Strands {
        &self.groom.hair.strands
    }

    /// Frames after the rest frame 0.
    pub fn frames(&self) -> u32 {
        self.scene.motion.frames
    }

    /// The pose of the head in a frame.
    pub fn pose(&self, frame: u32) -> Pose {
        self.way.poses.get(frame as usize).copied().unwrap_or_default()
    }

    /// Phrases about data of the head's file that is not used.
    pub(crate) fn unread_of_head(&self) -> Vec<String> {
        let unread = self.model.report.iter().flat_map(|report| &report.unread);
        unread.filter(|line| self.bent_head.frames.is_empty() || !says_rigid(line)).cloned().collect()
    }

    /// The vertices of the head's mesh in a frame (head space, cm), if its skin bends.
    pub fn skin(&self, frame: u32) -> Option<&[Vec3]> {
        let frames = &self.bent_head.frames;
        frames.get(frame as usize).or(frames.last()).map(Vec::as_slice)
    }

    /// The visible bodies: index, surface (body space, cm) and world pose in a frame.
    pub fn shown_bodies(&self, frame: u32) -> impl Iterator<Item = (usize, &Mesh, Pose)> {
        let head = self.pose(frame);
        let all = self.scene.bodies.iter().zip(&self.bodies).enumerate().filter(|(_, (settings, _))| settings.shown);
        all.map(move |(i, (_, body))| (i, &body.mesh, body.way.pose(frame, &head)))
    }

    /// The visible bodies, for the renderer.
    pub fn drawn_bodies(&self) -> Vec<DrawnBody> {
        let all = self.shown_bodies(0);
        all.map(|(i, mesh, _)| DrawnBody { mesh: mesh.clone(), colour: self.scene.bodies[i].colour }).collect()
    }

    /// The vertices in a frame (their own space, cm) of all that bends: of the head (`None`) and of visible bodies, by their
    /// index in [`drawn_bodies`](Self::drawn_bodies). For the renderer.
    pub fn bent(&self, frame: u32) -> impl Iterator<Item = (Option<usize>, &[Vec3])> {
        let shown = self.scene.bodies.iter().zip(&self.bodies).filter(|(settings, _)| settings.shown);
        let bodies = shown.enumerate().filter_map(move |(i, (_, body))| Some((Some(i), body.skin(frame)?)));
        self.skin(frame).map(|skin| (None, skin)).into_iter().chain(bodies)
    }

    /// The vertices of a body in a frame (its own space, cm), by its index in the scene, if it bends.
    pub fn skin_of_body(&self, body: usize, frame: u32) -> Option<&[Vec3]> {
        self.bodies.get(body)?.skin(frame)
    }

    /// World poses of the visible bodies in a frame, in the order of [`drawn_bodies`](Self::drawn_bodies).
    pub fn drawn_poses(&self, frame: u32) -> Vec<Pose> {
        self.shown_bodies(frame).map(|(_, _, pose)| pose).collect()
    }

    /// The input of the step to a frame.
    pub fn input(&self, frame: u32) -> FrameInput<'_> {
        FrameInput::new(frame, &self.way.poses, &*self.forces.field)
    }

    /// The force at a point (cm) in a frame, both in the space of the scene's forces.
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

    /// The origin of imported hair, for exports into the space of its file and for motion caches.
    pub fn hair_origin(&self) -> Option<Origin> {
        hair_origin(&self.scene, &self.groom)
    }

    /// The hair at rest with its points in the order of its file, which may have strands tip first.
    pub(crate) fn hair_in_source(&self) -> Cow<'_, Hair> {
        match self.groom.hair.attributes.tip_first {
            Some(_) => Cow::Owned(self.groom.hair.clone().as_in_source()),
            None => Cow::Borrowed(&self.groom.hair),
        }
    }

    /// Mean length of the scene's hair, shown or not (cm); free form only.
    pub(crate) fn mean_length(&self) -> f64 {
        dynamics::mean_lengths(&self.groom.first).strand
    }

    /// Number of frame 0 on the timeline of the shot, from which exports count: that of the scene, or else of the file
    /// of the head's motion, or else of the hair's file; 0 if none has one.
    pub fn first_frame(&self) -> i32 {
        let of_hair = || {
            let first = (self.groom.imported.as_ref()?.begins? * self.scene.frame_rate()).round() as i32;
            // Programs use an impossible number to say none.
            (first.unsigned_abs() <= Motion::MOST_FRAMES).then_some(first)
        };
        self.scene.output.first_frame.or(self.way.begins).or_else(of_hair).unwrap_or(0)
    }

    /// Adds the scene's file and line to an error, and the unit to fix if hair or head have an implausible size,
    /// because no other setting would help then.
    pub fn refusal(&self, mut refused: SettingError) -> Error {
        let units = self.advice().into_iter().filter(Advice::is_of_unit);
        units.for_each(|advice| refused.remedy += &format!("; check the size first: {advice}"));
        self.scene.refusal(refused).into()
    }
}

/// See [`BuiltScene::hair_origin`].
fn hair_origin(scene: &Scene, groom: &Groom) -> Option<Origin> {
    let Imported { placement, report, curves, .. } = groom.imported.as_ref()?;
    let in_world = scene.head.motion.as_ref().is_some_and(|motion| !motion.start_at_origin);
    let (placement, groom) = (*placement, curves.clone());
    Some(Origin { placement, points: report.points_in_file as u64, groom, in_world })
}
