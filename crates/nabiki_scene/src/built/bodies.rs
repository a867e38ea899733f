//! The bodies of a scene besides the head: those that hair collides with, and those that are only drawn.

use std::path::PathBuf;
use std::sync::{Arc, OnceLock};

use glam::Vec3;
use nabiki::body::{Body, BodyWay, Shape, skin_of};
use nabiki::distance::SkinDistance;
use nabiki::strands::bounds;
use nabiki::{Mesh, Pose, Skin, Strands};
use nabiki_io::skin::says_rigid;
use nabiki_io::{Placement, declared_space, mesh};

use super::groom::Groom;
use super::skin::{Sampled, frames_of};
use super::stage::{At, Stage};
use super::way::WayInputs;
use crate::error::Result;
use crate::scene::{BodySettings, Scene};

/// A body as drawn.
#[derive(Debug)]
pub(crate) struct BuiltBody {
    inputs: BodyInputs,
    /// Its own space (cm).
    pub mesh: Mesh,
    /// Phrases about unused data of the meshes in its file.
    pub unread: Vec<String>,
    pub way: BodyWay,
    /// The file of its motion, if that may bend it.
    pub file: Option<PathBuf>,
    /// Its vertices in each frame, from frame 0 on; none for a body that does not bend.
    pub frames: Vec<Vec<Vec3>>,
    /// How its file lies in that space.
    pub placement: Placement,
    /// Its shape: a capsule, or the skin of the mesh once that is needed for contact.
    shape: OnceLock<Shape>,
    /// The same of what bends.
    bending: Sampled,
}

/// The inputs of a body.
#[derive(Debug)]
pub(super) struct BodyInputs {
    /// The scene file, to whose folder paths are relative.
    file: PathBuf,
    /// Its index in the list of bodies.
    number: usize,
    /// What its file and its motion are read with; other settings are at their defaults.
    settings: BodySettings,
    frame_rate: f64,
    /// The last frame.
    last: u32,
}

impl BodyInputs {
    pub fn of(scene: &Scene, number: usize) -> Self {
        // Contact and look are those of the scene.
        let BodySettings { solid, margin, friction, static_friction, shown, colour, .. } = BodySettings::default();
        let settings = scene.bodies[number].clone();
        let settings = BodySettings { solid, margin, friction, static_friction, shown, colour, ..settings };
        Self {
            file: scene.file().to_owned(),
            number,
            settings,
            frame_rate: scene.frame_rate(),
            last: scene.motion.frames,
        }
    }
}

impl Stage for BuiltBody {
    type Inputs = BodyInputs;

    fn is_of(&self, inputs: &BodyInputs) -> bool {
        let BodyInputs { file, number, settings, frame_rate, last } = &self.inputs;
        // The number of frames matters only to what bends.
        (file, number, settings, frame_rate) == (&inputs.file, &inputs.number, &inputs.settings, &inputs.frame_rate)
            && (self.frames.is_empty() || *last == inputs.last)
    }

    fn make(inputs: BodyInputs, at: At<'_>) -> Result<Self> {
        let BodyInputs { file: scene, number, settings, frame_rate, last } = &inputs;
        let name = format!("body[{number}]");
        let capsule = settings.as_capsule(&name).map_err(|refused| at.refusal(refused))?;
        let (file, placement, mesh, unread, shape) = match capsule {
            Some(capsule) => {
                let shape = OnceLock::from(Shape::Other(Arc::new(capsule)));
                (None, Placement::default(), capsule.mesh(), Vec::new(), shape)
            }
            None => {
                let file = at.there(scene, &format!("{name}.mesh"), &settings.mesh)?;
                let declared = declared_space(&file)?;
                let placement = settings.placement(declared.unit, declared.up);
                placement.check(&name).map_err(|refused| at.refusal(refused))?;
                let (mesh, report) = mesh::import(&file, &placement, &settings.groups)?;
                (Some(file), placement, mesh, report.unread, OnceLock::new())
            }
        };
        let (mut frames, mut bending) = (Vec::new(), None);
        let way = match &settings.motion {
            _ if settings.with_head => BodyWay::WithHead,
            None => BodyWay::InWorld(Arc::new([Pose::STILL])),
            Some(source) => {
                let (scene, source) = (scene.clone(), source.clone());
                let groups = settings.groups.clone();
                let motion =
                    WayInputs { file: scene, source, mesh: file.clone(), groups, placement, frame_rate: *frame_rate };
                let read = motion.read(&format!("{name}.motion"), at)?;
                if let Some(files) = motion.of_mesh() {
                    let (which, clip) = (&settings.groups, motion.source.clip.as_str());
                    let times = (&read.poses[..], read.times, motion.rate());
                    bending = Some(files.motion.clone());
                    frames = frames_of(&files, (which, clip), &placement, times, (*last, mesh.positions.len()), at)?;
                }
                BodyWay::InWorld(read.poses.into())
            }
        };
        let mut unread: Vec<String> = unread;
        unread.retain(|line| frames.is_empty() || !says_rigid(line));
        Ok(Self { inputs, mesh, file: bending, unread, way, frames, placement, shape, bending: Sampled::default() })
    }
}

