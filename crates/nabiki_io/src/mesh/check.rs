//! What every reader of meshes refuses.

use nabiki::Mesh;

use crate::error::{Error, Result};
use crate::names::nearest;

/// Refuses what cannot be a mesh: places that are not finite, no triangle. The readers have checked the indices. Texture
/// coordinates that are not finite are left out, which joins what of these is `lost`.
pub(super) fn check(mut mesh: Mesh, lost: &mut Vec<String>) -> Result<Mesh> {
    if let Some(v) = mesh.positions.iter().position(|p| !p.is_finite()) {
        let p = mesh.positions[v];
        let place = format!("({}, {}, {})", p.x, p.y, p.z);
        return Err(Error::new(format!("vertex {v}: {place} is not a place: coordinates must be finite")));
    }
    let corners = mesh.corner_uvs.iter().flatten().enumerate();
    let odd = corners.flat_map(|(t, uvs)| uvs.map(|uv| (t, uv))).find(|(_, uv)| !uv.is_finite());
    if let Some((t, uv)) = odd {
        lost.push(format!("texture coordinates: those of triangle {t} are ({}, {}), which are not finite", uv.x, uv.y));
        mesh.corner_uvs = None;
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
