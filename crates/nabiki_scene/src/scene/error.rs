//! Errors of scenes as data: an editor can mark the position, a command line prints one line.

use std::fmt;
use std::path::PathBuf;

use nabiki::SettingError;
use nabiki::setting::Key;

/// An error about a scene. It displays as one line: file and line (or override), key, value, remedy.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub struct SceneError {
    /// The scene file; empty for a scene made in code.
    pub file: PathBuf,
    /// Line of the value in the file, from 1; `None` if there is no such line.
    pub line: Option<usize>,
    /// The override that set the value, `KEY=VALUE`, if it was not the file.
    pub set: Option<String>,
    /// The setting's name in the file, such as `force[1].vector`; empty if the error is about the file.
    pub key: Key,
    /// The problem.
    pub problem: Box<Problem>,
}

/// The problem with a setting or the file.
#[derive(Clone, Debug, PartialEq)]
pub enum Problem {
    /// The file cannot be read or written.
    File {
        /// The system's words, or ours.
        what: String,
        /// What the system said, where it was the system that refused.
        system: Option<std::io::ErrorKind>,
    },
    /// The text is not TOML. The parser's message.
    NotToml(String),
    /// No setting has this name.
    UnknownKey {
        /// The known one that was perhaps meant (whole, `motion.time_step`).
        near: Option<String>,
        /// The names that the table may hold.
        known: Vec<String>,
    },
    /// A required setting is missing.
    Missing,
    /// The setting has no effect in this scene. The reason and the remedy.
    Useless(String),
    /// A value of the wrong type.
    Kind {
        /// What was found, with its kind: `string "many"`.
        found: String,
        /// What it must be.
        wanted: String,
    },
    /// A value out of range.
    Range {
        /// The value; empty where there is none, and the remedy then continues the key.
        value: String,
        /// The range, or the way out.
        remedy: String,
    },
    /// A named file that the system refuses.
    NoFile {
        /// The name, as a scene file has it.
        value: String,
        /// The way out.
        remedy: String,
        /// Where the name leads.
        path: PathBuf,
        /// What the system says of it.
        system: std::io::ErrorKind,
    },
    /// Anything else, as text.
    Other(String),
}

impl SceneError {
    /// The refused value, if there is one.
    pub fn value(&self) -> Option<&str> {
        match &*self.problem {
            Problem::Kind { found: value, .. } | Problem::Range { value, .. } | Problem::NoFile { value, .. } => {
                Some(value.as_str()).filter(|value| !value.is_empty())
            }
            _ => None,
        }
    }

    /// The allowed range, or the remedy.
    pub fn remedy(&self) -> String {
        match &*self.problem {
            Problem::Kind { wanted, .. } => format!("must be {wanted}"),
            Problem::Range { remedy, .. } | Problem::NoFile { remedy, .. } => remedy.clone(),
            Problem::UnknownKey { near: Some(near), .. } => format!("did you mean {near}?"),
            Problem::UnknownKey { known, .. } => format!("the keys here are {}", known.join(", ")),
            Problem::Missing => format!("write {} = ...", self.key.last_name()),
            Problem::File { what: text, .. }
            | Problem::NotToml(text)
            | Problem::Useless(text)
            | Problem::Other(text) => text.clone(),
        }
    }
}

impl fmt::Display for SceneError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if !self.file.as_os_str().is_empty() {
            write!(f, "{}:", self.file.display())?;
            if let Some(line) = self.line {
                write!(f, "{line}:")?;
            }
            write!(f, " ")?;
        }
        if let Some(set) = &self.set {
            write!(f, "--set {set}: ")?;
        }
        write!(f, "{}", self.key)?;
        match &*self.problem {
            Problem::Range { value, .. } if value.is_empty() => write!(f, " ")?,
            Problem::Range { value, .. } | Problem::NoFile { value, .. } => write!(f, " = {value}: ")?,
            _ if self.key.is_empty() => {}
            _ => write!(f, ": ")?,
        }
        let remedy = self.remedy();
        match &*self.problem {
            Problem::NotToml(_) => write!(f, "not TOML: {remedy}"),
            Problem::UnknownKey { .. } => write!(f, "unknown key; {remedy}"),
            Problem::Missing => write!(f, "is missing: {remedy}"),
            Problem::Kind { found, .. } => write!(f, "found {found}, {remedy}"),
            _ => f.write_str(&remedy),
        }
    }
}

impl From<SettingError> for SceneError {
    fn from(refused: SettingError) -> Self {
        let SettingError { thing, value, remedy } = refused;
        let problem = Box::new(Problem::Range { value, remedy });
        Self { file: PathBuf::new(), line: None, set: None, key: thing, problem }
    }
}
