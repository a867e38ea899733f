//! The unit and axes that a file declares.

use crate::axis::Axis;
use crate::unit::Unit;

/// Unit and up axis that a file declares; `None` if it does not.
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
