//! What building and running a scene may fail with.

use std::path::{Path, PathBuf};

use nabiki_render::RenderError;

use crate::scene::SceneError;

/// What went wrong, in one line: file, thing, value, way out.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// A setting of the scene is refused.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// A file that the scene names is refused; a file could not be written.
    #[error(transparent)]
    File(#[from] nabiki_io::Error),
    /// A picture or movie could not be made.
    #[error(transparent)]
    Picture(#[from] RenderError),
    /// A request that the scene cannot meet, or a place that a result cannot go to.
    #[error("{0}")]
    Refused(String),
    /// A place that a result cannot go to, of which the system said so, or would have.
    #[error("{}: {what}", file.display())]
    Place {
        /// Where it was to go.
        file: PathBuf,
        /// What is wrong there, and the way out.
        what: String,
        /// In the system's words.
        system: std::io::ErrorKind,
    },
    /// The watcher asked to stop; nothing is left under a final name.
    #[error("cancelled")]
    Cancelled,
}

impl Error {
    /// A refusal in one line.
    pub fn refused(line: impl Into<String>) -> Self {
        Self::Refused(line.into())
    }

    /// A place that is refused.
    pub(crate) fn place(file: &Path, what: impl Into<String>, system: std::io::ErrorKind) -> Self {
        Self::Place { file: file.to_owned(), what: what.into(), system }
    }
}

/// What this crate's functions return.
pub type Result<T, E = Error> = std::result::Result<T, E>;
