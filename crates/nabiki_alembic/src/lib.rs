//! Hair in and out of Alembic archives.
//!
//! Written here rather than bound: no crate writes Alembic, and the C++ library would bring CMake, Imath and minutes of
//! build to a project whose default build needs the Rust toolchain only, for the sake of a container that takes 200
//! lines. The layout was learnt from archives that Alembic 1.8 writes, and the proof is that its own reader, Blender
//! and others open ours (`tests/interchange`). What is not written: HDF5 archives (obsolete since 2013), materials,
//! cameras, and all schemas but transform, curves and polygon mesh.

#![forbid(unsafe_code)]

mod attributes;
mod digest;
mod layout;
mod ogawa;
mod property;
mod read;
mod tree;
mod values;
mod write;

pub use nabiki_exchange::{Contents, Problem};
pub use read::ArchiveReader;
pub use write::HairArchive;
