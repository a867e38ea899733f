//! Numbers that Python gives as arrays.

use pyo3::intern;
use pyo3::prelude::*;
use pyo3::types::{PyFloat, PyList, PyTuple};

use crate::error;

/// Numbers of whatever NumPy makes an array of. What `kind` cannot hold is refused: NumPy would cut fractions off, take text
/// for numbers and show what is masked.
pub fn numbers<'py>(thing: &str, given: &Bound<'py, PyAny>, kind: &str) -> PyResult<Bound<'py, PyAny>> {
    let py = given.py();
    let numpy = py.import(intern!(py, "numpy"))?;
    let refused = |value: String, way_out: &str| error::argument(py, thing, value, way_out);
    let made = |given: &Bound<'py, PyAny>, arguments: (&Bound<'py, PyAny>, Option<&str>)| {
        let made = numpy.call_method1(intern!(py, "asarray"), arguments);
        let type_ = given.get_type().name().map_or_else(|_| String::new(), |name| name.to_string());
        made.map_err(|e| refused(type_, &format!("is not an array of numbers: {}", e.value(py))))
    };
    check_depth(thing, given, 0)?;
    let array = made(given, (given, None))?;
    let dtype = array.getattr(intern!(py, "dtype"))?;
    let letter: String = dtype.getattr(intern!(py, "kind"))?.extract()?;
    if !matches!(letter.as_str(), "i" | "u" | "f" | "O") {
        return Err(refused(format!("an array of {dtype}"), "must be an array of numbers"));
    }
    if numpy.getattr(intern!(py, "ma"))?.call_method1(intern!(py, "is_masked"), (given,))?.extract()? {
        return Err(refused(
            "a masked array".to_owned(),
            "must have all its values: fill or drop those that are masked",
        ));
    }
    if kind == "int64" && letter == "f" {
        let whole = numpy.call_method1(intern!(py, "trunc"), (&array,))?;
        if !numpy.call_method1(intern!(py, "array_equal"), (whole, &array))?.extract()? {
            return Err(refused(format!("an array of {dtype}"), "must be whole numbers"));
        }
    }
    made(given, (&array, Some(kind)))
}

/// Refuses lists that lie deeper in one another than any array of ours has dimensions. NumPy goes through them before it refuses them,
/// and a list that holds another one twice, which holds a third one twice, has no end.
pub fn check_depth(thing: &str, given: &Bound<'_, PyAny>, depth: usize) -> PyResult<()> {
    const DEEPEST: usize = 3;
    if given.is_instance_of::<PyFloat>() || !(given.is_instance_of::<PyList>() || given.is_instance_of::<PyTuple>()) {
        return Ok(());
    }
    if depth == DEEPEST {
        let way_out = "must be an array of numbers";
        return Err(error::argument(given.py(), thing, format!("a list more than {DEEPEST} lists deep"), way_out));
    }
    given.try_iter()?.try_for_each(|item| check_depth(thing, &item?, depth + 1))
}

/// The shape of an array, as a refused value.
pub fn shape(array: &Bound<'_, PyAny>) -> PyResult<String> {
    Ok(format!("an array of shape {}", array.getattr(intern!(array.py(), "shape"))?))
}
