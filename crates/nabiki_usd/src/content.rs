//! The prims of a groom: the same for text and for binary layers.

use glam::Vec3;
use nabiki::Mesh;
use nabiki::hair::{Attributes, Other, Per, Role, Values};
use nabiki::strands::bounds;
use nabiki_exchange::Export;
use nabiki_exchange::attributes::names;

use crate::layer::{Attribute, Prim, Value};

/// The moving curves without their samples: topology, and everything that does not move.
pub fn curves<S>(export: &Export<'_>, name: &str) -> Prim<S> {
    let strands = &export.hair.strands;
    let at = &export.hair.attributes;
    let counts = strands.iter().map(|s| s.len() as i32).collect();
    let rest = export.rest_points();
    let mut attributes = vec![
        // Readers take curves without a type for cubic ones.
        Attribute::uniform("type", "token", Value::Token("linear".to_owned())),
        Attribute::uniform("wrap", "token", Value::Token("nonperiodic".to_owned())),
        Attribute::new("curveVertexCounts", "int[]", Value::Ints(counts)),
        Attribute::new("points", "point3f[]", Value::Triples(rest.clone())),
    ];
    if let Some(widths) = export.widths() {
        attributes.push(Attribute::primvar("widths", "float[]", "vertex", Value::Floats(widths)));
    }
    appearance(export, &mut attributes);
    roots(at, &mut attributes);
    if export.rest {
        attributes.push(Attribute::primvar(primvar(names::REST), "point3f[]", "vertex", Value::Triples(rest)));
    }
    if let Some(uv) = &at.point_uv {
        let value = Value::Pairs(uv.clone());
        attributes.push(Attribute::primvar("primvars:point_uv", "texCoord2f[]", "vertex", value));
    }
    if let Some(freedom) = &at.inverse_mass {
        let value = Value::Floats(freedom.clone());
        attributes.push(Attribute::primvar("primvars:freedom", "float[]", "vertex", value));
    }
    // What was carried along goes before what is made here under the same name.
    let carried: Vec<Attribute<S>> = at.other.iter().filter_map(carried).collect();
    attributes.retain(|made| carried.iter().all(|c| c.name != made.name));
    attributes.extend(carried);
    Prim { name: name.to_owned(), type_name: "BasisCurves", attributes, children: Vec::new() }
}

/// Colours and transparencies.
fn appearance<S>(export: &Export<'_>, attributes: &mut Vec<Attribute<S>>) {
    let at = &export.hair.attributes;
    if let Some(color) = &at.colour {
        let value = Value::Triples(color.clone());
        attributes.push(Attribute::primvar("primvars:displayColor", "color3f[]", "vertex", value));
    } else if let Some(color) = at.constant.colour.or(export.default_colour) {
        let value = Value::Triples(vec![color]);
        attributes.push(Attribute::primvar("primvars:displayColor", "color3f[]", "constant", value));
    }
    if let Some(transparency) = export.transparency() {
        let opacity = transparency.iter().map(|t| 1.0 - t).collect();
        attributes.push(Attribute::primvar("primvars:displayOpacity", "float[]", "vertex", Value::Floats(opacity)));
        // The subtraction above rounds; this comes back to the bit.
        let value = Value::Floats(transparency);
        attributes.push(Attribute::primvar("primvars:transparency", "float[]", "vertex", value));
    }
}

/// What strands have one of each: UVs of their roots, ids, groups, guides.
fn roots<S>(at: &Attributes, attributes: &mut Vec<Attribute<S>>) {
    let mut by_strand = |name: &str, type_name: &'static str, value: Value| {
        attributes.push(Attribute::primvar(primvar(name), type_name, "uniform", value));
    };
    if let Some(uv) = &at.root_uv {
        for name in ["st", "groom_root_uv"] {
            by_strand(name, "texCoord2f[]", Value::Pairs(uv.clone()));
        }
        // Blender's own name, and its own type for it.
        by_strand("surface_uv_coordinate", "float2[]", Value::Pairs(uv.clone()));
    }
    if let Some(ids) = &at.id {
        match ids.iter().map(|&id| i32::try_from(id)).collect::<Result<Vec<_>, _>>() {
            Ok(ids) => by_strand("groom_id", "int[]", Value::Ints(ids)),
            Err(_) => by_strand("groom_id", "int64[]", Value::Longs(ids.clone())),
        }
    }
    if let Some(groups) = &at.group {
        by_strand("groom_group_id", "int[]", Value::Ints(groups.clone()));
        if !at.group_names.is_empty() {
            let names = groups.iter().map(|g| at.group_names.get(g).cloned().unwrap_or_default()).collect();
            by_strand("groom_group_name", "string[]", Value::Texts(names));
        }
    }
    if let Some(guides) = &at.guide {
        by_strand("groom_guide", "int[]", Value::Ints(guides.iter().map(|&g| i32::from(g)).collect()));
    }
}

