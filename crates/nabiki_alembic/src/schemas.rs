//! The schemas of shapes: which are read, and what the others are called.

use crate::tree::Object;

/// Schemas of shapes that are not read.
pub const NURBS_SURFACE: &str = "AbcGeom_NuPatch";
pub const POINTS: &str = "AbcGeom_Points";
/// What is read of shapes.
pub const READ: &str = "curves and meshes of polygons";

/// Whether an object is a mesh of polygons or a subdivision surface, which is taken as the cage that it is made from.
pub fn is_mesh(object: &Object) -> bool {
    ["AbcGeom_PolyMesh", "AbcGeom_SubD"].into_iter().any(|schema| object.is(schema))
}
