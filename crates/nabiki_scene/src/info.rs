//! What is in a file of any kind that Nabiki knows, scenes too.

mod scene;

use std::{fmt, path::Path};

use nabiki_io::Result;
use serde::Serialize;

pub use scene::SceneInfo;

use crate::Scene;

/// What a file turned out to be.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(untagged)]
pub enum Info {
    /// A scene file.
    Scene(SceneInfo),
    /// A file of hair, a mesh, motion.
    File(Box<nabiki_io::info::Info>),
}

impl fmt::Display for Info {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Scene(info) => info.fmt(f),
            Self::File(info) => info.fmt(f),
        }
    }
}

/// Looks into a file, told by its name's ending: .toml, or what [`nabiki_io::info::info`] knows.
///
/// # Errors
/// What is wrong with the file.
pub fn info(path: &Path) -> Result<Info> {
    if path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("toml")) {
        Ok(Info::Scene(SceneInfo::of(&Scene::load(path, &[])?)))
    } else {
        nabiki_io::info::info(path).map(|info| Info::File(Box::new(info)))
    }
}
