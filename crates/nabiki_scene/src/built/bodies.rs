//! The bodies of a scene besides the head: those that hair collides with, and those that are only drawn.

use std::path::PathBuf;
use std::sync::{Arc, OnceLock};

use nabiki::body::{Body, BodyWay, Shape, skin_of};
use nabiki::{Mesh, Pose};
use nabiki_io::{Placement, declared_space, mesh};

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
    /// How its file lies in that space.
    pub placement: Placement,
    /// Its shape: a capsule, or the skin of the mesh once that is needed for contact.
    shape: OnceLock<Shape>,
}

/// The inputs of a body.
#[derive(Debug, PartialEq)]
pub(super) struct BodyInputs {
    /// The scene file, to whose folder paths are relative.
    file: PathBuf,
    /// Its index in the list of bodies.
    number: usize,
    /// What its file and its motion are read with; other settings are at their defaults.
    settings: BodySettings,
    frame_rate: f64,
}

impl BodyInputs {
    pub fn of(scene: &Scene, number: usize) -> Self {
        // Contact and look are those of the scene.
        let BodySettings { solid, margin, friction, static_friction, shown, colour, .. } = BodySettings::default();
        let settings = scene.bodies[number].clone();
        let settings = BodySettings { solid, margin, friction, static_friction, shown, colour, ..settings };
        Self { file: scene.file().to_owned(), number, settings, frame_rate: scene.frame_rate() }
    }
}

impl Stage for BuiltBody {
    type Inputs = BodyInputs;

    fn is_of(&self, inputs: &BodyInputs) -> bool {
        self.inputs == *inputs
    }

    fn make(inputs: BodyInputs, at: At<'_>) -> Result<Self> {
        let BodyInputs { file: scene, number, settings, frame_rate } = &inputs;
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
        let way = match &settings.motion {
            _ if settings.with_head => BodyWay::WithHead,
            None => BodyWay::InWorld(Arc::new([Pose::STILL])),
            Some(source) => {
                let (scene, source) = (scene.clone(), source.clone());
                let motion = WayInputs { file: scene, source, mesh: file, placement, frame_rate: *frame_rate };
                BodyWay::InWorld(motion.read(&format!("{name}.motion"), at)?.poses.into())
            }
        };
        Ok(Self { inputs, mesh, unread, way, placement, shape })
    }
}

impl BuiltBody {
    /// The body for contact, if it is solid, with the scene's settings.
    pub(super) fn felt(&self, settings: &BodySettings, frames: u32, at: At<'_>) -> Result<Option<Body>> {
        let name = format!("body[{}]", self.inputs.number);
        let long_enough = if settings.motion.is_some() { self.way.check_length(&name, frames) } else { Ok(()) };
        long_enough.and_then(|()| self.way.check(&name, frames)).map_err(|refused| at.refusal(refused))?;
        if !settings.solid {
            return Ok(None);
        }
        let shape = match self.shape.get() {
            Some(shape) => shape.clone(),
            None => {
                let skin =
                    skin_of(self.mesh.clone(), &format!("{name}.mesh")).map_err(|refused| at.refusal(refused))?;
                self.shape.get_or_init(|| Arc::new(skin).into()).clone()
            }
        };
        Ok(Some(Body::new(name, shape, self.way.clone(), settings.contact())))
    }
}
