//! Strands kept as the `l` polylines of a Wavefront .obj, in its own unit and axes.

use glam::Vec3;
use nabiki::{Hair, Strands};

use crate::{
    error::{Error, Result},
    finite,
};

/// Reads every `l` element as one strand, its first vertex as the root. All else but `v` is passed over.
pub fn from_bytes(bytes: &[u8]) -> Result<Hair> {
    let text = std::str::from_utf8(bytes).map_err(|_| Error::new("not a text file: not an .obj"))?;
    let mut vertices: Vec<Vec3> = Vec::new();
    let mut strands = Strands::default();
    for (i, line) in text.lines().enumerate() {
        let at_line = |what: String| Error::new(what).at_line(Some(i + 1));
        let mut words = line.split_ascii_whitespace();
        match words.next() {
            Some("v") => {
                let mut coordinate = || words.next().and_then(|w| w.parse().ok());
                match (coordinate(), coordinate(), coordinate()) {
                    (Some(x), Some(y), Some(z)) => vertices.push(Vec3::new(x, y, z)),
                    _ => return Err(at_line(format!("\"{}\": a vertex has three numbers", clip(line)))),
                }
            }
            Some("l") => {
                let points: Option<Vec<Vec3>> = words.map(|word| vertex(&vertices, word)).collect();
                match points {
                    Some(points) if !points.is_empty() => strands.push(points),
                    _ => {
                        let count = vertices.len();
                        return Err(at_line(format!(
                            "\"{}\": a line names vertices that stand before it, 1 to {count} here",
                            clip(line)
                        )));
                    }
                }
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

/// The vertex that `word` (`7`, `-1`, `7/3`) names.
fn vertex(vertices: &[Vec3], word: &str) -> Option<Vec3> {
    let number: i64 = word.split('/').next()?.parse().ok()?;
    let index = if number < 0 { number.checked_add(vertices.len() as i64)? } else { number - 1 };
    vertices.get(usize::try_from(index).ok()?).copied()
}

/// The beginning of a line, short enough for a message.
fn clip(line: &str) -> String {
    let mut short: String = line.chars().take(40).collect();
    if short.len() < line.len() {
        short.push_str("...");
    }
    short
}
