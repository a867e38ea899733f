//! What is bound to a skeleton: UsdSkel places it by the joints, and not by the transforms of its own prim.

use std::collections::HashMap;
use std::rc::Rc;

use glam::{DMat4, DVec3, Vec3};

use crate::Problem;
use crate::opened::Layer;
use crate::rig::Rig;
use crate::transform;

/// How the points of a prim hang on joints.
pub struct Skin {
    /// The skeleton.
    pub rig: Rc<Rig>,
    /// Takes the points to where they were bound, in the skeleton's space.
    geom_bind: DMat4,
    /// The joint of the rig that each number among the influences means, where that is not the rig's own.
    joints: Option<Vec<Option<usize>>>,
    indices: Vec<i64>,
    weights: Vec<f64>,
    /// Whether all points have the same influences.
    is_constant: bool,
    /// Whether joints are to be blended as dual quaternions, which is not done.
    blends_otherwise: bool,
}

/// In which pose of their skeletons heads stand.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stance {
    /// That in which they were bound, as hair of other files was groomed on them.
    Bound,
    /// That of the first frame, as the stage shows them.
    First,
}

impl Skin {
    /// How a prim is bound, if UsdSkel takes it as bound: below a `SkelRoot`, with a skeleton, joints and weights that it or a prim
    /// above it names, each of which has `SkelBindingAPI` applied.
    pub fn of(layer: &mut Layer, prim: usize) -> Result<Option<Self>, Problem> {
        let mut chain: Vec<usize> = layer.upward(prim).collect();
        let Some(root) = chain.iter().rposition(|&i| layer.prims[i].type_name == "SkelRoot") else { return Ok(None) };
        chain.truncate(root + 1);
        let is_skeleton = |layer: &Layer, i: usize| layer.prims[i].type_name == "Skeleton" && layer.is_on_stage(i);
        let skeleton = layer.bound_target(&chain, "skel:skeleton")?;
        let Some(skeleton) = skeleton.filter(|&i| is_skeleton(layer, i)) else { return Ok(None) };
        let nearest = |layer: &Layer, name: &str| {
            let has = |&&i: &&usize| layer.prims[i].is_bound && layer.at(i, name, f64::NEG_INFINITY).is_some();
            chain.iter().find(has).copied()
        };
        let [indices, weights] = ["primvars:skel:jointIndices", "primvars:skel:jointWeights"];
        let (Some(of_indices), Some(of_weights)) = (nearest(layer, indices), nearest(layer, weights)) else {
            return Ok(None);
        };
        let mut is_constant = |prim: usize, name: &str| {
            let interpolation = layer.interpolation(prim, name)?;
            Ok::<_, Problem>(match interpolation.as_deref() {
                None | Some("constant") => Some(true),
                Some("vertex") => Some(false),
                Some(_) => None,
            })
        };
        let (Some(is_constant), same) = (is_constant(of_indices, indices)?, is_constant(of_weights, weights)?) else {
            return Ok(None);
        };
        if same != Some(is_constant) {
            return Ok(None);
        }
        let value = |prim: usize, name: &str| layer.at(prim, name, f64::NEG_INFINITY);
        let (Some(indices), Some(weights)) = (value(of_indices, indices), value(of_weights, weights)) else {
            return Ok(None);
        };
        let (indices, weights) = (layer.integers(indices)?, layer.numbers(weights)?);
        if indices.is_empty() || indices.len() != weights.len() {
            return Ok(None);
        }
        let rig = Rig::of(layer, skeleton)?;
        let joints = match nearest(layer, "skel:joints").and_then(|i| layer.at(i, "skel:joints", f64::NEG_INFINITY)) {
            None => None,
            Some(own) => {
                let place: HashMap<&str, usize> =
                    rig.joints.iter().enumerate().map(|(i, name)| (name.as_str(), i)).collect();
                Some(layer.words(own)?.iter().map(|name| place.get(name.as_str()).copied()).collect())
            }
        };
        let bind = "primvars:skel:geomBindTransform";
        let geom_bind = match nearest(layer, bind) {
            Some(i) => layer.numbers_at(i, bind, f64::NEG_INFINITY)?.unwrap_or_default(),
            None => Vec::new(),
        };
        let geom_bind = geom_bind.first_chunk::<16>().map_or(DMat4::IDENTITY, DMat4::from_cols_array);
        let method = "primvars:skel:skinningMethod";
        let method = nearest(layer, method).map(|i| layer.word(i, method)).transpose()?.flatten();
        let blends_otherwise = method.is_some_and(|method| method == "dualQuaternion");
        Ok(Some(Self { rig, geom_bind, joints, indices, weights, is_constant, blends_otherwise }))
    }

