//! An error about the content of a file.

use std::fmt;

/// An error about the content of a file, in one line without the file's name.
#[derive(Debug)]
pub struct Problem(pub String);

impl Problem {
    /// An error with this text.
    pub fn new(text: &str) -> Self {
        Self(text.to_owned())
    }
}

impl fmt::Display for Problem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

impl std::error::Error for Problem {}

impl From<std::io::Error> for Problem {
    fn from(error: std::io::Error) -> Self {
        Self(error.to_string())
    }
}
