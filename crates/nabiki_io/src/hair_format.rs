//! The formats of hair, by their file name endings.

use std::path::Path;

use nabiki::Hair;
use nabiki_exchange::attributes::names;
use serde::Serialize;

use crate::error::{Error, Result};
use crate::kind::{extension, way_out};

/// The formats of hair that does not move.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub enum Format {
    /// Cem Yuksel's .hair.
    #[serde(rename = "hair")]
    Hair,
    /// TressFX .tfx, version 3 or 4; written as 4.
    #[serde(rename = "tfx")]
    Tfx,
    /// Polylines of a Wavefront .obj; read only.
    #[serde(rename = "obj")]
    ObjLines,
    /// A USD layer, text or binary.
    #[serde(rename = "usd")]
    Usd,
    /// An Alembic archive.
    #[serde(rename = "alembic")]
    Alembic,
}

impl Format {
    /// The format of a file, from its name.
    pub fn of(path: &Path) -> Result<Self> {
        match extension(path).as_str() {
            "hair" => Ok(Self::Hair),
            "tfx" => Ok(Self::Tfx),
            "obj" => Ok(Self::ObjLines),
            "usd" | "usda" | "usdc" => Ok(Self::Usd),
            "abc" => Ok(Self::Alembic),
            "tfxbone" => {
                let what = "holds no strands, only bone weights for the .tfx beside it: read the .tfx";
                Err(Error::new(what).in_file(path))
            }
            other => {
                let known = ".hair, .tfx, .usd, .usda, .usdc or .abc (.obj only to read)";
                let line = format!("ending \"{other}\" is not a hair format: {known}{}", way_out(other));
                Err(Error::new(line).in_file(path))
            }
        }
    }
}

/// What only formats with attributes of any name pass on.
pub(crate) fn passed_on(hair: &Hair) -> Vec<String> {
    // What is said a second time, the other way, is held.
    let again = |name: &str| names::OPACITY.contains(&name) && hair.attributes.transparency.is_some();
    let names = hair.attributes.other.iter().map(|other| other.name.clone()).filter(|name| !again(name));
    names.collect()
}