impl BuiltBody {
    /// Its vertices in a frame, if it bends.
    pub fn skin(&self, frame: u32) -> Option<&[Vec3]> {
        self.frames.get(frame as usize).or(self.frames.last()).map(Vec::as_slice)
    }

    /// The body for contact, if it is solid, with the scene's settings.
    pub(super) fn felt(
        &self,
        settings: &BodySettings,
        frames: u32,
        reach: &Reach<'_>,
        at: At<'_>,
    ) -> Result<Option<Body>> {
        let name = format!("body[{}]", self.inputs.number);
        let long_enough = if settings.motion.is_some() { self.way.check_length(&name, frames) } else { Ok(()) };
        long_enough.and_then(|()| self.way.check(&name, frames)).map_err(|refused| at.refusal(refused))?;
        if !settings.solid {
            return Ok(None);
        }
        let skin = || -> Result<Arc<SkinDistance>> {
            let skin = skin_of(self.mesh.clone(), &format!("{name}.mesh"));
            Ok(Arc::new(skin.map_err(|refused| at.refusal(refused))?))
        };
        let shape = match self.shape.get() {
            Some(shape) => shape.clone(),
            None if self.frames.is_empty() => {
                let skin = skin()?;
                self.shape.get_or_init(|| skin.into()).clone()
            }
            None => {
                let (within, of) = (reach.in_space_of(&self.way), (&self.mesh, &self.frames[..]));
                Shape::Other(self.bending.of(skin, of, within, settings.margin * reach.times)?)
            }
        };
        Ok(Some(Body::new(name, shape, self.way.clone(), settings.contact())))
    }
}

/// Where hair may be: a ball in head space, and the head's poses.
pub(super) struct Reach<'a> {
    center: Vec3,
    radius: f32,
    poses: &'a [Pose],
    last: u32,
    /// The most that a strand multiplies the margin of a contact by.
    times: f32,
}

impl<'a> Reach<'a> {
    pub fn of(groom: &Groom, skin: Option<&Skin>, poses: &'a [Pose], last: u32, times: f32) -> Self {
        let roots = |strands: &Strands| strands.iter().map(|strand| strand[0]).collect::<Vec<_>>();
        let all = [&groom.hair.strands, &groom.first];
        let moved = skin.and_then(Skin::bounds).into_iter().flatten();
        let [low, high] = bounds(&all.map(roots).concat().into_iter().chain(moved).collect::<Vec<_>>());
        let longest = all.into_iter().flat_map(Strands::lengths).fold(0.0, f32::max);
        Self { center: 0.5 * (low + high), radius: 0.5 * low.distance(high) + longest, poses, last, times }
    }

    /// The box about it in the space of a body, for all frames.
    fn in_space_of(&self, way: &BodyWay) -> [Vec3; 2] {
        let centers = (0..=self.last).map(|n| {
            let head = self.poses.get(n as usize).or(self.poses.last()).copied().unwrap_or_default();
            let body_from_head = way.pose(n, &head).world_from_head().inverse() * head.world_from_head();
            body_from_head.transform_point3(self.center)
        });
        let [low, high] = bounds(&centers.collect::<Vec<_>>());
        [low - self.radius, high + self.radius]
    }
}
