//! TressFX .tfx, versions 3 and 4, little-endian: a header of counts and byte offsets, then arrays.
//!
//! Version 4: version f32, strands u32, points a strand u32, offsets u32 of points (f32 x 4, w = 0 held, 1 free),
//! strand UVs, point UVs, strand thickness, point colours (RGBA), 32 reserved words.
//!
//! Version 3: version f32, guides u32, points a strand u32, follow strands a guide u32, both ends held i32, 31
//! reserved words, offsets of points (f32 x 3), strand thickness, strand UVs, point colours, guide numbers, point
//! UVs, 32 reserved words.
//!
//! Both contain only guides. TressFX generates the strands that follow a guide when it loads the file, so they are
//! neither read nor written here. An offset of 0 means that the array is absent.

use std::io::{Read, Seek, Write};

use glam::Vec3;
use nabiki::{Hair, Strands, hair::Attributes};

use crate::{
    bytes::{Bytes, product, put},
    error::{Error, Result},
    finite,
    hair_format::passed_on,
};

const HEADER_BYTES: u32 = 160;

/// Reads a .tfx file from memory, in its unit and axes.
pub fn from_bytes(bytes: &[u8]) -> Result<Hair> {
    from_source(&mut Bytes::from_slice(bytes))
}

/// Byte offsets of the arrays; 0 where absent.
struct Offsets {
    points: u32,
    strand_uv: u32,
    point_uv: u32,
    strand_thickness: u32,
    point_color: u32,
}

/// Reads from a file or from memory.
pub(crate) fn from_source<R: Read + Seek>(source: &mut Bytes<R>) -> Result<Hair> {
    let version: f32 = source.value("version")?;
    if version == 3.0 { version_3(source) } else { version_4(source, version) }
}

fn version_4<R: Read + Seek>(source: &mut Bytes<R>, version: f32) -> Result<Hair> {
    if !(4.0..5.0).contains(&version) {
        return Err(Error::new(format!("version is {version}: only TressFX files of versions 3 and 4 are read")));
    }
    source.expect(u64::from(HEADER_BYTES) - 4, "header")?;
    let [strands, points]: [u32; 2] = [source.value("strand count")?, source.value("points a strand")?];
    let [at_points, strand_uv, point_uv, strand_thickness]: [u32; 4] = source.value("offsets")?;
    let point_color = source.value("offsets")?;
    let offsets = Offsets { points: at_points, strand_uv, point_uv, strand_thickness, point_color };
    let count = check_counts(strands, points)?;
    seek(source, offsets.points, HEADER_BYTES, "points")?;
    source.expect(count as u64 * 16, "points")?;
    let (mut positions, mut freedom) = (vec![Vec3::ZERO; count], vec![0.0; count]);
    let mut block = vec![[0.0f32; 4]; 4096.min(count)];
    for (positions, freedom) in positions.chunks_mut(block.len()).zip(freedom.chunks_mut(block.len())) {
        let block = &mut block[..positions.len()];
        source.fill(block, "points")?;
        for ((position, freedom), &[x, y, z, w]) in positions.iter_mut().zip(freedom).zip(&*block) {
            *position = Vec3::new(x, y, z);
            *freedom = w;
        }
    }
    let strands = Strands::from_parts((0..=strands).map(|s| s * points).collect(), positions);
    finite::points(&strands)?;
    let mut attributes = attributes(source, &strands, &offsets, HEADER_BYTES)?;
    attributes.inverse_mass = Some(finite::values("w of points", freedom)?);
    Ok(Hair { strands, attributes })
}

