//! Cem Yuksel's .hair: a 128-byte header, then the arrays that its bit field names, little-endian.
//!
//! Header: `"HAIR"`, strand count, point count, bit field (1 segments, 2 points, 4 thickness, 8 transparency,
//! 16 colours), then the values used where an array is absent: segments a strand, thickness, transparency, RGB, and
//! 88 bytes of text. Arrays: segments u16 by strand; points, thickness, transparency, colours f32 by point.
//! The format knows neither unit nor axes. A header thickness of 0 stands for "not stated".

use std::io::{Read, Seek, Write};

use glam::Vec3;
use nabiki::{Hair, Strands, hair::Attributes};

use crate::{
    bytes::{Bytes, product, put},
    error::{Error, Result},
    finite,
    hair_format::passed_on,
};

const SEGMENTS: u32 = 1;
const POINTS: u32 = 2;
const THICKNESS: u32 = 4;
const TRANSPARENCY: u32 = 8;
const COLORS: u32 = 16;
const HEADER_BYTES: u64 = 128;

/// Reads a .hair file from memory, in its unit and axes.
pub fn from_bytes(bytes: &[u8]) -> Result<Hair> {
    from_source(&mut Bytes::from_slice(bytes))
}

/// Reads from a file or from memory.
pub(crate) fn from_source<R: Read + Seek>(source: &mut Bytes<R>) -> Result<Hair> {
    source.expect(HEADER_BYTES, "header")?;
    if source.array::<u8>(4, "magic")? != b"HAIR" {
        return Err(Error::new("does not start with HAIR: not a .hair file"));
    }
    let [strand_count, point_count, arrays, default_segments]: [u32; 4] = source.value("counts")?;
    let [thickness, transparency]: [f32; 2] = source.value("default thickness")?;
    let color: [f32; 3] = source.value("default colour")?;
    source.seek(HEADER_BYTES)?;
    if strand_count == 0 {
        return Err(Error::new("strand count is 0: the file holds no hair"));
    }
    if arrays & POINTS == 0 {
        return Err(Error::new(format!("bit field {arrays} names no points: the file holds no hair")));
    }
    let starts = starts(source, strand_count, point_count, (arrays & SEGMENTS == 0).then_some(default_segments))?;
    let count = point_count as usize;
    let strands = Strands::from_parts(starts, source.array::<Vec3>(count, "points")?);
    finite::points(&strands)?;

    let mut attributes = Attributes::default();
    if arrays & THICKNESS != 0 {
        attributes.width = Some(finite::widths("thickness", source.array(count, "thickness")?)?);
    }
    if arrays & TRANSPARENCY != 0 {
        attributes.transparency = Some(finite::values("transparency", source.array(count, "transparency")?)?);
    }
    if arrays & COLORS != 0 {
        attributes.colour = Some(finite::tuples("colours", source.array(count, "colours")?)?);
    }
    finite::widths("default thickness", vec![thickness])?;
    finite::values("default transparency", vec![transparency])?;
    finite::tuples("default colour", vec![color])?;
    attributes.constant.width = (thickness != 0.0).then_some(thickness);
    attributes.constant.transparency = Some(transparency);
    attributes.constant.colour = Some(color);
    Ok(Hair { strands, attributes })
}

/// Where each strand's points start, once the counts agree with each other and with the file's length.
/// `default_segments`: segments of every strand; `None` where the file lists them.
fn starts<R: Read + Seek>(
    source: &mut Bytes<R>,
    strand_count: u32,
    point_count: u32,
    default_segments: Option<u32>,
) -> Result<Vec<u32>> {
    let agree = |total: u64| {
        if total == u64::from(point_count) {
            return Ok(());
        }
        Err(Error::new(format!("point count is {point_count}, but {strand_count} strands have {total} points in all")))
    };
    match default_segments {
        Some(segments) => {
            let points = segments.saturating_add(1);
            agree(product(strand_count, points, "strands x points")? as u64)?;
            source.expect(u64::from(point_count) * 12, "points")?;
            Ok((0..=strand_count).map(|s| s * points).collect())
        }
        None => {
            let segments: Vec<u16> = source.array(strand_count as usize, "segments")?;
            agree(segments.iter().map(|&n| u64::from(n) + 1).sum())?;
            source.expect(u64::from(point_count) * 12, "points")?;
            let mut end = 0;
            let ends = segments.iter().map(|&n| {
                end += u32::from(n) + 1;
                end
            });
            Ok(std::iter::once(0).chain(ends).collect())
        }
    }
}

/// Phrases about the data of `hair` that a .hair file cannot store.
pub fn losses(hair: &Hair) -> Vec<String> {
    let a = &hair.attributes;
    let mut lost = Vec::new();
    let mut lose = |there: bool, what: &str| {
        if there {
            lost.push(what.to_owned());
        }
    };
    lose(a.id.is_some(), "strand ids");
    lose(a.root_uv.is_some(), "root UVs");
    lose(a.group.is_some() || !a.group_names.is_empty(), "groups");
    lose(a.guide.is_some(), "guide flags");
    lose(a.point_uv.is_some(), "point UVs");
    lose(a.inverse_mass.is_some(), "which points are held");
    let no_width = a.width.is_none() && a.constant.width == Some(0.0);
    lose(no_width, "the width 0 of all points (there 0 means no width)");
    lost.extend(passed_on(hair));
    lost
}

/// Writes the strands, widths, colours and transparencies of `hair`, in its unit and axes. The first 88 bytes of
/// `comment` go into the header.
pub fn to_writer(hair: &Hair, comment: &str, out: &mut dyn Write) -> Result<()> {
    let (strands, a) = (&hair.strands, &hair.attributes);
    let strand_count = u32::try_from(strands.len()).map_err(|_| Error::new("more than 2^32 - 1 strands"))?;
    let mut segments = Vec::with_capacity(strands.len());
    for (s, strand) in strands.iter().enumerate() {
        let n = u16::try_from(strand.len().wrapping_sub(1)).map_err(|_| {
            Error::new(format!("strand {s} has {} points: a .hair file holds 1 to 65536 per strand", strand.len()))
        })?;
        segments.push(n);
    }
    let Some(&first) = segments.first() else { return Err(Error::new("there are no strands to write")) };
    let uniform = segments.iter().all(|&n| n == first);
    let bit = |there: bool, bit: u32| if there { bit } else { 0 };
    let arrays = POINTS
        | bit(!uniform, SEGMENTS)
        | bit(a.width.is_some(), THICKNESS)
        | bit(a.transparency.is_some(), TRANSPARENCY)
        | bit(a.colour.is_some(), COLORS);
    let default_segments = if uniform { u32::from(first) } else { 0 };
    out.write_all(b"HAIR")?;
    put(out, &[strand_count, strands.points().len() as u32, arrays, default_segments])?;
    put(out, &[a.constant.width.unwrap_or(0.0), a.constant.transparency.unwrap_or(0.0)])?;
    put(out, &a.constant.colour.unwrap_or([1.0; 3]))?;
    let mut text = [0u8; 88];
    for (to, from) in text.iter_mut().zip(comment.bytes()) {
        *to = from;
    }
    out.write_all(&text)?;
    if !uniform {
        put(out, &segments)?;
    }
    put(out, strands.points())?;
    put(out, a.width.as_deref().unwrap_or_default())?;
    put(out, a.transparency.as_deref().unwrap_or_default())?;
    put(out, a.colour.as_deref().unwrap_or_default())
}
