//! Attributes that are only passed on, in the types of their source wherever USD has these.

use half::f16;
use nabiki::hair::{Other, Per, Role, Stored, Values};
use nabiki_exchange::attributes::{renamed, type_change, unique_names};

use crate::layer::{Attribute, Value, primvar};
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

/// The attributes as primvars, but for values of a shape that USD has no type for.
pub fn carried<S>(others: &[Other]) -> Vec<Attribute<S>> {
    let named = others.iter().zip(names(others));
    named.filter_map(|(other, name)| primvar_of(other, &name)).collect()
}

fn primvar_of<S>(other: &Other, name: &str) -> Option<Attribute<S>> {
    let (type_name, value) = typed(other)?;
    let interpolation = match other.per {
        Per::Groom => "constant",
        Per::Strand => "uniform",
        Per::Point => "vertex",
    };
    let name = primvar(name);
    Some(match type_name.strip_suffix("[]").filter(|_| other.single) {
        Some(type_name) => Attribute::primvar(name, type_name, interpolation, Value::One(Box::new(value))),
        None => Attribute::primvar(name, type_name, interpolation, value),
    })
}

/// What a USD layer cannot keep of attributes that are passed on, a phrase each.
pub fn changes(others: &[Other]) -> Vec<String> {
    others.iter().zip(names(others)).flat_map(|(other, name)| changes_of(other, &name)).collect()
}

fn changes_of(other: &Other, name: &str) -> Vec<String> {
    let Some((type_name, _)) = typed(other) else {
        return vec![format!("{}: USD has no type for its values", other.name)];
    };
    let mut changes = Vec::new();
    if name != other.name {
        changes.push(renamed(&other.name, name));
    }
    if let Some(Kind { stored, role, .. }) = kind(type_name.trim_end_matches("[]")) {
        changes.extend(type_change(other, stored, role));
    }
    changes
}

/// The names of attributes as a layer has them: those that USD allows as they are, others as near to them as it allows.
fn names(others: &[Other]) -> Vec<String> {
    unique_names(others, valid_name, &RESERVED)
}

/// Names under which the layer has what hair has a place for.
const RESERVED: [&str; 16] = [
    "displayColor",
    "displayOpacity",
    "transparency",
    "st",
    "groom_root_uv",
    "surface_uv_coordinate",
    "groom_id",
    "groom_group_id",
    "groom_group_name",
    "groom_guide",
    "point_uv",
    "freedom",
    "width",
    "widths",
    "rest",
    "indices",
];

/// The name with what USD allows in one: identifiers as Unicode has them (XID), with colons between. One that ends with
/// `:indices` would be taken for the indices of another.
fn valid_name(name: &str) -> String {
    let identifier = |part: &str| {
        let continues = |c: char| if c == '_' || unicode_ident::is_xid_continue(c) { c } else { '_' };
        let valid: String = part.chars().map(continues).collect();
        let begins = valid.starts_with(|c: char| c == '_' || unicode_ident::is_xid_start(c));
        if begins { valid } else { format!("_{valid}") }
    };
    let parts: Vec<String> = name.split(':').filter(|part| !part.is_empty()).map(identifier).collect();
    match &*parts.join(":") {
        "" => "_".to_owned(),
        name if name.ends_with(":indices") => format!("{name}_"),
        name => name.to_owned(),
    }
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_what_usd_allows_and_each_stands_once() {
        let one = |name: &str| Other::new(name, Per::Groom, Role::Plain, 1, Values::Floats(vec![1.0]));
        let named = |names_of: &[&str]| names(&names_of.iter().map(|name| one(name)).collect::<Vec<_>>());
        // Those that are allowed are kept, whichever comes first.
        assert_eq!(named(&["a b", "a_b", "a-b", "a b"]), ["a_b_2", "a_b", "a_b_3", "a_b_4"]);
        assert_eq!(named(&["髪", "é:髪", "a·b", "名 前"]), ["髪", "é:髪", "a·b", "名_前"]);
        assert_eq!(named(&["ns::a", "ns:a", ":a", "a:", "a", "::"]), ["ns:a_2", "ns:a", "a_2", "a_3", "a", "_"]);
        assert_eq!(named(&["", "1a", "a:1", "_", "a:indices"]), ["__2", "_1a", "a:_1", "_", "a:indices_"]);
        // Nor does one take the place of what the layer says by itself.
        assert_eq!(named(&["groom id", "a\u{1b}\"'.b"]), ["groom_id_2", "a____b"]);
        let long = "n".repeat(5000);
        let found = named(&[&long, &format!("{long}x")]);
        assert!(found.iter().all(|name| name.len() <= 1010) && found[0] != found[1]);
        assert_eq!(changes(&[one("a b"), one("a_b")]), ["the name \"a b\": it becomes a_b_2"]);
    }
}
