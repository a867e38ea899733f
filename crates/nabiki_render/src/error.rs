//! Errors of drawing and writing pictures.

use std::path::{Path, PathBuf};

use nabiki::SettingError;

/// Why a picture could not be drawn or written. It displays as one line.
#[derive(Debug, thiserror::Error)]
pub enum RenderError {
    /// A setting of the scene's `[picture]` table is out of range.
    #[error(transparent)]
    Setting(#[from] SettingError),
    /// The strands or the head cannot be drawn. Names the strand and the problem.
    #[error("{0}")]
    Geometry(String),
    /// A picture could not be read.
    #[error("{}: {what}", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// What is wrong with it, or what the system said.
        what: String,
    },
    /// A file could not be written.
    #[error("cannot write {}: {source}", path.display())]
    Write {
        /// The file's final name.
        path: PathBuf,
        /// What the system or the encoder said.
        source: std::io::Error,
    },
}

impl RenderError {
    pub(crate) fn read(path: &Path, source: impl Into<Box<dyn std::error::Error + Send + Sync>>) -> Self {
        // Messages of other crates may span lines; ours never do.
        let what = source.into().to_string().split_whitespace().collect::<Vec<_>>().join(" ");
        Self::Read { path: path.to_owned(), what }
    }

    pub(crate) fn write(path: &Path, source: impl Into<Box<dyn std::error::Error + Send + Sync>>) -> Self {
        Self::Write { path: path.to_owned(), source: std::io::Error::other(source) }
    }
}
