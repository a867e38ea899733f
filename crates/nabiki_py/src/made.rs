//! Hair and meshes that Python gives as arrays: files in a folder of the scene's, gone with it, so that all that is true of
//! hair and meshes of files is true of them.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

use glam::Vec3;
use nabiki::{Hair, Strands};
use numpy::{PyReadonlyArray1, PyReadonlyArray2};
use pyo3::intern;
use pyo3::prelude::*;
use pyo3::types::PyTuple;
use tempfile::TempDir;

use crate::error;

/// The folder of the arrays of a scene, and of those copied from it.
#[derive(Clone, Default)]
pub struct Folder(Arc<Mutex<Files>>);

#[derive(Default)]
struct Files {
    folder: Option<TempDir>,
    made: u32,
}

impl Folder {
    /// Whether a file is one of them.
    pub fn holds(&self, path: &Path) -> bool {
        let files = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        files.folder.as_ref().is_some_and(|folder| path.starts_with(folder.path()))
    }

    /// A new name in it.
    fn file(&self, py: Python<'_>, ending: &str) -> PyResult<PathBuf> {
        let new = || {
            let mut files = self.0.lock().unwrap_or_else(PoisonError::into_inner);
            files.made += 1;
            let name = format!("{}.{ending}", files.made);
            if files.folder.is_none() {
                files.folder = Some(tempfile::Builder::new().prefix("nabiki_").tempdir()?);
            }
            Ok(files.folder.as_ref().map(|folder| folder.path().join(name)).unwrap_or_default())
        };
        new().map_err(|e: std::io::Error| {
            error::line(py, format!("no place for arrays beside other temporary files: {e}"))
        })
    }

    /// A hair file of (points, offsets).
    pub fn hair(&self, arrays: &Bound<'_, PyTuple>) -> PyResult<PathBuf> {
        let py = arrays.py();
        let hair = hair(arrays)?;
        let path = self.file(py, "hair")?;
        nabiki_io::hair::write(&path, &hair).map_err(|refused| error::raised(py, refused.into()))?;
        Ok(path)
    }

    /// A mesh file of (points, faces).
    pub fn mesh(&self, thing: &str, arrays: &Bound<'_, PyTuple>) -> PyResult<PathBuf> {
        let py = arrays.py();
        let (points, faces) = pair(thing, "(points, faces)", arrays)?;
        let points = points_of(&format!("{thing} points"), &points)?;
        let faces = numbers(&format!("{thing} faces"), &faces, "int64")?;
        let faces: PyReadonlyArray2<'_, i64> = faces.extract().map_err(|_| {
            error::argument(
                py,
                &format!("{thing} faces"),
                "an array of another shape",
                "must have the shape (faces, 3) or (faces, 4)",
            )
        })?;
        let mut text = String::new();
        for [x, y, z] in points.iter().map(Vec3::to_array) {
            let _ = writeln!(text, "v {x} {y} {z}");
        }
        for face in faces.as_array().rows() {
            text.push('f');
            for &corner in face {
                if !(0..points.len() as i64).contains(&corner) {
                    let way_out = format!("names no point: the points are 0 to {}", points.len().saturating_sub(1));
                    return Err(error::argument(py, &format!("{thing} faces"), corner, &way_out));
                }
                let _ = write!(text, " {}", corner + 1);
            }
            text.push('\n');
        }
        let path = self.file(py, "obj")?;
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
    let offsets: PyReadonlyArray1<'_, i64> = offsets.extract().map_err(|_| {
        error::argument(py, "hair offsets", "an array of another shape", "must have the shape (strands + 1,)")
    })?;
    let offsets: Vec<i64> = offsets.as_array().to_vec();
    let count = points.len() as i64;
    let refused = |value: String, way_out: &str| Err(error::argument(py, "hair offsets", value, way_out));
    if offsets.len() < 2 || offsets[0] != 0 || offsets.last() != Some(&count) {
        let ends = format!("{:?} to {:?}", offsets.first().unwrap_or(&0), offsets.last().unwrap_or(&0));
        return refused(ends, &format!("must begin with 0 and end with the number of points, {count}"));
    }
    if let Some(s) = offsets.windows(2).position(|w| w[1] - w[0] < 2) {
        let way_out = "every strand must have two points at least";
        return refused(format!("{} points in strand {s}", offsets[s + 1] - offsets[s]), way_out);
    }
    if count > i64::from(u32::MAX) {
        return refused(count.to_string(), "must be below 2^32 points in all");
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
    let points: PyReadonlyArray2<'_, f32> = array
        .extract()
        .map_err(|_| refused("an array of another shape".to_owned(), "must have the shape (points, 3)"))?;
    let points = points.as_array();
    if points.shape()[1] != 3 {
        return Err(refused(format!("shape {:?}", points.shape()), "must have the shape (points, 3)"));
    }
    let points: Vec<Vec3> = points.rows().into_iter().map(|p| Vec3::new(p[0], p[1], p[2])).collect();
    match nabiki::strands::not_finite(&points) {
        None => Ok(points),
        Some(i) => Err(refused(format!("{} at {i}", points[i]), "every point must be finite")),
    }
}

/// Whatever NumPy makes an array of.
fn numbers<'py>(thing: &str, array: &Bound<'py, PyAny>, kind: &str) -> PyResult<Bound<'py, PyAny>> {
    let py = array.py();
    let made = py.import(intern!(py, "numpy"))?.call_method1(intern!(py, "asarray"), (array, kind));
    made.map_err(|e| error::argument(py, thing, array.get_type(), &format!("is no array of numbers: {}", e.value(py))))
}
