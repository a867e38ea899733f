//! Bodies that hair does not enter: the head, and whatever else a scene names.

use std::sync::Arc;

use glam::Affine3A;
use serde::{Deserialize, Serialize};

use crate::distance::SkinDistance;
use crate::error::SettingError;
use crate::pose::Pose;

/// How hair and a body touch.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields, default)]
pub struct Contact {
    /// How far from the skin nodes are kept (cm), 0..=5. A node that lies closer at rest is kept where it lies.
    pub margin: f32,
    /// The part of the push that sliding hair loses of its speed along the skin (Coulomb), 0..=10.
    pub friction: f32,
    /// The same for hair that does not slide: it stays as long as what would move it is below this part of the push.
    /// At least `friction`.
    pub static_friction: f32,
}

impl Default for Contact {
    fn default() -> Self {
        Self { margin: 0.1, friction: 0.1, static_friction: 0.15 }
    }
}

impl Contact {
    /// Refuses numbers out of range; `name` is what the body is called.
    pub fn check(&self, name: &str) -> Result<(), SettingError> {
        crate::error::check_range(&format!("{name}.margin"), self.margin, 0.0, 5.0)?;
        crate::error::check_range(&format!("{name}.friction"), self.friction, 0.0, 10.0)?;
        if !(self.friction..=10.0).contains(&self.static_friction) {
            let remedy = format!("must be at least the friction of sliding hair, {}, and at most 10", self.friction);
            return Err(SettingError::new(format!("{name}.static_friction"), self.static_friction, remedy));
        }
        Ok(())
    }
}

/// Where a body is, frame by frame.
#[derive(Clone, Debug, PartialEq)]
pub enum BodyWay {
    /// Its space is head space: the head itself, a hat.
    WithHead,
    /// In the world: the pose of every frame from 0 on, or a single one for a body that stands still.
    InWorld(Arc<[Pose]>),
}

/// Something that hair does not enter.
#[derive(Clone, Debug)]
pub struct Body {
    /// What a scene calls it, `head` or `body[0]`.
    pub name: String,
    /// The distance to its skin, in its own space (cm).
    pub distance: Arc<SkinDistance>,
    /// Where it is.
    pub way: BodyWay,
    /// How it is touched.
    pub contact: Contact,
}

impl Body {
    /// Refuses contacts out of range, and a way that ends before `frames` or leads through places that are none.
    pub fn check(&self, frames: u32) -> Result<(), SettingError> {
        self.contact.check(&self.name)?;
        let BodyWay::InWorld(poses) = &self.way else { return Ok(()) };
        if poses.len() != 1 && poses.len() <= frames as usize {
            let remedy =
                format!("the body has a pose in {} frames; give one, or one for every frame from 0 on", poses.len());
            return Err(SettingError::new(format!("{}.motion", self.name), format!("frame {frames}"), remedy));
        }
        match poses.iter().position(|pose| !pose.is_valid()) {
            None => Ok(()),
            Some(n) => {
                let remedy = "must be a finite position (cm) and a rotation of length 1";
                Err(SettingError::new(format!("{}.motion frame {n}", self.name), format!("{:?}", poses[n]), remedy))
            }
        }
    }

    /// Takes points of the body's space into head space in a frame in which the head has the pose `head`.
    pub fn head_from_body(&self, frame: u32, head: &Pose) -> Affine3A {
        match &self.way {
            BodyWay::WithHead => Affine3A::IDENTITY,
            BodyWay::InWorld(poses) => {
                let pose = poses.get(frame as usize).or(poses.last()).copied().unwrap_or_default();
                head.world_from_head().inverse() * pose.world_from_head()
            }
        }
    }
}

impl PartialEq for Body {
    /// Whether they are the very same: distances are compared by identity.
    fn eq(&self, other: &Self) -> bool {
        self.name == other.name
            && Arc::ptr_eq(&self.distance, &other.distance)
            && self.way == other.way
            && self.contact == other.contact
    }
}
