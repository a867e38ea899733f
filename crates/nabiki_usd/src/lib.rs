//! Hair in and out of USD layers.
//!
//! Text and binary layers are written and read by this crate itself. The one Rust crate that does both, `openusd`,
//! takes 200 s to build on two cores and keeps a layer in memory, where a hundred frames of hair are half a gigabyte;
//! what is needed of the format is small. Layers are not composed: references, payloads, sublayers and variants must
//! be flattened first (`usdcat --flatten`).

#![forbid(unsafe_code)]

mod content;
mod crate_file;
mod layer;
mod opened;
mod primvars;
mod read;
mod skeleton;
mod source;
mod text;
mod transform;
mod write;

pub use content::{has_type, valid_name};
pub use nabiki_exchange::{Contents, Problem};
pub use read::StageReader;
pub use source::Source;
pub use write::{Form, HairStage};
