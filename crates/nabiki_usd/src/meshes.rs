//! Which meshes of a layer make its head, and what is said of them.

use nabiki_exchange::{BOUND_SHAPE, Candidate, FIRST_SHAPE, kept_holes, those_that_show};

use crate::Problem;
use crate::blend::BlendShapes;
use crate::instances;
use crate::opened::Layer;
use crate::shown::hidden;
use crate::skin::{Skin, Stance};
use crate::transform;

/// The meshes that make a head.
pub struct Chosen {
    /// Their prims.
    pub prims: Vec<usize>,
    /// What is left out or not obeyed, a phrase each.
    pub unread: Vec<String>,
}

/// Of the meshes whose path is `wanted` those that show; all, where none does. `stance`: the pose of those that joints bend.
pub fn chosen(layer: &mut Layer, wanted: &dyn Fn(&str) -> bool, stance: Stance) -> Result<Chosen, Problem> {
    let mut all = Vec::new();
    for prim in layer.with_points("Mesh") {
        if wanted(&layer.path(prim)) {
            all.push(Candidate { mesh: prim, path: layer.path(prim), hidden: hidden(layer, prim)? });
        }
    }
    let (prims, mut unread) = those_that_show(all);
    unread.extend(layer.without_points("Mesh", "mesh"));
    unread.extend(instances::unread(layer, "Mesh", wanted));
    for &prim in &prims {
        let holes = layer.at(prim, "holeIndices", f64::NEG_INFINITY).map(|holes| layer.integers(holes)).transpose()?;
        unread.extend(kept_holes(&layer.path(prim), holes.map_or(0, |holes| holes.len())));
        unread.extend(bent(layer, prim, stance)?);
        if let Some(shapes) = BlendShapes::of(layer, prim)? {
            unread.extend(shapes.unread(layer));
        }
        unread.extend(transform::not_there(layer, prim)?);
    }
    unread.sort();
    unread.dedup();
    Ok(Chosen { prims, unread })
}

/// What bends a mesh over time, which a head or body does not.
fn bent(layer: &mut Layer, prim: usize, stance: Stance) -> Result<Vec<String>, Problem> {
    let path = layer.path(prim);
    if layer.prims[prim].attributes.get("points").is_some_and(|points| points.samples.len() > 1) {
        return Ok(vec![format!("the motion of the points of {path}: {FIRST_SHAPE}")]);
    }
    let shapes = BlendShapes::of(layer, prim)?.map(|_| format!("the blend shapes of {path}: {FIRST_SHAPE}"));
    let Some(skin) = Skin::of(layer, prim)? else {
        if shapes.is_some() {
            return Ok(shapes.into_iter().collect());
        }
        let bound = layer.prims[prim].related().find(|name| name.starts_with("skel:"));
        let line = |name| format!("{name} of {path}: it keeps the shape of its own points");
        return Ok(bound.map(line).into_iter().collect());
    };
    let unblended = skin.unblended(&path);
    let kept = match stance {
        Stance::First => FIRST_SHAPE,
        Stance::Bound => BOUND_SHAPE,
    };
    Ok(skin
        .bends()
        .then(|| format!("how joints bend {path}: {kept}"))
        .into_iter()
        .chain(unblended)
        .chain(shapes)
        .collect())
}
