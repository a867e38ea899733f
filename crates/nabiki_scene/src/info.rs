//! Summaries of all files that Nabiki knows, including scenes.

mod scene;

use std::{fmt, path::Path};

use serde::{Serialize, Serializer};

pub use scene::SceneInfo;

use crate::{Result, Scene};

/// The summary of a file.
#[derive(Clone, Debug, PartialEq)]
pub enum Info {
    /// A scene file.
    Scene(Box<SceneInfo>),
    /// A file of hair, mesh or motion.
    File(Box<nabiki_io::info::Info>),
}

impl Info {
    /// Why a scene does not move: a file that is missing, a group that the hair does not have.
    pub fn problem(&self) -> Option<&str> {
        match self {
            Self::Scene(info) => info.problem.as_deref(),
            Self::File(_) => None,
        }
    }
}

impl fmt::Display for Info {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Scene(info) => info.fmt(f),
            Self::File(info) => info.fmt(f),
        }
    }
}

/// Every kind of file has its `kind`: `scene`, or what [`nabiki_io::info::Info`] says.
impl Serialize for Info {
    fn serialize<S: Serializer>(&self, serializer: S) -> std::result::Result<S::Ok, S::Error> {
        #[derive(Serialize)]
        #[serde(tag = "kind", rename_all = "lowercase")]
        enum Tagged<'a> {
            Scene(&'a SceneInfo),
        }
        match self {
            Self::Scene(info) => Tagged::Scene(info).serialize(serializer),
            Self::File(info) => info.serialize(serializer),
        }
    }
}

/// Summarises a file. The ending of the name decides: .toml, or those of [`nabiki_io::info::info`].
///
/// # Errors
/// If the file is invalid.
pub fn info(path: &Path) -> Result<Info> {
    if path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("toml")) {
        Ok(Info::Scene(Box::new(SceneInfo::of(&Scene::load(path, &[])?))))
    } else {
        Ok(Info::File(Box::new(nabiki_io::info::info(path)?)))
    }
}
