//! What a prim is by the prims above it, worked out once for all: thousands may stand below one deep path.

use crate::source::PrimInfo;

/// What a prim is by those above it.
#[derive(Clone, Copy, Debug, Default)]
pub struct Standing {
    /// Whether neither it nor any above it is inactive or a class.
    pub is_active: bool,
    /// Whether it is active, and neither it nor any above it an `over`.
    pub is_defined: bool,
    /// The nearest point instancer above it.
    pub instancer: Option<usize>,
    /// Bytes of its path.
    pub path_bytes: u32,
    /// Samples over time of the transforms of it and all above it.
    pub moves: usize,
    /// Whether it has transforms of its own that move.
    pub moves_itself: bool,
    /// Whether it has primvars or relationships, which are said of all below it.
    pub says: bool,
}

impl Standing {
    /// That of all prims, parents before their children.
    pub fn of_all(prims: &[PrimInfo]) -> Vec<Self> {
        let mut all: Vec<Self> = Vec::with_capacity(prims.len());
        for prim in prims {
            let (above, of_above) = match prim.parent {
                Some(parent) => (all[parent], Some(parent)),
                None => (Self { is_active: true, is_defined: true, ..Self::default() }, None),
            };
            let is_instancer = |&parent: &usize| prims[parent].type_name == "PointInstancer";
            let named = |name: &str| prim.is_transformable() && name.starts_with("xformOp:");
            let operations = prim.attributes.iter().filter(|(name, _)| named(name));
            let moves: usize = operations.map(|(_, operation)| operation.samples.len()).sum();
            let is_active = above.is_active && !prim.is_off_stage;
            all.push(Self {
                is_active,
                is_defined: is_active && above.is_defined && !prim.is_over,
                instancer: of_above.filter(is_instancer).or(above.instancer),
                path_bytes: above.path_bytes.saturating_add(prim.name.len() as u32 + 1),
                moves: above.moves + moves,
                moves_itself: moves > 0,
                says: !prim.relationships.is_empty()
                    || prim.attributes.keys().any(|name| name.starts_with("primvars:")),
            });
        }
        all
    }
}
