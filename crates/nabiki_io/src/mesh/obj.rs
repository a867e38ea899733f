//! Wavefront .obj by way of the crate tobj.

use glam::Vec3;
use nabiki::Mesh;

use super::{check, check_groups};
use crate::error::{Error, Result};

pub(super) fn from_bytes(mut bytes: &[u8], groups: &[String]) -> Result<Mesh> {
    let options =
        tobj::LoadOptions { triangulate: true, ignore_points: true, ignore_lines: true, ..Default::default() };
    // Materials are nothing to a head of one skin.
    let (models, _) = tobj::load_obj_buf(&mut bytes, &options, |_| Err(tobj::LoadError::GenericFailure))
        .map_err(|e| Error::new(format!("is not a readable .obj: {e}")))?;
    let names: Vec<&str> = models.iter().map(|model| model.name.as_str()).collect();
    check_groups(groups, &names)?;
    let mut mesh = Mesh::default();
    for model in models.iter().filter(|m| groups.is_empty() || groups.contains(&m.name)) {
        let first = mesh.positions.len() as u32;
        mesh.positions.extend(model.mesh.positions.chunks_exact(3).map(Vec3::from_slice));
        mesh.triangles.extend(model.mesh.indices.chunks_exact(3).map(|t| [first + t[0], first + t[1], first + t[2]]));
    }
    check(mesh)
}
