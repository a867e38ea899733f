//! Attributes that are only passed on, in the types of their source wherever USD has these.

use half::f16;
use nabiki::hair::{Other, Per, Role, Stored, Values};
use nabiki_exchange::attributes::type_change;

use crate::content::primvar;
use crate::layer::{Attribute, Value};
use crate::primvars::{Kind, kind};

/// Types of numbers with a fraction: what they stand for, how many make a value, in half, single and double precision.
const TYPES: [(Role, usize, [&str; 3]); 11] = [
    (Role::Plain, 1, ["half[]", "float[]", "double[]"]),
    (Role::Plain, 2, ["half2[]", "float2[]", "double2[]"]),
    (Role::Plain, 3, ["half3[]", "float3[]", "double3[]"]),
    (Role::Plain, 4, ["half4[]", "float4[]", "double4[]"]),
    (Role::Colour, 3, ["color3h[]", "color3f[]", "color3d[]"]),
    (Role::Colour, 4, ["color4h[]", "color4f[]", "color4d[]"]),
    (Role::Point, 3, ["point3h[]", "point3f[]", "point3d[]"]),
    (Role::Vector, 3, ["vector3h[]", "vector3f[]", "vector3d[]"]),
    (Role::Normal, 3, ["normal3h[]", "normal3f[]", "normal3d[]"]),
    (Role::TextureCoordinate, 2, ["texCoord2h[]", "texCoord2f[]", "texCoord2d[]"]),
    (Role::TextureCoordinate, 3, ["texCoord3h[]", "texCoord3f[]", "texCoord3d[]"]),
];

/// The attribute as a primvar; `None` for values of a shape that USD has no type for.
pub fn carried<S>(other: &Other) -> Option<Attribute<S>> {
    let (type_name, value) = typed(other)?;
    let interpolation = match other.per {
        Per::Groom => "constant",
        Per::Strand => "uniform",
        Per::Point => "vertex",
    };
    let name = primvar(&valid_name(&other.name));
    Some(match type_name.strip_suffix("[]").filter(|_| other.single) {
        Some(type_name) => Attribute::primvar(name, type_name, interpolation, Value::One(Box::new(value))),
        None => Attribute::primvar(name, type_name, interpolation, value),
    })
}

/// What a USD layer cannot keep of an attribute that is passed on, a phrase each.
pub fn changes(other: &Other) -> Vec<String> {
    let Some((type_name, _)) = typed(other) else {
        return vec![format!("{}: USD has no type for its values", other.name)];
    };
    let name = valid_name(&other.name);
    let mut changes = Vec::new();
    if name != other.name {
        changes.push(format!("the name {}: it is {name} there", other.name));
    }
    if let Some(Kind { stored, role, .. }) = kind(type_name.trim_end_matches("[]")) {
        changes.extend(type_change(other, stored, role));
    }
    changes
}

/// The name with what USD allows in one: letters, digits, underscores, and colons between.
fn valid_name(name: &str) -> String {
    let mut valid: String =
        name.chars().map(|c| if c.is_ascii_alphanumeric() || matches!(c, '_' | ':') { c } else { '_' }).collect();
    if valid.starts_with(|c: char| c.is_ascii_digit()) {
        valid.insert(0, '_');
    }
    valid
}

/// The type of the values as a list, and these.
fn typed(other: &Other) -> Option<(&'static str, Value)> {
    match &other.values {
        Values::Floats(v) => floats(other, v),
        Values::Doubles(v) => {
            let type_name = matrix(other).or(fractions(other, 2))?;
            Some((type_name, Value::DoubleTuples(other.extent, v.clone())))
        }
        Values::Integers(v) if other.extent == 1 => Some(integers(other.stored, v)),
        Values::Integers(v) => {
            let type_name = *["int2[]", "int3[]", "int4[]"].get(other.extent.checked_sub(2)?)?;
            Some((type_name, Value::IntTuples(other.extent, all(v)?)))
        }
        Values::Words(v) if other.extent == 1 => Some(match other.stored {
            Stored::Token => ("token[]", Value::Tokens(v.clone())),
            _ => ("string[]", Value::Texts(v.clone())),
        }),
        Values::Words(_) => None,
    }
}

fn floats(other: &Other, v: &[f32]) -> Option<(&'static str, Value)> {
    // Matrices are of doubles only.
    if let Some(type_name) = matrix(other) {
        return Some((type_name, Value::DoubleTuples(other.extent, v.iter().copied().map(f64::from).collect())));
    }
    if other.stored == Stored::F16 {
        let halves = v.iter().copied().map(f16::from_f32).collect();
        return Some((fractions(other, 0)?, Value::HalfTuples(other.extent, halves)));
    }
    Some((fractions(other, 1)?, Value::FloatTuples(other.extent, v.to_vec())))
}

fn matrix(other: &Other) -> Option<&'static str> {
    match (other.role, other.extent) {
        (Role::Plain, 9) => Some("matrix3d[]"),
        (Role::Plain, 16) => Some("matrix4d[]"),
        _ => None,
    }
}

/// The type of numbers with a fraction; of what has none of its own, that of plain ones.
fn fractions(other: &Other, precision: usize) -> Option<&'static str> {
    let of = |wanted: Role| TYPES.iter().find(|(role, extent, _)| (*role, *extent) == (wanted, other.extent));
    of(other.role).or_else(|| of(Role::Plain)).map(|(_, _, names)| names[precision])
}

/// Whole numbers as they were stored, if USD can and they still fit, or else in 32 or 64 bits.
fn integers(stored: Stored, v: &[i64]) -> (&'static str, Value) {
    let is_bool = || v.iter().all(|&x| x == 0 || x == 1);
    let as_stored = match stored {
        Stored::Bool if is_bool() => all(v).map(|v| ("bool[]", Value::Bools(v))),
        Stored::U8 => all(v).map(|v| ("uchar[]", Value::Bytes(v))),
        Stored::U32 => all(v).map(|v| ("uint[]", Value::Unsigned(v))),
        Stored::I64 => Some(("int64[]", Value::Longs(v.to_vec()))),
        Stored::U64 => Some(("uint64[]", Value::UnsignedLongs(v.iter().map(|x| x.cast_unsigned()).collect()))),
        _ => None,
    };
    as_stored
        .or_else(|| all(v).map(|v| ("int[]", Value::IntTuples(1, v))))
        .unwrap_or_else(|| ("int64[]", Value::Longs(v.to_vec())))
}

/// All numbers in a narrower kind, if it holds them.
fn all<T: TryFrom<i64>>(v: &[i64]) -> Option<Vec<T>> {
    v.iter().map(|&x| T::try_from(x).ok()).collect()
}
