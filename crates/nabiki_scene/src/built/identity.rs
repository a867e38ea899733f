//! What a motion cache of a scene is marked with.

use nabiki::dynamics::Motion;
use nabiki_io::identity::{Digest, SceneId};

use super::BuiltScene;
use crate::error::Result;

impl BuiltScene {
    /// Everything that decides how the hair moves, but not how many frames are made of it, nor how it is drawn. Two
    /// scenes spelled differently that mean the same have the same.
    ///
    /// # Errors
    /// A file of the head's motion that can no longer be read.
    pub fn identity(&self) -> Result<SceneId> {
        let mut digest = Digest::new();
        digest.bytes("starts", bytemuck::cast_slice(&little_endian(self.hair.strands.starts())));
        let points: &[f32] = bytemuck::cast_slice(self.hair.strands.points());
        let bits: Vec<u32> = points.iter().map(|x| x.to_bits()).collect();
        digest.bytes("points", bytemuck::cast_slice(&little_endian(&bits)));
        // The rate counts where it says which poses the head has, which are taken in below.
        let motion = Motion { frames: 1, frame_rate: 24.0, ..self.dynamics.motion.clone() };
        digest.settings("motion", &motion)?;
        digest.settings("segment_length", &[self.dynamics.segment_length, self.dynamics.shell])?;
        digest.settings("ellipsoid", &self.dynamics.ellipsoid)?;
        digest.settings("pseudo_force", &self.dynamics.pseudo_force)?;
        digest.settings("force", &self.field.keyframes())?;
        if let Some(disturbance) = &self.dynamics.disturbance {
            digest.settings("disturbance", disturbance)?;
            digest.bytes("ids", bytemuck::cast_slice(&little_endian(&self.ids)));
        }
        for frame in 0..self.poses.len() {
            let pose = self.poses[frame];
            let numbers = [pose.position_cm.to_array().as_slice(), pose.rotation.to_array().as_slice()].concat();
            let bits: Vec<u32> = numbers.iter().map(|x| x.to_bits()).collect();
            digest.bytes("pose", bytemuck::cast_slice(&little_endian(&bits)));
        }
        Ok(digest.finish())
    }
}

fn little_endian(values: &[u32]) -> Vec<u32> {
    values.iter().map(|value| value.to_le()).collect()
}
