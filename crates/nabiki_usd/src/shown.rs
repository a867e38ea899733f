//! Visibility and purpose, which come down from the prims above.

use nabiki_exchange::Hidden;

use crate::Problem;
use crate::opened::Layer;
use crate::source::{BLOCKED, Handle};

/// What keeps a prim out of a final picture; nothing for one that shows.
pub fn hidden(layer: &mut Layer, prim: usize) -> Result<Vec<Hidden>, Problem> {
    // A prim without a type has neither in USD.
    let upward: Vec<usize> = layer.upward(prim).filter(|&i| !layer.prims[i].type_name.is_empty()).collect();
    let mut found = Vec::new();
    for &i in &upward {
        if let Some(at_times) = invisible(layer, i)? {
            layer.budget.take(layer.standing[i].path_bytes.into(), "paths of prims")?;
            found.push(Hidden { by: layer.path(i), name: "visibility", value: "invisible".to_owned(), at_times });
        }
    }
    for &i in &upward {
        let Some(value) = layer.word(i, "purpose")? else { continue };
        // The nearest that says one has it for all below.
        if matches!(value.as_str(), "guide" | "proxy") {
            found.push(Hidden { by: layer.path(i), name: "purpose", value, at_times: false });
        }
        break;
    }
    Ok(found)
}

/// Whether a prim is itself invisible: `Some(true)` at some of its time codes, `Some(false)` at all.
fn invisible(layer: &mut Layer, prim: usize) -> Result<Option<bool>, Problem> {
    if let Some(&known) = layer.invisible.get(&prim) {
        return Ok(known);
    }
    let found = read_invisible(layer, prim)?;
    layer.invisible.insert(prim, found);
    Ok(found)
}

fn read_invisible(layer: &mut Layer, prim: usize) -> Result<Option<bool>, Problem> {
    let Some(attribute) = layer.prims[prim].attributes.get("visibility") else { return Ok(None) };
    let values: Vec<Handle> = match &attribute.samples[..] {
        [] => attribute.default.into_iter().collect(),
        samples => samples.iter().map(|&(_, value)| value).collect(),
    };
    let (mut seen, mut unseen) = (false, false);
    // What is blocked is inherited.
    for value in values.into_iter().filter(|&value| value != BLOCKED) {
        match layer.words(value)?.first().map(String::as_str) {
            Some("invisible") => unseen = true,
            _ => seen = true,
        }
        if seen && unseen {
            break;
        }
    }
    Ok(unseen.then_some(seen))
}
