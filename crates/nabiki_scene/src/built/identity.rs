//! The identity of a scene, for motion caches.

use std::path::{Path, PathBuf};

use glam::Vec3;
use nabiki::aim::AimShape;
use nabiki::body::BodyWay;
use nabiki::dynamics::{Form, Motion};
use nabiki::free_form::FreeMotion;
use nabiki::pseudo_force::PseudoForce;
use nabiki::{Mesh, Pose};
use nabiki_io::cache::Piece;
use nabiki_io::identity::{Digest, SceneId, StrandSum};
use nabiki_io::skin;

use super::{BuiltScene, ShardOf};
use crate::error::{Error, Result};
use crate::scene::{FieldSettings, ForceSettings, HairSource};

impl BuiltScene {
    /// A hash of everything that determines how the hair moves, except the number of frames and the pictures. Two
    /// scenes that mean the same have the same identity, however they are written.
    ///
    /// # Errors
    /// If a file of the head's motion cannot be read again, or a program added its own field, which has no identity.
    pub fn identity(&self) -> Result<SceneId> {
        Ok(SceneId::of(self.settings_identity()?, self.strand_sum()))
    }

    /// What a cache of one shard records of the whole; `None` if all strands are built. `command`: the command that
    /// makes it, without shard and file.
    ///
    /// # Errors
    /// As [`identity`](Self::identity).
    pub(crate) fn piece(&self, reference: bool, command: &str) -> Result<Option<Piece>> {
        let Some(ShardOf { shard, strands, .. }) = self.groom.shard else { return Ok(None) };
        let (settings, groom) = (self.settings_identity()?, self.groom_identity()?);
        let (strands, command) = (strands as u64, command.to_owned());
        Ok(Some(Piece { shard, strands, settings, groom, sum: self.strand_sum(), reference, command }))
    }

    fn strand_sum(&self) -> StrandSum {
        let from = self.groom.shard.map_or(0, |ShardOf { shard, strands, .. }| shard.range(strands).start);
        let places = from..from + self.groom.hair.strands.len();
        StrandSum::of(self.strands(), places, self.dynamics.disturbance.as_ref().map(|_| self.groom.ids.as_slice()))
    }

    /// What the strands grow from, or the strands that identify an imported groom.
    fn groom_identity(&self) -> Result<SceneId> {
        let mut digest = Digest::new();
        match &self.scene.hair.source {
            HairSource::Grown(hair) => digest.settings("grown", hair)?,
            HairSource::Imported(hair) => digest.settings("imported", hair)?,
        }
        digest.settings("segment_length", &[self.scene.hair.segment_length])?;
        add_numbers(&mut digest, "head", bytemuck::cast_slice(&self.model.head.mesh.positions));
        let groom = self.groom.shard.map_or(StrandSum::default(), |shard| shard.groom);
        digest.bytes("groom", &groom.0.to_le_bytes());
        Ok(digest.finish())
    }

    /// Everything that moves the strands.
    fn settings_identity(&self) -> Result<SceneId> {
        if !self.scene.field.own.is_empty() {
            return Err(Error::refused(
                "a motion cache cannot record a field from a program: export to .usd, .usda, .usdc or .abc, or remove the \
                 field",
            ));
        }
        let mut digest = Digest::new();
        // The rate matters only for the poses of the head, which are hashed below.
        let motion = Motion { frames: 1, frame_rate: 24.0, ..self.dynamics.motion.clone() };
        digest.settings("motion", &motion)?;
        digest.settings("segment_length", &[self.dynamics.segment_length, self.dynamics.shell])?;
        digest.settings("ellipsoid", &self.dynamics.ellipsoid)?;
        digest.settings("pseudo_force", &self.dynamics.weakening().cloned().unwrap_or_else(PseudoForce::off))?;
        let force = self.forces.intervals();
        digest.settings("force", &force)?;
        if !self.scene.field.is_the_papers() {
            let force = force.iter().copied().map(ForceSettings::from).collect();
            digest.settings("fields", &FieldSettings { force, ..self.scene.field.clone() })?;
            // Gusts and the head's velocity are per second.
            digest.settings("frame_rate", &[self.dynamics.motion.frame_rate])?;
        }
        if let Some(disturbance) = &self.dynamics.disturbance {
            digest.settings("disturbance", disturbance)?;
        }
        if let Form::Free(free) = &self.dynamics.form {
            self.add_free(&mut digest, free)?;
        }
        for frame in 0..self.way.poses.len() {
            add_pose(&mut digest, &self.way.poses[frame]);
        }
        if let Some(file) = self.bent_head.file() {
            add_skin(&mut digest, &file, &self.bent_head.frames)?;
            add_mesh(&mut digest, &self.model.head.mesh);
        }
        Ok(digest.finish())
    }

