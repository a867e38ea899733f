//! One-line errors with file, subject, value and remedy.

use std::{
    fmt, io,
    path::{Path, PathBuf},
};

/// An error about a file. It displays as one line: `hair.tfx: points: ...`, `gust.toml:12: motion.time_step: ...`.
#[derive(Debug)]
pub struct Error {
    /// The file, if known. Parsers of bytes leave it to their callers.
    pub file: Option<PathBuf>,
    /// Line in a text file, counted from 1.
    pub line: Option<usize>,
    /// Subject, value and remedy.
    pub what: String,
    /// Whether `what` begins with the key of a setting, whose table a caller may know.
    of_setting: bool,
    source: Option<io::Error>,
}

/// The result type of this crate.
pub type Result<T, E = Error> = std::result::Result<T, E>;

impl Error {
    /// A refusal of, or for want of, a setting, with whose key it begins.
    pub(crate) fn of_setting(what: impl Into<String>) -> Self {
        Self { of_setting: true, ..Self::new(what) }
    }

    /// An error about content.
    pub fn new(what: impl Into<String>) -> Self {
        // Messages of other crates may span lines; ours never do.
        let what = what.into().split_whitespace().collect::<Vec<_>>().join(" ");
        Self { file: None, line: None, what, of_setting: false, source: None }
    }

    /// Adds the file, unless it is set.
    pub fn in_file(mut self, file: &Path) -> Self {
        self.file.get_or_insert_with(|| file.to_owned());
        self
    }

    /// Prepends what it is part of: `joint Head: ...`.
    pub fn under(mut self, thing: impl fmt::Display) -> Self {
        self.what = format!("{thing}: {}", self.what);
        self
    }

    /// Prepends a table to the name of the setting: `head.motion.up` below `head.motion`.
    pub fn below(self, table: &str) -> Self {
        if !self.of_setting {
            return self;
        }
        Self { what: format!("{table}.{}", self.what), of_setting: false, ..self }
    }

    /// The kind of system error, if the system refused the file.
    pub fn system(&self) -> Option<io::ErrorKind> {
        self.source.as_ref().map(io::Error::kind)
    }

    /// Names what a system would have said of the file.
    pub(crate) fn of_system(self, kind: io::ErrorKind) -> Self {
        Self { source: Some(kind.into()), ..self }
    }

    /// Sets the line (from 1).
    pub fn at_line(mut self, line: Option<usize>) -> Self {
        self.line = line;
        self
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(file) = &self.file {
            write!(f, "{}:", file.display())?;
            if let Some(line) = self.line {
                write!(f, "{line}:")?;
            }
            write!(f, " ")?;
        }
        f.write_str(&self.what)
    }
}

impl std::error::Error for Error {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        self.source.as_ref().map(|e| e as _)
    }
}

impl From<io::Error> for Error {
    fn from(source: io::Error) -> Self {
        let what = match source.kind() {
            io::ErrorKind::NotFound => "there is no such file or folder".to_owned(),
            io::ErrorKind::UnexpectedEof => "ends too early: is it still being written, or was it cut off?".to_owned(),
            _ => source.to_string(),
        };
        Self { what: Self::new(what).what, source: Some(source), file: None, line: None, of_setting: false }
    }
}

impl From<nabiki_exchange::Problem> for Error {
    fn from(problem: nabiki_exchange::Problem) -> Self {
        Self::new(problem.0)
    }
}

impl From<nabiki::SettingError> for Error {
    fn from(refused: nabiki::SettingError) -> Self {
        Self::new(refused.to_string())
    }
}
