//! The words of a Wavefront .obj that its two readers, of strands and of triangles, share.

use std::borrow::Cow;

use glam::{Vec2, Vec3};

use crate::error::{Error, Result};
use crate::input::BYTE_ORDER_MARK;

/// The text of a file in whole lines, each at its number. Names in other encodings than UTF-8 do no harm.
pub(crate) fn text(bytes: &[u8]) -> Cow<'_, str> {
    let text = String::from_utf8_lossy(bytes.strip_prefix(BYTE_ORDER_MARK).unwrap_or(bytes));
    let ends_with_cr = text.as_bytes().windows(2).any(|pair| pair[0] == b'\r' && pair[1] != b'\n');
    if ends_with_cr || text.contains('\\') { Cow::Owned(whole_lines(&text)) } else { text }
}

/// Puts what a backslash continues into the line that it ends, and as many empty lines behind it.
fn whole_lines(text: &str) -> String {
    let text = text.replace("\r\n", "\n").replace('\r', "\n");
    let mut whole = String::with_capacity(text.len() + 1);
    let mut continued = 0;
    for line in text.lines() {
        let commented = line.split_ascii_whitespace().any(is_comment);
        match line.trim_ascii_end().strip_suffix('\\').filter(|_| !commented) {
            Some(begun) => {
                whole.push_str(begun);
                whole.push(' ');
                continued += 1;
            }
            None => {
                whole.push_str(line);
                whole.extend(std::iter::repeat_n('\n', continued + 1));
                continued = 0;
            }
        }
    }
    whole
}

/// The words of a line before its comment.
pub(crate) fn words(line: &str) -> impl Iterator<Item = &str> + Clone {
    line.split_ascii_whitespace().take_while(|word| !is_comment(word))
}

fn is_comment(word: &str) -> bool {
    word.starts_with('#')
}

/// The place that follows a `v`.
pub(crate) fn place<'a>(mut words: impl Iterator<Item = &'a str>, line: &str, number: usize) -> Result<Vec3> {
    let mut coordinate = || words.next().and_then(|word| word.parse().ok());
    match (coordinate(), coordinate(), coordinate()) {
        (Some(x), Some(y), Some(z)) => Ok(Vec3::new(x, y, z)),
        _ => Err(refusal(line, number, "a vertex needs three numbers")),
    }
}

/// The colour that follows the place of a `v`, as many programs write it: exactly three more numbers.
pub(crate) fn colour<'a>(words: impl Iterator<Item = &'a str>) -> Option<[f32; 3]> {
    let mut more = words.skip(3);
    let mut number = || more.next().and_then(|word| word.parse().ok());
    let colour = [number()?, number()?, number()?];
    more.next().is_none().then_some(colour)
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
        _ => Err(refusal(line, number, "texture coordinates need one to three numbers")),
    }
}

/// The vertex that `word` (`7`, `-1`, `7/3/2`) names, of `count` so far, from 0.
pub(crate) fn vertex(word: &str, count: usize, line: &str, number: usize) -> Result<u32> {
    word.split('/').next().and_then(|named| index(named, count)).ok_or_else(|| {
        refusal(line, number, &format!("\"{word}\" is not one of the {count} vertices before this line"))
    })
}

/// The texture coordinates that `word` names beside its vertex, of `count` so far, from 0; `None` where it names none
/// (`7`, `7//2`).
pub(crate) fn texture(word: &str, count: usize, line: &str, number: usize) -> Result<Option<usize>> {
    let Some(named) = word.split('/').nth(1).filter(|named| !named.is_empty()) else { return Ok(None) };
    let found = index(named, count).map(|i| i as usize);
    let why = || format!("\"{word}\" is not one of the {count} texture coordinates before this line");
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

#[cfg(test)]
mod tests {
    use crate::{mesh, obj_lines};

    const PLAIN: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\ng face\nf 1 2 3\nl 1 2 3\n";

    #[test]
    fn comments_continued_lines_and_any_line_ends_change_nothing() {
        let read = |text: &str| {
            let bytes = text.as_bytes();
            let groups = ["face".to_owned()];
            (mesh::from_bytes(bytes, "obj", &groups).unwrap(), obj_lines::from_bytes(bytes).unwrap().strands)
        };
        for text in [
            PLAIN.replace("0\n", "0 # c\n").replace("3\n", "3 # 4 \\\n"),
            PLAIN.replace("2 3", "2 \\\n 3").replace("1 1 0", "1 \\\n1\\ \n 0"),
            PLAIN.replace('\n', "\r"),
            PLAIN.replace('\n', "\r\n").replace("2 3", "2 \\\r\n3"),
            PLAIN.replace("2 3", "2 \\\n3").replace('\n', "\r"),
            format!("# in C:\\hair\\\n{PLAIN}"),
        ] {
            assert_eq!(read(&text), read(PLAIN), "{text:?}");
        }
    }

    #[test]
    fn lines_behind_a_continued_one_keep_their_numbers() {
        let text = PLAIN.replace("1 1 0", "1 \\\n1 \\\n0").replace("f 1 2 3", "f 1 2 9");
        assert_eq!(mesh::from_bytes(text.as_bytes(), "obj", &[]).unwrap_err().line, Some(7));
    }
}
