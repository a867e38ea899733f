//! Stored samples of a distance, and the check when they are read.

use std::sync::OnceLock;

use glam::{UVec3, Vec3};

use super::{COARSE, EDGE, FINE, SkinDistance};
use crate::error::check_positive;
use crate::{Mesh, SettingError};

/// Most coarse nodes along an axis: 21 bits number the fine steps.
const MOST_NODES: u32 = (1 << 21) / FINE as u32;

/// Signed distance at the nodes of two grids, one four times finer near the skin; negative inside, in the mesh's unit.
#[derive(Clone, Debug, PartialEq)]
pub struct Samples {
    /// The first node.
    pub low: Vec3,
    /// Edge of a coarse cell.
    pub cell: f32,
    /// Coarse nodes along each axis, at least 2: one more than there are cells.
    pub nodes: UVec3,
    /// Whether the samples are mirrored to z < 0.
    pub mirrored: bool,
    /// Distance at the coarse nodes, x fastest.
    pub coarse: Vec<f32>,
    /// For each coarse cell, x fastest, the index of its block in `fine`, or [`COARSE`] for a cell far from the skin.
    pub block_of: Vec<u32>,
    /// Distance at the fine nodes of a cell including its faces, x fastest: [`EDGE`] along each axis.
    pub fine: Vec<[f32; EDGE * EDGE * EDGE]>,
}

impl Samples {
    /// Refuses grids without cells, lists whose lengths do not match nodes and cells, blocks that do not exist, and
    /// numbers that are not finite.
    ///
    /// # Errors
    /// Names the field, such as `samples.coarse`.
    pub fn check(&self) -> Result<(), SettingError> {
        let refused = |field: &str, value: String, remedy: String| {
            Err(SettingError::new(format!("samples.{field}"), value, remedy))
        };
        if !self.low.is_finite() || (self.mirrored && self.low.z > 0.0) {
            let remedy = "must be finite, and its z not above 0 where the samples are mirrored";
            return refused("low", self.low.to_string(), remedy.to_owned());
        }
        check_positive("samples.cell", self.cell)?;
        let product = |counts: UVec3| counts.to_array().into_iter().map(u64::from).product::<u64>();
        let range = 2..=MOST_NODES;
        if !self.nodes.to_array().iter().all(|count| range.contains(count)) {
            return refused("nodes", self.nodes.to_string(), format!("must lie in 2..{MOST_NODES} along each axis"));
        }
        let (nodes, cells) = (product(self.nodes), product(self.nodes - 1));
        if cells >= u64::from(u32::MAX) {
            return refused("nodes", self.nodes.to_string(), "must make fewer than 2^32 - 1 cells".to_owned());
        }
        for (field, count, wanted) in [("coarse", self.coarse.len(), nodes), ("block_of", self.block_of.len(), cells)] {
            if count as u64 != wanted {
                return refused(field, format!("{count} of them"), format!("must be {wanted}, as samples.nodes says"));
            }
        }
        if let Some(block) = self.block_of.iter().find(|&&block| block != COARSE && block as usize >= self.fine.len()) {
            return refused("block_of", block.to_string(), format!("must name one of the {} blocks", self.fine.len()));
        }
        for (field, numbers) in [("coarse", &self.coarse[..]), ("fine", self.fine.as_flattened())] {
            if let Some(number) = numbers.iter().find(|number| !number.is_finite()) {
                return refused(field, number.to_string(), "must be finite numbers".to_owned());
            }
        }
        Ok(())
    }
}

impl SkinDistance {
    /// The distance to `mesh` from the [`samples`](Self::samples) of an earlier one, instead of measuring as
    /// [`new`](Self::new) does. The mesh is used only outside the sampled box. The caller guarantees that the samples
    /// belong to it.
    ///
    /// # Errors
    /// As for [`Samples::check`].
    pub fn from_samples(mesh: &Mesh, samples: Samples) -> Result<Self, SettingError> {
        samples.check()?;
        Ok(Self { tree: OnceLock::new(), mesh: mesh.clone(), samples })
    }

    /// The samples, for storing.
    pub fn samples(&self) -> &Samples {
        &self.samples
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sketch;

    #[test]
    fn what_was_sampled_is_read_as_before_to_the_bit() {
        let head = sketch::head();
        let stored = head.skin().samples().clone();
        let again = SkinDistance::from_samples(&head.mesh, stored.clone()).unwrap();
        assert_eq!(*again.samples(), stored);
        for i in 0..4000 {
            let share = [0.618_034, 0.754_878, 0.569_84].map(|g: f32| 2.0 * (i as f32 * g).fract() - 1.0);
            let p = Vec3::from_array(share) * Vec3::new(40.0, 60.0, 40.0);
            assert_eq!(again.at(p).to_bits(), head.skin().at(p).to_bits(), "{p}");
            assert_eq!(again.gradient(p), head.skin().gradient(p), "{p}");
        }
    }

    #[test]
    fn samples_that_cannot_be_read_are_refused_by_their_field() {
        let head = sketch::head();
        let sound = head.skin().samples();
        let refused = |spoil: &dyn Fn(&mut Samples)| {
            let mut samples = sound.clone();
            spoil(&mut samples);
            SkinDistance::from_samples(&head.mesh, samples).unwrap_err().to_string()
        };
        let starts = |text: String, with: &str| assert!(text.starts_with(with), "{text}, not {with}");
        starts(refused(&|samples| samples.low.x = f32::NAN), "samples.low = ");
        starts(refused(&|samples| samples.low.z = 1.0), "samples.low = ");
        starts(refused(&|samples| samples.cell = 0.0), "samples.cell = 0");
        starts(refused(&|samples| samples.nodes.y = 1), "samples.nodes = ");
        starts(refused(&|samples| samples.nodes = UVec3::splat(MOST_NODES)), "samples.nodes = ");
        starts(refused(&|samples| samples.nodes.x += 1), "samples.coarse = ");
        starts(refused(&|samples| samples.block_of.truncate(7)), "samples.block_of = 7 of them: must be ");
        starts(refused(&|samples| samples.fine.truncate(1)), "samples.block_of = ");
        starts(refused(&|samples| samples.coarse[3] = f32::INFINITY), "samples.coarse = inf");
        starts(refused(&|samples| samples.fine[2][5] = f32::NAN), "samples.fine = NaN");
    }
}
