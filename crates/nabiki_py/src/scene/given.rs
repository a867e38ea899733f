//! What Python gives as settings, in which arrays of hair, meshes and motion become files.

use std::path::Path;

use pyo3::prelude::*;
use pyo3::types::{PyList, PyMapping, PyTuple};
use toml::{Table, Value};

use crate::error;
use crate::made::Files;
use crate::values::{Walk, below};

/// A value of a setting, or of a table of them. `rate`: matrices a second, where they do not say it themselves.
pub fn setting(key: &str, given: &Bound<'_, PyAny>, rate: Option<f64>, files: &mut Files) -> PyResult<Value> {
    Settings { rate, files, walk: Walk::default() }.read(key, given)
}

/// The setting by which hair is given as arrays, and that by which it is known that these are root first.
pub const HAIR_FILE: &str = "hair.file";
pub const HAIR_ROOT: &str = "hair.root";

/// What [`HAIR_ROOT`] is of arrays, where they do not say otherwise: they are root first, wherever they lie on the skin.
pub fn root_first() -> Option<Value> {
    Some(Value::String("first".to_owned()))
}

struct Settings<'a> {
    rate: Option<f64>,
    files: &'a mut Files,
    walk: Walk,
}

impl Settings<'_> {
    fn read(&mut self, key: &str, given: &Bound<'_, PyAny>) -> PyResult<Value> {
        let name = key.rsplit('.').next().unwrap_or(key);
        let is_motion = name == "motion" && key != name;
        if is_motion && is_array(given)? {
            return Ok(Value::Table(self.moved(key, given, self.rate)?));
        }
        let pair = match given.cast::<PyList>() {
            Ok(list) => Ok(list.to_tuple()),
            Err(_) => given.cast::<PyTuple>().cloned(),
        };
        if let Ok(arrays) = pair {
            match name {
                "mesh" => return self.files.mesh(key, &arrays).and_then(|path| text(key, given, &path)),
                "file" if key == HAIR_FILE => {
                    return self.files.hair(&arrays).and_then(|path| text(key, given, &path));
                }
                _ => {}
            }
        }
        if let Ok(table) = given.cast::<PyMapping>() {
            // Its entries come back here, so that it is walked here and not in the walk of plain values.
            return self.table(key, table, is_motion).map(Value::Table);
        }
        if key == "body"
            && let Ok(bodies) = given.cast::<PyList>()
        {
            let entries = bodies.iter().enumerate();
            let entries = entries
                .map(|(i, body)| self.within(key, given, |settings| settings.read(&format!("body[{i}]"), &body)));
            return entries.collect::<PyResult<_>>().map(Value::Array);
        }
        self.walk.value(key, given)
    }

    /// Reads what is in a list or a table, as [`Walk::within`] does.
    fn within<T>(
        &mut self,
        key: &str,
        holder: &Bound<'_, PyAny>,
        read: impl FnOnce(&mut Self) -> PyResult<T>,
    ) -> PyResult<T> {
        self.walk.enter(key, holder)?;
        let found = read(self);
        self.walk.leave();
        found
    }

    fn table(&mut self, key: &str, table: &Bound<'_, PyMapping>, is_motion: bool) -> PyResult<Table> {
        let (mut values, mut matrices, mut is_root_first) = (Table::new(), None, false);
        self.within(key, table, |settings| {
            for entry in table.items()?.iter() {
                let (name, value): (String, Bound<'_, PyAny>) = entry.extract()?;
                if is_motion && name == "file" && is_array(&value)? {
                    matrices = Some(value);
                } else if !value.is_none() {
                    is_root_first |= below(key, &name) == HAIR_FILE && is_array(&value)?;
                    let value = settings.read(&below(key, &name), &value)?;
                    values.insert(name, value);
                }
            }
            Ok(())
        })?;
        if let Some(first) = root_first().filter(|_| is_root_first) {
            values.entry("root").or_insert(first);
        }
        let Some(matrices) = matrices else { return Ok(values) };
        let mut own_rate = None;
        // Of a table of poses it is known by its times.
        if let Some(given) = values.remove("frames_per_second") {
            own_rate = given.as_float().or(given.as_integer().map(|whole| whole as f64));
            if !own_rate.is_some_and(|rate| rate.is_finite() && rate > 0.0) {
                let (thing, way_out) = (format!("{key}.frames_per_second"), "must be a finite number above 0");
                return Err(error::argument(matrices.py(), &thing, given, way_out));
            }
        }
        let mut moved = self.moved(key, &matrices, own_rate.or(self.rate))?;
        moved.extend(values);
        Ok(moved)
    }

    /// The table of a motion of matrices, in the space of the scene unless it says otherwise.
    fn moved(&mut self, key: &str, matrices: &Bound<'_, PyAny>, rate: Option<f64>) -> PyResult<Table> {
        let Some(rate) = rate else {
            let way_out = "needs a frame rate, because the scene is not read yet: give {\"file\": ..., \"frames_per_second\": ...}";
            return Err(error::argument(matrices.py(), key, "an array", way_out));
        };
        let file = text(key, matrices, &self.files.motion(key, matrices, rate)?)?;
        let axis = |axis: &str| Value::String(axis.to_owned());
        let values = [("file", file), ("up", axis("+y")), ("facing", axis("+x"))];
        Ok(values.map(|(key, value)| (key.to_owned(), value)).into_iter().collect())
    }
}

/// Whether numbers are given, and neither a file nor a table.
fn is_array(given: &Bound<'_, PyAny>) -> PyResult<bool> {
    Ok(given.is_instance_of::<PyList>() || given.is_instance_of::<PyTuple>() || given.hasattr("__array__")?)
}

/// The path of a file of arrays, which a scene has as text.
fn text(key: &str, arrays: &Bound<'_, PyAny>, path: &Path) -> PyResult<Value> {
    let text = path.to_str().map(|path| Value::String(path.to_owned()));
    text.ok_or_else(|| {
        let way_out = "is in a temporary folder whose name is not UTF-8: set TMPDIR to another";
        error::argument(arrays.py(), key, path.display(), way_out)
    })
}
