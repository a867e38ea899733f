//! Parts of files whose meshes stand in a tree, as in USD and Alembic, by name.

use std::slice;

use super::check::check_groups;
use crate::error::Result;

/// Whether `group` names the mesh at the path `mesh`, or what it stands below: by name, or from the root down by a path that
/// begins with `/`.
pub(crate) fn is_part(group: &str, mesh: &str) -> bool {
    match group.starts_with('/') {
        true => paths(mesh).any(|path| path == group),
        false => names(mesh).any(|name| name == group),
    }
}

/// Whether a scene that keeps these groups, or everything if there are none, reads the mesh at the path `mesh`.
pub(crate) fn is_kept(groups: &[String], mesh: &str) -> bool {
    groups.is_empty() || groups.iter().any(|group| is_part(group, mesh))
}

/// Refuses groups that name none of the meshes at these paths.
pub(crate) fn check(groups: &[String], meshes: &[String]) -> Result<()> {
    for group in groups {
        let mut known: Vec<&str> = match group.starts_with('/') {
            true => meshes.iter().flat_map(|mesh| paths(mesh)).collect(),
            false => meshes.iter().flat_map(|mesh| names(mesh)).collect(),
        };
        known.sort_unstable();
        known.dedup();
        check_groups(slice::from_ref(group), &known)?;
    }
    Ok(())
}

/// Of `/a/b`: `a` and `b`.
fn names(path: &str) -> impl Iterator<Item = &str> {
    path.split('/').filter(|name| !name.is_empty())
}

/// Of `/a/b`: itself and `/a`.
fn paths(path: &str) -> impl Iterator<Item = &str> {
    std::iter::successors(Some(path), |path| path.rsplit_once('/').map(|(above, _)| above).filter(|a| !a.is_empty()))
}