    /// Whether its influences can be those of so many points.
    pub fn fits(&self, points: usize) -> bool {
        self.is_constant || points > 0 && self.indices.len().is_multiple_of(points)
    }

    /// Takes the skeleton's space to the world.
    pub fn world(&self, layer: &mut Layer, time: f64) -> Result<DMat4, Problem> {
        transform::world(layer, self.rig.skeleton, time)
    }

    /// Takes points of the prim into the skeleton's space as they were bound, or as joints have them at a time code, each the mean of
    /// where these take it.
    pub fn place(&self, layer: &mut Layer, points: &mut [Vec3], stance: Stance, time: f64) -> Result<(), Problem> {
        let moved = match stance {
            Stance::Bound => None,
            Stance::First => self.moves(layer, time)?,
        };
        let Some(moves) = moved else {
            points.iter_mut().for_each(|p| *p = self.geom_bind.transform_point3(p.as_dvec3()).as_vec3());
            return Ok(());
        };
        let each = self.indices.len() / if self.is_constant { 1 } else { points.len().max(1) };
        for (n, point) in points.iter_mut().enumerate() {
            let from = if self.is_constant { 0 } else { n * each };
            let at = point.as_dvec3();
            let influences = self.indices[from..from + each].iter().zip(&self.weights[from..from + each]);
            let placed = influences.filter(|&(_, &weight)| weight != 0.0);
            let placed = placed.map(|(&joint, &weight)| moves[&joint].transform_point3(at) * weight);
            *point = placed.sum::<DVec3>().as_vec3();
        }
        Ok(())
    }

    /// The joint of the rig that a number among the influences means; `None` where it means none at all.
    fn joint(&self, number: i64) -> Option<Option<usize>> {
        let number = usize::try_from(number).ok()?;
        match &self.joints {
            Some(joints) => joints.get(number).copied(),
            None => (number < self.rig.joints.len()).then_some(Some(number)),
        }
    }

    /// What each number among the influences does to a point at a time code. `None` where UsdSkel moves nothing: the
    /// skeleton does not say where joints were bound, or an influence is no joint.
    fn moves(&self, layer: &mut Layer, time: f64) -> Result<Option<HashMap<i64, DMat4>>, Problem> {
        let Some(bound) = self.rig.bound(layer)? else { return Ok(None) };
        let poses = self.rig.poses_of_all(layer, time)?;
        let takes = |joint: usize| poses[joint].map(|pose| pose * bound[joint].inverse());
        // Of thousands of joints a prim may hang on one.
        let mut moves = HashMap::new();
        for (&number, _) in self.indices.iter().zip(&self.weights).filter(|&(_, &weight)| weight != 0.0) {
            let Some(joint) = self.joint(number) else { return Ok(None) };
            let of = || joint.and_then(takes).unwrap_or(DMat4::IDENTITY) * self.geom_bind;
            moves.entry(number).or_insert_with(of);
        }
        Ok(Some(moves))
    }

    /// The sum of the weights of each joint of the rig.
    pub fn weight_of_joints(&self) -> Vec<f64> {
        let mut sums = vec![0.0; self.rig.joints.len()];
        for (&joint, &weight) in self.indices.iter().zip(&self.weights) {
            if let Some(Some(joint)) = self.joint(joint) {
                sums[joint] += weight;
            }
        }
        sums
    }

    /// What is said where it is not blended as it asks for. `path`: its prim's.
    pub fn unblended(&self, path: &str) -> Option<String> {
        let asked = self.blends_otherwise && self.bends();
        asked
            .then(|| format!("skel:skinningMethod of {path}: its joints are blended linearly, not as dual quaternions"))
    }

    /// Whether more than one joint has a part in it, which then bends it.
    pub fn bends(&self) -> bool {
        let mut sums: HashMap<usize, f64> = HashMap::new();
        for (&number, &weight) in self.indices.iter().zip(&self.weights) {
            if let Some(Some(joint)) = self.joint(number) {
                *sums.entry(joint).or_default() += weight;
            }
        }
        sums.values().filter(|&&weight| weight != 0.0).count() > 1
    }
}
