//! Skeletons: where their joints are, out of the animation that moves them.

use std::collections::HashMap;
use std::rc::Rc;

use glam::{DMat4, DQuat, DVec3};

use crate::Problem;
use crate::opened::Layer;
use crate::rig::{Animation, Poses, Rig};
use crate::transform;

/// A joint of a rig.
pub struct Joint {
    rig: Rig,
    index: usize,
}

/// The paths of the joints of a skeleton or an animation.
pub fn joints(layer: &mut Layer, prim: usize) -> Result<Vec<String>, Problem> {
    match layer.at(prim, "joints", 0.0) {
        Some(handle) => layer.words(handle),
        None => Ok(Vec::new()),
    }
}

/// The joint that `node` names: its path in the skeleton, with or without the skeleton's own before it, or its last name
/// where one joint only has that.
///
/// # Errors
/// Several joints of that name; several animations that may move it, of which none is bound to the skeleton.
pub fn joint(layer: &mut Layer, node: &str) -> Result<Option<Joint>, Problem> {
    let mut found = Vec::new();
    for skeleton in layer.of_type("Skeleton") {
        let path = layer.path(skeleton);
        for (index, joint) in joints(layer, skeleton)?.into_iter().enumerate() {
            let whole = joint == node || format!("{path}/{joint}") == node;
            if whole || joint.rsplit('/').next().is_some_and(|last| last.eq_ignore_ascii_case(node)) {
                found.push((skeleton, index, format!("{path}/{joint}"), whole));
            }
        }
    }
    // A whole path goes before names that are alike.
    if found.iter().filter(|(.., whole)| *whole).count() == 1 {
        found.retain(|(.., whole)| *whole);
    }
    match &found[..] {
        [] => Ok(None),
        [(skeleton, index, ..)] => {
            let mut rig = Rig::clone(&*Rig::of(layer, *skeleton)?);
            if rig.animation.is_none() {
                let only = only_animation(layer, *skeleton, &rig.joints[*index])?;
                rig.animation = only.map(|prim| Animation::of(layer, prim, &rig.joints)).transpose()?;
            }
            Ok(Some(Joint { rig, index: *index }))
        }
        several => {
            let paths: Vec<&str> = several.iter().map(|(_, _, path, _)| path.as_str()).take(8).collect();
            Err(Problem(format!("has {} joints {node}: node can be {}", several.len(), paths.join(", "))))
        }
    }
}

/// The animation of a joint that is named although no animation is bound to its skeleton: that which the skeleton names all the same,
/// or the one that has the joint or one above it.
fn only_animation(layer: &mut Layer, skeleton: usize, path: &str) -> Result<Option<usize>, Problem> {
    let named = layer.targets(skeleton, "skel:animationSource")?.and_then(|targets| *targets.first()?);
    if let Some(named) = named.filter(|&prim| is_animation(layer, prim)) {
        return Ok(Some(named));
    }
    let above = |joint: &String| path.strip_prefix(joint.as_str()).is_some_and(|r| r.is_empty() || r.starts_with('/'));
    let mut animations = Vec::new();
    for prim in layer.of_type("SkelAnimation") {
        if joints(layer, prim)?.iter().any(above) {
            animations.push(prim);
        }
    }
    if animations.len() > 1 {
        let paths: Vec<String> = animations.iter().take(8).map(|&prim| layer.path(prim)).collect();
        let paths = paths.join(", ");
        return Err(Problem(format!(
            "joint {path} may move as in {paths}: bind one to the skeleton (skel:animationSource), or keep one in the layer"
        )));
    }
    Ok(animations.pop())
}

fn is_animation(layer: &Layer, prim: usize) -> bool {
    layer.prims[prim].type_name == "SkelAnimation" && layer.is_on_stage(prim)
}

impl Animation {
    fn of(layer: &mut Layer, prim: usize, of_skeleton: &[String]) -> Result<Self, Problem> {
        let own = joints(layer, prim)?;
        let place: HashMap<&str, usize> = own.iter().enumerate().rev().map(|(i, joint)| (joint.as_str(), i)).collect();
        let numbers = of_skeleton.iter().map(|joint| place.get(joint.as_str()).copied()).collect();
        Ok(Self { prim, count: own.len(), numbers })
    }

