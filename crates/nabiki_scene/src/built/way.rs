//! Files that move a head or a body.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use nabiki::Pose;
use nabiki_io::motion::{self, HeadMotion, MotionSource};
use nabiki_io::{Placement, exchange, mesh};

use super::model::Model;
use super::stage::{At, Stage};
use crate::error::Result;
use crate::scene::{Scene, resolved};

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
        let of_mesh = self.mesh.as_ref() == Some(&source.file) && holds_scenes(&source.file);
        let facing = source.facing.or(of_mesh.then_some(self.placement.facing));
        let unit_cm = source.unit_cm.or(of_mesh.then_some(100.0 * self.placement.unit.metres()));
        let source = MotionSource { facing, unit_cm, ..source };
        let mut motion = motion::read(&source, self.frame_rate).map_err(|e| e.below(key))?;
        motion.bound = motion.bound.filter(|_| of_mesh);
        let origin = self.placement.origin_in_world().as_vec3();
        Ok(if source.bind_at_start { motion.bound_at(origin) } else { motion })
    }
}

/// Whether files of this kind hold meshes and their motion in one space.
pub(crate) fn holds_scenes(file: &Path) -> bool {
    exchange::is_usd(file) || exchange::is_alembic(file) || mesh::is_gltf(file)
}

impl WayInputs {
    /// The file of the mesh, if the motion is of the same one and carries the mesh as it lies there.
    pub fn of_mesh(&self) -> Option<&Path> {
        let mesh = self.mesh.as_deref().filter(|_| self.source.bind_at_start)?;
        (resolved(&self.file, &self.source.file) == *mesh && holds_scenes(mesh)).then_some(mesh)
    }
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
    /// The file that both mesh and motion are of, its clip, and its times of frame 0 and between two frames (s), if the mesh is carried
    /// as it lies there. Its skin may bend then.
    pub(super) fn of_mesh(&self) -> Option<(&Path, &str, [f64; 2])> {
        let inputs = self.inputs.as_ref()?;
        Some((inputs.of_mesh()?, inputs.source.clip.as_str(), self.times))
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
