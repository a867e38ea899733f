//! Settings of the camera: `[picture.camera]`.

use glam::Vec3;
use nabiki::setting::{Place, refused};
use nabiki::{SettingError, settings, words};

/// Smallest depth that is drawn (cm). Everything nearer to the eye, or behind it, is left out.
pub const NEAR: f32 = 1.0;

words! {
    /// How space is projected onto the picture.
    pub enum Projection = Perspective {
        /// As an eye or a camera sees.
        Perspective = "perspective",
        /// Parallel rays, as in a technical drawing.
        Orthographic = "orthographic",
    }
}

settings! {
    /// A camera on an orbit around the hair, still or moving between two places.
    #[derive(Copy)]
    pub struct Camera where moves_from_somewhere {
        /// How space is projected onto the picture.
        pub projection: Projection = Projection::Perspective => "Projection";
        /// Direction of the camera around the world's vertical. For a head that has not turned, 0 is in front of the
        /// face, 90 at the character's right hand and 180 behind.
        pub azimuth: f32 = 40.0 => "Azimuth", unit "degrees", least -3600.0, most 3600.0;
        /// Direction of the camera above the horizon.
        pub elevation: f32 = 5.0 => "Elevation", unit "degrees", least -89.0, most 89.0;
        /// Vertical field of view, for perspective.
        pub fov: f32 = 26.0 => "Field of view", unit "degrees", least 1.0, most 150.0;
        /// Distance from the target to the eye.
        pub distance: Option<f32> = None => "Distance", unit "cm", least NEAR as f64, most 1e6, open "fits everything";
        /// Height of the picture in space, for orthographic views.
        pub height: Option<f32> = None => "Height", unit "cm", least 1e-3, most 1e6, open "fits everything";
        /// The point to look at, from the head's origin along the world's axes. The camera moves with the head but does
        /// not turn with it.
        pub target: Option<Vec3> = None => "Target", unit "cm", least -1e6, most 1e6, open "the middle";
        /// Aperture of the lens, for perspective: focal length over diameter. Small numbers blur more; nabiki refuses
        /// skin blurred by more than 3 picture heights. The focal length is that for a sensor 24 mm high with this
        /// `fov`: 52 mm for 26 degrees.
        pub f_stop: Option<f32> = None => "f-stop", least 0.1, most 128.0, open "everything sharp";
        /// Distance from the eye to the plane in focus, along the view axis. By default the side of the head that the
        /// camera sees.
        pub focus_distance: Option<f32> = None => "Focus distance", unit "cm", least NEAR as f64, most 1e6, open "the head";
        /// Empty border around what is framed, as a share of the picture's shorter side.
        pub margin: f32 = 0.06 => "Margin", least 0.0, most 0.45;
        /// Camera at the last frame. It moves there from the values above.
        pub to: Option<CameraKey> = None => "Camera at the last frame", open "unchanged";
    }
}

settings! {
    /// Where a moving camera ends. Values you leave out do not change.
    #[derive(Copy)]
    pub struct CameraKey {
        /// Azimuth at the end.
        pub azimuth: Option<f32> = None => "Azimuth", unit "degrees", least -3600.0, most 3600.0, open "unchanged";
        /// Elevation at the end.
        pub elevation: Option<f32> = None => "Elevation", unit "degrees", least -89.0, most 89.0, open "unchanged";
        /// Distance at the end. It requires `distance` at the start.
        pub distance: Option<f32> = None => "Distance", unit "cm", least NEAR as f64, most 1e6, open "unchanged";
        /// Field of view at the end.
        pub fov: Option<f32> = None => "Field of view", unit "degrees", least 1.0, most 150.0, open "unchanged";
        /// Target at the end. It requires `target` at the start.
        pub target: Option<Vec3> = None => "Target", unit "cm", least -1e6, most 1e6, open "unchanged";
        /// Focus distance at the end. It requires `focus_distance` at the start.
        pub focus_distance: Option<f32> = None => "Focus distance", unit "cm", least NEAR as f64, most 1e6, open "unchanged";
    }
}

impl Camera {
    /// The camera at `progress` (0..1) of the way to its second key, with a soft start and stop.
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

    /// Whether the view depends on the framed objects, because a setting that it needs is not given.
    pub fn is_automatic(&self) -> bool {
        let open = match self.projection {
            Projection::Perspective => self.distance.is_none(),
            // Without a distance the eye stands before all that is framed.
            Projection::Orthographic => self.height.is_none() || self.distance.is_none(),
        };
        self.target.is_none() || open
    }

    /// Refuses a lens where rays are parallel, and an end of a way that has no beginning.
    fn moves_from_somewhere(&self, at: &Place) -> Result<(), SettingError> {
        if let (Some(f_stop), Projection::Orthographic) = (self.f_stop, self.projection) {
            let way_out = "parallel rays have no lens: use projection = \"perspective\", or leave f_stop out";
            return refused(&at.key("f_stop"), f_stop, way_out);
        }
        let Some(to) = self.to else { return Ok(()) };
        let ends = [
            ("distance", to.distance.map(|end| end.to_string()), self.distance.is_some()),
            ("focus_distance", to.focus_distance.map(|end| end.to_string()), self.focus_distance.is_some()),
            ("target", to.target.map(|end| end.to_string()), self.target.is_some()),
        ];
        for (key, end, begins) in ends {
            if let (Some(end), false) = (end, begins) {
                let way_out = format!("give picture.camera.{key} as well, to start from");
                return refused(&at.key("to").key(key), end, way_out);
            }
        }
        Ok(())
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
