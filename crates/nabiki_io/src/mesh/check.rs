//! What every reader of meshes refuses.

use nabiki::Mesh;

use crate::error::{Error, Result};
use crate::names::nearest;

/// Refuses what cannot be a mesh: NaN, infinities, no triangle. The readers have checked the indices.
pub(super) fn check(mesh: Mesh) -> Result<Mesh> {
    if let Some(v) = mesh.positions.iter().position(|p| !p.is_finite()) {
        let p = mesh.positions[v];
        let place = format!("({}, {}, {})", p.x, p.y, p.z);
        return Err(Error::new(format!("vertex {v}: {place} is not a place: coordinates must be finite")));
    }
    for (t, uvs) in mesh.corner_uvs.iter().flatten().enumerate() {
        if let Some(uv) = uvs.iter().find(|uv| !uv.is_finite()) {
            let line = format!("triangle {t}: its texture coordinates ({}, {}) must be finite", uv.x, uv.y);
            return Err(Error::new(line));
        }
    }
    if mesh.triangles.is_empty() {
        return Err(Error::new("holds no triangles"));
    }
    Ok(mesh)
}

/// Refuses a wanted group that the file has not.
pub(super) fn check_groups(wanted: &[String], known: &[&str]) -> Result<()> {
    for group in wanted {
        if !known.contains(&group.as_str()) {
            let hint = match nearest(group, known.iter().copied()) {
                Some(near) => format!("did you mean \"{near}\"?"),
                None => match known {
                    [] => "it has no named groups".to_owned(),
                    [first, ..] => format!("it has {} groups, the first \"{first:.80}\"", known.len()),
                },
            };
            return Err(Error::new(format!("group \"{group:.80}\" is not in the file; {hint}")));
        }
    }
    Ok(())
}
