//! Joints of skeletons, as far as they can carry a head: where a joint is, out of the animation that moves it.

use glam::{DMat4, DVec3};

use crate::Problem;
use crate::opened::Layer;
use crate::transform;

/// A joint and what moves it.
pub struct Joint {
    skeleton: usize,
    animation: Option<usize>,
    /// Each from the top down: its number in the skeleton, and in the animation.
    chain: Vec<(usize, Option<usize>)>,
}

/// The paths of the joints of a skeleton, each below the skeleton's own: `/man/rig/hips/neck/head`.
pub fn joints(layer: &mut Layer, skeleton: usize) -> Result<Vec<String>, Problem> {
    match layer.at(skeleton, "joints", 0.0) {
        Some(handle) => layer.words(handle),
        None => Ok(Vec::new()),
    }
}

/// The joint that `node` names: its path in the skeleton, with or without the skeleton's own before it, or its last name
/// where one joint only has that.
///
/// # Errors
/// Several joints of that name; several animations of the skeleton.
pub fn joint(layer: &mut Layer, node: &str) -> Result<Option<Joint>, Problem> {
    let mut found = Vec::new();
    for skeleton in layer.of_type("Skeleton") {
        let path = layer.path(skeleton);
        for (index, joint) in joints(layer, skeleton)?.into_iter().enumerate() {
            let whole = joint == node || format!("{path}/{joint}") == node;
            if whole || joint.rsplit('/').next().is_some_and(|last| last.eq_ignore_ascii_case(node)) {
                found.push((skeleton, index, format!("{path}/{joint}")));
            }
        }
    }
    match &found[..] {
        [] => Ok(None),
        [(skeleton, index, _)] => of_skeleton(layer, *skeleton, *index).map(Some),
        several => {
            let paths: Vec<&str> = several.iter().map(|(.., path)| path.as_str()).take(8).collect();
            Err(Problem(format!("has {} joints {node}: node can be {}", several.len(), paths.join(", "))))
        }
    }
}

fn of_skeleton(layer: &mut Layer, skeleton: usize, index: usize) -> Result<Joint, Problem> {
    let joints = joints(layer, skeleton)?;
    let path = &joints[index];
    let above = |joint: &String| path.strip_prefix(joint.as_str()).is_some_and(|r| r.is_empty() || r.starts_with('/'));
    let mut animations = Vec::new();
    for prim in layer.of_type("SkelAnimation") {
        let animated = self::joints(layer, prim)?;
        if animated.iter().any(above) {
            animations.push((prim, animated));
        }
    }
    if animations.len() > 1 {
        let paths: Vec<String> = animations.iter().take(8).map(|&(prim, _)| layer.path(prim)).collect();
        return Err(Problem(format!("joint {path} moves in {}: keep one animation in the layer", paths.join(", "))));
    }
    let animation = animations.pop();
    let place = |joint: &str| {
        let animated = animation.as_ref().and_then(|(_, animated)| animated.iter().position(|name| name == joint));
        joints.iter().position(|name| name == joint).map(|index| (index, animated))
    };
    let ends = path.match_indices('/').map(|(at, _)| at).chain([path.len()]);
    let chain = ends.filter_map(|end| place(&path[..end])).collect();
    Ok(Joint { skeleton, animation: animation.map(|(prim, _)| prim), chain })
}

impl Joint {
    /// The time codes at which it, or a prim above its skeleton, moves.
    pub fn times(&self, layer: &Layer) -> Vec<f64> {
        let mut times = transform::times(layer, self.skeleton);
        let attributes = self.animation.map(|prim| &layer.prims[prim].attributes);
        for name in ["translations", "rotations", "scales"] {
            let samples = attributes.and_then(|a| a.get(name)).map(|a| &a.samples[..]).unwrap_or_default();
            times.extend(samples.iter().map(|&(t, _)| t));
        }
        times
    }

    /// Its axes in the world at a time code.
    pub fn world(&self, layer: &mut Layer, time: f64) -> Result<DMat4, Problem> {
        let mut world = transform::world(layer, self.skeleton, time)?;
        for &(index, animated) in &self.chain {
            world *= match (self.animation, animated) {
                (Some(animation), Some(index)) => moved(layer, animation, index, time)?,
                _ => self.rest(layer, index)?,
            };
        }
        Ok(world)
    }

    /// Its axes in the world when meshes were bound to it, if the skeleton says so.
    pub fn bound(&self, layer: &mut Layer) -> Result<Option<DMat4>, Problem> {
        let numbers = layer.numbers_at(self.skeleton, "bindTransforms", 0.0)?.unwrap_or_default();
        let own = self.chain.last().and_then(|&(index, _)| numbers.as_chunks::<16>().0.get(index));
        Ok(own.map(DMat4::from_cols_array))
    }

    fn rest(&self, layer: &mut Layer, index: usize) -> Result<DMat4, Problem> {
        let numbers = layer.numbers_at(self.skeleton, "restTransforms", 0.0)?.unwrap_or_default();
        match numbers.as_chunks::<16>().0.get(index) {
            Some(matrix) => Ok(DMat4::from_cols_array(matrix)),
            None => {
                Err(Problem(format!("skeleton {}: joint {index} has no rest transform", layer.path(self.skeleton))))
            }
        }
    }
}

/// A joint's own transform in an animation: scale first, then turn, then place.
fn moved(layer: &mut Layer, animation: usize, index: usize, time: f64) -> Result<DMat4, Problem> {
    let triple =
        |numbers: Option<Vec<f64>>| numbers.unwrap_or_default().as_chunks::<3>().0.get(index).map(|&v| DVec3::from(v));
    let place = triple(layer.numbers_at(animation, "translations", time)?);
    let scale = triple(layer.numbers_at(animation, "scales", time)?);
    let turn = layer.quaternions_at(animation, "rotations", time)?.and_then(|turns| turns.get(index).copied());
    match (place, turn) {
        (Some(place), Some(turn)) => {
            Ok(DMat4::from_scale_rotation_translation(scale.unwrap_or(DVec3::ONE), turn, place))
        }
        _ => Err(Problem(format!("animation {}: has no place or no turn of joint {index}", layer.path(animation)))),
    }
}
