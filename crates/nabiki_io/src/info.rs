//! Summaries of files, for display or, through serde, for programs.

mod cache;
mod exchange;
mod hair;
mod measure;
mod mesh;

use std::{fmt, path::Path};

use serde::Serialize;

pub use crate::motion::MotionInfo;
pub use crate::short::Short;
pub use cache::CacheInfo;
pub use exchange::{ExchangeInfo, PrimSummary};
pub use hair::{Carried, HairInfo};
pub use measure::{Box3, Guess, Spread};
pub use mesh::likely_unit;
pub use mesh::{ClipInfo, MeshInfo};

use crate::{
    error::{Error, Result},
    input::{self, MOST_TEXT_BYTES},
    kind::{extension, way_out},
    motion, obj_text,
};

/// The summary of a file.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(tag = "kind", rename_all = "lowercase")]
pub enum Info {
    /// Strands at rest.
    Hair(HairInfo),
    /// A head or another mesh.
    Mesh(MeshInfo),
    /// Moving strands.
    Cache(CacheInfo),
    /// A USD layer or an Alembic archive.
    Exchange(Box<ExchangeInfo>),
    /// Motion of a head.
    Motion(MotionInfo),
}

impl fmt::Display for Info {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Hair(info) => info.fmt(f),
            Self::Mesh(info) => info.fmt(f),
            Self::Cache(info) => info.fmt(f),
            Self::Exchange(info) => info.fmt(f),
            Self::Motion(info) => info.fmt(f),
        }
    }
}

/// Summarises a file. The ending of the name decides: .hair, .tfx, .obj, .glb, .gltf, .fbx, .ply, .tfxmesh, .usd,
/// .usda, .usdc, .abc, .bvh, .csv, .amc, .asf, .tof or .nabiki. (`nabiki_scene` handles scenes, .toml.)
///
/// # Errors
/// An unknown ending, or an invalid file, in one line.
pub fn info(path: &Path) -> Result<Info> {
    match extension(path).as_str() {
        "hair" | "tfx" | "tfxbone" => Ok(Info::Hair(HairInfo::of(&crate::hair::read(path)?))),
        "usd" | "usda" | "usdc" | "abc" => Ok(Info::Exchange(Box::new(ExchangeInfo::of_file(path)?))),
        "bvh" | "csv" | "amc" | "asf" | "tof" => Ok(Info::Motion(motion::survey(path)?)),
        "glb" | "gltf" | "fbx" | "ply" | "tfxmesh" => Ok(Info::Mesh(MeshInfo::of_file(path)?)),
        "obj" => {
            let bytes = input::read(path, MOST_TEXT_BYTES)?;
            let is_hair = obj_text::text(&bytes).lines().any(|line| obj_text::words(line).next() == Some("l"));
            if is_hair {
                Ok(Info::Hair(HairInfo::of(&crate::hair::read(path)?)))
            } else {
                Ok(Info::Mesh(MeshInfo::of_file(path)?))
            }
        }
        "nabiki" => Ok(Info::Cache(CacheInfo::of(crate::cache::Reader::open(path)?)?)),
        other => {
            // A name without an ending may be a slip, or a folder; a pointer of Git LFS is as short as this.
            let may_be_pointer = std::fs::metadata(path).is_ok_and(|file| file.is_file() && file.len() < 1024);
            if other.is_empty() || may_be_pointer {
                input::open(path)?;
            }
            let known = ".hair, .tfx, .obj, .glb, .gltf, .fbx, .ply, .tfxmesh, .usd, .usda, .usdc, .abc, .bvh, .csv, .amc, .asf, .tof, \
                         .nabiki or .toml";
            Err(Error::new(format!("ending \"{other}\" is not one of {known}{}", way_out(other))).in_file(path))
        }
    }
}
