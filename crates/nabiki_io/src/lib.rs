//! Reads and writes the files of Nabiki: hair, heads, head motion and motion caches. It does not handle scenes or
//! pictures.
//!
//! ```
//! use glam::Vec3;
//! use nabiki::{Hair, Strands};
//! use nabiki_io::{Error, hair};
//!
//! fn main() -> Result<(), Error> {
//!     let mut strands = Strands::default();
//!     strands.push([Vec3::ZERO, Vec3::Y, 2.0 * Vec3::Y]);
//!     let path = std::env::temp_dir().join(format!("nabiki_io_{}.hair", std::process::id()));
//!     let lost = hair::write(&path, &Hair::from(strands.clone()))?;
//!     assert_eq!(lost, Vec::<String>::new());
//!     assert_eq!(hair::read(&path)?.strands, strands);
//!     Ok(std::fs::remove_file(&path)?)
//! }
//! ```

#![forbid(unsafe_code)]

mod axis;
mod bytes;
pub mod cache;
mod declared;
pub mod error;
pub mod exchange;
mod fbx_file;
mod finite;
mod gltf_file;
mod gltf_write;
mod groom_curves;
mod groom_file;
pub mod hair;
pub mod hair_file;
mod hair_format;
pub mod identity;
pub mod info;
pub mod input;
mod joint_chains;
pub mod kind;
pub mod mesh;
pub mod motion;
pub mod moving;
pub mod names;
pub mod obj_lines;
mod obj_text;
pub mod painted;
pub mod placement;
pub mod point_cache;
mod point_texture;
pub mod screen;
pub mod shell;
mod short;
pub mod skin;
mod sum;
pub mod tfx;
mod unit;

pub use axis::Axis;
pub use declared::DeclaredSpace;
pub use error::{Error, Result};
pub use exchange::declared_space;
pub use groom_curves::{CurvePrim, GroomCurves};
pub use groom_file::GroomFile;
pub use identity::SceneId;
pub use placement::Placement;
pub use unit::Unit;
