//! Strands stored as `l` elements of a Wavefront .obj, in its unit and axes: polylines, or single edges.

mod join;

use glam::Vec3;
use nabiki::{Hair, Strands};

use crate::{
    error::{Error, Result},
    finite, obj_text,
};
use join::Lines;

/// Reads `l` elements as strands whose first vertices are the roots. Elements that continue where another ends become
/// one strand. So do edges of two vertices that meet in pairs, in any order and direction; the end that comes first in
/// the file is the root. Closed lines are left out. Everything else except `v` is ignored.
pub fn from_bytes(bytes: &[u8]) -> Result<Hair> {
    let mut vertices: Vec<Vec3> = Vec::new();
    let mut lines = Lines::default();
    for (i, line) in obj_text::text(bytes).lines().enumerate() {
        let mut words = obj_text::words(line);
        match words.next() {
            Some("v") => vertices.push(obj_text::place(words, line, i + 1)?),
            Some("l") => {
                let vertex = |word| obj_text::vertex(word, vertices.len(), line, i + 1);
                if !lines.push(words.map(vertex), i + 1)? {
                    return Err(obj_text::refusal(line, i + 1, "a line needs vertices"));
                }
            }
            _ => {}
        }
    }
    if lines.is_empty() {
        return Err(Error::new("has no l elements: the file holds no strands"));
    }
    let (joined, closed) = lines.joined(&vertices)?;
    if joined.is_empty() {
        return Err(Error::new("its l elements are closed lines, which cannot be hair: the file holds no strands"));
    }
    let mut strands = Strands::with_capacity(joined.len(), joined.iter().map(Vec::len).sum());
    joined.iter().for_each(|strand| strands.push(strand.iter().map(|&v| vertices[v as usize])));
    finite::points(&strands)?;
    let mut hair = Hair::from(strands);
    if closed > 0 {
        hair.attributes.unread.push(format!("{closed} closed lines, which cannot be hair"));
    }
    Ok(hair)
}
