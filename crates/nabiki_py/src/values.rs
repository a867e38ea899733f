//! Settings between Python and TOML.

use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyDict, PyFloat, PyInt, PyList, PyMapping, PySequence, PyString, PyTuple};
use toml::{Table, Value};

use crate::error;

/// A setting's value as Python has it: a list of numbers or words becomes a tuple, which nobody takes for the setting itself.
pub fn to_python<'py>(py: Python<'py>, value: &Value) -> PyResult<Bound<'py, PyAny>> {
    Ok(match value {
        Value::String(text) => PyString::new(py, text).into_any(),
        Value::Integer(number) => number.into_pyobject(py)?.into_any(),
        Value::Float(number) => PyFloat::new(py, *number).into_any(),
        Value::Boolean(truth) => PyBool::new(py, *truth).to_owned().into_any(),
        Value::Datetime(moment) => PyString::new(py, &moment.to_string()).into_any(),
        Value::Table(table) => dict(py, table)?.into_any(),
        Value::Array(values) => {
            let items: Vec<_> = values.iter().map(|value| to_python(py, value)).collect::<PyResult<_>>()?;
            match values.iter().any(Value::is_table) {
                true => PyList::new(py, items)?.into_any(),
                false => PyTuple::new(py, items)?.into_any(),
            }
        }
    })
}

/// A table as a dictionary.
pub fn dict<'py>(py: Python<'py>, table: &Table) -> PyResult<Bound<'py, PyDict>> {
    let dict = PyDict::new(py);
    for (key, value) in table {
        dict.set_item(key, to_python(py, value)?)?;
    }
    Ok(dict)
}

/// Lists and tables within one another that are followed; the deepest setting lies in half as many.
const DEEPEST: usize = 16;
/// Numbers and words of one value; a force of its own for each of 100,000 frames takes half as many.
const MOST: usize = 1 << 20;

/// The way through a value of Python to its numbers and words. A list may hold itself, and a few lists that hold one another twice stand
/// for more values than there is room for: either is refused where it is met.
pub struct Walk {
    /// Addresses of the lists and tables around the place that it is at. They live as long as they are here.
    around: Vec<usize>,
    /// How many numbers and words may still come.
    left: usize,
}

impl Default for Walk {
    fn default() -> Self {
        Self { around: Vec::new(), left: MOST }
    }
}

impl Walk {
    /// Reads what is in a list or a table.
    fn within<T>(
        &mut self,
        key: &str,
        holder: &Bound<'_, PyAny>,
        read: impl FnOnce(&mut Self) -> PyResult<T>,
    ) -> PyResult<T> {
        self.enter(key, holder)?;
        let found = read(self);
        self.leave();
        found
    }

    /// Goes into a list or a table; [`leave`](Self::leave) goes out of it.
    ///
    /// # Errors
    /// One that is read already, or lies too deep.
    pub fn enter(&mut self, key: &str, holder: &Bound<'_, PyAny>) -> PyResult<()> {
        let refused = |what: String, way_out: &str| Err(error::argument(holder.py(), key, what, way_out));
        let address = holder.as_ptr() as usize;
        if self.around.contains(&address) {
            let what = format!("a {} within itself", holder.get_type().name()?);
            return refused(what, "a list or table in a setting must not contain itself");
        }
        if self.around.len() == DEEPEST {
            let what = format!("a {} {DEEPEST} lists or tables deep", holder.get_type().name()?);
            return refused(what, "no setting is nested so deep");
        }
        self.take(key, holder, 1)?;
        self.around.push(address);
        Ok(())
    }

    /// Goes out of the innermost one.
    pub fn leave(&mut self) {
        self.around.pop();
    }

    /// Counts what is read.
    fn take(&mut self, key: &str, value: &Bound<'_, PyAny>, count: usize) -> PyResult<()> {
        match self.left.checked_sub(count) {
            Some(left) => {
                self.left = left;
                Ok(())
            }
            None => {
                let way_out = format!("holds more than {MOST} numbers and words, the most that nabiki reads");
                Err(error::argument(value.py(), key, format!("a {}", value.get_type().name()?), &way_out))
            }
        }
    }

