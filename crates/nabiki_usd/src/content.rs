//! The prims of a groom: the same for text and for binary layers.

use glam::Vec3;
use nabiki::Mesh;
use nabiki::export::Export;
use nabiki::strands::bounds;

use crate::layer::{Attribute, Prim, Value};

/// The moving curves without their samples: topology, and everything that does not move.
pub fn curves<S>(export: &Export<'_>, name: &str) -> Prim<S> {
    let strands = &export.hair.strands;
    let at = &export.hair.attributes;
    let counts = strands.iter().map(|s| s.len() as i32).collect();
    let rest: Vec<[f32; 3]> =
        strands.points().iter().map(|&p| export.file_from_head.transform_point3(p).to_array()).collect();
    let mut attributes = vec![
        // Readers take curves without a type for cubic ones.
        Attribute::uniform("type", "token", Value::Token("linear".to_owned())),
        Attribute::uniform("wrap", "token", Value::Token("nonperiodic".to_owned())),
        Attribute::new("curveVertexCounts", "int[]", Value::Ints(counts)),
        Attribute::new("points", "point3f[]", Value::Triples(rest)),
    ];
    if let Some(widths) = export.widths() {
        attributes.push(Attribute::primvar("widths", "float[]", "vertex", Value::Floats(widths)));
    }
    if let Some(color) = &at.color {
        let value = Value::Triples(color.clone());
        attributes.push(Attribute::primvar("primvars:displayColor", "color3f[]", "vertex", value));
    } else if let Some(color) = at.constant.color {
        let value = Value::Triples(vec![color]);
        attributes.push(Attribute::primvar("primvars:displayColor", "color3f[]", "constant", value));
    }
    if let Some(uv) = &at.root_uv {
        let value = Value::Pairs(uv.clone());
        attributes.push(Attribute::primvar("primvars:st", "texCoord2f[]", "uniform", value.clone()));
        attributes.push(Attribute::primvar("primvars:groom_root_uv", "texCoord2f[]", "uniform", value));
    }
    if let Some(ids) = &at.id {
        let (kind, value) = match ids.iter().map(|&id| i32::try_from(id)).collect::<Result<Vec<_>, _>>() {
            Ok(ids) => ("int[]", Value::Ints(ids)),
            Err(_) => ("int64[]", Value::Longs(ids.clone())),
        };
        attributes.push(Attribute::primvar("primvars:groom_id", kind, "uniform", value));
    }
    if let Some(groups) = &at.group {
        let value = Value::Ints(groups.clone());
        attributes.push(Attribute::primvar("primvars:groom_group_id", "int[]", "uniform", value));
        if !at.group_names.is_empty() {
            let names = groups.iter().map(|g| at.group_names.get(g).cloned().unwrap_or_default()).collect();
            let value = Value::Texts(names);
            attributes.push(Attribute::primvar("primvars:groom_group_name", "string[]", "uniform", value));
        }
    }
    if let Some(guides) = &at.guide {
        let value = Value::Ints(guides.iter().map(|&g| i32::from(g)).collect());
        attributes.push(Attribute::primvar("primvars:groom_guide", "int[]", "uniform", value));
    }
    if let Some(uv) = &at.point_uv {
        let value = Value::Pairs(uv.clone());
        attributes.push(Attribute::primvar("primvars:point_uv", "texCoord2f[]", "vertex", value));
    }
    if let Some(transparency) = export.transparency() {
        let opacity = transparency.iter().map(|t| 1.0 - t).collect();
        attributes.push(Attribute::primvar("primvars:displayOpacity", "float[]", "vertex", Value::Floats(opacity)));
        // The subtraction above rounds; this comes back to the bit.
        let value = Value::Floats(transparency);
        attributes.push(Attribute::primvar("primvars:transparency", "float[]", "vertex", value));
    }
    if let Some(freedom) = &at.freedom {
        let value = Value::Floats(freedom.clone());
        attributes.push(Attribute::primvar("primvars:freedom", "float[]", "vertex", value));
    }
    Prim { name: name.to_owned(), type_name: "BasisCurves", attributes, children: Vec::new() }
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
