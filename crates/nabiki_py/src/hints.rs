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

/// An object that Python gives, of the type `T` as far as Python's own tools check it.
pub struct Given<'py, T>(pub Bound<'py, PyAny>, pub PhantomData<T>);

impl<'py, T: Hint> FromPyObject<'_, 'py> for Given<'py, T> {
    type Error = Infallible;

    const INPUT_TYPE: PyStaticExpr = T::TYPE;

    fn extract(object: Borrowed<'_, 'py, PyAny>) -> Result<Self, Self::Error> {
        Ok(Self(object.to_owned(), PhantomData))
    }
}

macro_rules! hints {
    ($($(#[$doc:meta])* $name:ident = $type:expr;)*) => {
        $(
            $(#[$doc])*
            pub struct $name;

            impl Hint for $name {
                const TYPE: PyStaticExpr = $type;
            }
        )*
    };
}

/// One of two types.
macro_rules! either {
    ($left:expr, $right:expr) => {
        PyStaticExpr::BinOp { left: $left, op: pyo3::inspect::PyStaticOperator::BitOr, right: $right }
    };
}

const INT: PyStaticExpr = type_hint_identifier!("builtins", "int");
const STR: PyStaticExpr = type_hint_identifier!("builtins", "str");
const OBJECT: PyStaticExpr = type_hint_identifier!("builtins", "object");
const ANY: PyStaticExpr = type_hint_identifier!("typing", "Any");
const CALLABLE: PyStaticExpr = type_hint_identifier!("collections.abc", "Callable");
const ARRAY: PyStaticExpr = type_hint_identifier!("numpy.typing", "NDArray");
const ARRAY_LIKE: PyStaticExpr = type_hint_identifier!("numpy.typing", "ArrayLike");
const NONE: PyStaticExpr = PyStaticExpr::Constant { value: pyo3::inspect::PyStaticConstant::None };
const POSE_LIKE: PyStaticExpr =
    either!(&ARRAY_LIKE, &type_hint_subscript!(type_hint_identifier!("builtins", "tuple"), ARRAY_LIKE, ARRAY_LIKE));
const DICT: PyStaticExpr = type_hint_subscript!(type_hint_identifier!("builtins", "dict"), STR, ANY);

hints! {
    /// An array of float32.
    Float32 = type_hint_subscript!(ARRAY, type_hint_identifier!("numpy", "float32"));
    /// An array of float64.
    Float64 = type_hint_subscript!(ARRAY, type_hint_identifier!("numpy", "float64"));
    /// An array of uint32.
    UInt32 = type_hint_subscript!(ARRAY, type_hint_identifier!("numpy", "uint32"));
    /// What NumPy makes an array of.
    ArrayLike = ARRAY_LIKE;
    /// Anything.
    Anything = ANY;
    /// An object of the class that was asked.
    SameClass = type_hint_identifier!("typing_extensions", "Self");
    /// A dictionary by name.
    Dictionary = DICT;
    /// Dictionaries by name.
    Dictionaries = type_hint_subscript!(type_hint_identifier!("builtins", "list"), DICT);
    /// Values by name.
    ByName = type_hint_subscript!(type_hint_identifier!("collections.abc", "Mapping"), STR, ANY);
    /// Called with what is done and what there is to do.
    Progress = type_hint_subscript!(CALLABLE, PyStaticExpr::List { elts: &[INT, INT] }, OBJECT);
    /// Called with lines.
    Report = type_hint_subscript!(CALLABLE, PyStaticExpr::List { elts: &[STR] }, OBJECT);
    /// Forces at points in a frame.
    Forces = type_hint_subscript!(CALLABLE, PyStaticExpr::List { elts: &[Float32::TYPE, INT] }, ARRAY_LIKE);
    /// A matrix, or a position and a quaternion.
    PoseLike = POSE_LIKE;
    /// Some of them, and some that are not told.
    PosesLike = type_hint_subscript!(type_hint_identifier!("collections.abc", "Iterable"), either!(&POSE_LIKE, &NONE));
    /// One force everywhere, or a field.
    ForceLike = either!(&ARRAY_LIKE, &type_hint_identifier!("nabiki", "Field"));
    /// The scene with its settings as attributes.
    SceneClass = type_hint_identifier!("nabiki", "Scene");
    /// A unit of length by name, or in centimetres.
    UnitName = either!(&STR, &type_hint_identifier!("builtins", "float"));
}
