//! The pose in which the heads of a layer stand, and the joint that carries them.

use glam::Vec3;

use crate::Problem;
use crate::meshes;
use crate::read::StageReader;
use crate::skin::{Skin, Stance};
use crate::transform;

/// Roots, and prims of curves, that are looked at to see on which of two poses hair was groomed.
const MOST_ROOTS: usize = 64;
const MOST_PRIMS: usize = 16;

impl StageReader {
    /// The pose in which what is bound to skeletons stands.
    ///
    /// Hair that is bound, or that moves by itself, is that of the stage, and so is the head then. Hair that stands still was groomed
    /// either on the head of the first frame or on that which was bound: its roots lie on the skin there. Of hair that is not in
    /// the layer nothing is known but that it is mostly groomed on the head as it was bound.
    pub(crate) fn stance(&mut self) -> Result<Stance, Problem> {
        if self.stance.is_none() {
            self.stance = Some(self.find_stance()?);
        }
        Ok(self.stance.expect("found above"))
    }

    fn find_stance(&mut self) -> Result<Stance, Problem> {
        let mut heads = Vec::new();
        for prim in self.layer.with_points("Mesh") {
            if let Some(skin) = Skin::of(&mut self.layer, prim)? {
                heads.push((prim, skin));
            }
        }
        let curves: Vec<usize> =
            self.layer.of_type("BasisCurves").into_iter().filter(|&i| self.layer.has_points(i)).collect();
        for &prim in &curves {
            let moves = self.layer.prims[prim].attributes["points"].samples.len() > 1;
            if moves || Skin::of(&mut self.layer, prim)?.is_some() {
                return Ok(Stance::First);
            }
        }
        // What is not bound itself may be carried by a joint that a scene names, from where the skeleton was bound.
        if heads.is_empty() {
            return Ok(Stance::Bound);
        }
        if curves.is_empty() {
            let moves = heads.iter().any(|(_, skin)| skin.rig.is_animated());
            return Ok(if moves { Stance::Bound } else { Stance::First });
        }
        let roots = self.roots(&curves)?;
        let [mut bound, mut first] = [vec![f32::INFINITY; roots.len()], vec![f32::INFINITY; roots.len()]];
        for (prim, skin) in heads {
            for (stance, nearest) in [(Stance::Bound, &mut bound), (Stance::First, &mut first)] {
                let vertices = self.vertices(prim, &skin, stance)?;
                for (near, root) in nearest.iter_mut().zip(&roots) {
                    let here = vertices.iter().map(|v| v.distance_squared(*root)).fold(f32::INFINITY, f32::min);
                    *near = near.min(here);
                }
            }
        }
        let sum = |squares: &[f32]| squares.iter().map(|d| f64::from(d.sqrt())).sum::<f64>();
        // Where neither is nearer, by what rounding leaves, it is all one.
        Ok(if sum(&first) < 0.999 * sum(&bound) { Stance::First } else { Stance::Bound })
    }

    /// Some roots of curves, in the world.
    fn roots(&mut self, curves: &[usize]) -> Result<Vec<Vec3>, Problem> {
        let time = self.code_of(0)?;
        let mut roots = Vec::new();
        for &prim in curves.iter().step_by(curves.len().div_ceil(MOST_PRIMS)) {
            let points = self.layer.points_at(prim, "points", time)?.unwrap_or_default();
            let counts = self.layer.at(prim, "curveVertexCounts", time);
            let counts = counts.map(|counts| self.layer.integers(counts)).transpose()?.unwrap_or_default();
            let world = transform::world(&mut self.layer, prim, time)?;
            let starts =
                counts.iter().scan(0, |start, &count| Some(std::mem::replace(start, *start + count.max(0) as usize)));
            let own: Vec<&Vec3> = starts.map_while(|start| points.get(start)).collect();
            let chosen = own.iter().step_by(own.len().div_ceil(MOST_ROOTS).max(1));
            roots.extend(chosen.map(|root| world.transform_point3(root.as_dvec3()).as_vec3()));
        }
        let step = roots.len().div_ceil(MOST_ROOTS).max(1);
        Ok(roots.into_iter().step_by(step).collect())
    }

    /// The vertices of a mesh in a pose, in the world.
    fn vertices(&mut self, prim: usize, skin: &Skin, stance: Stance) -> Result<Vec<Vec3>, Problem> {
        let time = self.code_of(0)?;
        let mut points = self.layer.points_at(prim, "points", time)?.unwrap_or_default();
        if !skin.fits(points.len()) {
            return Ok(Vec::new());
        }
        skin.place(&mut self.layer, &mut points, stance, time)?;
        let world = skin.world(&mut self.layer, time)?.as_mat4();
        Ok(points.into_iter().map(|p| world.transform_point3(p)).collect())
    }

    /// The joint that carries the meshes whose path is `wanted`, by its path below that of its skeleton: one named `head` among those
    /// that hold them, or one with that in its name, or the one that holds most of them.
    pub(crate) fn carrying_joint(&mut self, wanted: &dyn Fn(&str) -> bool) -> Result<Option<String>, Problem> {
        let mut weights: Vec<(String, f64)> = Vec::new();
        for prim in meshes::chosen(&mut self.layer, wanted, Stance::First)?.prims {
            let Some(skin) = Skin::of(&mut self.layer, prim)? else { continue };
            let skeleton = self.layer.path(skin.rig.skeleton);
            let of_joints = skin.weight_of_joints();
            let all: f64 = of_joints.iter().sum();
            for (joint, weight) in skin.rig.joints.iter().zip(of_joints).filter(|&(_, weight)| weight > 0.0) {
                let path = format!("{skeleton}/{joint}");
                match weights.iter_mut().find(|(known, _)| *known == path) {
                    Some((_, sum)) => *sum += weight / all,
                    None => weights.push((path, weight / all)),
                }
            }
        }
        let likely = |path: &str| {
            let name = path.rsplit('/').next().unwrap_or_default().to_ascii_lowercase();
            // Rigs have their own name before that of the joint: `mixamorig_Head`.
            u8::from(name.contains("head")) + u8::from(name.ends_with("head")) + u8::from(name == "head")
        };
        let rank = |(path, weight): &(String, f64)| (likely(path), *weight);
        let best = weights.into_iter().max_by(|a, b| {
            let ((a, of_a), (b, of_b)) = (rank(a), rank(b));
            a.cmp(&b).then(of_a.total_cmp(&of_b))
        });
        Ok(best.map(|(path, _)| path))
    }
}