fn primvar(name: &str) -> String {
    format!("primvars:{name}")
}

/// An attribute that is only passed on; `None` for values of a shape that USD has no type for.
fn carried<S>(other: &Other) -> Option<Attribute<S>> {
    let (type_name, value) = typed(other)?;
    let interpolation = match other.per {
        Per::Groom => "constant",
        Per::Strand => "uniform",
        Per::Point => "vertex",
    };
    Some(Attribute::primvar(primvar(&valid_name(&other.name)), type_name, interpolation, value))
}

/// The name with what USD allows in one: letters, digits, underscores, and colons between.
pub fn valid_name(name: &str) -> String {
    let mut valid: String =
        name.chars().map(|c| if c.is_ascii_alphanumeric() || matches!(c, '_' | ':') { c } else { '_' }).collect();
    if valid.starts_with(|c: char| c.is_ascii_digit()) {
        valid.insert(0, '_');
    }
    valid
}

/// Whether USD has a type for values of this shape.
pub fn has_type(other: &Other) -> bool {
    typed(other).is_some()
}

fn typed(other: &Other) -> Option<(&'static str, Value)> {
    use Role::{Colour, Normal, Plain, Point, TextureCoordinate, Vector};
    Some(match (&other.values, other.role, other.extent) {
        (Values::Floats(v), role, extent) => {
            let type_name = match (role, extent) {
                (_, 1) => "float[]",
                (TextureCoordinate, 2) => "texCoord2f[]",
                (TextureCoordinate, 3) => "texCoord3f[]",
                (Colour, 3) => "color3f[]",
                (Colour, 4) => "color4f[]",
                (Point, 3) => "point3f[]",
                (Vector, 3) => "vector3f[]",
                (Normal, 3) => "normal3f[]",
                (_, 2) => "float2[]",
                (_, 3) => "float3[]",
                (_, 4) => "float4[]",
                (Plain, 9 | 16) => {
                    let v = v.iter().copied().map(f64::from).collect();
                    return Some((
                        if extent == 9 { "matrix3d[]" } else { "matrix4d[]" },
                        Value::DoubleTuples(extent, v),
                    ));
                }
                _ => return None,
            };
            (type_name, Value::FloatTuples(extent, v.clone()))
        }
        (Values::Doubles(v), role, extent) => {
            let type_name = match (role, extent) {
                (_, 1) => "double[]",
                (TextureCoordinate, 2) => "texCoord2d[]",
                (TextureCoordinate, 3) => "texCoord3d[]",
                (Colour, 3) => "color3d[]",
                (Colour, 4) => "color4d[]",
                (Point, 3) => "point3d[]",
                (Vector, 3) => "vector3d[]",
                (Normal, 3) => "normal3d[]",
                (_, 2) => "double2[]",
                (_, 3) => "double3[]",
                (_, 4) => "double4[]",
                (_, 9) => "matrix3d[]",
                (_, 16) => "matrix4d[]",
                _ => return None,
            };
            (type_name, Value::DoubleTuples(extent, v.clone()))
        }
        (Values::Integers(v), _, extent @ 1..=4) => match v.iter().map(|&x| i32::try_from(x)).collect() {
            Ok(v) => (["int[]", "int2[]", "int3[]", "int4[]"][extent - 1], Value::IntTuples(extent, v)),
            Err(_) if extent == 1 => ("int64[]", Value::Longs(v.clone())),
            Err(_) => return None,
        },
        (Values::Words(v), _, 1) => ("string[]", Value::Texts(v.clone())),
        _ => return None,
    })
}

/// The head.
pub fn skin<S>(mesh: &Mesh, export: &Export<'_>) -> Prim<S> {
    let points: Vec<Vec3> = mesh.positions.iter().map(|&p| export.file_from_head.transform_point3(p)).collect();
    let mirrored = export.file_from_head.matrix3.determinant() < 0.0;
    let corners = mesh.triangles.iter().flat_map(|&[a, b, c]| if mirrored { [c, b, a] } else { [a, b, c] });
    let attributes = vec![
        Attribute::uniform("subdivisionScheme", "token", Value::Token("none".to_owned())),
        Attribute::new("faceVertexCounts", "int[]", Value::Ints(vec![3; mesh.triangles.len()])),
        Attribute::new("faceVertexIndices", "int[]", Value::Ints(corners.map(|v| v as i32).collect())),
        Attribute::new("extent", "float3[]", Value::Triples(extent(&points, 0.0))),
        Attribute::new("points", "point3f[]", Value::Triples(points.iter().map(|p| p.to_array()).collect())),
    ];
    Prim { name: "skin".to_owned(), type_name: "Mesh", attributes, children: Vec::new() }
}

/// The lowest and highest corner of the points' box, widened by `margin` on all sides.
pub fn extent(points: &[Vec3], margin: f32) -> Vec<[f32; 3]> {
    let [low, high] = bounds(points);
    vec![(low - margin).to_array(), (high + margin).to_array()]
}
