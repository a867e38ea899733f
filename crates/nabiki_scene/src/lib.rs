//! Scenes, and everything that a front end does with them: loading, building, simulation, films, exports and reports.
//!
//! A front end (the command line, a window, a script) reads or makes a [`Scene`]. It passes the scene to one of the
//! [`tasks`], or [builds](Scene::build) it and steps it itself. It shows what a [`Watch`] receives.
//!
//! This example opens a scene, changes the wind, simulates it, and reads points in the world:
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
