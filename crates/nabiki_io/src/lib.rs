//! What goes in and out of Nabiki: scenes, hair, heads, motion of the head, caches.

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
mod names;
pub mod obj_lines;
mod obj_text;
pub mod placement;
pub mod scene;
pub mod stage;
pub mod take;
pub mod tfx;

pub use error::{Error, Result};
pub use identity::SceneId;
pub use placement::Placement;
pub use scene::Scene;
