//! Colours and application-specific attributes of the vertices of a glTF primitive.

use gltf::Semantic;
use gltf::accessor::{Accessor, Dimensions};
use nabiki::Mesh;
use nabiki_exchange::Painted;

use crate::error::{Error, Result};
use crate::gltf_file::Buffers;
use crate::gltf_file::accessors::{Whole, numbers};

/// Adds those of the `count` vertices from `first` on. The answer names what is left out, and why: it costs itself and not the
/// mesh.
pub(super) fn add(
    primitive: &gltf::Primitive,
    buffers: &Buffers<'_>,
    mesh: &mut Mesh,
    first: usize,
    count: usize,
) -> Vec<(String, String)> {
    let mut left_out = Vec::new();
    for (semantic, accessor) in primitive.attributes() {
        let whole = match &semantic {
            Semantic::Colors(_) => Whole::Shares,
            Semantic::Extras(_) => Whole::AsSaid,
            _ => continue,
        };
        let name = semantic.to_string();
        let added = painted(&name, &accessor, buffers, whole, count).and_then(|painted| match painted {
            Some(painted) => painted.add_to(mesh, first, &buffers.budget).map_err(Error::from),
            None => Ok(()),
        });
        left_out.extend(added.err().map(|why| (format!("{name:.80}"), why.what)));
    }
    left_out
}

/// The numbers of an accessor; `None` for pairs and matrices.
fn painted(
    name: &str,
    accessor: &Accessor,
    buffers: &Buffers<'_>,
    whole: Whole,
    count: usize,
) -> Result<Option<Painted>> {
    let extent = match accessor.dimensions() {
        Dimensions::Scalar => 1,
        Dimensions::Vec3 => 3,
        Dimensions::Vec4 => 4,
        _ => return Ok(None),
    };
    if accessor.count() != count {
        return Err(Error::new(format!("{} for {count} vertices", accessor.count())));
    }
    let numbers = match extent {
        1 => numbers::<1>(accessor, buffers, whole, name)?.into_flattened(),
        3 => numbers::<3>(accessor, buffers, whole, name)?.into_flattened(),
        _ => numbers::<4>(accessor, buffers, whole, name)?.into_flattened(),
    };
    Ok(Some(Painted { name: name.to_owned(), extent, numbers }))
}