    /// What Python gave as a value of a setting. Arrays are lists, paths are text, entries without a value are left out.
    pub fn value(&mut self, key: &str, value: &Bound<'_, PyAny>) -> PyResult<Value> {
        if value.is_instance_of::<PyBool>() {
            return Ok(Value::Boolean(value.extract()?));
        }
        if value.is_instance_of::<PyInt>() {
            let way_out = format!("must be a whole number from {} to {}", i64::MIN, i64::MAX);
            let number = value.extract().map_err(|_| error::argument(value.py(), key, shown(value), &way_out))?;
            self.take(key, value, 1)?;
            return Ok(Value::Integer(number));
        }
        if value.is_instance_of::<PyFloat>() {
            self.take(key, value, 1)?;
            return Ok(Value::Float(value.extract()?));
        }
        if value.is_instance_of::<PyString>() {
            return self.text(key, value);
        }
        if value.hasattr("to_dict")? {
            return self.within(key, value, |walk| walk.value(key, &value.call_method0("to_dict")?));
        }
        // Numbers and arrays of NumPy.
        if value.hasattr("tolist")? {
            let size = value.getattr("size").and_then(|size| size.extract()).unwrap_or(0);
            if size > self.left {
                self.take(key, value, size)?;
            }
            return self.within(key, value, |walk| walk.value(key, &value.call_method0("tolist")?));
        }
        if value.hasattr("__fspath__")? {
            return self.text(key, &value.call_method0("__fspath__")?);
        }
        if let Ok(mapping) = value.cast::<PyMapping>() {
            return self.table(key, mapping).map(Value::Table);
        }
        if let Ok(sequence) = value.cast::<PySequence>() {
            return self.within(key, value, |walk| {
                let items = sequence.try_iter()?.enumerate();
                items
                    .map(|(i, item)| walk.value(&format!("{key}[{i}]"), &item?))
                    .collect::<PyResult<_>>()
                    .map(Value::Array)
            });
        }
        Err(PyTypeError::new_err(format!("{key}: a setting cannot be of type {}", value.get_type().name()?)))
    }

    /// A dictionary as a table.
    pub fn table(&mut self, key: &str, mapping: &Bound<'_, PyMapping>) -> PyResult<Table> {
        self.within(key, mapping, |walk| {
            let mut table = Table::new();
            for entry in mapping.items()?.iter() {
                let (name, value): (String, Bound<'_, PyAny>) = entry.extract()?;
                if !value.is_none() {
                    let value = walk.value(&below(key, &name), &value)?;
                    table.insert(name, value);
                }
            }
            Ok(table)
        })
    }

    /// Words, or a path; text that a file cannot hold is refused, and not changed into some that it can.
    fn text(&mut self, key: &str, text: &Bound<'_, PyAny>) -> PyResult<Value> {
        let way_out = "must be valid Unicode: scene files and the paths in them are UTF-8";
        let refused = || error::argument(text.py(), key, shown(text), way_out);
        let words: String = text.extract().map_err(|_| refused())?;
        self.take(key, text, 1 + words.len() / 2)?;
        Ok(Value::String(words))
    }
}

/// The key of what is called `name` in a table.
pub fn below(key: &str, name: &str) -> String {
    match key {
        "" => name.to_owned(),
        key => format!("{key}.{name}"),
    }
}

/// What a refused value is called in its line: as Python shows it, where it is short.
pub fn shown(value: &Bound<'_, PyAny>) -> String {
    const MOST: usize = 60;
    let type_ = || value.get_type().name().map_or_else(|_| "value".to_owned(), |name| name.to_string());
    // A number of a million digits takes long to write, and what holds itself in a thousand ways for ever.
    let bits = value.call_method0("bit_length").and_then(|bits| bits.extract()).unwrap_or(0u64);
    if bits > 128 {
        return format!("a whole number of {bits} bits");
    }
    let short = value.py().import("reprlib").and_then(|reprlib| reprlib.call_method1("repr", (value,)));
    match short.and_then(|text| text.extract::<String>()) {
        Ok(text) if text.chars().count() <= MOST && !text.contains(char::is_control) => text,
        _ => format!("a {}", type_()),
    }
}
