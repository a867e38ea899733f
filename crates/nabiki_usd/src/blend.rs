//! Blend shapes: how an animation of UsdSkel moves the points of a prim before joints do.

use glam::Vec3;

use crate::Problem;
use crate::opened::Layer;
use crate::rig::Rig;

/// The shapes of a prim, and the animation that weighs them.
pub struct BlendShapes {
    /// Of each shape the prim, and the number of its weight in the animation.
    shapes: Vec<(usize, usize)>,
    animation: usize,
}

const WEIGHTS: &str = "blendShapeWeights";

impl BlendShapes {
    /// Those of a prim that an animation weighs; `None` where there are none, or UsdSkel takes none as bound.
    pub fn of(layer: &mut Layer, prim: usize) -> Result<Option<Self>, Problem> {
        let mut chain: Vec<usize> = layer.upward(prim).collect();
        let Some(root) = chain.iter().rposition(|&i| layer.prims[i].type_name == "SkelRoot") else { return Ok(None) };
        chain.truncate(root + 1);
        if !layer.prims[prim].is_bound {
            return Ok(None);
        }
        let Some(names) = layer.at(prim, "skel:blendShapes", f64::NEG_INFINITY) else { return Ok(None) };
        let Some(targets) = layer.targets(prim, "skel:blendShapeTargets")? else { return Ok(None) };
        let skeleton = layer.bound_target(&chain, "skel:skeleton")?;
        let Some(skeleton) = skeleton.filter(|&i| layer.prims[i].type_name == "Skeleton") else { return Ok(None) };
        let Some(animation) = Rig::of(layer, skeleton)?.animation.as_ref().map(|animation| animation.prim) else {
            return Ok(None);
        };
        let Some(weighed) = layer.at(animation, "blendShapes", f64::NEG_INFINITY) else { return Ok(None) };
        let (names, weighed) = (layer.words(names)?, layer.words(weighed)?);
        let number = |name: &String| weighed.iter().position(|weighed| weighed == name);
        let shapes = names.iter().zip(targets).filter_map(|(name, target)| Some((target?, number(name)?)));
        let shapes: Vec<_> = shapes.filter(|&(shape, _)| layer.prims[shape].type_name == "BlendShape").collect();
        Ok((!shapes.is_empty()).then_some(Self { shapes, animation }))
    }

    /// Moves the points of the prim as at a time code. Shapes whose numbers do not fit move nothing.
    pub fn blend(&self, layer: &mut Layer, points: &mut [Vec3], time: f64) -> Result<(), Problem> {
        let weights = layer.numbers_at(self.animation, WEIGHTS, time)?.unwrap_or_default();
        for &(shape, number) in &self.shapes {
            let Some(&weight) = weights.get(number).filter(|&&weight| weight != 0.0) else { continue };
            let offsets = layer.points_at(shape, "offsets", f64::NEG_INFINITY)?.unwrap_or_default();
            let indices = layer.at(shape, "pointIndices", f64::NEG_INFINITY);
            let indices = indices.map(|indices| layer.integers(indices)).transpose()?.filter(|some| !some.is_empty());
            match indices {
                Some(indices) if indices.len() == offsets.len() => {
                    for (index, offset) in indices.into_iter().zip(offsets) {
                        if let Some(point) = usize::try_from(index).ok().and_then(|index| points.get_mut(index)) {
                            *point += weight as f32 * offset;
                        }
                    }
                }
                None if offsets.len() == points.len() => {
                    points.iter_mut().zip(offsets).for_each(|(point, offset)| *point += weight as f32 * offset);
                }
                _ => {}
            }
        }
        Ok(())
    }

    /// The time codes at which their weights change.
    pub fn times(&self, layer: &Layer) -> Vec<f64> {
        let weights = layer.prims[self.animation].attributes.get(WEIGHTS);
        weights.map(|weights| weights.samples.iter().map(|&(time, _)| time).collect()).unwrap_or_default()
    }

    /// Shapes between none and all of one, which are not read: a phrase for each.
    pub fn unread(&self, layer: &Layer) -> Vec<String> {
        let has = |shape: &&(usize, usize)| {
            layer.prims[shape.0].attributes.keys().any(|name| name.starts_with("inbetweens:"))
        };
        let line =
            |&(shape, _): &(usize, usize)| format!("the inbetweens of {}: it is blended linearly", layer.path(shape));
        self.shapes.iter().filter(has).map(line).collect()
    }
}
