//! Attribute blocks of a cache: an eight-letter tag, the length in bytes, the values, zeros up to a multiple of 8.

use std::io::{Read, Seek};

use glam::Vec3;
use nabiki::hair::Attributes;

use super::{
    BOUNDS_TAG, START_TAG, SUMS_TAG,
    origin::{self, Origin},
    other,
    piece::{self, Piece},
};
use crate::{
    bytes::{Bytes, Scalar, put},
    error::{Error, Result},
    finite,
};

/// Writes one block, if there are values for it.
pub(super) fn block<T: Scalar>(out: &mut Vec<u8>, tag: &[u8; 8], values: Option<&[T]>) -> Result<()> {
    let Some(values) = values else { return Ok(()) };
    out.extend_from_slice(tag);
    put(out, &[size_of_val(values) as u64])?;
    put(out, values)?;
    out.resize(out.len().next_multiple_of(8), 0);
    Ok(())
}

pub(super) fn write(out: &mut Vec<u8>, a: &Attributes) -> Result<()> {
    block(out, b"id      ", a.id.as_deref())?;
    block(out, b"root_uv ", a.root_uv.as_deref())?;
    block(out, b"group   ", a.group.as_deref())?;
    let guide: Option<Vec<u8>> = a.guide.as_ref().map(|guide| guide.iter().map(|&g| u8::from(g)).collect());
    block(out, b"guide   ", guide.as_deref())?;
    let tip_first: Option<Vec<u8>> =
        a.tip_first.as_ref().map(|all| all.iter().map(|&turned| u8::from(turned)).collect());
    block(out, b"tipfirst", tip_first.as_deref())?;
    block(out, b"width   ", a.width.as_deref())?;
    block(out, b"color   ", a.colour.as_deref())?;
    block(out, b"transpar", a.transparency.as_deref())?;
    block(out, b"point_uv", a.point_uv.as_deref())?;
    block(out, b"freedom ", a.inverse_mass.as_deref())?;
    block(out, b"c_width ", a.constant.width.as_ref().map(std::slice::from_ref))?;
    block(out, b"c_color ", a.constant.colour.as_ref().map(std::slice::from_ref))?;
    block(out, b"c_transp", a.constant.transparency.as_ref().map(std::slice::from_ref))?;
    for (number, name) in &a.group_names {
        let mut text = number.to_le_bytes().to_vec();
        text.extend_from_slice(name.as_bytes());
        block(out, b"grp_name", Some(&text))?;
    }
    for other in &a.other {
        block(out, other::TAG, Some(&other::bytes(other)?))?;
    }
    // `unread` is not written: it names what the source has and this hair has not, and is told when the source is read.
    // The cache holds all of the hair that it was given.
    Ok(())
}

/// What the blocks say.
#[derive(Default)]
pub(super) struct Blocks {
    pub attributes: Attributes,
    pub origin: Option<Origin>,
    pub piece: Option<Piece>,
    pub bounds: Option<[Vec3; 2]>,
    pub first_frame: i32,
    pub sums: Option<Sums>,
}

/// What was noted of the bytes that were written.
pub(super) struct Sums {
    /// The offset at which the block's values begin.
    pub at: u64,
    /// The sum of all before them.
    pub header: u64,
    /// That of each frame.
    pub frames: Vec<u64>,
}

/// How many of each a cache has.
#[derive(Clone, Copy)]
pub(super) struct Counts {
    pub strands: usize,
    pub points: usize,
    pub frames: u64,
}

