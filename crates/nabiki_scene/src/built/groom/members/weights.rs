//! How much strands belong to a region by an attribute of the hair, or by weights on the vertices of the head's mesh.

use glam::Vec3;
use nabiki::distance::Surface;
use nabiki::hair::{Other, Per, Values};
use nabiki::mesh::VertexWeights;
use nabiki::{Hair, Head, SettingError};

use super::{Refusable, listed};

/// The weight at each root by the attribute of this name, of the hair or else of the head's mesh: its number, or whether that is
/// one of `chosen`, if there are any.
pub(super) fn at_roots(key: &str, hair: &Hair, head: &Head, name: &str, chosen: &[i32]) -> Refusable<Vec<f64>> {
    let refused = |why: String| Err(SettingError::new(key, format!("{name:?}"), why));
    let of_hair = hair.attributes.other.iter().find(|other| other.name == name);
    let of_head = head.mesh.weights_named(name).filter(|_| of_hair.is_none());
    let values = match (of_hair, of_head) {
        (Some(found), _) => match hair_values(hair, found) {
            Ok(values) => values,
            Err(has) => return refused(format!("has {has}, but a weight is one number per strand or point")),
        },
        (None, Some(found)) => skin_values(hair, head, found, chosen.is_empty()),
        (None, None) => return refused(not_there(hair, head, name)),
    };
    if !chosen.is_empty() {
        let belongs = |value: &f64| chosen.iter().any(|&of| f64::from(of) == *value);
        return Ok(values.iter().map(|value| f64::from(u8::from(belongs(value)))).collect());
    }
    match values.iter().enumerate().find(|(_, value)| !(0.0..=1.0).contains(*value)) {
        Some((s, value)) => {
            let (value, count) = (*value as f32, values.len());
            let [of, file] = if of_head.is_some() { [" on the head's mesh", "its file"] } else { ["", "the file"] };
            refused(format!(
                "is {value}{of} at the root of strand {s} of {count}, but must be 0 to 1: correct it in {file}"
            ))
        }
        None => Ok(values),
    }
}

/// The number of an attribute at each root, or what it has instead of numbers.
fn hair_values(hair: &Hair, found: &Other) -> Result<Vec<f64>, String> {
    if !is_weight(found) {
        return Err(match (&found.values, found.per, found.extent) {
            (Values::Words(_), ..) => "words".to_owned(),
            (_, Per::Groom, _) => "one value for all the hair".to_owned(),
            (.., extent) => format!("{extent} numbers each"),
        });
    }
    let at = |i: usize| match &found.values {
        Values::Floats(values) => f64::from(values[i]),
        Values::Doubles(values) => values[i],
        Values::Integers(values) => values[i] as f64,
        Values::Words(_) => f64::NAN,
    };
    let index = |s: usize| if found.per == Per::Point { hair.strands.range(s).start } else { s };
    Ok((0..hair.strands.len()).map(|s| at(index(s))).collect())
}

/// The weight of the skin at each root: the mean of the corners of the triangle there, or, where numbers are not to be mixed, that
/// of the nearest one.
fn skin_values(hair: &Hair, head: &Head, weights: &VertexWeights, mixed: bool) -> Vec<f64> {
    // A head has triangles.
    let Some(skin) = Surface::new(&head.mesh) else { return vec![0.0; hair.strands.len()] };
    let at = |strand: &[Vec3]| {
        let (triangle, shares) = skin.nearest(strand[0]);
        let corners = head.mesh.triangles[triangle];
        if mixed { weights.within(corners, shares) } else { weights.nearest(corners, shares) }
    };
    hair.strands.iter().map(at).collect()
}

/// Why there is no attribute of this name, and which there are.
fn not_there(hair: &Hair, head: &Head, name: &str) -> String {
    let of = &hair.attributes;
    let is_it = |line: &&String| line.split(|c: char| !c.is_alphanumeric() && !"_:".contains(c)).any(|w| w == name);
    if let Some(line) = of.unread.iter().find(is_it) {
        return format!("the file has it, but it was not read: {line}");
    }
    let of_hair = listed(of.other.iter().filter(|other| is_weight(other)).map(|other| other.name.clone()));
    let of_head = listed(head.mesh.weight_names().map(str::to_owned));
    match (of_hair, of_head) {
        (Some(hair), Some(head)) => format!(
            "no attribute of the hair with one number per strand or point; it has {hair}; and the head's mesh has {head}"
        ),
        (Some(hair), None) => format!(
            "no attribute of the hair with one number per strand or point; it has {hair}; the head's mesh has none"
        ),
        (None, Some(head)) => {
            format!("the hair has no attributes with one number per strand or point, and the head's mesh has {head}")
        }
        (None, None) => {
            "the hair has no attributes with one number per strand or point, and the head's mesh has no vertex \
                         colours or weights: use near or groups"
                .to_owned()
        }
    }
}

/// Whether an attribute has one number per strand or point.
fn is_weight(of: &Other) -> bool {
    of.extent == 1 && of.per != Per::Groom && !matches!(of.values, Values::Words(_))
}
