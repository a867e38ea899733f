//! The words of a Wavefront .obj that its two readers, of strands and of triangles, share.

use std::borrow::Cow;

use glam::Vec3;

use crate::error::{Error, Result};

/// The lines of a file with their numbers from 1. Names in other encodings than UTF-8 do no harm.
pub(crate) fn text(bytes: &[u8]) -> Cow<'_, str> {
    String::from_utf8_lossy(bytes)
}

/// The place that follows a `v`.
pub(crate) fn place<'a>(mut words: impl Iterator<Item = &'a str>, line: &str, number: usize) -> Result<Vec3> {
    let mut coordinate = || words.next().and_then(|word| word.parse().ok());
    match (coordinate(), coordinate(), coordinate()) {
        (Some(x), Some(y), Some(z)) => Ok(Vec3::new(x, y, z)),
        _ => Err(refusal(line, number, "a vertex has three numbers")),
    }
}

/// The vertex that `word` (`7`, `-1`, `7/3/2`) names, of `count` so far, from 0.
pub(crate) fn vertex(word: &str, count: usize, line: &str, number: usize) -> Result<u32> {
    let index = || {
        let named: i64 = word.split('/').next()?.parse().ok()?;
        let index = if named < 0 { named.checked_add(i64::try_from(count).ok()?)? } else { named.checked_sub(1)? };
        u32::try_from(index).ok().filter(|&i| (i as usize) < count)
    };
    index().ok_or_else(|| {
        refusal(line, number, &format!("\"{word}\" is not one of the {count} vertices that stand before this line"))
    })
}

/// An error about a line, of which it shows the beginning.
pub(crate) fn refusal(line: &str, number: usize, why: &str) -> Error {
    let mut short: String = line.chars().take(40).collect();
    if short.len() < line.len() {
        short.push_str("...");
    }
    Error::new(format!("\"{short}\": {why}")).at_line(Some(number))
}
