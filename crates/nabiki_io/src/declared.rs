//! What a file says itself of the space of its coordinates.

use std::path::Path;

use crate::axis::Axis;
use crate::error::Result;
use crate::exchange;
use crate::kind::extension;
use crate::unit::Unit;

/// Unit and up axis that a file declares; `None` where it says nothing.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct DeclaredSpace {
    /// Length unit.
    pub unit: Option<Unit>,
    /// Axis that points up.
    pub up: Option<Axis>,
}

impl DeclaredSpace {
    /// glTF 2.0, section 3.4: metres, +y up.
    pub const GLTF: Self = Self { unit: Some(Unit { cm: 100.0 }), up: Some(Axis::PlusY) };
}

/// What the file says, or its format for it: glTF is in metres, +y up; a USD layer names both; Alembic is +y up by
/// agreement and names no unit; other formats say nothing.
///
/// # Errors
/// A layer that cannot be read; a unit or an axis that is none.
pub fn declared_space(path: &Path) -> Result<DeclaredSpace> {
    if matches!(extension(path).as_str(), "glb" | "gltf") {
        return Ok(DeclaredSpace::GLTF);
    }
    exchange::declared_space(path)
}
