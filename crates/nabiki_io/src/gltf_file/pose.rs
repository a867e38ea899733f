//! Where the nodes of a glTF are in its still pose, the one that it has without its animations.

use glam::{DAffine3, DMat3, DVec3};
use gltf::{Document, Node};

use crate::error::{Error, Result};

/// The node above each; none above a root.
///
/// # Errors
/// A node below two others.
pub(crate) fn parents(document: &Document) -> Result<Vec<Option<usize>>> {
    let mut parents = vec![None; document.nodes().len()];
    for node in document.nodes() {
        for child in node.children() {
            if parents[child.index()].replace(node.index()).is_some() {
                return Err(Error::new(format!("node {} has two parents", child.index())));
            }
        }
    }
    Ok(parents)
}

/// Takes each node's space to the scene's; `None` for what hangs below itself. Some nodes are moved from where they are in the file to
/// where `moved` has them below the node above.
///
/// # Errors
/// A node below two others.
pub(crate) fn pose(document: &Document, moved: &dyn Fn(&Node) -> Option<DAffine3>) -> Result<Vec<Option<DAffine3>>> {
    let parents = parents(document)?;
    let mut pose = vec![None; parents.len()];
    let roots = document.nodes().filter(|node| parents[node.index()].is_none());
    let mut open: Vec<_> = roots.map(|root| (root, DAffine3::IDENTITY)).collect();
    while let Some((node, scene_from_parent)) = open.pop() {
        let scene_from_node = scene_from_parent * moved(&node).unwrap_or_else(|| transform(node.transform().matrix()));
        pose[node.index()] = Some(scene_from_node);
        open.extend(node.children().map(|child| (child, scene_from_node)));
    }
    Ok(pose)
}

/// The transform of a matrix, by its columns.
pub(crate) fn transform(columns: [[f32; 4]; 4]) -> DAffine3 {
    let [x, y, z, translation] = columns.map(|[a, b, c, _]| DVec3::new(a.into(), b.into(), c.into()));
    DAffine3 { matrix3: DMat3::from_cols(x, y, z), translation }
}
