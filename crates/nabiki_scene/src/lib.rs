//! The document of Nabiki and all that a shell does with it: scenes, what they name, loaded and ready to move, films,
//! exports, reports.
//!
//! A shell (the command line, a window, a script) reads or makes a [`Scene`], hands it to one of the [`tasks`] or
//! [builds](Scene::build) it and steps it itself, and shows what a [`Watch`] hears.

#![forbid(unsafe_code)]

pub mod advice;
pub mod built;
mod cache_file;
pub mod error;
pub mod exports;
mod film;
pub mod frames;
pub mod info;
pub mod inside;
mod outputs;
mod place;
pub mod scene;
pub mod tasks;
pub mod template;
pub mod told;
pub mod watch;

pub use built::{BuiltScene, Shown};
pub use error::{Error, Result};
pub use scene::Scene;
pub use told::Told;
pub use watch::{Unwatched, Watch};
