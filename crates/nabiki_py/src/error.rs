//! What is refused, as Python hears it: `nabiki.Error`.

use std::io::ErrorKind;
use std::path::Path;

use nabiki_render::RenderError;
use nabiki_scene::scene::{Problem, SceneError};
use pyo3::exceptions::PyKeyboardInterrupt;
use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;
use pyo3::types::PyDict;

/// A refusal in parts, as far as they are known.
#[derive(Default)]
struct Parts {
    file: Option<String>,
    line: Option<usize>,
    thing: Option<String>,
    value: Option<String>,
    way_out: Option<String>,
    /// What the system said, and of what file.
    system: Option<(ErrorKind, Option<String>)>,
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
            let system = refused.system().map(|system| (system, file.clone()));
            Parts { file, line: refused.line, way_out: Some(refused.what), system, ..Parts::default() }
        }
        Error::Place { file, what, system } => place_parts(&file, what, system),
        Error::Picture(RenderError::Setting(refused)) => setting_parts(refused),
        Error::Picture(RenderError::Write { path, source }) => place_parts(&path, source.to_string(), source.kind()),
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

/// A file that cannot be where it is to be.
pub fn place(py: Python<'_>, file: &Path, what: &str, system: ErrorKind) -> PyErr {
    with_parts(py, format!("{}: {what}", file.display()), place_parts(file, what.to_owned(), system))
}

/// A line without parts.
pub fn line(py: Python<'_>, line: impl Into<String>) -> PyErr {
    with_parts(py, line.into(), Parts::default())
}

fn setting_parts(nabiki::SettingError { thing, value, remedy }: nabiki::SettingError) -> Parts {
    let value = Some(value).filter(|value| !value.is_empty());
    Parts { thing: Some(thing.to_string()), value, way_out: Some(remedy), ..Parts::default() }
}

fn place_parts(file: &Path, what: String, system: ErrorKind) -> Parts {
    let file = named(file);
    Parts { system: Some((system, file.clone())), file, way_out: Some(what), ..Parts::default() }
}

fn scene_parts(refused: &SceneError) -> Parts {
    Parts {
        file: named(&refused.file),
        // Of a scene that no file holds, no line is anywhere.
        line: refused.line.filter(|_| !refused.file.as_os_str().is_empty()),
        thing: Some(refused.key.to_string()).filter(|key| !key.is_empty()),
        value: refused.value().map(str::to_owned),
        way_out: Some(refused.remedy()),
        system: match &*refused.problem {
            Problem::File { system, .. } => system.map(|system| (system, named(&refused.file))),
            Problem::NoFile { system, path, .. } => Some((*system, named(path))),
            _ => None,
        },
    }
}

/// What the module `errno` calls it; none of what is wrong with the content of a file.
fn errno(system: ErrorKind) -> Option<&'static str> {
    Some(match system {
        ErrorKind::NotFound => "ENOENT",
        ErrorKind::PermissionDenied => "EACCES",
        ErrorKind::AlreadyExists => "EEXIST",
        ErrorKind::IsADirectory => "EISDIR",
        ErrorKind::NotADirectory => "ENOTDIR",
        ErrorKind::StorageFull => "ENOSPC",
        ErrorKind::ReadOnlyFilesystem => "EROFS",
        ErrorKind::InvalidFilename => "ENAMETOOLONG",
        _ => return None,
    })
}

fn named(path: &Path) -> Option<String> {
    (!path.as_os_str().is_empty()).then(|| path.display().to_string())
}

fn with_parts(py: Python<'_>, line: String, parts: Parts) -> PyErr {
    static REFUSED: PyOnceLock<Py<PyAny>> = PyOnceLock::new();
    let build = || -> PyResult<PyErr> {
        let parts_by_name = PyDict::new(py);
        parts_by_name.set_item("file", parts.file)?;
        parts_by_name.set_item("line", parts.line)?;
        parts_by_name.set_item("thing", parts.thing)?;
        parts_by_name.set_item("value", parts.value)?;
        parts_by_name.set_item("way_out", parts.way_out)?;
        let (system, file) = parts.system.unzip();
        let make = REFUSED.import(py, "nabiki._error", "refused")?;
        let error = make.call((line, system.and_then(errno), file.flatten()), Some(&parts_by_name))?;
        Ok(PyErr::from_value(error))
    };
    build().unwrap_or_else(|error| error)
}