fn version_3<R: Read + Seek>(source: &mut Bytes<R>) -> Result<Hair> {
    const HEADER_BYTES: u32 = 296;
    source.expect(u64::from(HEADER_BYTES) - 4, "header")?;
    let [strands, points, _follow, both_ends]: [u32; 4] = source.value("counts")?;
    source.seek(144)?;
    let [at_points, strand_thickness, strand_uv, point_color]: [u32; 4] = source.value("offsets")?;
    let [_guide_numbers, point_uv]: [u32; 2] = [source.value("offsets")?, source.value("offsets")?];
    let offsets = Offsets { points: at_points, strand_uv, point_uv, strand_thickness, point_color };
    let count = check_counts(strands, points)?;
    seek(source, offsets.points, HEADER_BYTES, "points")?;
    let positions: Vec<Vec3> = source.array(count, "points")?;
    let strands = Strands::from_parts((0..=strands).map(|s| s * points).collect(), positions);
    finite::points(&strands)?;
    let mut attributes = attributes(source, &strands, &offsets, HEADER_BYTES)?;
    let held = |p: u32| p == 0 || (both_ends != 0 && p + 1 == points);
    attributes.inverse_mass = Some((0..count as u32).map(|p| if held(p % points) { 0.0 } else { 1.0 }).collect());
    Ok(Hair { strands, attributes })
}

/// Points in all.
fn check_counts(strands: u32, points: u32) -> Result<usize> {
    if strands == 0 || points == 0 {
        return Err(Error::new(format!("{strands} strands of {points} points: the file holds no hair")));
    }
    product(strands, points, "strands x points")
}

fn seek<R: Read + Seek>(source: &mut Bytes<R>, offset: u32, header: u32, what: &str) -> Result<()> {
    if offset < header || u64::from(offset) > source.len() {
        let end = source.len();
        return Err(Error::new(format!(
            "{what}: offset {offset} must lie between the header and the end, {header}..{end}"
        )));
    }
    source.seek(u64::from(offset))
}

fn attributes<R: Read + Seek>(
    source: &mut Bytes<R>,
    strands: &Strands,
    offsets: &Offsets,
    header: u32,
) -> Result<Attributes> {
    let (strand_count, point_count) = (strands.len(), strands.points().len());
    let mut a = Attributes::default();
    if offsets.strand_uv != 0 {
        seek(source, offsets.strand_uv, header, "strand UVs")?;
        a.root_uv = Some(finite::tuples("strand UVs", source.array(strand_count, "strand UVs")?)?);
    }
    if offsets.point_uv != 0 {
        seek(source, offsets.point_uv, header, "point UVs")?;
        a.point_uv = Some(finite::tuples("point UVs", source.array(point_count, "point UVs")?)?);
    }
    if offsets.strand_thickness != 0 {
        seek(source, offsets.strand_thickness, header, "strand thickness")?;
        let thickness = finite::widths("strand thickness", source.array(strand_count, "strand thickness")?)?;
        let points = point_count / strand_count;
        a.width = Some(thickness.iter().flat_map(|&t| std::iter::repeat_n(t, points)).collect());
    }
    if offsets.point_color != 0 {
        seek(source, offsets.point_color, header, "point colours")?;
        let rgba: Vec<[f32; 4]> = finite::tuples("point colours", source.array(point_count, "point colours")?)?;
        a.colour = Some(rgba.iter().map(|&[r, g, b, _]| [r, g, b]).collect());
        a.transparency = Some(rgba.iter().map(|&[.., alpha]| 1.0 - alpha).collect());
    }
    Ok(a)
}

/// Phrases about the data of `hair` that a .tfx file cannot store.
pub fn losses(hair: &Hair) -> Vec<String> {
    let a = &hair.attributes;
    let mut lost = Vec::new();
    let mut lose = |there: bool, what: &str| {
        if there {
            lost.push(what.to_owned());
        }
    };
    lose(a.id.is_some(), "strand ids");
    lose(a.group.is_some() || !a.group_names.is_empty(), "groups");
    lose(a.guide.is_some(), "guide flags");
    if let Some(width) = &a.width {
        let tapers = (0..hair.strands.len()).any(|s| width[hair.strands.range(s)].windows(2).any(|w| w[0] != w[1]));
        lose(tapers, "width along a strand (each strand keeps the width at its root)");
    }
    let transparencies = a.transparency.iter().flatten().chain(&a.constant.transparency);
    lose(transparencies.clone().any(|t| 1.0 - (1.0 - t) != *t), "the last bits of transparencies (it holds 1 - t)");
    let points = hair.strands.iter().next().map_or(0, <[Vec3]>::len);
    let loads = points.is_power_of_two() && (4..=64).contains(&points);
    if !loads {
        lost.push(format!("{points} points per strand for TressFX itself, which loads 4, 8, 16, 32 or 64"));
    }
    lost.extend(passed_on(hair));
    lost
}

