//! Strands kept as the `l` polylines of a Wavefront .obj, in its own unit and axes.

use glam::Vec3;
use nabiki::{Hair, Strands};

use crate::{
    error::{Error, Result},
    finite, obj_text,
};

/// Reads every `l` element as one strand, its first vertex as the root. All else but `v` is passed over.
pub fn from_bytes(bytes: &[u8]) -> Result<Hair> {
    let mut vertices: Vec<Vec3> = Vec::new();
    let mut strands = Strands::default();
    for (i, line) in obj_text::text(bytes).lines().enumerate() {
        let mut words = obj_text::words(line);
        match words.next() {
            Some("v") => vertices.push(obj_text::place(words, line, i + 1)?),
            Some("l") => {
                let point = |word| Ok(vertices[obj_text::vertex(word, vertices.len(), line, i + 1)? as usize]);
                let points: Vec<Vec3> = words.map(point).collect::<Result<_>>()?;
                if points.is_empty() {
                    return Err(obj_text::refusal(line, i + 1, "a line has vertices"));
                }
                strands.push(points);
            }
            _ => {}
        }
    }
    if strands.is_empty() {
        return Err(Error::new("has no l elements: the file holds no strands"));
    }
    finite::points(&strands)?;
    Ok(strands.into())
}
