//! The words of a Wavefront .obj that its two readers, of strands and of triangles, share.

use std::borrow::Cow;

use glam::{Vec2, Vec3};

use crate::error::{Error, Result};
use crate::input::BYTE_ORDER_MARK;

/// The lines of a file with their numbers from 1. Names in other encodings than UTF-8 do no harm.
pub(crate) fn text(bytes: &[u8]) -> Cow<'_, str> {
    String::from_utf8_lossy(bytes.strip_prefix(BYTE_ORDER_MARK).unwrap_or(bytes))
}

/// The place that follows a `v`.
pub(crate) fn place<'a>(mut words: impl Iterator<Item = &'a str>, line: &str, number: usize) -> Result<Vec3> {
    let mut coordinate = || words.next().and_then(|word| word.parse().ok());
    match (coordinate(), coordinate(), coordinate()) {
        (Some(x), Some(y), Some(z)) => Ok(Vec3::new(x, y, z)),
        _ => Err(refusal(line, number, "a vertex has three numbers")),
    }
}

/// The texture coordinates that follow a `vt`; v is 0 where it is left out, the third is of no surface.
pub(crate) fn texture_coordinates<'a>(
    mut words: impl Iterator<Item = &'a str>,
    line: &str,
    number: usize,
) -> Result<Vec2> {
    let u = words.next().and_then(|word| word.parse().ok());
    let v = words.next().map_or(Some(0.0), |word| word.parse().ok());
    match (u, v) {
        (Some(u), Some(v)) => Ok(Vec2::new(u, v)),
        _ => Err(refusal(line, number, "texture coordinates are one to three numbers")),
    }
}

/// The vertex that `word` (`7`, `-1`, `7/3/2`) names, of `count` so far, from 0.
pub(crate) fn vertex(word: &str, count: usize, line: &str, number: usize) -> Result<u32> {
    word.split('/').next().and_then(|named| index(named, count)).ok_or_else(|| {
        refusal(line, number, &format!("\"{word}\" is not one of the {count} vertices that stand before this line"))
    })
}

/// The texture coordinates that `word` names beside its vertex, of `count` so far, from 0; `None` where it names none
/// (`7`, `7//2`).
pub(crate) fn texture(word: &str, count: usize, line: &str, number: usize) -> Result<Option<usize>> {
    let Some(named) = word.split('/').nth(1).filter(|named| !named.is_empty()) else { return Ok(None) };
    let found = index(named, count).map(|i| i as usize);
    let why = || format!("\"{word}\" names none of the {count} texture coordinates that stand before this line");
    found.map(Some).ok_or_else(|| refusal(line, number, &why()))
}

/// What a number from 1 on, or one back from the last, stands for, from 0.
fn index(named: &str, count: usize) -> Option<u32> {
    let named: i64 = named.parse().ok()?;
    let index = if named < 0 { named.checked_add(i64::try_from(count).ok()?)? } else { named.checked_sub(1)? };
    u32::try_from(index).ok().filter(|&i| (i as usize) < count)
}

/// An error about a line, of which it shows the beginning.
pub(crate) fn refusal(line: &str, number: usize, why: &str) -> Error {
    let mut short: String = line.chars().take(40).collect();
    if short.len() < line.len() {
        short.push_str("...");
    }
    Error::new(format!("\"{short}\": {why}")).at_line(Some(number))
}