/// Reads the blocks up to the offset `end`; tags of later versions are passed over.
pub(super) fn read<R: Read + Seek>(source: &mut Bytes<R>, end: u64, counts: Counts) -> Result<Blocks> {
    let Counts { strands, points, frames } = counts;
    let Blocks { attributes: mut a, mut piece, mut bounds, mut first_frame, mut sums, .. } = Blocks::default();
    let (mut origin, mut groom, mut in_world) = (None, None, false);
    while source.at() < end {
        let tag: [u8; 8] = source.value("attribute tag")?;
        let length: u64 = source.value("attribute length")?;
        let name = String::from_utf8_lossy(&tag).trim_end().to_owned();
        let next = length.checked_next_multiple_of(8).and_then(|padded| source.at().checked_add(padded));
        let Some(next) = next.filter(|&next| next <= end) else {
            return Err(Error::new(format!("attribute {name}: {length} bytes reach beyond the header")));
        };
        let mut block = Block { source, name: &name, length };
        match &tag {
            b"id      " => a.id = Some(block.values(strands)?),
            b"root_uv " => a.root_uv = Some(finite::tuples(&name, block.values(strands)?)?),
            b"group   " => a.group = Some(block.values(strands)?),
            b"guide   " => a.guide = Some(block.values::<u8>(strands)?.iter().map(|&g| g != 0).collect()),
            b"tipfirst" => a.tip_first = Some(block.values::<u8>(strands)?.iter().map(|&turned| turned != 0).collect()),
            b"width   " => a.width = Some(finite::widths(&name, block.values(points)?)?),
            b"color   " => a.colour = Some(finite::tuples(&name, block.values(points)?)?),
            b"transpar" => a.transparency = Some(finite::values(&name, block.values(points)?)?),
            b"point_uv" => a.point_uv = Some(finite::tuples(&name, block.values(points)?)?),
            b"freedom " => a.inverse_mass = Some(finite::values(&name, block.values(points)?)?),
            b"c_width " => a.constant.width = finite::widths(&name, block.values(1)?)?.pop(),
            b"c_color " => a.constant.colour = finite::tuples(&name, block.values(1)?)?.pop(),
            b"c_transp" => a.constant.transparency = finite::values(&name, block.values(1)?)?.pop(),
            b"grp_name" => {
                let text: Vec<u8> = block.values(length as usize)?;
                let damaged = || Error::new("attribute grp_name: is not a number and a name: the file is damaged");
                let (number, text) = text.split_first_chunk().ok_or_else(damaged)?;
                let text = std::str::from_utf8(text).map_err(|_| damaged())?;
                a.group_names.insert(i32::from_le_bytes(*number), text.to_owned());
            }
            origin::TAG => origin = Some(origin::from_bytes(&block.values(origin::BYTES)?)?),
            origin::WORLD_TAG => in_world = block.values::<u8>(1)? == [1],
            origin::GROOM_TAG => groom = Some(origin::groom_from_bytes(&block.values(length as usize)?)?),
            piece::TAG => piece = Some(Piece::from_bytes(&block.values(length as usize)?)?),
            BOUNDS_TAG => {
                let corners: Vec<Vec3> = block.values(2)?;
                bounds = Some([corners[0], corners[1]]);
            }
            START_TAG => first_frame = block.values(1)?[0],
            SUMS_TAG => {
                let at = block.source.at();
                let mut all =
                    block.values::<u64>(usize::try_from(frames).map_or(usize::MAX, |n| n.saturating_add(1)))?;
                let header = all.remove(0);
                sums = Some(Sums { at, header, frames: all });
            }
            other::TAG => a.other.push(other::read(source, length, strands, points)?),
            _ => {}
        }
        source.seek(next)?;
    }
    let origin = match (origin, groom) {
        (Some((placement, points)), Some(groom)) => Some(Origin { placement, points, groom, in_world }),
        (Some(_), None) => return Err(Error::new("attribute origin: the block groom is missing: the file is damaged")),
        (None, _) => None,
    };
    Ok(Blocks { attributes: a, origin, piece, bounds, first_frame, sums })
}

/// The values of one block.
struct Block<'a, R> {
    source: &'a mut Bytes<R>,
    name: &'a str,
    length: u64,
}

impl<R: Read + Seek> Block<'_, R> {
    fn values<T: Scalar>(&mut self, count: usize) -> Result<Vec<T>> {
        let expected = (count as u64).saturating_mul(size_of::<T>() as u64);
        if expected != self.length {
            let (name, found) = (self.name, self.length);
            return Err(Error::new(format!("attribute {name}: {expected} bytes expected, {found} found")));
        }
        self.source.array(count, self.name)
    }
}
