//! Hair, meshes and ways that Python gives as arrays: temporary files of the scenes that name them, so that all that is true of
//! files of hair, meshes and motion is true of them.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use glam::Vec3;
use nabiki::{Hair, Strands};
use numpy::{PyReadonlyArray1, PyReadonlyArray2};
use pyo3::prelude::*;
use pyo3::types::PyTuple;
use tempfile::TempPath;

use crate::error;
use crate::given_arrays::{numbers, shape};
use crate::poses;

/// The files of the arrays of a scene. Each goes with the last scene that names it.
#[derive(Clone, Default)]
pub struct Files(Vec<Arc<File>>);

struct File {
    path: TempPath,
    process: u32,
}

impl Drop for File {
    fn drop(&mut self) {
        // What a fork lets go of, its parent still has.
        self.path.disable_cleanup(self.process != std::process::id());
    }
}

impl Files {
    /// How many they are.
    pub fn len(&self) -> usize {
        self.0.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Whether a file is one of them.
    pub fn holds(&self, path: &Path) -> bool {
        self.0.iter().any(|file| &*file.path == path)
    }

    /// Keeps these besides, and of all of them those that a scene reads.
    pub fn take(&mut self, others: Self, scene: &nabiki_scene::Scene) {
        self.0.extend(others.0);
        let named = scene.inputs();
        self.0.retain(|file| named.iter().any(|path| **path == *file.path));
    }

    /// A new one, empty.
    fn file(&mut self, py: Python<'_>, ending: &str) -> PyResult<PathBuf> {
        let new = tempfile::Builder::new().prefix("nabiki_").suffix(ending).tempfile();
        let new = new.map_err(|e| error::line(py, format!("cannot write arrays to a temporary file: {e}")))?;
        let file = File { path: new.into_temp_path(), process: std::process::id() };
        let path = file.path.to_owned();
        self.0.push(Arc::new(file));
        Ok(path)
    }

    /// A hair file of (points, offsets).
    pub fn hair(&mut self, arrays: &Bound<'_, PyTuple>) -> PyResult<PathBuf> {
        let py = arrays.py();
        let hair = hair(arrays)?;
        let path = self.file(py, ".hair")?;
        nabiki_io::hair::write(&path, &hair).map_err(|refused| error::raised(py, refused.into()))?;
        Ok(path)
    }

    /// A mesh file of (points, faces).
    pub fn mesh(&mut self, thing: &str, arrays: &Bound<'_, PyTuple>) -> PyResult<PathBuf> {
        let py = arrays.py();
        let (points, faces) = pair(thing, "(points, faces)", arrays)?;
        let points = points_of(&format!("{thing} points"), &points)?;
        let faces = numbers(&format!("{thing} faces"), &faces, "int64")?;
        let corners: Option<PyReadonlyArray2<'_, i64>> = faces.extract().ok();
        let Some(corners) = corners.filter(|corners| matches!(corners.as_array().ncols(), 3 | 4)) else {
            let way_out = "must have the shape (faces, 3) or (faces, 4)";
            return Err(error::argument(py, &format!("{thing} faces"), shape(&faces)?, way_out));
        };
        let mut text = String::new();
        for [x, y, z] in points.iter().map(Vec3::to_array) {
            let _ = writeln!(text, "v {x} {y} {z}");
        }
        for face in corners.as_array().rows() {
            text.push('f');
            for &corner in face {
                if !(0..points.len() as i64).contains(&corner) {
                    let way_out = match points.len() {
                        0 => "is not a point: there are none".to_owned(),
                        count => format!("is not a point: the points are 0 to {}", count - 1),
                    };
                    return Err(error::argument(py, &format!("{thing} faces"), corner, &way_out));
                }
                let _ = write!(text, " {}", corner + 1);
            }
            text.push('\n');
        }
        self.text(py, ".obj", &text)
    }

    /// A table of poses of matrices, so many a second.
    pub fn motion(&mut self, thing: &str, matrices: &Bound<'_, PyAny>, rate: f64) -> PyResult<PathBuf> {
        let mut text = "t_s,px_cm,py_cm,pz_cm,qx,qy,qz,qw\n".to_owned();
        for (n, (p, q)) in poses::way(thing, matrices)?.into_iter().enumerate() {
            let _ = writeln!(text, "{},{},{},{},{},{},{},{}", n as f64 / rate, p.x, p.y, p.z, q.x, q.y, q.z, q.w);
        }
        self.text(matrices.py(), ".csv", &text)
    }

    /// A file of this text.
    fn text(&mut self, py: Python<'_>, ending: &str, text: &str) -> PyResult<PathBuf> {
        let path = self.file(py, ending)?;
        std::fs::write(&path, text).map_err(|e| error::line(py, format!("{}: {e}", path.display())))?;
        Ok(path)
    }
}

/// The hair of (points, offsets).
pub fn hair(arrays: &Bound<'_, PyTuple>) -> PyResult<Hair> {
    let py = arrays.py();
    let (points, offsets) = pair("hair", "(points, offsets)", arrays)?;
    let points = points_of("hair points", &points)?;
    let offsets = numbers("hair offsets", &offsets, "int64")?;
    let refused = |value: String, way_out: &str| Err(error::argument(py, "hair offsets", value, way_out));
    let Ok(starts) = offsets.extract::<PyReadonlyArray1<'_, i64>>() else {
        return refused(shape(&offsets)?, "must have the shape (strands + 1,)");
    };
    let offsets: Vec<i64> = starts.as_array().to_vec();
    let count = points.len() as i64;
    if offsets.len() < 2 {
        let way_out = "must have at least one strand: 0, then the point count at the end of each strand";
        return refused(format!("{offsets:?}"), way_out);
    }
    if offsets[0] != 0 || offsets.last() != Some(&count) {
        let ends = format!("{:?} to {:?}", offsets.first().unwrap_or(&0), offsets.last().unwrap_or(&0));
        return refused(ends, &format!("must begin with 0 and end with the number of points, {count}"));
    }
    if let Some(s) = offsets.windows(2).position(|w| w[1] - w[0] < 2) {
        let way_out = "every strand must have at least two points";
        return refused(format!("{} points in strand {s}", offsets[s + 1] - offsets[s]), way_out);
    }
    if count > i64::from(u32::MAX) {
        return refused(count.to_string(), "must be less than 2^32 points in all");
    }
    Ok(Strands::from_parts(offsets.iter().map(|&at| at as u32).collect(), points).into())
}

fn pair<'py>(
    thing: &str,
    shape: &str,
    arrays: &Bound<'py, PyTuple>,
) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyAny>)> {
    arrays.extract().map_err(|_| {
        error::argument(arrays.py(), thing, format!("{} values", arrays.len()), &format!("must be a file, or {shape}"))
    })
}

/// Finite points of an array of shape (P, 3).
pub fn points_of(thing: &str, array: &Bound<'_, PyAny>) -> PyResult<Vec<Vec3>> {
    let py = array.py();
    let array = numbers(thing, array, "float32")?;
    let refused = |value: String, way_out: &str| error::argument(py, thing, value, way_out);
    let points: Option<PyReadonlyArray2<'_, f32>> = array.extract().ok();
    let Some(points) = points.filter(|points| points.as_array().ncols() == 3) else {
        return Err(refused(shape(&array)?, "must have the shape (points, 3)"));
    };
    let points = points.as_array();
    let points: Vec<Vec3> = points.rows().into_iter().map(|p| Vec3::new(p[0], p[1], p[2])).collect();
    match nabiki::strands::not_finite(&points) {
        None => Ok(points),
        Some(i) => Err(refused(format!("{} at {i}", points[i]), "every point must be finite")),
    }
}
