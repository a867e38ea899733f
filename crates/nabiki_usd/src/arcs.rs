//! Composition arcs, by which a layer takes content from elsewhere: they are not followed, which is said.

use crate::Problem;
use crate::opened::Layer;

/// How to have them followed.
const FLATTEN: &str = "flatten it first (usdcat --flatten IN -o OUT)";

/// The same where prims share what comes to them: flattening makes prototypes of it, which are on no stage by themselves.
const FLATTEN_INSTANCES: &str = "turn off instanceable on its prims, then flatten it (usdcat --flatten IN -o OUT)";

/// How to have the arcs of a layer followed.
pub fn way_out(layer: &Layer) -> &'static str {
    if has_instances(layer) { FLATTEN_INSTANCES } else { FLATTEN }
}

/// Whether prims share what comes to them by arcs.
pub fn has_instances(layer: &Layer) -> bool {
    let instances = |&prim: &usize| layer.prims[prim].is_instance && !layer.prims[prim].arcs.is_empty();
    (0..layer.prims.len()).filter(instances).any(|prim| layer.is_active(prim))
}

/// What comes to the stage by arcs, as a phrase.
pub fn unread(layer: &mut Layer) -> Result<Option<String>, Problem> {
    let mut first = layer.has_sublayers()?.then(|| "subLayers of the layer".to_owned());
    let mut count = usize::from(first.is_some());
    for prim in (0..layer.prims.len()).filter(|&prim| layer.is_active(prim)) {
        for arc in &layer.prims[prim].arcs {
            count += 1;
            first.get_or_insert_with(|| format!("{arc} of {}", layer.path(prim)));
        }
    }
    let Some(first) = first else { return Ok(None) };
    let more = match count - 1 {
        0 => String::new(),
        more => format!(", and by {more} more of its arcs"),
    };
    Ok(Some(format!("what comes by {first}{more}: {}", way_out(layer))))
}
