//! Meshes of an archive: which make a head, their polygons, and what is said of them.

use std::io::{Read, Seek};

use glam::{Affine3A, Vec3};
use nabiki::Mesh;
use nabiki_exchange::{Candidate, Canvas, FIRST_SHAPE, Polygons, add_polygons, kept_holes, those_that_show};

use crate::Problem;
use crate::attributes::Parameters;
use crate::read::{ArchiveReader, go_toward, required};
use crate::schemas::{NURBS_SURFACE, READ, is_mesh};
use crate::shown::hidden;
use crate::tree::Header;
use crate::values::integers;

/// The meshes that make a head.
pub struct Chosen {
    /// Their objects.
    pub objects: Vec<usize>,
    /// What is left out or not obeyed, a phrase each.
    pub unread: Vec<String>,
}

impl<R: Read + Seek> ArchiveReader<R> {
    /// All meshes.
    pub(crate) fn all_meshes(&self) -> Vec<usize> {
        (0..self.tree.objects.len()).filter(|&i| is_mesh(&self.tree.objects[i])).collect()
    }

    /// Of the meshes whose path is `wanted` those that show; all, where none does.
    pub(crate) fn chosen_meshes(&mut self, wanted: &dyn Fn(&str) -> bool) -> Result<Chosen, Problem> {
        let mut all = Vec::new();
        for mesh in self.all_meshes() {
            let path = self.tree.path(mesh);
            if wanted(&path) {
                all.push(Candidate { mesh, path, hidden: hidden(&mut self.tree, mesh)? });
            }
        }
        let (objects, mut unread) = those_that_show(all);
        for &object in &objects {
            let path = self.tree.path(object);
            let inside = self.schema(object)?;
            if required(&inside, "P", &path)?.different_samples() > 1 {
                unread.push(format!("the motion of the points of {path}: {FIRST_SHAPE}"));
            }
            unread.extend(kept_holes(&path, self.count(inside.iter().find(|h| &*h.name == ".holes"))?));
        }
        unread.extend(self.left_out(NURBS_SURFACE, wanted).unread(READ));
        unread.sort();
        unread.dedup();
        Ok(Chosen { objects, unread })
    }

    /// The times (s) at which the points of the chosen meshes move, growing.
    pub(crate) fn times_of_points(&mut self, wanted: &dyn Fn(&str) -> bool) -> Result<Vec<f64>, Problem> {
        let mut times = Vec::new();
        for object in self.chosen_meshes(wanted)?.objects {
            let (path, inside) = (self.tree.path(object), self.schema(object)?);
            let header = required(&inside, "P", &path)?;
            if header.different_samples() > 1 {
                let timing = &self.tree.timings[header.timing];
                times.extend((0..header.samples).map(|n| timing.time(n)));
            }
        }
        times.sort_by(f64::total_cmp);
        times.dedup();
        Ok(times)
    }

    /// The vertices of the chosen meshes at a time (s), in the world.
    pub(crate) fn vertices_at(&mut self, wanted: &dyn Fn(&str) -> bool, time: f64) -> Result<Vec<Vec3>, Problem> {
        let mut all = Vec::new();
        for object in self.chosen_meshes(wanted)?.objects {
            let (path, inside) = (self.tree.path(object), self.schema(object)?);
            let world = Affine3A::from_mat4(self.world(object, time)?.as_mat4());
            let positions = self.positions(required(&inside, "P", &path)?, time)?;
            all.extend(positions.into_iter().map(|p| world.transform_point3(p)));
        }
        Ok(all)
    }

    /// Points at a time (s), on the way from one sample to the next.
    fn positions(&mut self, header: &Header, time: f64) -> Result<Vec<Vec3>, Problem> {
        let (frame, share) = self.tree.timings[header.timing].at(time, header.samples);
        let mut positions = self.tree.points(header, frame)?;
        if share > 0.0 {
            let next = self.tree.points(header, frame + 1)?;
            if next.len() == positions.len() {
                go_toward(&mut positions, &next, share);
            }
        }
        Ok(positions)
    }

    /// Appends the polygons of an object as they are at `time` (s), with their weights and colours; the answer says what of these and
    /// of the texture coordinates is left out, a phrase each.
    pub(crate) fn add_mesh(&mut self, mesh: &mut Mesh, object: usize, time: f64) -> Result<Vec<String>, Problem> {
        let path = self.tree.path(object);
        let inside = self.schema(object)?;
        let world = Affine3A::from_mat4(self.world(object, time)?.as_mat4());
        let header = required(&inside, "P", &path)?;
        let (frame, _) = self.tree.timings[header.timing].at(time, header.samples);
        let positions = self.positions(header, time)?;
        let mut numbers = |name: &str| -> Result<Vec<i64>, Problem> {
            let header: &Header = required(&inside, name, &path)?;
            let (sample, _) = self.tree.timings[header.timing].at(time, header.samples);
            integers(header.kind, &self.tree.sample(header, sample)?)
        };
        let (counts, corners) = (numbers(".faceCounts")?, numbers(".faceIndices")?);
        let mut parameters = Parameters::of(&mut self.tree, inside, frame)?;
        let (uvs, none) = match parameters.texture_coordinates()? {
            Ok(uvs) => (uvs, None),
            Err(why) => (None, Some(why)),
        };
        let (painted, unpainted) = parameters.painted(&path, Canvas { vertices: positions.len(), corners: &corners });
        // Alembic winds faces clockwise.
        let polygons = Polygons { positions: &positions, counts: &counts, corners: &corners, clockwise: true, uvs };
        let first = mesh.positions.len();
        let misfit = add_polygons(mesh, polygons, &world).map_err(|e| Problem(format!("mesh {path}: {e}")))?;
        let mut left_out: Vec<String> =
            none.or(misfit).map(|why| format!("texture coordinates of {path}: {why}")).into_iter().collect();
        left_out.extend(unpainted);
        for painted in painted {
            let added = painted.add_to(mesh, first, self.tree.budget());
            left_out.extend(added.err().map(|why| format!("{} of {path}: {why}", painted.name)));
        }
        Ok(left_out)
    }
}
