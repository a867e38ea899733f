//! The position of the head ellipsoid in each frame, for fields that go around it.

use glam::{Mat3, Vec3};

use crate::ellipsoid::Ellipsoid;
use crate::error::SettingError;
use crate::pose::{Pose, check_poses};

/// The head ellipsoid through the frames, in the space of the field.
#[derive(Clone, Debug)]
pub(super) struct HeadTrack {
    pub ellipsoid: Ellipsoid,
    places: Vec<Place>,
}

/// The position of the ellipsoid in one frame.
#[derive(Clone, Copy, Debug)]
pub(super) struct Place {
    /// Its centre (cm).
    pub center: [f32; 3],
    /// Rows of the rotation from the space of the field to the axes of the ellipsoid.
    pub axes: [[f32; 3]; 3],
}

impl HeadTrack {
    /// `poses`: one per frame from frame 0 on, the last of which holds after that; none for a head that does not move.
    ///
    /// # Errors
    /// An ellipsoid or a pose that is none.
    pub fn new(ellipsoid: Ellipsoid, poses: &[Pose]) -> Result<Self, SettingError> {
        ellipsoid.check_at("head.ellipsoid")?;
        check_poses("pose of", poses)?;
        let still = [Pose::STILL];
        let poses = if poses.is_empty() { &still } else { poses };
        let place = |pose: &Pose| Place {
            center: (pose.rotation * ellipsoid.center + pose.position_cm).to_array(),
            // The columns of a rotation are the rows of its inverse.
            axes: Mat3::from_quat(pose.rotation).to_cols_array_2d(),
        };
        Ok(Self { ellipsoid, places: poses.iter().map(place).collect() })
    }

    pub fn place(&self, frame: u32) -> &Place {
        &self.places[(frame as usize).min(self.places.len() - 1)]
    }

    /// The centre of the ellipsoid in a frame.
    pub fn center(&self, frame: u32) -> Vec3 {
        Vec3::from_array(self.place(frame).center)
    }
}
