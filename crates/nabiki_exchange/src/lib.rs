//! What the formats that exchange grooms between programs share, apart from how each is stored.
//!
//! [`curves`] turns curves into strands, [`attributes`] knows the names by which programs call what curves carry,
//! [`Gathered`] joins curves of several objects, [`export`] is what a writer of moving hair is told, and
//! [`GroomReader`] what a reader answers.

#![forbid(unsafe_code)]

pub mod attributes;
pub mod curves;
pub mod export;
mod gather;
mod in_place;
mod polygons;
mod reader;

pub use export::{Export, FrameSink, Velocities};
pub use gather::Gathered;
pub use in_place::InPlace;
pub use nabiki::error::Problem;
pub use polygons::{Polygons, Uvs, add_polygons};
pub use reader::{Contents, GroomReader, Placed, Prim, PrimKind};
