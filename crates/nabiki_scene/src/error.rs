//! Errors of building and running a scene.

use std::path::{Path, PathBuf};

use nabiki_io::screen::OneLine;
use nabiki_render::RenderError;

use crate::advice::Advice;
use crate::scene::{Problem, SceneError};

/// An error in one line: file, subject, value, remedy. Control characters in it are escaped.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// A setting of the scene is refused.
    #[error("{}", OneLine(.0))]
    Scene(#[from] SceneError),
    /// A file of the scene is refused, or a file could not be written.
    #[error("{}", OneLine(.0))]
    File(#[from] nabiki_io::Error),
    /// A picture or movie could not be made.
    #[error("{}", OneLine(.0))]
    Picture(#[from] RenderError),
    /// A request that the scene cannot meet, or an unusable place for a result.
    #[error("{}", OneLine(.0))]
    Refused(String),
    /// A place for a result that the system refuses, or would refuse.
    #[error("{}", OneLine(&format_args!("{}: {what}", file.display())))]
    Place {
        /// Where it was to go.
        file: PathBuf,
        /// What is wrong there, and the way out.
        what: String,
        /// In the system's words.
        system: std::io::ErrorKind,
    },
    /// The watcher asked to stop. No file with a final name remains.
    #[error("cancelled")]
    Cancelled,
}

impl Error {
    /// An error with this line.
    pub fn refused(line: impl Into<String>) -> Self {
        Self::Refused(line.into())
    }

    /// Adds the likelier cause, if there is one: with an implausible size of head or hair, a plausible number is
    /// refused.
    pub(crate) fn blamed_on(mut self, size: Option<Advice>) -> Self {
        if let (Self::Scene(refused), Some(size)) = (&mut self, size)
            && let Problem::Range { value, remedy } = &mut *refused.problem
            // A missing file, or a word, has no size.
            && !value.starts_with('"')
        {
            *remedy += &format!("; check the size first: {size}");
        }
        self
    }

    /// The error for a refused place.
    pub(crate) fn place(file: &Path, what: impl Into<String>, system: std::io::ErrorKind) -> Self {
        Self::Place { file: file.to_owned(), what: what.into(), system }
    }
}

/// The result type of this crate.
pub type Result<T, E = Error> = std::result::Result<T, E>;