    /// The additional inputs of the free form. A body is identified by its distance samples, neighbours by their
    /// carriers.
    fn add_free(&self, digest: &mut Digest, free: &FreeMotion) -> Result<()> {
        // What a region is called changes nothing.
        let mut form = free.form.clone();
        form.regions.iter_mut().for_each(|region| {
            region.name.clear();
            // What a map selects is added below.
            region.map = region.map.as_ref().map(|_| PathBuf::new());
        });
        digest.settings("free", &form)?;
        if self.groom.imported.is_some() {
            for members in free.members.iter().flatten() {
                add_numbers(digest, "members", &members.numbers().collect::<Vec<_>>());
            }
        } else {
            // Groups of grown hair follow from its settings, and only some members are known.
            self.groom.maps().for_each(|map| digest.bytes("map", &map.bytes()));
            if self.groom.maps().next().is_some() {
                let uvs = self.model.head.mesh.corner_uvs.as_deref().unwrap_or_default();
                add_numbers(digest, "uvs", bytemuck::cast_slice(uvs.as_flattened()));
            }
            // It has no attributes of its own: those are of the head's mesh.
            let mesh = &self.model.head.mesh;
            for weights in self.groom.attributes().filter_map(|name| mesh.weights_named(name)) {
                add_mesh(digest, mesh);
                add_numbers(digest, "weights", &weights.values);
            }
        }
        // Accelerations are per second.
        digest.settings("frame_rate", &[self.dynamics.motion.frame_rate])?;
        let mut solid = self.bodies.iter().zip(&self.scene.bodies).filter(|(_, settings)| settings.solid);
        for (i, body) in free.bodies.iter().enumerate() {
            digest.settings("contact", &body.contact)?;
            let built = if i > 0 { solid.next().map(|(built, _)| built) } else { None };
            match built.and_then(|built| Some((built.file.as_deref()?, &built.frames))).filter(|(_, of)| !of.is_empty())
            {
                Some((file, frames)) => {
                    add_skin(digest, file, frames)?;
                    built.into_iter().for_each(|built| add_mesh(digest, &built.mesh));
                }
                // The head's skin is added above.
                None if i == 0 && self.bent_head.file().is_some() => {}
                None => body.shape.obstacle().identify(&mut |numbers| add_numbers(digest, "distance", numbers)),
            }
            if let BodyWay::InWorld(poses) = &body.way {
                poses.iter().for_each(|pose| add_pose(digest, pose));
            }
        }
        for aim in &free.aims {
            digest.settings("aim", &aim.lead)?;
            digest.settings("region", &[aim.region.map_or(-1.0, |region| region as f64)])?;
            match &aim.shape {
                AimShape::Groom => digest.bytes("groom", &[]),
                AimShape::Toward(point) => add_numbers(digest, "toward", &point.to_array()),
                AimShape::Curves(curves) => {
                    digest.settings("posed", &[curves.frame().map_or(-1.0, f64::from)])?;
                    add_numbers(digest, "curves", bytemuck::cast_slice(curves.curves().points()));
                    digest.bytes("starts", bytemuck::cast_slice(&little_endian(curves.curves().starts())));
                }
            }
        }
        if let Some(neighbours) = &free.neighbours {
            digest.settings("neighbours", &neighbours.forces)?;
            add_numbers(digest, "carriers", bytemuck::cast_slice(neighbours.carriers.points()));
        }
        Ok(())
    }
}

fn add_pose(digest: &mut Digest, pose: &Pose) {
    let numbers = [pose.position_cm.to_array().as_slice(), pose.rotation.to_array().as_slice()].concat();
    add_numbers(digest, "pose", &numbers);
}

/// What bends, however many of its frames are wanted: its file, and the first of them, which depend on how it is read.
fn add_skin(digest: &mut Digest, file: &Path, frames: &[Vec<Vec3>]) -> Result<()> {
    skin::each_part(file, &mut |bytes| digest.bytes("skin", bytes))?;
    for frame in frames.iter().take(2) {
        add_numbers(digest, "skin", bytemuck::cast_slice(frame));
    }
    Ok(())
}

/// A mesh at rest, whose file may be another than that of its motion.
fn add_mesh(digest: &mut Digest, mesh: &Mesh) {
    add_numbers(digest, "rest", bytemuck::cast_slice(&mesh.positions));
    digest.bytes("triangles", bytemuck::cast_slice(&little_endian(mesh.triangles.as_flattened())));
}

fn add_numbers(digest: &mut Digest, name: &str, numbers: &[f32]) {
    let bits: Vec<u32> = numbers.iter().map(|x| x.to_bits()).collect();
    digest.bytes(name, bytemuck::cast_slice(&little_endian(&bits)));
}

fn little_endian(values: &[u32]) -> Vec<u32> {
    values.iter().map(|value| value.to_le()).collect()
}
