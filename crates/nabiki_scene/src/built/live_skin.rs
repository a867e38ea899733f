//! The skin of a head that a program bends from step to step.

use std::sync::Arc;

use glam::{Affine3A, Vec3};
use nabiki::dynamics::{Dynamics, Simulation};
use nabiki::strands::not_finite;
use nabiki::{SettingError, Skin};
use nabiki_io::mesh::Welded;

use super::BuiltScene;
use super::model::Model;
use super::skin::under_hair;
use crate::error::Result;

/// How the vertices of a mesh file become those of the head.
#[derive(Debug)]
pub(super) struct FileVertices {
    /// Those that are left.
    pub welded: Welded,
    /// As the file was read.
    pub head_from_file: Affine3A,
    /// What moved into the origin after that. Both steps stay apart: a mesh at rest then has the bits of the head.
    pub center: Vec3,
}

/// The skin of a scene's head for a program that bends it from step to step.
#[derive(Clone, Debug)]
pub struct LiveSkin {
    skin: Arc<Skin>,
    model: Arc<Model>,
}

impl LiveSkin {
    /// The part that carries the hair: as it bends in the scene, or else at rest.
    pub fn skin(&self) -> &Arc<Skin> {
        &self.skin
    }

    /// The vertices of `head.mesh`, in its order, unit and axes, as those of the head's mesh (head space, cm):
    /// [`Skin::frame`] takes them.
    ///
    /// # Errors
    /// Another number of vertices than the mesh has, and a vertex that is not finite or does not stay so.
    pub fn placed(&self, vertices: &[Vec3]) -> Result<Vec<Vec3>, SettingError> {
        let refused = |value: String, remedy: String| Err(SettingError::new("skin", value, remedy));
        let of_file = self.model.vertices.as_ref().expect("a live skin is of a mesh file");
        let FileVertices { welded: Welded { vertices: count, kept }, head_from_file, center } = of_file;
        if vertices.len() != *count {
            let remedy = format!("head.mesh has {count}: give all of them, in its order");
            return refused(format!("{} vertices", vertices.len()), remedy);
        }
        if let Some(v) = not_finite(vertices) {
            return refused(format!("{} at {v}", vertices[v]), "every vertex must be finite".to_owned());
        }
        let there = kept.iter().map(|&v| head_from_file.transform_point3(vertices[v as usize]) - *center);
        let there: Vec<Vec3> = there.collect();
        match not_finite(&there) {
            None => Ok(there),
            Some(v) => {
                let v = kept[v] as usize;
                let remedy = "leaves the range of f32 when converted to cm: check head.unit";
                refused(format!("{} at {v}", vertices[v]), remedy.to_owned())
            }
        }
    }
}

impl BuiltScene {
    /// The head's skin, to be bent from step to step.
    ///
    /// # Errors
    /// The built-in head, and a mesh without a triangle that has an area.
    pub fn live_skin(&self) -> Result<LiveSkin> {
        if self.model.vertices.is_none() {
            let remedy = "keeps its shape: to give a skin, set head.mesh to your own mesh";
            return Err(self.scene.refusal(SettingError::new("head.mesh", "\"builtin:bust\"", remedy)).into());
        }
        let skin = match &self.dynamics.skin {
            Some(skin) => skin.clone(),
            None => {
                let skin = under_hair(&self.model.head.mesh, &self.groom);
                Arc::new(skin.map_err(|refused| self.refusal(refused))?)
            }
        };
        Ok(LiveSkin { skin, model: self.model.clone() })
    }

    /// Like [`simulation`](Self::simulation), with roots that ride on a skin from [`live_skin`](Self::live_skin).
    ///
    /// # Errors
    /// As for [`simulation`](Self::simulation).
    pub fn simulation_on(&self, skin: &LiveSkin) -> Result<Simulation> {
        self.moved_by(&Dynamics { skin: Some(skin.skin.clone()), ..self.dynamics.clone() })
    }
}
