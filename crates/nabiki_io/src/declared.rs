//! What a file says itself of the space of its coordinates.

use crate::axis::Axis;
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
