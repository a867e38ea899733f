//! Weight, which pulls on every node, and the moments N of the joints that carry it at rest, so that groomed hair does not sag.

use glam::DVec3;

use crate::dynamics::pull::{Name, Pull};
use crate::pose::Pose;

/// Of `free.gravity`.
pub struct Gravity(pub f32);

impl Pull for Gravity {
    fn name(&self) -> Name {
        Name { setting: "free.gravity", words: "gravity", term: "gravity" }
    }

    fn setting(&self) -> f32 {
        self.0
    }

    fn strongest(&self) -> f64 {
        f64::from(self.0)
    }
}

/// The force of the weight under a head of this pose (head space). `gravity`: its strength.
pub fn on_head(pose: &Pose, gravity: f64) -> DVec3 {
    pose.rotation.as_dquat().inverse() * DVec3::new(0.0, -gravity, 0.0)
}

/// The strength of hold that a segment needs so that weight does not tip it over: its part along the segment, if the segment stands up.
pub fn held_up(pose: &Pose, gravity: f64, rest: DVec3) -> f64 {
    (-on_head(pose, gravity).dot(rest)).max(0.0)
}

/// The moment against what hangs on the end of a segment with direction `way`.
pub fn moment(way: DVec3, hangs: DVec3) -> DVec3 {
    hangs.cross(way)
}
