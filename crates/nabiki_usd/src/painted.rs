//! Primvars of meshes that may be painted weights or vertex colours.

use nabiki::Mesh;
use nabiki::hair::Stored;
use nabiki_exchange::attributes::NamedValues;
use nabiki_exchange::{Canvas, Painted, PaintedOn};

use crate::Problem;
use crate::opened::Layer;
use crate::primvars::{Kind, Primvars, kind};

/// Adds the numbers and colours of a mesh's vertices or corners at a time code to `mesh`, whose vertices from `first` on they
/// belong to. The answer says what is left out, a phrase each. Values for faces or for the whole mesh are not read.
pub fn add(
    layer: &mut Layer,
    prim: usize,
    time: f64,
    canvas: Canvas<'_>,
    (mesh, first): (&mut Mesh, usize),
) -> Vec<String> {
    let path = layer.path(prim);
    let mut primvars = Primvars { layer, prim, time, frame: 0, is_bound: true };
    let mut names = primvars.names();
    names.sort_unstable();
    let mut left_out = Vec::new();
    for name in names {
        let added = painted(&mut primvars, &name, canvas).and_then(|painted| match painted {
            Some(painted) => painted.add_to(mesh, first, primvars.budget()),
            None => Ok(()),
        });
        // It costs itself and not the mesh.
        left_out.extend(added.err().map(|why| format!("{name} of {path}: {why}")));
    }
    left_out
}

fn painted(primvars: &mut Primvars<'_>, name: &str, canvas: Canvas<'_>) -> Result<Option<Painted>, Problem> {
    let whole = format!("primvars:{name}");
    let Some(attribute) = primvars.layer.prims[primvars.prim].attributes.get(whole.as_str()) else { return Ok(None) };
    let Some(Kind { stored, role, extent }) = kind(&attribute.type_name) else { return Ok(None) };
    if matches!(stored, Stored::Text | Stored::Token) || !Painted::may_be(role, extent) {
        return Ok(None);
    }
    let on = match primvars.layer.interpolation(primvars.prim, &whole)?.as_deref() {
        Some("vertex" | "varying") => PaintedOn::Vertices,
        Some("faceVarying") => PaintedOn::Corners,
        _ => return Ok(None),
    };
    if let Some(why) = primvars.misindexed(name)? {
        return Err(Problem::new(why));
    }
    let Some(whatever) = primvars.whatever(name)? else { return Ok(None) };
    Painted::of(name, &whatever, on, canvas, primvars.budget())
}
