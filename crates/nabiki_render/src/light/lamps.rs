//! Lamps as a frame sees them.

use glam::{Quat, Vec3};
use nabiki::Pose;

use crate::camera::{View, direction};
use crate::settings::{Light, LightSpace, Sky, SkySpace};

/// A lamp: where it is, and how strong.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lamp {
    /// Unit vector toward the lamp (head space).
    pub toward: Vec3,
    /// Radiance that a white surface facing the lamp shows (linear red, green, blue).
    pub strength: [f32; 3],
    /// Half of the lamp's extent as seen from the hair (rad).
    pub spread: f32,
}

/// The lamps of a picture for one view (in the world) and pose of the head.
pub fn lamps(lights: &[Light], view: &View, pose: &Pose) -> Vec<Lamp> {
    // Camera lamps turn about the vertical with the camera but keep their height: the key never comes from below.
    let back = -view.forward;
    let camera_azimuth = back.z.atan2(back.x).to_degrees();
    lights
        .iter()
        .map(|light| Lamp {
            toward: match light.space {
                LightSpace::Head => direction(light.azimuth, light.elevation),
                LightSpace::World => in_head(pose, direction(light.azimuth, light.elevation)),
                LightSpace::Camera => in_head(pose, direction(camera_azimuth + light.azimuth, light.elevation)),
            },
            strength: light.colour.map(|c| c * light.strength),
            spread: light.spread.to_radians() / 2.0,
        })
        .collect()
}

/// The direction in which the sky is above (head space, unit).
pub fn zenith(sky: &Sky, pose: &Pose) -> Vec3 {
    match sky.space {
        SkySpace::Head => Vec3::Y,
        SkySpace::World => in_head(pose, Vec3::Y),
    }
}

fn in_head(pose: &Pose, direction: Vec3) -> Vec3 {
    if pose.rotation == Quat::IDENTITY { direction } else { pose.rotation.inverse() * direction }
}
