//! The prims of a groom: the same for text and for binary layers.

use std::collections::HashSet;

use glam::Vec3;
use nabiki::Mesh;
use nabiki::hair::Attributes;
use nabiki::strands::bounds;
use nabiki_exchange::Export;
use nabiki_exchange::attributes::names;

use crate::carried::carried;
use crate::layer::{Attribute, Prim, Value, primvar};

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
    let carried: Vec<Attribute<S>> = carried(&at.other);
    let names: HashSet<&str> = carried.iter().map(|c| &*c.name).collect();
    attributes.retain(|made| !names.contains(&*made.name));
    attributes.extend(carried);
    Prim { name: name.to_owned(), type_name: "BasisCurves", schemas: &[], attributes, children: Vec::new() }
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

/// The head.
pub fn skin<S>(mesh: &Mesh, export: &Export<'_>) -> Prim<S> {
    let (points, mirrored) = export.skin(mesh);
    let corners = mesh.triangles.iter().flat_map(|&[a, b, c]| if mirrored { [c, b, a] } else { [a, b, c] });
    let mut attributes = vec![
        Attribute::uniform("subdivisionScheme", "token", Value::Token("none".to_owned())),
        Attribute::new("faceVertexCounts", "int[]", Value::Ints(vec![3; mesh.triangles.len()])),
        Attribute::new("faceVertexIndices", "int[]", Value::Ints(corners.map(|v| v as i32).collect())),
        Attribute::new("extent", "float3[]", Value::Triples(extent(&points, 0.0))),
        Attribute::new("points", "point3f[]", Value::Triples(points.iter().map(|p| p.to_array()).collect())),
    ];
    if let Some(uvs) = &mesh.corner_uvs {
        let corners = uvs.iter().flat_map(|&[a, b, c]| if mirrored { [c, b, a] } else { [a, b, c] });
        let value = Value::Pairs(corners.map(|uv| uv.to_array()).collect());
        attributes.push(Attribute::primvar(primvar("st"), "texCoord2f[]", "faceVarying", value));
    }
    Prim { name: "skin".to_owned(), type_name: "Mesh", schemas: &[], attributes, children: Vec::new() }
}

/// The lowest and highest corner of the points' box, widened by `margin` on all sides.
pub fn extent(points: &[Vec3], margin: f32) -> Vec<[f32; 3]> {
    let [low, high] = bounds(points);
    vec![(low - margin).to_array(), (high + margin).to_array()]
}
