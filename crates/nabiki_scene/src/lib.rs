//! The document of Nabiki and all that a shell does with it: scenes, what they name, loaded and ready to move, films,
//! exports, reports.
//!
//! A shell (the command line, a window, a script) reads or makes a [`Scene`], hands it to one of the [`tasks`] or
//! [builds](Scene::build) it and steps it itself, and shows what a [`Watch`] hears.
//!
//! Open a scene, change the wind, simulate, read points in the world:
//!
//! ```
//! use glam::Vec3;
//! use nabiki::field::Keyframe;
//! use nabiki_scene::{Result, Scene, Shown};
//!
//! fn main() -> Result<()> {
//! #     std::env::set_current_dir(concat!(env!("CARGO_MANIFEST_DIR"), "/../..")).expect("the project's folder");
//!     let mut scene = Scene::load("scenes/gust.toml".as_ref(), &[])?;
//!     let down = Keyframe { through: 100, vector: Vec3::new(-15.0, -300.0, 0.0) };
//!     scene.field.force = vec![down.into()];
//!     let built = scene.build(Shown::First(300))?;
//!     let mut timeline = built.timeline()?;
//!     let film = timeline.play();
//!     for frame in 0..=built.frames() {
//!         let tip = film.strand(frame, 0).last().copied().unwrap_or_default();
//!         println!("{frame}: {}", built.pose(frame).world_from_head().transform_point3(tip));
//!     }
//!     Ok(())
//! }
//! ```

#![forbid(unsafe_code)]

pub mod advice;
pub mod built;
mod cache_file;
pub mod error;
pub mod exports;
pub mod farm;
mod field_picture;
mod film;
pub mod frames;
pub mod info;
mod looks_wrong;
mod memory;
pub mod motion_summary;
mod outputs;
mod place;
pub mod pull;
mod root_ends;
pub mod scene;
pub mod schema;
mod seat;
mod size;
pub mod solve;
pub mod tasks;
pub mod template;
pub mod threads;
pub mod told;
pub mod watch;

pub use built::{BuiltScene, Shown};
pub use error::{Error, Result};
pub use scene::Scene;
pub use told::Told;
pub use watch::{Unwatched, Watch};
