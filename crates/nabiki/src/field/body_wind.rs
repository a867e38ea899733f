//! The wind that a moving head feels.

use glam::{DVec3, Vec3};

use super::Field;
use crate::dynamics::ForceSpace;
use crate::error::SettingError;
use crate::pose::{Pose, check_poses};
use crate::settings;
use crate::smoothing::{self, smoothed};

settings! {
    /// The wind caused by the motion of the head, the same everywhere. It needs `[head.motion]`.
    ///
    /// With the head's velocity v (cm/s) and acceleration a (cm/s^2), from its poses and the frame rate: F = -drag v -
    /// footfall (0, a_y, 0).
    pub struct BodyWind in "body_wind" {
        /// Force per cm/s of the head's speed, opposite to its direction.
        pub drag: f32 = 0.3 => "Drag", unit "per cm/s", least 0.0;
        /// Downward force per cm/s^2 of upward acceleration of the head. With gravity G, hair that is lifted with the
        /// head feels G / 981.
        pub footfall: f32 = 0.0 => "Footfall", unit "per cm/s2", least 0.0;
        /// Standard deviation of the bell that averages the head's positions for this wind. Raise it for recorded
        /// motion, whose accelerations tremble. 0 leaves the motion as it is.
        pub smoothing: f32 = 0.0 => "Smoothing", unit "frames", least 0.0, most smoothing::MOST as f64;
    }
}

/// The wind of a moving head: a force for each frame.
#[derive(Clone, Debug)]
pub struct BodyWindField {
    forces: Vec<Vec3>,
}

impl BodyWindField {
    /// `poses` are those of the head in the world, one per frame from frame 0 on. After the last, the head does not
    /// move. `frame_rate` is in frames per second. With [`ForceSpace::Head`], the force is in head space.
    ///
    /// # Errors
    /// Settings out of range, invalid poses, or a rate that is not above 0.
    pub fn new(settings: &BodyWind, poses: &[Pose], frame_rate: f64, space: ForceSpace) -> Result<Self, SettingError> {
        settings.check()?;
        check_poses("pose of", poses)?;
        if !(frame_rate.is_finite() && frame_rate > 0.0) {
            let remedy = "must be a finite number of frames a second, above 0";
            return Err(SettingError::new("motion.frame_rate", frame_rate, remedy));
        }
        let places: Vec<DVec3> = poses.iter().map(|pose| pose.position_cm.as_dvec3()).collect();
        let mean = |before: DVec3, now: DVec3, after: DVec3, b: f64| now + b * (before - now + (after - now));
        let places = smoothed(&places, f64::from(settings.smoothing), mean);
        let force = |n: usize| {
            let (velocity, acceleration) = moving(&places, n, frame_rate);
            let felt = DVec3::new(0.0, acceleration.y, 0.0) * f64::from(settings.footfall);
            let force = (-f64::from(settings.drag) * velocity - felt).as_vec3();
            match space {
                ForceSpace::World => force,
                ForceSpace::Head => poses[n].rotation.inverse() * force,
            }
        };
        let forces: Vec<Vec3> = (0..places.len()).map(force).collect();
        if let Some(n) = forces.iter().position(|force| !force.is_finite()) {
            let remedy = "the head moves too fast: check head.motion";
            return Err(SettingError::new(format!("body_wind in frame {n}"), forces[n], remedy));
        }
        Ok(Self { forces })
    }
}

/// Velocity and acceleration in a frame, by central differences; at the ends, those of the neighbouring frame.
fn moving(places: &[DVec3], n: usize, frame_rate: f64) -> (DVec3, DVec3) {
    let last = places.len() - 1;
    if last == 0 {
        return (DVec3::ZERO, DVec3::ZERO);
    }
    let (before, after) = (n.saturating_sub(1), (n + 1).min(last));
    let velocity = (places[after] - places[before]) * frame_rate / (after - before) as f64;
    if last == 1 {
        return (velocity, DVec3::ZERO);
    }
    let middle = n.clamp(1, last - 1);
    let step = places[middle + 1] - places[middle] - (places[middle] - places[middle - 1]);
    (velocity, step * frame_rate * frame_rate)
}

impl Field for BodyWindField {
    fn at(&self, _point: Vec3, frame: u32) -> Vec3 {
        self.forces.get(frame as usize).copied().unwrap_or_default()
    }

    fn strongest(&self) -> f32 {
        self.forces.iter().map(|force| force.length()).fold(0.0, f32::max)
    }

    fn first_above(&self, limit: f64) -> Option<(String, String)> {
        let n = self.forces.iter().position(|force| f64::from(force.length()) > limit)?;
        Some(("body_wind".to_owned(), format!("{} in frame {n}", self.forces[n])))
    }

