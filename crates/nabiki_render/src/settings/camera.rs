//! Settings of the camera: `[picture.camera]`.

use glam::Vec3;
use nabiki::SettingError;
use nabiki::error::check_range;
use serde::{Deserialize, Serialize};

use crate::camera::NEAR;

/// How space becomes a picture.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Projection {
    /// As an eye sees.
    #[default]
    Perspective,
    /// All rays parallel, as in a drawing.
    Orthographic,
}

/// `[picture.camera]`: a camera on an orbit about the hair, or moving between two places of it.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields, default)]
pub struct Camera {
    /// `"perspective"` (default) or `"orthographic"`.
    pub projection: Projection,
    /// Direction of the camera about the world's vertical (degrees): of a head that has not turned 0 is before the face, 90 at
    /// the character's right hand, 180 behind. Default 40.
    pub azimuth: f32,
    /// Direction of the camera above the horizon (degrees, -89..89). Default 5.
    pub elevation: f32,
    /// Vertical field of view (degrees, 1..150), for perspective. Default 26.
    pub fov: f32,
    /// From the target to the eye (cm, 1 to a million). Default: near enough to frame everything.
    pub distance: Option<f32>,
    /// Height of the picture in space (cm, a thousandth to a million), for orthographic views. Default: enough to frame everything.
    pub height: Option<f32>,
    /// The point looked at (cm), from the head's origin along the world's axes: the camera goes along with the head and does
    /// not turn with it. Default: the middle of what is framed.
    pub target: Option<Vec3>,
    /// How far the lens is opened, for perspective: its focal length over its diameter, as photographers count it (0.1..128). Small numbers
    /// blur much; skin blurred by more than 3 picture heights is refused. The focal length is that of a picture 24 mm high on the sensor
    /// with this `fov`: 52 mm for 26 degrees. Default: a pinhole, all is sharp.
    pub f_stop: Option<f32>,
    /// From the eye to the plane that is sharp, along the axis of view (cm, 1 to a million). Default: the side of the head that the
    /// camera sees.
    pub focus_distance: Option<f32>,
    /// Empty border around what is framed, as part of the picture's shorter side, 0..0.45. Default 0.06.
    pub margin: f32,
    /// Where the camera is at the last frame, `[picture.camera.to]`: it glides there from the values above.
    pub to: Option<CameraKey>,
}

/// The second place of a moving camera; what is left out stays as it was.
#[derive(Clone, Copy, Debug, Default, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields, default)]
pub struct CameraKey {
    /// Azimuth at the end (degrees).
    pub azimuth: Option<f32>,
    /// Elevation at the end (degrees).
    pub elevation: Option<f32>,
    /// Distance at the end (cm, 1 to a million); needs `distance` at the start.
    pub distance: Option<f32>,
    /// Field of view at the end (degrees).
    pub fov: Option<f32>,
    /// Target at the end (cm); needs `target` at the start.
    pub target: Option<Vec3>,
    /// Distance of what is sharp at the end (cm); needs `focus_distance` at the start.
    pub focus_distance: Option<f32>,
}

impl Default for Camera {
    fn default() -> Self {
        Self {
            projection: Projection::Perspective,
            azimuth: 40.0,
            elevation: 5.0,
            fov: 26.0,
            distance: None,
            height: None,
            target: None,
            f_stop: None,
            focus_distance: None,
            margin: 0.06,
            to: None,
        }
    }
}

impl Camera {
    /// The camera `progress` (0..1) of the way to its second key, with a soft start and stop.
    pub fn at(&self, progress: f32) -> Self {
        let Some(to) = self.to else { return *self };
        let t = progress.clamp(0.0, 1.0);
        let t = t * t * (3.0 - 2.0 * t);
        // Weighted so that both keys are met to the bit.
        let mix = |a: f32, b: Option<f32>| b.map_or(a, |b| a * (1.0 - t) + b * t);
        Self {
            azimuth: mix(self.azimuth, to.azimuth),
            elevation: mix(self.elevation, to.elevation),
            fov: mix(self.fov, to.fov),
            distance: self.distance.map(|d| mix(d, to.distance)),
            target: self.target.map(|a| to.target.map_or(a, |b| a * (1.0 - t) + b * t)),
            focus_distance: self.focus_distance.map(|d| mix(d, to.focus_distance)),
            to: None,
            ..*self
        }
    }

    /// Whether a view of this camera depends on what is to be framed: something it needs is left open.
    pub fn is_automatic(&self) -> bool {
        let open = match self.projection {
            Projection::Perspective => self.distance.is_none(),
            // Without a distance the eye stands before all that is framed.
            Projection::Orthographic => self.height.is_none() || self.distance.is_none(),
        };
        self.target.is_none() || open
    }

