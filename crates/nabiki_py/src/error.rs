//! What is refused, as Python hears it: `nabiki.Error`.

use std::path::Path;

use nabiki_render::RenderError;
use nabiki_scene::scene::SceneError;
use pyo3::exceptions::PyKeyboardInterrupt;
use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;
use pyo3::types::{PyDict, PyType};

/// A refusal in parts, as far as they are known.
#[derive(Default)]
struct Parts {
    file: Option<String>,
    line: Option<usize>,
    thing: Option<String>,
    value: Option<String>,
    way_out: Option<String>,
}

/// The whole line, and its parts as attributes.
pub fn raised(py: Python<'_>, error: nabiki_scene::Error) -> PyErr {
    use nabiki_scene::Error;
    let line = error.to_string();
    let parts = match error {
        Error::Cancelled => return PyKeyboardInterrupt::new_err(()),
        Error::Scene(refused) => scene_parts(&refused),
        Error::File(refused) => {
            let file = refused.file.as_deref().and_then(named);
            Parts { file, line: refused.line, way_out: Some(refused.what), ..Parts::default() }
        }
        Error::Picture(RenderError::Setting(refused)) => setting_parts(refused),
        Error::Picture(RenderError::Write { path, source }) => {
            Parts { file: named(&path), way_out: Some(source.to_string()), ..Parts::default() }
        }
        Error::Picture(RenderError::Read { path, what }) => {
            Parts { file: named(&path), way_out: Some(what), ..Parts::default() }
        }
        Error::Picture(RenderError::Geometry(_)) | Error::Refused(_) => Parts::default(),
    };
    with_parts(py, line, parts)
}

/// A setting that is refused.
pub fn setting(py: Python<'_>, refused: nabiki::SettingError) -> PyErr {
    with_parts(py, refused.to_string(), setting_parts(refused))
}

/// What Python code gave that cannot be used: what it is called, what it was, what to do.
pub fn argument(py: Python<'_>, thing: &str, value: impl ToString, way_out: &str) -> PyErr {
    setting(py, nabiki::SettingError::new(thing, value.to_string(), way_out))
}

/// A line without parts.
pub fn line(py: Python<'_>, line: impl Into<String>) -> PyErr {
    with_parts(py, line.into(), Parts::default())
}

fn setting_parts(nabiki::SettingError { thing, value, remedy }: nabiki::SettingError) -> Parts {
    Parts { thing: Some(thing), value: Some(value), way_out: Some(remedy), ..Parts::default() }
}

fn scene_parts(refused: &SceneError) -> Parts {
    Parts {
        file: named(&refused.file),
        // Of a scene that no file holds, no line is anywhere.
        line: refused.line.filter(|_| !refused.file.as_os_str().is_empty()),
        thing: Some(refused.key.clone()).filter(|key| !key.is_empty()),
        value: refused.value().map(str::to_owned),
        way_out: Some(refused.remedy()),
    }
}

fn named(path: &Path) -> Option<String> {
    (!path.as_os_str().is_empty()).then(|| path.display().to_string())
}

fn with_parts(py: Python<'_>, line: String, parts: Parts) -> PyErr {
    static ERROR: PyOnceLock<Py<PyType>> = PyOnceLock::new();
    let build = || -> PyResult<PyErr> {
        let parts_by_name = PyDict::new(py);
        parts_by_name.set_item("file", parts.file)?;
        parts_by_name.set_item("line", parts.line)?;
        parts_by_name.set_item("thing", parts.thing)?;
        parts_by_name.set_item("value", parts.value)?;
        parts_by_name.set_item("way_out", parts.way_out)?;
        let class = ERROR.import(py, "nabiki._error", "Error")?;
        Ok(PyErr::from_value(class.call((line,), Some(&parts_by_name))?))
    };
    build().unwrap_or_else(|error| error)
}
