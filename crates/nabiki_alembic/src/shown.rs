//! Visibility, which comes down from the objects above.

use std::io::{Read, Seek};

use nabiki_exchange::Hidden;

use crate::Problem;
use crate::layout::Pod;
use crate::tree::{PropertyKind, Tree};
use crate::values::integers;

/// What an object's `visible` says at a time: 0 hides it, above 0 it shows, and below it is as those above have it.
const HIDDEN: i64 = 0;

/// What keeps an object out of a final picture; nothing for one that shows. As Alembic has it, the nearest object that says
/// either has it for all below.
pub fn hidden<R: Read + Seek>(tree: &mut Tree<R>, object: usize) -> Result<Vec<Hidden>, Problem> {
    let mut found = Vec::new();
    let mut above = Some(object);
    while let Some(i) = above {
        let said = visible(tree, i)?;
        if said.contains(&HIDDEN) {
            let at_times = said.iter().any(|&value| value != HIDDEN);
            let (by, value) = (tree.path(i), "hidden".to_owned());
            tree.budget().take(by.len() as u64, "paths of objects")?;
            found.push(Hidden { by, name: "visibility", value, at_times });
        }
        if !said.is_empty() && said.iter().all(|&value| value >= HIDDEN) {
            break;
        }
        above = tree.objects[i].parent;
    }
    Ok(found)
}

/// What an object itself says over time, each value once.
fn visible<R: Read + Seek>(tree: &mut Tree<R>, object: usize) -> Result<Vec<i64>, Problem> {
    if let Some(known) = tree.visible.get(&object) {
        return Ok(known.clone());
    }
    let found = read_visible(tree, object)?;
    tree.visible.insert(object, found.clone());
    Ok(found)
}

fn read_visible<R: Read + Seek>(tree: &mut Tree<R>, object: usize) -> Result<Vec<i64>, Problem> {
    let properties = tree.properties_of(object)?;
    let is_number = |pod: Pod| !matches!(pod, Pod::Text | Pod::WideText);
    let found =
        properties.iter().find(|h| &*h.name == "visible" && h.form == PropertyKind::Scalar && is_number(h.kind.pod));
    let Some(header) = found else { return Ok(Vec::new()) };
    let mut said = Vec::new();
    for sample in 0..header.different_samples() {
        let value = integers(header.kind, &tree.sample(header, sample)?)?.first().map(|value| value.signum());
        said.extend(value.filter(|value| !said.contains(value)));
        if said.len() == 3 {
            break;
        }
    }
    Ok(said)
}
