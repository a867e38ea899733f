//! What a shell may ask for: each task refuses what cannot be done before it begins, tells its watcher what it knows,
//! and leaves only whole files.

mod convert;
mod groom;
mod new;
mod preview;
mod render;
mod run;
mod simulate;

pub use convert::{ConvertOptions, convert};
pub use groom::groom;
pub use new::{NewOptions, new};
pub use preview::preview;
pub use render::{RenderOptions, render};
pub use run::run;
pub use simulate::{SimulateOptions, Twin, simulate};

use std::path::PathBuf;

use crate::told::Told;
use crate::watch::Watch;

/// Says which files now exist.
fn wrote(files: Vec<PathBuf>, watch: &mut dyn Watch) {
    files.into_iter().for_each(|file| watch.told(Told::Wrote { file, holds: None }));
}
