//! The positions of a groom's curves in its file, for layers over them.

use std::path::Path;

use glam::DAffine3;
use nabiki_exchange::Course;

use crate::error::{Error, Result};

/// Curves of a layer or archive.
#[derive(Clone, Debug, PartialEq)]
pub struct CurvePrim {
    /// Their path in the file.
    pub path: String,
    /// Number of their control points.
    pub points: u64,
    /// Their basis.
    pub course: Course,
    /// Transform to the file's world at the first frame.
    pub world_from_curves: DAffine3,
    /// Whether a skeleton moves them.
    pub bound: bool,
}

/// The file that a groom came from, and its curves in that file.
#[derive(Clone, Debug, PartialEq)]
pub struct GroomCurves {
    /// The file, as it was given.
    pub file: String,
    /// Its curves, in order. Empty for formats with only hair.
    pub curves: Vec<CurvePrim>,
}

impl GroomCurves {
    /// The curves for a layer over the prim `path`.
    ///
    /// # Errors
    /// If the prim does not have the groom's curves (one line with the valid paths), or a transform above it flattens
    /// space.
    pub fn under_layer(&self, path: &str) -> Result<&CurvePrim> {
        let refuse =
            |why: String| Err(Error::new(format!("--export-layer {path}: {why}")).in_file(Path::new(&self.file)));
        let listed = self.curves.iter().take(8).map(|prim| format!("{} ({} points)", prim.path, prim.points));
        let list = listed.collect::<Vec<_>>().join(", ");
        match &self.curves[..] {
            [only] if only.path == path => {
                let inverse = only.world_from_curves.inverse();
                if inverse.is_finite() { Ok(only) } else { refuse("a transform above it flattens space".to_owned()) }
            }
            [] => refuse("it has no curves for a layer to cover".to_owned()),
            [_] => refuse(format!("its curves are at {list}")),
            several => {
                let n = several.len();
                refuse(format!("its curves are in {n} prims ({list}), but a layer covers only one"))
            }
        }
    }
}
