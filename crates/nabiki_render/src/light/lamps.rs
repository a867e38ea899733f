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

#[cfg(test)]
mod tests {
    use glam::vec3;

    use super::*;
    use crate::camera::Bounds;
    use crate::settings::Camera;

    fn view(azimuth: f32, elevation: f32) -> View {
        View::new(&Camera { azimuth, elevation, ..Camera::default() }, [64; 2], &Bounds::default())
    }

    #[test]
    fn a_lamp_of_the_camera_goes_round_with_it_and_one_of_the_world_stays_there_as_the_head_turns() {
        let pose =
            Pose { position_cm: vec3(3.0, 4.0, 5.0), rotation: Quat::from_euler(glam::EulerRot::YXZ, 0.9, 0.4, -0.3) };
        for azimuth in [0.0, 40.0, 200.0] {
            for elevation in [0.0, 30.0] {
                let (view, light) =
                    (view(azimuth, elevation), Light { azimuth: 25.0, elevation: 50.0, ..Light::default() });
                let toward = |space, pose: &Pose| lamps(&[Light { space, ..light }], &view, pose)[0].toward;
                // About the vertical with the camera, and as high as it was.
                let cases = [
                    (LightSpace::Camera, direction(azimuth + 25.0, 50.0)),
                    (LightSpace::World, direction(25.0, 50.0)),
                    (LightSpace::Head, pose.rotation * direction(25.0, 50.0)),
                ];
                for (space, in_world) in cases {
                    // A few roundings of a unit vector.
                    let found = pose.rotation * toward(space, &pose);
                    assert!(found.distance(in_world) < 1e-5, "{space:?} {azimuth}: {found}, not {in_world}");
                }
            }
        }
        assert!((pose.rotation * zenith(&Sky::default(), &pose)).distance(Vec3::Y) < 1e-6);
    }

    #[test]
    fn a_lamp_is_as_wide_as_its_spread_and_as_strong_as_its_colour_times_its_strength() {
        let light = Light { spread: 30.0, strength: 2.0, colour: [1.0, 0.5, 0.25], ..Light::default() };
        let lamp = lamps(&[light], &view(0.0, 0.0), &Pose::STILL)[0];
        assert!((2.0 * lamp.spread.to_degrees() - 30.0).abs() < 1e-5);
        assert_eq!(lamp.strength, [2.0, 1.0, 0.5]);
    }
}
