//! Files that move a head or a body.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use nabiki::{Pose, SettingError};
use nabiki_io::motion::{self, HeadMotion, MotionSource};
use nabiki_io::point_cache::is_point_cache;
use nabiki_io::{Placement, exchange, mesh};

use super::model::Model;
use super::stage::{At, Stage};
use crate::error::Result;
use crate::scene::{HeadSource, Scene, resolved};

/// The poses of the head in each frame.
#[derive(Debug)]
pub struct Way {
    inputs: Option<WayInputs>,
    /// World poses of the head from frame 0 on. Empty for a head that does not move.
    pub poses: Arc<[Pose]>,
    /// One line about how its motion was read and converted.
    pub report: Option<String>,
    /// Number of its first frame on the timeline of its file, if that has one.
    pub(super) begins: Option<i32>,
    /// Time in its file of frame 0, and between two frames (s).
    times: [f64; 2],
}

/// The inputs of a motion.
#[derive(Debug, PartialEq)]
pub(super) struct WayInputs {
    /// The scene file, to whose folder paths are relative.
    pub file: PathBuf,
    pub source: MotionSource,
    /// The file of the moved mesh, and its placement.
    pub mesh: Option<PathBuf>,
    /// Its groups.
    pub groups: Vec<String>,
    pub placement: Placement,
    /// Frames per second.
    pub frame_rate: f64,
}

impl WayInputs {
    /// Those of the head's motion; `None` for a head that does not move.
    pub fn of(scene: &Scene, model: &Model) -> Option<Self> {
        scene.head.motion.as_ref().map(|source| Self {
            file: scene.file().to_owned(),
            source: source.clone(),
            mesh: model.file(),
            groups: match &scene.head.source {
                HeadSource::Imported(head) => head.groups.clone(),
                HeadSource::Builtin => Vec::new(),
            },
            placement: model.placement,
            frame_rate: scene.frame_rate(),
        })
    }

    /// The motion that the scene names under `key`. A motion in the mesh's own file has the mesh's axes and unit by
    /// default, and is bound where the mesh is.
    pub fn read(&self, key: &str, at: At<'_>) -> Result<HeadMotion> {
        let there = |part: &str, file: &Path| at.there(&self.file, &format!("{key}.{part}"), file);
        let source = MotionSource {
            file: there("file", &self.source.file)?,
            skeleton: self.source.skeleton.as_ref().map(|file| there("skeleton", file)).transpose()?,
            ..self.source.clone()
        };
        let of_points = is_point_cache(&source.file);
        let given = [
            ("unit_cm", source.unit_cm.map(|unit| unit.to_string())),
            ("up", source.up.map(|axis| axis.to_string())),
            ("facing", source.facing.map(|axis| axis.to_string())),
        ];
        if let Some((part, Some(value))) = given.into_iter().find(|(_, given)| of_points && given.is_some()) {
            let remedy = "a point cache has the unit and axes of its mesh: remove it";
            return Err(at.refusal(SettingError::new(format!("{key}.{part}"), value, remedy)));
        }
        let of_mesh = of_points || self.mesh.as_ref() == Some(&source.file) && holds_scenes(&source.file);
        let facing = source.facing.or(of_mesh.then_some(self.placement.facing));
        let unit_cm = source.unit_cm.or(of_mesh.then_some(100.0 * self.placement.unit.metres()));
        let up = source.up.or(of_points.then_some(self.placement.up));
        let source = MotionSource { facing, unit_cm, up, ..source };
        let read = match &self.mesh {
            Some(mesh) if of_points => {
                let rest = mesh::read(mesh, &self.groups)?.positions;
                motion::of_points(&source, mesh, &rest, self.frame_rate)
            }
            None if of_points => {
                let line = "moves the points of a mesh, and there is none: give the mesh that it is of";
                Err(nabiki_io::Error::new(line).in_file(&source.file))
            }
            _ => motion::read(&source, self.frame_rate),
        };
        let mut motion = read.map_err(|e| e.below(key))?;
        motion.bound = motion.bound.filter(|_| of_mesh);
        let origin = self.placement.origin_in_world().as_vec3();
        Ok(if source.bind_at_start || of_points { motion.bound_at(origin) } else { motion })
    }
}

/// Whether files of this kind hold meshes and their motion in one space.
pub(crate) fn holds_scenes(file: &Path) -> bool {
    exchange::is_usd(file) || exchange::is_alembic(file) || mesh::is_gltf(file) || mesh::is_fbx(file)
}

impl WayInputs {
    /// Frames per second of a motion that counts frames.
    pub fn rate(&self) -> f64 {
        self.source.frames_per_second.unwrap_or(self.frame_rate)
    }

    /// The files of the mesh and of its motion, if that may bend it: a point cache, or the mesh's own file, which carries it as it
    /// lies there.
    pub fn of_mesh(&self) -> Option<SkinFiles<'_>> {
        let motion = resolved(&self.file, &self.source.file);
        if let Some(mesh) = self.mesh.as_deref().filter(|_| is_point_cache(&motion)) {
            return Some(SkinFiles { mesh, motion });
        }
        let mesh = self.mesh.as_deref().filter(|_| self.source.bind_at_start)?;
        (motion == *mesh && holds_scenes(mesh)).then_some(SkinFiles { mesh, motion })
    }
}

/// Where the shape of a mesh is, and where its motion.
#[derive(Clone, Debug)]
pub(super) struct SkinFiles<'a> {
    pub mesh: &'a Path,
    pub motion: PathBuf,
}

impl Stage for Way {
    type Inputs = Option<WayInputs>;

    fn is_of(&self, inputs: &Option<WayInputs>) -> bool {
        self.inputs == *inputs
    }

    fn make(inputs: Option<WayInputs>, at: At<'_>) -> Result<Self> {
        let read = inputs.as_ref().map(|inputs| inputs.read("head.motion", at)).transpose()?;
        let still = || Self { inputs: None, poses: Arc::default(), report: None, begins: None, times: [0.0; 2] };
        Ok(read.map_or_else(still, |read| Self {
            inputs,
            poses: read.poses.into(),
            report: Some(read.report),
            begins: read.first_frame,
            times: read.times,
        }))
    }
}

impl Way {
    /// The files of mesh and motion, the clip, the motion's times of frame 0 and between two frames (s), and its frames per second
    /// if it counts frames; if its skin may bend.
    pub(super) fn of_mesh(&self) -> Option<(SkinFiles<'_>, &str, [f64; 2], f64)> {
        let inputs = self.inputs.as_ref()?;
        Some((inputs.of_mesh()?, inputs.source.clip.as_str(), self.times, inputs.rate()))
    }

    /// Refuses a motion that ends before the scene does.
    pub(super) fn check_length(&self, scene: &Scene) -> Result<()> {
        let (frames, given) = (scene.motion.frames as usize, self.poses.len());
        if self.inputs.is_none() || given > frames {
            return Ok(());
        }
        let remedy = format!(
            "head.motion ends at frame {} and motion.frames = {frames}: lower motion.frames, or give a longer file",
            given.saturating_sub(1)
        );
        Err(nabiki_io::Error::new(remedy).in_file(scene.file()).into())
    }
}
