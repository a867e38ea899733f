//! Hair in and out of Alembic archives.
//!
//! Written here rather than bound: no crate writes Alembic, and the C++ library would bring CMake, Imath and minutes of
//! build to a project whose default build needs the Rust toolchain only, for the sake of a container that takes 200
//! lines. The layout was learnt from archives that Alembic 1.8 writes, and the proof is that its own reader, Blender
//! and others open ours (`tests/interchange`). What is not written: HDF5 archives (obsolete since 2013), materials,
//! cameras, and all schemas but transform, curves and polygon mesh. Of subdivision surfaces the cage is read.
//!
//! ```
//! use glam::{DAffine3, Vec3};
//! use nabiki::{Hair, Strands};
//! use nabiki_exchange::{Export, FrameSink, GroomReader, Problem};
//! use nabiki_alembic::{ArchiveReader, HairArchive};
//!
//! fn main() -> Result<(), Problem> {
//!     let mut strands = Strands::default();
//!     strands.push([Vec3::ZERO, Vec3::Y, 2.0 * Vec3::Y]);
//!     let hair = Hair::from(strands);
//!     let path = std::env::temp_dir().join(format!("nabiki_alembic_{}.abc", std::process::id()));
//!     let mut file = Box::new(HairArchive::create(&path, Export::new(&hair, 24.0))?);
//!     file.frame(&hair.strands, &DAffine3::IDENTITY)?;
//!     file.finish()?;
//!     let read = ArchiveReader::open(&path)?.hair(0, None)?;
//!     assert_eq!(read.strands, hair.strands);
//!     Ok(std::fs::remove_file(&path)?)
//! }
//! ```

#![forbid(unsafe_code)]

mod attributes;
mod carried;
mod curves;
mod digest;
mod layout;
mod meshes;
mod ogawa;
mod property;
mod read;
mod schemas;
mod shown;
mod tree;
mod values;
mod write;

pub use carried::changes;
pub use nabiki_exchange::{Contents, Problem};
pub use read::ArchiveReader;
pub use write::HairArchive;