    pub(crate) fn check(&self) -> Result<(), SettingError> {
        check_angles("picture.camera", Some(self.azimuth), Some(self.elevation), Some(self.fov))?;
        if let Some(distance) = self.distance {
            check_range("picture.camera.distance", distance, NEAR, 1e6)?;
        }
        if let Some(height) = self.height {
            check_range("picture.camera.height", height, 1e-3, 1e6)?;
        }
        check_target("picture.camera.target", self.target)?;
        if let Some(f_stop) = self.f_stop {
            check_range("picture.camera.f_stop", f_stop, 0.1, 128.0)?;
            if self.projection == Projection::Orthographic {
                let way_out = "parallel rays have no lens: use projection = \"perspective\", or leave f_stop out";
                return Err(SettingError::new("picture.camera.f_stop", f_stop, way_out));
            }
        }
        if let Some(focus) = self.focus_distance {
            check_focus("picture.camera.focus_distance", focus)?;
        }
        check_range("picture.camera.margin", self.margin, 0.0, 0.45)?;
        let Some(to) = self.to else { return Ok(()) };
        check_angles("picture.camera.to", to.azimuth, to.elevation, to.fov)?;
        check_target("picture.camera.to.target", to.target)?;
        if let Some(distance) = to.distance {
            check_range("picture.camera.to.distance", distance, NEAR, 1e6)?;
            if self.distance.is_none() {
                let way_out = "give picture.camera.distance as well, to start from";
                return Err(SettingError::new("picture.camera.to.distance", distance, way_out));
            }
        }
        if let Some(focus) = to.focus_distance {
            check_focus("picture.camera.to.focus_distance", focus)?;
            if self.focus_distance.is_none() {
                let way_out = "give picture.camera.focus_distance as well, to start from";
                return Err(SettingError::new("picture.camera.to.focus_distance", focus, way_out));
            }
        }
        match to.target {
            Some(target) if self.target.is_none() => {
                let way_out = "give picture.camera.target as well, to start from";
                Err(SettingError::new("picture.camera.to.target", target, way_out))
            }
            _ => Ok(()),
        }
    }
}

fn check_angles(
    table: &str,
    azimuth: Option<f32>,
    elevation: Option<f32>,
    fov: Option<f32>,
) -> Result<(), SettingError> {
    for (name, value, low, high) in
        [("azimuth", azimuth, -3600.0, 3600.0), ("elevation", elevation, -89.0, 89.0), ("fov", fov, 1.0, 150.0)]
    {
        if let Some(value) = value {
            check_range(&format!("{table}.{name}"), value, low, high)?;
        }
    }
    Ok(())
}

/// What lies nearer to the eye than [`NEAR`] is not drawn, so nothing there can be sharp.
fn check_focus(thing: &str, focus: f32) -> Result<(), SettingError> {
    check_range(thing, focus, NEAR, 1e6)
}

fn check_target(thing: &str, target: Option<Vec3>) -> Result<(), SettingError> {
    match target {
        Some(t) if !(t.is_finite() && t.abs().max_element() <= 1e6) => {
            Err(SettingError::new(thing, t, "must be three numbers within a million cm"))
        }
        _ => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn gliding() -> Camera {
        Camera {
            azimuth: 10.1,
            elevation: -3.3,
            distance: Some(70.7),
            target: Some(Vec3::new(0.1, 0.2, 0.3)),
            focus_distance: Some(61.3),
            to: Some(CameraKey {
                azimuth: Some(200.3),
                elevation: Some(25.1),
                distance: Some(41.9),
                fov: Some(33.3),
                target: Some(Vec3::new(-7.7, 1.1, 5.9)),
                focus_distance: Some(38.3),
            }),
            ..Camera::default()
        }
    }

    #[test]
    fn a_gliding_camera_meets_both_keys_to_the_bit() {
        let camera = gliding();
        let to = camera.to.unwrap();
        assert_eq!(camera.at(0.0), Camera { to: None, ..camera });
        let end = camera.at(1.0);
        assert_eq!(Some(end.azimuth), to.azimuth);
        assert_eq!(Some(end.elevation), to.elevation);
        assert_eq!(Some(end.fov), to.fov);
        assert_eq!((end.distance, end.target, end.to), (to.distance, to.target, None));
        assert_eq!(end.focus_distance, to.focus_distance);
    }

    #[test]
    fn it_is_halfway_in_the_middle_and_never_turns_back() {
        let camera = gliding();
        let to = camera.to.unwrap();
        // 1 - t is exact to half a unit in the last place, and so is each product and the sum: four of them.
        let near = |a: f32, b: f32| (a - b).abs() <= 4.0 * f32::EPSILON * a.abs().max(b.abs());
        let middle = camera.at(0.5);
        assert!(near(middle.azimuth, 0.5 * (camera.azimuth + to.azimuth.unwrap())));
        assert!(near(middle.distance.unwrap(), 0.5 * (camera.distance.unwrap() + to.distance.unwrap())));
        let way: Vec<f32> = (0..=100).map(|n| camera.at(n as f32 / 100.0).azimuth).collect();
        assert!(way.is_sorted());
        // A soft start: the first step is under a tenth of the one in the middle.
        assert!((way[1] - way[0]) < 0.1 * (way[51] - way[50]));
    }

    #[test]
    fn what_the_second_key_leaves_out_stays() {
        let camera = Camera { to: Some(CameraKey { azimuth: Some(90.0), ..CameraKey::default() }), ..gliding() };
        assert_eq!(camera.at(0.37), Camera { azimuth: camera.at(0.37).azimuth, to: None, ..camera });
        assert_eq!(Camera::default().at(0.37), Camera::default());
    }
}
