//! Blocks of attributes that mean nothing to the method: each with its name, what has a value, and of what kind it is.

use std::io::{Read, Seek};

use nabiki::hair::{Other, Per, Role, Stored, Values};

use crate::{
    bytes::{Bytes, Scalar, put},
    error::{Error, Result},
};

pub(super) const TAG: &[u8; 8] = b"other   ";
/// Six numbers: what has a value, role, kind, extent, bytes of the name, how it was stored.
const HEAD_BYTES: u64 = 24;
/// What has a value, and roles, by the numbers that the block gives them.
const PER: [Per; 3] = [Per::Groom, Per::Strand, Per::Point];
const ROLES: [Role; 6] = [Role::Plain, Role::Colour, Role::Point, Role::Vector, Role::Normal, Role::TextureCoordinate];
const FLOATS: u32 = 0;
const DOUBLES: u32 = 1;
const INTEGERS: u32 = 2;
const WORDS: u32 = 3;
/// How the source stores a number or word, from 1 on by the numbers that the block gives it; 0 where it does not say.
const STORED: [Stored; 14] = [
    Stored::Bool,
    Stored::I8,
    Stored::U8,
    Stored::I16,
    Stored::U16,
    Stored::I32,
    Stored::U32,
    Stored::I64,
    Stored::U64,
    Stored::F16,
    Stored::F32,
    Stored::F64,
    Stored::Text,
    Stored::Token,
];
/// Added for a single value, which is no list.
const SINGLE: u32 = 0x100;

/// The values of a block.
pub(super) fn bytes(other: &Other) -> Result<Vec<u8>> {
    let whole = |n: usize, what: &str| {
        u32::try_from(n).map_err(|_| Error::new(format!("attribute {}: {what} is 2^32 or more", other.name)))
    };
    let per = PER.iter().position(|&per| per == other.per).unwrap_or_default() as u32;
    let role = ROLES.iter().position(|&role| role == other.role).unwrap_or_default() as u32;
    let kind = match &other.values {
        Values::Floats(_) => FLOATS,
        Values::Doubles(_) => DOUBLES,
        Values::Integers(_) => INTEGERS,
        Values::Words(_) => WORDS,
    };
    if other.extent == 0 {
        return Err(Error::new(format!(
            "attribute {}: its values have no numbers: give at least one each",
            other.name
        )));
    }
    let (extent, name) = (whole(other.extent, "its extent")?, whole(other.name.len(), "the length of its name")?);
    let mut out = Vec::new();
    let stored = STORED.iter().position(|&stored| stored == other.stored).map_or(0, |at| at as u32 + 1);
    let stored = stored | if other.single { SINGLE } else { 0 };
    put(&mut out, &[per, role, kind, extent, name, stored])?;
    out.extend_from_slice(other.name.as_bytes());
    out.resize(out.len().next_multiple_of(8), 0);
    match &other.values {
        Values::Floats(values) => put(&mut out, values)?,
        Values::Doubles(values) => put(&mut out, values)?,
        Values::Integers(values) => put(&mut out, values)?,
        Values::Words(words) => {
            for word in words {
                put(&mut out, &[whole(word.len(), "the length of a word")?])?;
                out.extend_from_slice(word.as_bytes());
            }
        }
    }
    Ok(out)
}

/// Reads a block of `length` bytes, which lie within the source.
pub(super) fn read<R: Read + Seek>(source: &mut Bytes<R>, length: u64, strands: usize, points: usize) -> Result<Other> {
    let damaged = |what: &str| Error::new(format!("attribute other: {what}: the file is damaged"));
    if length < HEAD_BYTES {
        return Err(damaged("too short"));
    }
    let [per, role, kind, extent, name_bytes, stored]: [u32; 6] = source.value("attribute other")?;
    let per = *PER.get(per as usize).ok_or_else(|| damaged("is not of groom, strands or points"))?;
    let role = *ROLES.get(role as usize).ok_or_else(|| damaged("unknown role"))?;
    if extent == 0 {
        return Err(damaged("values without numbers"));
    }
    let name_room = u64::from(name_bytes).next_multiple_of(8);
    let left = (length - HEAD_BYTES).checked_sub(name_room).ok_or_else(|| damaged("a name longer than its block"))?;
    let mut name: Vec<u8> = source.array(name_room as usize, "attribute name")?;
    name.truncate(name_bytes as usize);
    let name = String::from_utf8(name).map_err(|_| damaged("a name that is not text"))?;
    let values = match kind {
        FLOATS => Values::Floats(numbers(source, left, &name)?),
        DOUBLES => Values::Doubles(numbers(source, left, &name)?),
        INTEGERS => Values::Integers(numbers(source, left, &name)?),
        WORDS => Values::Words(words(source, left, &name)?),
        _ => return Err(damaged("values of an unknown kind")),
    };
    let (extent, found) = (extent as usize, values.len());
    let fits = match per {
        Per::Groom => found.is_multiple_of(extent),
        Per::Strand => extent.checked_mul(strands) == Some(found),
        Per::Point => extent.checked_mul(points) == Some(found),
    };
    if !fits {
        let hair = format!("{extent} per value, {strands} strands, {points} points");
        return Err(Error::new(format!("attribute {name}: {found} numbers or words do not fit ({hair})")));
    }
    let single = stored & SINGLE != 0;
    let stored = match (stored & !SINGLE) as usize {
        0 => Stored::of(&values),
        number => *STORED.get(number - 1).ok_or_else(|| damaged("unknown way of storage"))?,
    };
    Ok(Other { name, per, role, extent, stored, single, values })
}

fn numbers<T: Scalar, R: Read + Seek>(source: &mut Bytes<R>, bytes: u64, name: &str) -> Result<Vec<T>> {
    let size = size_of::<T>() as u64;
    if !bytes.is_multiple_of(size) {
        return Err(Error::new(format!("attribute {name}: {bytes} bytes are not whole numbers of {size}")));
    }
    source.array((bytes / size) as usize, name)
}

/// Words, each behind the number of its bytes.
fn words<R: Read + Seek>(source: &mut Bytes<R>, bytes: u64, name: &str) -> Result<Vec<String>> {
    let text: Vec<u8> = source.array(bytes as usize, name)?;
    let damaged = || Error::new(format!("attribute {name}: its words do not fill their block: the file is damaged"));
    let mut all = Vec::new();
    let mut rest = &text[..];
    while !rest.is_empty() {
        let (length, after) = rest.split_first_chunk::<4>().ok_or_else(damaged)?;
        let (word, after) = after.split_at_checked(u32::from_le_bytes(*length) as usize).ok_or_else(damaged)?;
        all.push(std::str::from_utf8(word).map_err(|_| damaged())?.to_owned());
        rest = after;
    }
    Ok(all)
}
