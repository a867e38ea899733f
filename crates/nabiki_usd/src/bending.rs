//! Meshes that bend from frame to frame: by the samples of their points, joints and blend shapes.

use glam::Vec3;

use crate::Problem;
use crate::blend::BlendShapes;
use crate::meshes;
use crate::opened::Layer;
use crate::read::{StageReader, in_place};
use crate::skin::{Skin, Stance};

impl StageReader {
    /// The time codes at which the chosen meshes bend, growing; none where they only go as a whole.
    pub(crate) fn bending_codes(&mut self, wanted: &dyn Fn(&str) -> bool) -> Result<Vec<f64>, Problem> {
        let mut codes = Vec::new();
        for prim in meshes::chosen(&mut self.layer, wanted, Stance::First)?.prims {
            codes.extend(bending_codes(&mut self.layer, prim)?);
        }
        codes.sort_by(f64::total_cmp);
        codes.dedup();
        Ok(codes)
    }

    /// The vertices of the chosen meshes at a time code, as the stage shows them, in the order in which they are read at first.
    pub(crate) fn bent_at(&mut self, wanted: &dyn Fn(&str) -> bool, code: f64) -> Result<Vec<Vec3>, Problem> {
        let mut all = Vec::new();
        for prim in meshes::chosen(&mut self.layer, wanted, Stance::First)?.prims {
            let layer = &mut self.layer;
            let points = layer.points_at(prim, "points", code)?;
            let points = points.ok_or_else(|| Problem(format!("mesh {}: has no points", layer.path(prim))))?;
            let posed = in_place(layer, prim, points, Stance::First, code)?;
            all.extend(posed.points.into_iter().map(|p| posed.world.transform_point3(p.as_dvec3()).as_vec3()));
        }
        Ok(all)
    }
}

/// The time codes at which a mesh bends, in any order.
fn bending_codes(layer: &mut Layer, prim: usize) -> Result<Vec<f64>, Problem> {
    let mut codes = Vec::new();
    let samples = layer.prims[prim].attributes.get("points").map_or(&[][..], |points| &points.samples);
    if samples.len() > 1 {
        codes.extend(samples.iter().map(|&(code, _)| code));
    }
    if let Some(skin) = Skin::of(layer, prim)?.filter(Skin::bends) {
        codes.extend(skin.rig.times(layer));
    }
    if let Some(shapes) = BlendShapes::of(layer, prim)? {
        codes.extend(shapes.times(layer));
    }
    Ok(codes)
}