/// Writes version 4, in the unit and axes of `hair`. All strands must have the same number of points.
pub fn to_writer(hair: &Hair, out: &mut dyn Write) -> Result<()> {
    let (strands, a) = (&hair.strands, &hair.attributes);
    let Some(points) = strands.iter().next().map(<[Vec3]>::len) else {
        return Err(Error::new("there are no strands to write"));
    };
    if let Some((s, strand)) = strands.iter().enumerate().find(|(_, strand)| strand.len() != points) {
        return Err(Error::new(format!(
            "strand 0 has {points} points and strand {s} has {}: in a .tfx file all must have the same number; resample them (convert --segments N) or write .hair",
            strand.len()
        )));
    }
    let (strand_count, count) = (strands.len(), strands.points().len());
    let thickness: Option<Vec<f32>> = match (&a.width, a.constant.width) {
        (Some(width), _) => Some(width.iter().copied().step_by(points).collect()),
        (None, Some(width)) => Some(vec![width; strand_count]),
        (None, None) => None,
    };
    // TressFX has no colour for all points at once; white and opaque it takes for granted.
    let tinted = a.constant.colour.is_some_and(|rgb| rgb != [1.0; 3]);
    let clear = a.constant.transparency.is_some_and(|t| t != 0.0);
    let has_color = a.colour.is_some() || a.transparency.is_some() || tinted || clear;
    let mut end = u64::from(HEADER_BYTES);
    let mut place = |there: bool, bytes: usize| -> Result<u32> {
        let at = end;
        if !there {
            return Ok(0);
        }
        end += (bytes as u64).next_multiple_of(8);
        u32::try_from(at).map_err(|_| Error::new("more than 4 GiB: a .tfx file cannot hold it"))
    };
    let offsets = [
        place(true, count * 16)?,
        place(a.root_uv.is_some(), strand_count * 8)?,
        place(a.point_uv.is_some(), count * 8)?,
        place(thickness.is_some(), strand_count * 4)?,
        place(has_color, count * 16)?,
    ];
    put(out, &[4.0f32])?;
    put(out, &[strand_count as u32, points as u32])?;
    put(out, &offsets)?;
    put(out, &[0u32; 32])?;
    let root_held = |p: usize| if p.is_multiple_of(points) { 0.0 } else { 1.0 };
    let w = |p: usize| a.inverse_mass.as_ref().map_or_else(|| root_held(p), |freedom| freedom[p]);
    put_mapped(out, count, |p| strands.points()[p].extend(w(p)).to_array())?;
    put(out, a.root_uv.as_deref().unwrap_or_default())?;
    put(out, a.point_uv.as_deref().unwrap_or_default())?;
    put(out, thickness.as_deref().unwrap_or_default())?;
    if thickness.is_some() && strand_count % 2 == 1 {
        put(out, &[0u32])?;
    }
    if has_color {
        let rgb = |p: usize| a.colour.as_ref().map_or(a.constant.colour.unwrap_or([1.0; 3]), |color| color[p]);
        let clear = |p: usize| a.transparency.as_ref().map_or(a.constant.transparency.unwrap_or(0.0), |t| t[p]);
        put_mapped(out, count, |p| {
            let [r, g, b] = rgb(p);
            [r, g, b, 1.0 - clear(p)]
        })?;
    }
    Ok(())
}

/// Writes `count` values made one by one, a block at a time.
fn put_mapped(out: &mut dyn Write, count: usize, value: impl Fn(usize) -> [f32; 4]) -> Result<()> {
    let mut block = Vec::with_capacity(4096);
    for first in (0..count).step_by(4096) {
        block.clear();
        block.extend((first..count.min(first + 4096)).map(&value));
        put(out, &block)?;
    }
    Ok(())
}
