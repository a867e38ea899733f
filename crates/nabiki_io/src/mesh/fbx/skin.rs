//! Skins of FBX at rest: where the joints have the vertices in the pose to which they were bound.

use glam::{DAffine3, DVec3, Vec3};
use ufbx::SkinDeformer;

use crate::fbx_file::affine;
use crate::fbx_file::document::number;

/// The joints of a skin at rest.
pub(super) struct Skin<'a> {
    skin: &'a SkinDeformer,
    /// The number of each joint's node, and what takes a vertex to where it has it; none for a joint that the file lacks.
    joints: Vec<Option<(usize, DAffine3)>>,
}

/// Vertices where the joints have them.
pub(super) struct Bent {
    pub positions: Vec<Vec3>,
    /// The node of the joint that has the largest share of each.
    pub carriers: Vec<usize>,
    /// Whether the joints turn the surface inside out.
    pub mirrored: bool,
}

impl<'a> Skin<'a> {
    /// `rest`: takes each node's space to the scene's.
    pub fn new(skin: &'a SkinDeformer, rest: &[DAffine3]) -> Self {
        let joint = |cluster: &ufbx::SkinCluster| {
            let joint = number(cluster.bone_node.as_ref()?);
            Some((joint, rest[joint] * affine(&cluster.geometry_to_bone)))
        };
        Self { skin, joints: skin.clusters.as_ref().iter().map(|cluster| joint(cluster)).collect() }
    }

    /// Bends the vertices `own` of a mesh. `unbound`: where vertices without a joint are, and the node that carries them.
    pub fn bend(&self, own: &[DVec3], unbound: (DAffine3, usize)) -> Bent {
        let mut bent = Bent { positions: Vec::with_capacity(own.len()), carriers: Vec::new(), mirrored: false };
        let mut inside_out = 0_i64;
        for (v, &position) in own.iter().enumerate() {
            let weights = self.skin.vertices.as_ref().get(v).and_then(|vertex| {
                let first = vertex.weight_begin as usize;
                self.skin.weights.as_ref().get(first..first + vertex.num_weights as usize)
            });
            let (mut place, mut total) = (DVec3::ZERO, 0.0);
            let mut largest: Option<(f64, usize, DAffine3)> = None;
            for weight in weights.unwrap_or_default() {
                let Some((joint, scene_from_mesh)) = self.joints.get(weight.cluster_index as usize).copied().flatten()
                else {
                    continue;
                };
                place += weight.weight * scene_from_mesh.transform_point3(position);
                total += weight.weight;
                if largest.is_none_or(|(most, ..)| weight.weight > most) {
                    largest = Some((weight.weight, joint, scene_from_mesh));
                }
            }
            // Weights are to add up to 1. Those that do not are taken as shares.
            let (place, carrier, by) = match largest {
                Some((_, joint, by)) if total > 0.0 => (place / total, joint, by),
                _ => (unbound.0.transform_point3(position), unbound.1, unbound.0),
            };
            bent.positions.push(place.as_vec3());
            bent.carriers.push(carrier);
            inside_out += if by.matrix3.determinant() < 0.0 { 1 } else { -1 };
        }
        bent.mirrored = inside_out > 0;
        bent
    }
}
