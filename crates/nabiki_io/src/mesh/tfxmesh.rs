//! The collision meshes of TressFX 4, .tfxmesh: text lists of bones, of vertices with their normals and weights, and of
//! triangles. Places and triangles are read; they are those of the bind pose.

use glam::Vec3;
use nabiki::Mesh;

use super::check::check;
use crate::{
    error::{Error, Result},
    obj_text,
};

/// The lines that hold more than a comment, with their numbers from 1.
type Lines<'a> = dyn Iterator<Item = (usize, &'a str)> + 'a;

pub(super) fn from_bytes(bytes: &[u8]) -> Result<Mesh> {
    let text = obj_text::text(bytes);
    let lines = text.lines().enumerate().map(|(i, line)| (i + 1, line.trim()));
    let mut lines = lines.filter(|(_, line)| !line.is_empty() && !line.starts_with('#'));
    let (mut positions, mut triangles): (Vec<Vec3>, Vec<[u32; 3]>) = (Vec::new(), Vec::new());
    let bones = count(&mut lines, "numOfBones")?;
    for _ in 0..bones {
        next(&mut lines, "a bone")?;
    }
    let vertices = count(&mut lines, "numOfVertices")?;
    for vertex in 0..vertices {
        let (number, line, rest) = entry(&mut lines, "vertex", vertex)?;
        positions.push(obj_text::place(rest, line, number)?);
    }
    let count = count(&mut lines, "numOfTriangles")?;
    for triangle in 0..count {
        let (number, line, mut rest) = entry(&mut lines, "triangle", triangle)?;
        let mut corner = || rest.next().and_then(|word| word.parse().ok()).filter(|&v: &u32| v < vertices);
        let corners = (corner(), corner(), corner());
        let (Some(a), Some(b), Some(c)) = corners else {
            let why = format!("a triangle needs three of the {vertices} vertices, counted from 0");
            return Err(obj_text::refusal(line, number, &why));
        };
        triangles.push([a, b, c]);
    }
    check(Mesh { positions, triangles, ..Mesh::default() }, &mut Vec::new())
}

fn next<'a>(lines: &mut Lines<'a>, wanted: &str) -> Result<(usize, &'a str)> {
    lines.next().ok_or_else(|| Error::new(format!("ends before {wanted}: is it complete?")))
}

/// The number behind `keyword`.
fn count<'a>(lines: &mut Lines<'a>, keyword: &str) -> Result<u32> {
    let (number, line) = next(lines, keyword)?;
    let count = line.strip_prefix(keyword).and_then(|rest| rest.trim().parse().ok());
    count.ok_or_else(|| obj_text::refusal(line, number, &format!("{keyword} and a number expected here")))
}

/// The line of the `wanted`th `thing`: its number, itself, and its words behind the index.
fn entry<'a>(
    lines: &mut Lines<'a>,
    thing: &str,
    wanted: u32,
) -> Result<(usize, &'a str, impl Iterator<Item = &'a str> + use<'a>)> {
    let (number, line) = next(lines, &format!("{thing} {wanted}"))?;
    let mut words = line.split_ascii_whitespace();
    if words.next().and_then(|word| word.parse().ok()) != Some(wanted) {
        return Err(obj_text::refusal(line, number, &format!("{thing} {wanted} expected here")));
    }
    Ok((number, line, words))
}
