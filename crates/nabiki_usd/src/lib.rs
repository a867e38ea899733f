//! Hair in and out of USD layers.
//!
//! Text and binary layers are written and read by this crate itself. The one Rust crate that does both, `openusd`,
//! takes 200 s to build on two cores and keeps a layer in memory, where a hundred frames of hair are half a gigabyte;
//! what is needed of the format is small. Layers are not composed: references, payloads, sublayers and variants must
//! be flattened first (`usdcat --flatten`).
//!
//! ```
//! use glam::{DAffine3, Vec3};
//! use nabiki::{Hair, Strands};
//! use nabiki_exchange::{Export, FrameSink, GroomReader, Problem};
//! use nabiki_usd::{LayerKind, HairStage, StageReader};
//!
//! fn main() -> Result<(), Problem> {
//!     let mut strands = Strands::default();
//!     strands.push([Vec3::ZERO, Vec3::Y, 2.0 * Vec3::Y]);
//!     let hair = Hair::from(strands);
//!     let path = std::env::temp_dir().join(format!("nabiki_usd_{}.usdc", std::process::id()));
//!     let mut file = Box::new(HairStage::create(&path, Export::new(&hair, 24.0), LayerKind::Stage)?);
//!     file.frame(&hair.strands, &DAffine3::IDENTITY)?;
//!     file.finish()?;
//!     let read = StageReader::open(&path)?.hair(0, None)?;
//!     assert_eq!(read.strands, hair.strands);
//!     Ok(std::fs::remove_file(&path)?)
//! }
//! ```

#![forbid(unsafe_code)]

mod arcs;
mod bending;
mod blend;
mod carried;
mod content;
mod crate_file;
mod instances;
mod layer;
mod meshes;
mod opened;
mod painted;
mod primvars;
mod read;
mod rig;
mod shown;
mod skeleton;
mod skin;
mod source;
mod stance;
mod standing;
mod text;
mod timing;
mod transform;
mod write;

pub use carried::changes;
pub use nabiki_exchange::{Contents, Problem};
pub use read::StageReader;
pub use source::Source;
pub use text::write::text_bytes;
pub use write::{HairStage, LayerKind};
