//! Skins of glTF: vertices go where the joints have them, whatever node their mesh hangs below (glTF 2.0, section 3.7.3.3).

use glam::{DAffine3, DVec3, Vec3};
use gltf::{Primitive, Semantic};

use crate::error::{Error, Result};
use crate::gltf_file::Buffers;
use crate::gltf_file::accessors::{Whole, numbers, transforms, whole_numbers};

/// The joints of a skin in the still pose.
pub(super) struct Skin {
    /// Their nodes.
    joints: Vec<usize>,
    /// Takes a vertex to where each has it.
    scene_from_mesh: Vec<DAffine3>,
}

/// Vertices where the joints have them.
pub(super) struct Bent {
    pub positions: Vec<Vec3>,
    /// The node of the joint that has the largest share of each.
    pub carriers: Vec<usize>,
    /// Whether the joints turn the surface inside out.
    pub mirrored: bool,
}

impl Skin {
    /// `pose`: takes each node's space to the scene's.
    pub fn new(skin: &gltf::Skin, pose: &[Option<DAffine3>], buffers: &Buffers<'_>) -> Result<Self> {
        let joints: Vec<usize> = skin.joints().map(|joint| joint.index()).collect();
        let binds = match skin.inverse_bind_matrices() {
            Some(accessor) => transforms(&accessor, buffers, "inverse bind matrices")?,
            None => vec![DAffine3::IDENTITY; joints.len()],
        };
        if binds.len() < joints.len() {
            let (binds, joints, skin) = (binds.len(), joints.len(), skin.index());
            return Err(Error::new(format!("skin {skin}: {binds} inverse bind matrices for {joints} joints")));
        }
        let bound = joints.iter().zip(&binds).map(|(&joint, bind)| {
            let scene_from_joint =
                pose[joint].ok_or_else(|| Error::new(format!("node {joint} is its own ancestor")))?;
            Ok(scene_from_joint * *bind)
        });
        let scene_from_mesh = bound.collect::<Result<Vec<_>>>()?;
        Ok(Self { joints, scene_from_mesh })
    }

    /// Bends vertices of `positions` by the joints and weights of their primitive; `None` where it has none.
    pub fn bend(&self, primitive: &Primitive, positions: &[Vec3], buffers: &Buffers<'_>) -> Result<Option<Bent>> {
        let mut joints: Vec<Vec<[u32; 4]>> = Vec::new();
        let mut weights: Vec<Vec<[f32; 4]>> = Vec::new();
        for set in 0.. {
            let found = primitive.get(&Semantic::Joints(set)).zip(primitive.get(&Semantic::Weights(set)));
            let Some((of_joints, of_weights)) = found else { break };
            joints.push(whole_numbers(&of_joints, buffers, "joints")?);
            weights.push(numbers(&of_weights, buffers, Whole::Shares, "weights")?);
            let (count, vertices) = (joints[set as usize].len().min(weights[set as usize].len()), positions.len());
            if count < vertices {
                return Err(Error::new(format!("joints and weights for {count} vertices instead of {vertices}")));
            }
        }
        if joints.is_empty() || self.joints.is_empty() {
            return Ok(None);
        }
        let mut bent = Bent { positions: Vec::with_capacity(positions.len()), carriers: Vec::new(), mirrored: false };
        let mut inside_out = 0_i64;
        for (v, position) in positions.iter().enumerate() {
            let sets = joints.iter().zip(&weights);
            let all =
                sets.flat_map(|(joints, weights)| joints[v].into_iter().zip(weights[v])).filter(|&(_, w)| w != 0.0);
            let (mut place, mut total, mut largest) = (DVec3::ZERO, 0.0, (0.0, 0));
            for (joint, weight) in all {
                let weight = f64::from(weight);
                let scene_from_mesh = self.scene_from_mesh.get(joint as usize).ok_or_else(|| {
                    let known = self.joints.len();
                    Error::new(format!("vertex {v} is bound to joint {joint}, but its skin has {known}"))
                })?;
                place += weight * scene_from_mesh.transform_point3(position.as_dvec3());
                total += weight;
                if weight > largest.0 {
                    largest = (weight, joint as usize);
                }
            }
            // Weights are to add up to 1. Those that add up to nothing leave the vertex to the first joint, as other programs do.
            let place = match total {
                0.0 => self.scene_from_mesh[0].transform_point3(position.as_dvec3()),
                total => place / total,
            };
            bent.positions.push(place.as_vec3());
            bent.carriers.push(self.joints[largest.1]);
            let turns = self.scene_from_mesh[largest.1].matrix3.determinant() < 0.0;
            inside_out += if turns { 1 } else { -1 };
        }
        bent.mirrored = inside_out > 0;
        Ok(Some(bent))
    }
}
