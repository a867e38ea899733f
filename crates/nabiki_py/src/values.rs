//! Settings between Python and TOML.

use std::path::PathBuf;

use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyDict, PyFloat, PyInt, PyList, PyMapping, PySequence, PyString, PyTuple};
use toml::{Table, Value};

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

/// What Python gave as a value of a setting. Arrays are lists, paths are text, entries without a value are left out.
pub fn to_toml(value: &Bound<'_, PyAny>) -> PyResult<Value> {
    if value.is_instance_of::<PyBool>() {
        return Ok(Value::Boolean(value.extract()?));
    }
    if value.is_instance_of::<PyInt>() {
        return Ok(Value::Integer(value.extract()?));
    }
    if value.is_instance_of::<PyFloat>() {
        return Ok(Value::Float(value.extract()?));
    }
    if let Ok(text) = value.cast::<PyString>() {
        return Ok(Value::String(text.to_str()?.to_owned()));
    }
    if value.hasattr("to_dict")? {
        return to_toml(&value.call_method0("to_dict")?);
    }
    // Numbers and arrays of NumPy.
    if value.hasattr("tolist")? {
        return to_toml(&value.call_method0("tolist")?);
    }
    if value.hasattr("__fspath__")? {
        return Ok(Value::String(value.extract::<PathBuf>()?.to_string_lossy().into_owned()));
    }
    if let Ok(mapping) = value.cast::<PyMapping>() {
        return table(mapping).map(Value::Table);
    }
    if let Ok(sequence) = value.cast::<PySequence>() {
        let items = sequence.try_iter()?.map(|item| to_toml(&item?));
        return items.collect::<PyResult<_>>().map(Value::Array);
    }
    Err(PyTypeError::new_err(format!("{} is no value of a setting", value.get_type().name()?)))
}

/// A dictionary as a table.
pub fn table(mapping: &Bound<'_, PyMapping>) -> PyResult<Table> {
    let mut table = Table::new();
    for entry in mapping.items()?.iter() {
        let (key, value): (String, Bound<'_, PyAny>) = entry.extract()?;
        if !value.is_none() {
            table.insert(key, to_toml(&value)?);
        }
    }
    Ok(table)
}