    fn uniform(&self, frame: u32) -> Option<Vec3> {
        Some(self.at(Vec3::ZERO, frame))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Quat;

    fn track(place: impl Fn(f32) -> Vec3) -> Vec<Pose> {
        (0..60)
            .map(|n| Pose { position_cm: place(n as f32), rotation: Quat::from_rotation_y(0.3 * n as f32) })
            .collect()
    }

    fn wind(settings: &BodyWind, poses: &[Pose]) -> BodyWindField {
        BodyWindField::new(settings, poses, 24.0, ForceSpace::World).unwrap()
    }

    #[test]
    fn a_head_that_goes_evenly_has_an_even_wind_against_it() {
        let poses = track(|n| Vec3::new(10.0 * n, 160.0, -2.5 * n));
        for smoothing in [0.0, 0.4, 3.0] {
            let field = wind(&BodyWind { smoothing, ..BodyWind::default() }, &poses);
            // Averages reach beyond the ends, which are left out.
            for frame in 20..40 {
                let expected = -0.3 * 24.0 * Vec3::new(10.0, 0.0, -2.5);
                assert!((field.at(Vec3::ONE, frame) - expected).length() < 1e-4, "{smoothing}");
            }
        }
        let field = wind(&BodyWind::default(), &poses);
        assert_eq!(field.uniform(0), field.uniform(30));
        assert_eq!(field.uniform(60), Some(Vec3::ZERO));
        assert_eq!(field.strongest(), field.at(Vec3::ZERO, 3).length());
    }

    #[test]
    fn a_head_that_is_thrown_up_presses_its_hair_down() {
        // y = n^2 / 4 cm: 1/2 cm per frame^2, 288 cm/s^2.
        let poses = track(|n| Vec3::new(0.0, 0.25 * n * n, 0.0));
        let field = wind(&BodyWind { drag: 0.0, footfall: 0.1, smoothing: 0.0 }, &poses);
        for frame in 0..60 {
            assert!((field.at(Vec3::ZERO, frame) - Vec3::new(0.0, -28.8, 0.0)).length() < 1e-2);
        }
    }

    #[test]
    fn smoothing_weakens_a_sway_as_a_bell_does() {
        // exp(-(omega sigma)^2 / 2) in the limit; each round is 1 - 2 b (1 - cos omega).
        let omega = 0.5_f32;
        let poses = track(|n| Vec3::new(5.0 * (omega * n).sin(), 0.0, 0.0));
        let swing = |smoothing: f32| {
            let field = wind(&BodyWind { smoothing, ..BodyWind::default() }, &poses);
            (25..38).map(|n| field.at(Vec3::ZERO, n).length()).fold(0.0, f32::max)
        };
        for sigma in [0.5_f32, 1.0, 2.0] {
            let rounds = (2.0 * sigma * sigma).ceil();
            let expected = (1.0 - sigma * sigma / rounds * (1.0 - omega.cos())).powf(rounds);
            assert!((swing(sigma) / swing(0.0) / expected - 1.0).abs() < 1e-3, "{sigma}");
            assert!((expected / (-0.5 * (omega * sigma).powi(2)).exp() - 1.0).abs() < 0.03, "{sigma}");
        }
    }

    #[test]
    fn in_head_space_it_turns_against_the_head() {
        let poses = track(|n| Vec3::new(10.0 * n, 0.0, 0.0));
        let world = wind(&BodyWind::default(), &poses);
        let head = BodyWindField::new(&BodyWind::default(), &poses, 24.0, ForceSpace::Head).unwrap();
        for (n, pose) in poses.iter().enumerate() {
            let turned = pose.rotation * head.at(Vec3::ZERO, n as u32);
            assert!((turned - world.at(Vec3::ZERO, n as u32)).length() < 1e-4);
        }
    }

    #[test]
    fn few_poses_and_bad_settings() {
        let one = wind(&BodyWind::default(), &[Pose::STILL]);
        assert_eq!((one.uniform(0), one.strongest()), (Some(Vec3::ZERO), 0.0));
        assert_eq!(wind(&BodyWind::default(), &[]).uniform(3), Some(Vec3::ZERO));
        let refused = |settings: BodyWind| settings.check().unwrap_err().thing;
        assert_eq!(refused(BodyWind { drag: -1.0, ..BodyWind::default() }), "body_wind.drag");
        assert_eq!(refused(BodyWind { footfall: f32::INFINITY, ..BodyWind::default() }), "body_wind.footfall");
        assert_eq!(refused(BodyWind { smoothing: 241.0, ..BodyWind::default() }), "body_wind.smoothing");
        let broken = [Pose { position_cm: Vec3::NAN, ..Pose::STILL }];
        let refused = BodyWindField::new(&BodyWind::default(), &broken, 24.0, ForceSpace::World).unwrap_err();
        assert_eq!(refused.thing, "pose of frame 0");
    }
}
