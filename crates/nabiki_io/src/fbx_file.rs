//! FBX, by way of ufbx: one file of C, which is why it can be left out of a build (the feature `fbx`). This is what the rest of the
//! crate asks of such a file, whether it is built in or not.
//!
//! Joints are at rest where their skins bind them, as hair is groomed on a character in its bind pose; an FBX has the pose in which it
//! was exported besides, often that of the first frame.

#[cfg(feature = "fbx")]
pub(crate) mod document;
#[cfg(feature = "fbx")]
pub(crate) use document::{Document, affine};

#[cfg(feature = "fbx")]
pub(crate) use crate::mesh::fbx::{bends, each_bent, groups, mesh, outline};
#[cfg(feature = "fbx")]
pub(crate) use crate::motion::fbx::{carries, head_motion, mover};

#[cfg(not(feature = "fbx"))]
mod absent;
#[cfg(not(feature = "fbx"))]
pub(crate) use absent::{bends, carries, each_bent, groups, head_motion, mesh, mover, outline};

use std::path::Path;

use crate::declared::DeclaredSpace;
use crate::error::Result;
use crate::input::{self, MOST_BINARY_BYTES};
use crate::kind::extension;

/// What a file declares, and what it has besides shapes.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Outline {
    pub space: DeclaredSpace,
    /// Frames per second.
    pub rate: Option<f64>,
    /// The number of its meshes.
    pub meshes: usize,
    /// The names of its animations, and how long each lasts (s).
    pub clips: Vec<(String, f64)>,
    /// The names of its nodes.
    pub nodes: Vec<String>,
}

/// Whether the file name ends like an FBX.
pub(crate) fn is_fbx(path: &Path) -> bool {
    extension(path) == "fbx"
}

/// What the file at `path` declares.
///
/// # Errors
/// A file that cannot be read.
pub(crate) fn outline_of(path: &Path) -> Result<Outline> {
    outline(&input::read(path, MOST_BINARY_BYTES)?).map_err(|e| e.in_file(path))
}

#[cfg(all(test, feature = "fbx"))]
mod tests;