    /// The own transforms of its joints at a time code; `None` where its values are not one for each joint, with which
    /// UsdSkel plays none. Scales may be left out.
    fn at(&self, layer: &mut Layer, time: f64) -> Result<Option<Vec<DMat4>>, Problem> {
        let places = layer.numbers_at(self.prim, "translations", time)?.unwrap_or_default();
        let turns = layer.quaternions_at(self.prim, "rotations", time)?.unwrap_or_default();
        let scales = layer.numbers_at(self.prim, "scales", time)?.unwrap_or_else(|| vec![1.0; 3 * self.count]);
        if places.len() != 3 * self.count || turns.len() != self.count || scales.len() != 3 * self.count {
            return Ok(None);
        }
        let triples = places.as_chunks::<3>().0.iter().zip(scales.as_chunks::<3>().0);
        let all = triples.zip(turns).map(|((&place, &scale), turn): (_, DQuat)| {
            DMat4::from_scale_rotation_translation(DVec3::from(scale), turn, DVec3::from(place))
        });
        Ok(Some(all.collect()))
    }
}

impl Rig {
    /// A skeleton with the animation that is bound to it, if any is: read once, whatever hangs on it.
    pub fn of(layer: &mut Layer, skeleton: usize) -> Result<Rc<Self>, Problem> {
        if let Some(known) = layer.rigs.by_skeleton.get(&skeleton) {
            return Ok(known.clone());
        }
        let rig = Rc::new(Self::read(layer, skeleton)?);
        let letters: usize = rig.joints.iter().map(String::len).sum();
        let numbers = rig.joints.len() * (size_of::<String>() + 2 * size_of::<Option<usize>>());
        layer.budget.keep((letters + numbers) as u64, "joints")?;
        layer.rigs.by_skeleton.insert(skeleton, rig.clone());
        Ok(rig)
    }

    fn read(layer: &mut Layer, skeleton: usize) -> Result<Self, Problem> {
        let joints = joints(layer, skeleton)?;
        let place: HashMap<&str, usize> = joints.iter().enumerate().map(|(i, joint)| (joint.as_str(), i)).collect();
        let above = |joint: &String| joint.rmatch_indices('/').find_map(|(at, _)| place.get(&joint[..at]).copied());
        let parents = joints.iter().map(above).collect();
        let chain: Vec<usize> = layer.upward(skeleton).collect();
        let animation = layer.bound_target(&chain, "skel:animationSource")?;
        let animation = animation.filter(|&prim| is_animation(layer, prim));
        let animation = animation.map(|prim| Animation::of(layer, prim, &joints)).transpose()?;
        Ok(Self { skeleton, joints, parents, animation })
    }

    /// Whether an animation is bound to it.
    pub fn is_animated(&self) -> bool {
        self.animation.is_some()
    }

    /// The time codes at which it, or a prim above it, moves.
    pub fn times(&self, layer: &Layer) -> Vec<f64> {
        let mut times = transform::times(layer, self.skeleton);
        let attributes = self.animation.as_ref().map(|animation| &layer.prims[animation.prim].attributes);
        for name in ["translations", "rotations", "scales", "blendShapeWeights"] {
            let samples = attributes.and_then(|a| a.get(name)).map(|a| &a.samples[..]).unwrap_or_default();
            times.extend(samples.iter().map(|&(t, _)| t));
        }
        times
    }

    /// Where each joint is at a time code, as [`poses`](Self::poses), of the rig that the skeleton has by itself: worked out once.
    pub fn poses_of_all(&self, layer: &mut Layer, time: f64) -> Result<Rc<Poses>, Problem> {
        match &layer.rigs.posed {
            Some((skeleton, at, poses)) if *skeleton == self.skeleton && *at == time => Ok(poses.clone()),
            _ => {
                let poses: Rc<Poses> = self.poses(layer, time)?.into();
                layer.rigs.posed = Some((self.skeleton, time, poses.clone()));
                Ok(poses)
            }
        }
    }

