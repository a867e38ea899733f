//! What goes in and out of Nabiki: hair, heads, motion of the head, motion caches. It knows no scene and no picture.

#![forbid(unsafe_code)]

mod atomic;
mod bytes;
pub mod cache;
pub mod error;
pub mod exchange;
mod finite;
pub mod hair;
pub mod hair_file;
pub mod identity;
pub mod info;
pub mod mesh;
pub mod motion;
pub mod names;
pub mod obj_lines;
mod obj_text;
pub mod placement;
pub mod tfx;

pub use error::{Error, Result};
pub use identity::SceneId;
pub use placement::Placement;
