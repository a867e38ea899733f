//! The fields of a scene.

use std::sync::Arc;

use nabiki::field::{Field, Keyframe};

use super::model::Model;
use super::stage::{At, Stage};
use super::way::Way;
use crate::error::Result;
use crate::scene::{FieldBound, FieldParts, FieldPlace, FieldSettings, FormChoice, Scene};

/// The fields of a scene, ready for use.
#[derive(Debug)]
pub struct Forces {
    pub(crate) inputs: ForcesInputs,
    /// The sum of all fields.
    pub field: Arc<dyn Field>,
    /// The uniform wind, before it flows around the head. No force if the scene has neither `[[force]]` nor
    /// `[body_wind]`.
    pub wind: Arc<dyn Field>,
    /// The bound of each field.
    pub bounds: Vec<FieldBound>,
}

/// The inputs of the fields.
#[derive(Debug, PartialEq)]
pub(crate) struct ForcesInputs {
    settings: FieldSettings,
    pub place: FieldPlace,
    /// The intervals of `[[force]]`, with speeds converted to strengths.
    intervals: Vec<Keyframe>,
}

impl ForcesInputs {
    /// The fields around a moving head, with `[[force]]` converted to strengths.
    pub fn of(scene: &Scene, model: &Model, way: &Way, intervals: Vec<Keyframe>) -> Self {
        let place = FieldPlace {
            ellipsoid: model.head.ellipsoid,
            poses: way.poses.clone(),
            frame_rate: scene.frame_rate(),
            frames: scene.motion.frames,
            space: scene.motion.force_space,
            may_be_none: scene.form == FormChoice::Free,
        };
        Self { settings: scene.field.clone(), place, intervals }
    }
}

impl Forces {
    /// The intervals of `[[force]]`, with speeds converted to strengths.
    pub fn intervals(&self) -> &[Keyframe] {
        &self.inputs.intervals
    }
}

impl Stage for Forces {
    type Inputs = ForcesInputs;

    fn is_of(&self, inputs: &ForcesInputs) -> bool {
        self.inputs == *inputs
    }

    fn make(inputs: ForcesInputs, at: At<'_>) -> Result<Self> {
        let built = inputs.settings.build(&inputs.place, &inputs.intervals);
        let FieldParts { field, wind, bounds } = built.map_err(|refused| at.refusal(refused))?;
        Ok(Self { inputs, field, wind, bounds })
    }
}