    /// Where each joint is in the skeleton's space at a time code; none for joints that neither an animation nor a rest
    /// transform places.
    pub fn poses(&self, layer: &mut Layer, time: f64) -> Result<Vec<Option<DMat4>>, Problem> {
        let rest = self.matrices(layer, "restTransforms")?.unwrap_or_default();
        let animated = match &self.animation {
            Some(animation) => animation.at(layer, time)?,
            None => None,
        };
        let number = |joint: usize| self.animation.as_ref().and_then(|animation| animation.numbers[joint]);
        let own = |joint: usize| {
            let moved = animated.as_ref().zip(number(joint)).map(|(all, number)| all[number]);
            moved.or_else(|| rest.get(joint).copied())
        };
        // Those above have shorter paths.
        let mut order: Vec<usize> = (0..self.joints.len()).collect();
        order.sort_by_key(|&joint| self.joints[joint].len());
        let mut poses = vec![None; self.joints.len()];
        for joint in order {
            let above = self.parents[joint].map_or(Some(DMat4::IDENTITY), |parent| poses[parent]);
            poses[joint] = above.zip(own(joint)).map(|(above, own): (DMat4, DMat4)| above * own);
        }
        Ok(poses)
    }

    /// Where each joint was when meshes were bound to it, if the skeleton says so of all.
    pub fn bound(&self, layer: &mut Layer) -> Result<Option<Rc<[DMat4]>>, Problem> {
        if let Some(known) = layer.rigs.bound.get(&self.skeleton) {
            return Ok(known.clone());
        }
        let bound = self.matrices(layer, "bindTransforms")?;
        layer.budget.keep((bound.as_ref().map_or(0, Vec::len) * size_of::<DMat4>()) as u64, "bindTransforms")?;
        let bound: Option<Rc<[DMat4]>> = bound.map(Into::into);
        layer.rigs.bound.insert(self.skeleton, bound.clone());
        Ok(bound)
    }

    /// One matrix for each joint.
    fn matrices(&self, layer: &mut Layer, name: &str) -> Result<Option<Vec<DMat4>>, Problem> {
        let numbers = layer.numbers_at(self.skeleton, name, 0.0)?.unwrap_or_default();
        let (matrices, _) = numbers.as_chunks::<16>();
        let fit = matrices.len() == self.joints.len() && !matrices.is_empty();
        Ok(fit.then(|| matrices.iter().map(DMat4::from_cols_array).collect()))
    }
}

impl Joint {
    /// The time codes at which it, or a prim above its skeleton, moves.
    pub fn times(&self, layer: &Layer) -> Vec<f64> {
        self.rig.times(layer)
    }

    /// Its axes in the world at a time code.
    pub fn world(&self, layer: &mut Layer, time: f64) -> Result<DMat4, Problem> {
        if let Some(animation) = &self.rig.animation
            && animation.at(layer, time)?.is_none()
        {
            let (path, joints) = (layer.path(animation.prim), animation.count);
            return Err(Problem(format!(
                "animation {path}: it has {joints} joints, but another number of translations, rotations or scales"
            )));
        }
        let Some(pose) = self.rig.poses(layer, time)?[self.index] else {
            let (path, joint) = (layer.path(self.rig.skeleton), &self.rig.joints[self.index]);
            return Err(Problem(format!("skeleton {path}: joint {joint}, or one above it, has no rest transform")));
        };
        Ok(transform::world(layer, self.rig.skeleton, time)? * pose)
    }

    /// Its axes in the world when meshes were bound to it, with the skeleton where it is at a time code, if that says so.
    pub fn bound(&self, layer: &mut Layer, time: f64) -> Result<Option<DMat4>, Problem> {
        let Some(bound) = self.rig.bound(layer)? else { return Ok(None) };
        Ok(Some(transform::world(layer, self.rig.skeleton, time)? * bound[self.index]))
    }
}
