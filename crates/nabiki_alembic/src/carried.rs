//! Attributes that are only passed on, as the kinds of numbers in which their source stores them.

use half::f16;
use nabiki::hair::{Other, Per, Role, Stored, Values};
use nabiki_exchange::attributes::{renamed, type_change, unique_names};

use crate::layout::{Kind, pod, stored};
use crate::property::Property;

/// What an archive cannot keep of attributes that are passed on, a phrase each.
pub fn changes(others: &[Other]) -> Vec<String> {
    let named = others.iter().zip(names(others));
    let renamed = |(other, name): (&Other, String)| (name != other.name).then(|| renamed(&other.name, &name));
    let renamed: Vec<String> = named.filter_map(renamed).collect();
    others.iter().flat_map(changes_of).chain(renamed).collect()
}

/// The names of attributes as an archive has them, each once.
pub fn names(others: &[Other]) -> Vec<String> {
    // What a path is made of is no part of a name.
    let valid = |name: &str| match name {
        "" => "_".to_owned(),
        name => name.replace(['/', '\0'], "_"),
    };
    unique_names(others, valid, &RESERVED)
}

/// Names under which the archive has what hair has a place for, and those of its schemas.
const RESERVED: [&str; 16] = [
    "P",
    "uv",
    "width",
    "groom_color",
    "point_uv",
    "transparency",
    "freedom",
    "rest",
    "groom_root_uv",
    "surface_uv_coordinate",
    "groom_id",
    "id",
    "groom_group_id",
    "groom_group_name",
    "groom_guide",
    "nVertices",
];

fn changes_of(other: &Other) -> Vec<String> {
    if extent(other).is_none() {
        let most = u8::MAX;
        return vec![format!("{}: {} numbers per value, but Alembic allows 1 to {most}", other.name, other.extent)];
    }
    let list = (other.per == Per::Groom && !other.single && other.values.len() == other.extent)
        .then(|| format!("{} as a list of one value: it becomes that value", other.name));
    // Of two numbers, texture coordinates are vectors, and of others the other way round.
    let role = match (other.role, other.extent) {
        (Role::Vector, 2) => Role::TextureCoordinate,
        (Role::TextureCoordinate, extent) if extent != 2 => Role::Vector,
        (role, _) => role,
    };
    let role =
        (role != other.role).then(|| format!("the meaning of the numbers of {}: they become vectors", other.name));
    type_change(other, stored(pod(kept(other))), other.role).into_iter().chain(role).chain(list).collect()
}

/// How many numbers make a value, where a header has room for it.
fn extent(other: &Other) -> Option<u8> {
    u8::try_from(other.extent).ok().filter(|&extent| extent > 0)
}

/// The property of a name that holds it, without its value; `None` for values of more numbers than a property has.
pub fn property(other: &Other, name: &str) -> Option<Property> {
    let scope = match other.per {
        Per::Groom => "con",
        Per::Strand => "uni",
        Per::Point => "vtx",
    };
    let interpretation = match (other.role, other.extent) {
        (Role::Plain, _) => "",
        (Role::Colour, 4) => "rgba",
        (Role::Colour, _) => "rgb",
        (Role::Point, _) => "point",
        (Role::Vector | Role::TextureCoordinate, _) => "vector",
        (Role::Normal, _) => "normal",
    };
    let kind = Kind { pod: pod(kept(other)), extent: extent(other)? };
    Some(Property::attribute(name, scope, interpretation, kind, 0))
}

/// How its values are written: as they were stored, where they still fit.
fn kept(other: &Other) -> Stored {
    let within = |low: i64, high: i64| match &other.values {
        Values::Integers(v) => v.iter().all(|x| (low..=high).contains(x)),
        _ => false,
    };
    let fits = match (other.stored, &other.values) {
        (Stored::Bool, _) => within(0, 1),
        (Stored::I8, _) => within(i8::MIN.into(), i8::MAX.into()),
        (Stored::U8, _) => within(0, u8::MAX.into()),
        (Stored::I16, _) => within(i16::MIN.into(), i16::MAX.into()),
        (Stored::U16, _) => within(0, u16::MAX.into()),
        (Stored::I32, _) => within(i32::MIN.into(), i32::MAX.into()),
        (Stored::U32, _) => within(0, u32::MAX.into()),
        (Stored::I64 | Stored::U64, values) => matches!(values, Values::Integers(_)),
        (Stored::F16 | Stored::F32, values) => matches!(values, Values::Floats(_)),
        (Stored::F64, values) => matches!(values, Values::Doubles(_)),
        (Stored::Text | Stored::Token, values) => matches!(values, Values::Words(_)),
    };
    if fits { other.stored } else { Stored::of(&other.values) }
}

/// The bytes of its values.
pub fn bytes(other: &Other) -> Vec<u8> {
    match &other.values {
        Values::Floats(v) if kept(other) == Stored::F16 => {
            v.iter().flat_map(|&x| f16::from_f32(x).to_le_bytes()).collect()
        }
        Values::Floats(v) => bytemuck::cast_slice(v).to_vec(),
        Values::Doubles(v) => bytemuck::cast_slice(v).to_vec(),
        // The low bytes of a number that fits into them are that number.
        Values::Integers(v) => {
            let size = pod(kept(other)).size();
            v.iter().flat_map(|x| x.to_le_bytes().into_iter().take(size)).collect()
        }
        Values::Words(v) => v.iter().flat_map(|word| (word.replace('\0', "") + "\0").into_bytes()).collect(),
    }
}
