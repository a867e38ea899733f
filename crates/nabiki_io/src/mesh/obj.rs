//! Faces of a Wavefront .obj. (Its words are few; the reader of the crate tobj panics on faces without positions.)

use std::collections::{BTreeMap, BTreeSet};

use glam::Vec2;
use nabiki::Mesh;
use nabiki_exchange::{Budget, Painted};

use super::{
    TRIANGLE_BYTES,
    check::{check, check_groups},
    push_fan,
};
use crate::{
    error::{Error, Result},
    obj_text,
};

/// The name of vertex colours, which have none in the file.
pub(super) const COLOUR: &str = "color";

/// `groups`: names that follow a `g` or an `o`; faces under any of them are kept, all where there are none. `lost`: what of the
/// texture coordinates is left out is put there; the shape does without.
pub(super) fn from_bytes(bytes: &[u8], groups: &[String], lost: &mut Vec<String>) -> Result<Mesh> {
    let mut mesh = Mesh::default();
    // Red, green and blue of the vertices, as far as they have any.
    let mut colours: Vec<f32> = Vec::new();
    // `None` keeps the number of one that is none.
    let mut uvs: Vec<Option<Vec2>> = Vec::new();
    let mut wrong_uv: Option<Error> = None;
    let mut face: Vec<(u32, Option<Vec2>)> = Vec::new();
    let text = obj_text::text(bytes);
    let budget = Budget::of(bytes.len() as u64);
    let mut names: BTreeSet<&str> = BTreeSet::new();
    let wanted = |name: &str| groups.iter().any(|group| group == name);
    let (mut in_object, mut in_group) = (false, false);
    for (i, line) in text.lines().enumerate() {
        let mut words = obj_text::words(line);
        match words.next() {
            Some("v") => {
                if let Some(colour) = obj_text::colour(words.clone()) {
                    colours.resize(3 * mesh.positions.len(), 0.0);
                    colours.extend(colour);
                }
                mesh.positions.push(obj_text::place(words, line, i + 1)?);
            }
            Some("vt") => {
                let uv = obj_text::texture_coordinates(words, line, i + 1);
                uvs.push(uv.map_err(|e| wrong_uv.get_or_insert(e)).ok());
            }
            Some("f") if groups.is_empty() || in_object || in_group => {
                face.clear();
                for word in words {
                    let vertex = obj_text::vertex(word, mesh.positions.len(), line, i + 1)?;
                    let uv = obj_text::texture(word, uvs.len(), line, i + 1);
                    let uv = uv.map_err(|e| wrong_uv.get_or_insert(e)).ok().flatten();
                    face.push((vertex, uv.and_then(|uv| uvs[uv])));
                }
                if face.len() < 3 {
                    return Err(obj_text::refusal(line, i + 1, "a face needs at least three vertices"));
                }
                budget.take((face.len() - 2) as u64 * TRIANGLE_BYTES, "triangles")?;
                push_fan(&mut mesh, &face);
            }
            Some("o") => {
                let name = line.trim_start()[1..].trim();
                in_object = wanted(name);
                names.insert(name);
            }
            Some("g") => {
                in_group = words.clone().any(wanted);
                names.extend(words);
            }
            _ => {}
        }
    }
    let names: Vec<&str> = names.into_iter().collect();
    check_groups(groups, &names)?;
    if mesh.triangles.is_empty() {
        return Err(Error::new(format!("holds {} vertices but no faces: not a head", mesh.positions.len())));
    }
    if let Some(Error { what, line, .. }) = wrong_uv.filter(|_| mesh.corner_uvs.is_none()) {
        lost.push(format!("texture coordinates: line {}: {what}", line.unwrap_or(0)));
    }
    if !colours.is_empty() {
        let painted = Painted { name: COLOUR.to_owned(), extent: 3, numbers: colours };
        let added = painted.add_to(&mut mesh, 0, &budget);
        lost.extend(added.err().map(|why| format!("{COLOUR}: {why}")));
    }
    check(only_used(mesh), lost)
}

/// Every name that follows a `g` or an `o`, with the faces under it.
pub(super) fn groups(bytes: &[u8]) -> Vec<(String, usize)> {
    let text = obj_text::text(bytes);
    let mut faces: BTreeMap<&str, usize> = BTreeMap::new();
    let (mut object, mut groups) = (None, Vec::new());
    for line in text.lines() {
        let mut words = obj_text::words(line);
        match words.next() {
            Some("f") => groups.iter().copied().chain(object).for_each(|name| *faces.entry(name).or_default() += 1),
            Some("o") => object = Some(line.trim_start()[1..].trim()),
            Some("g") => groups = words.collect(),
            _ => {}
        }
    }
    faces.into_iter().map(|(name, faces)| (name.to_owned(), faces)).collect()
}

/// Leaves out the vertices of other groups, and those of no face.
fn only_used(Mesh { positions, mut triangles, corner_uvs, weights }: Mesh) -> Mesh {
    let mut number = vec![u32::MAX; positions.len()];
    for &v in triangles.iter().flatten() {
        number[v as usize] = 0;
    }
    for (used, n) in number.iter_mut().filter(|n| **n == 0).enumerate() {
        *n = used as u32;
    }
    for v in triangles.iter_mut().flatten() {
        *v = number[*v as usize];
    }
    let kept = || (0..).zip(&number).filter(|&(_, &n)| n != u32::MAX).map(|(v, _)| v);
    let weights = weights.iter().map(|weights| weights.of_vertices(kept())).collect();
    let positions = kept().map(|v: u32| positions[v as usize]).collect();
    Mesh { positions, triangles, corner_uvs, weights }
}
