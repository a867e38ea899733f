//! What type stubs say of objects that Rust cannot name a type of Python for.

use std::convert::Infallible;
use std::marker::PhantomData;

use pyo3::inspect::PyStaticExpr;
use pyo3::prelude::*;
use pyo3::{type_hint_identifier, type_hint_subscript};

/// The type of an object of Python.
pub trait Hint {
    /// As a stub has it.
    const TYPE: PyStaticExpr;
}

/// An object of Python of the type `T`.
pub struct Hinted<'py, T>(Bound<'py, PyAny>, PhantomData<T>);

impl<'py, T> Hinted<'py, T> {
    pub fn new<O>(object: Bound<'py, O>) -> Self {
        Self(object.into_any(), PhantomData)
    }
}

impl<'py, T: Hint> IntoPyObject<'py> for Hinted<'py, T> {
    type Target = PyAny;
    type Output = Bound<'py, PyAny>;
    type Error = Infallible;

    const OUTPUT_TYPE: PyStaticExpr = T::TYPE;

    fn into_pyobject(self, _: Python<'py>) -> Result<Self::Output, Self::Error> {
        Ok(self.0)
    }
}

const fn array(of: &'static PyStaticExpr) -> PyStaticExpr {
    PyStaticExpr::Subscript { value: &type_hint_identifier!("numpy.typing", "NDArray"), slice: of }
}

/// An array of float32.
pub struct Float32;

impl Hint for Float32 {
    const TYPE: PyStaticExpr = array(&type_hint_identifier!("numpy", "float32"));
}

/// An array of float64.
pub struct Float64;

impl Hint for Float64 {
    const TYPE: PyStaticExpr = array(&type_hint_identifier!("numpy", "float64"));
}

/// An array of uint32.
pub struct UInt32;

impl Hint for UInt32 {
    const TYPE: PyStaticExpr = array(&type_hint_identifier!("numpy", "uint32"));
}

/// Anything.
pub struct Anything;

impl Hint for Anything {
    const TYPE: PyStaticExpr = type_hint_identifier!("typing", "Any");
}

/// Dictionaries by name.
pub struct Dictionaries;

impl Hint for Dictionaries {
    const TYPE: PyStaticExpr = type_hint_subscript!(
        type_hint_identifier!("builtins", "list"),
        type_hint_subscript!(
            type_hint_identifier!("builtins", "dict"),
            type_hint_identifier!("builtins", "str"),
            type_hint_identifier!("typing", "Any")
        )
    );
}
