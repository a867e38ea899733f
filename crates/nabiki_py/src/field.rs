//! A Python function as a field.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

use glam::Vec3;
use nabiki::field::{ROW, VectorRow};
use numpy::{PyArray2, PyArrayMethods, PyReadonlyArray2};
use pyo3::intern;
use pyo3::prelude::*;

use crate::error;
use crate::given_arrays;
use crate::hints::{Forces, Given};
use crate::numbers::Strongest;
use crate::values::shown;

/// A field of force computed by a Python function.
///
/// `function(points, frame)` receives points (N, 3) float32 and the frame number. Points are in cm in the space of the
/// forces: the world, or head space if `motion.force_space` is "head". It returns forces (N, 3), or one (3,) for all
/// points. A force may depend only on the point and the frame. No force may be longer than `strongest`, which lets
/// nabiki refuse a field that is too strong for the hair before the first frame.
///
/// This is slow, some 20 times the step of the hair without it: the function is called for 16 points at a time. Use the
/// fields of the scene where possible.
#[pyclass(frozen, module = "nabiki")]
pub struct Field {
    pub shared: Arc<PythonField>,
}

#[pymethods]
impl Field {
    #[new]
    fn new(py: Python<'_>, function: Given<'_, Forces>, strongest: Strongest) -> PyResult<Self> {
        let strongest = strongest.0;
        let function = function.0;
        if !function.is_callable() {
            return Err(error::argument(py, "function", shown(&function), "must be a function of points and frame"));
        }
        let (failure, failed, stopped) = (Mutex::new(None), AtomicBool::new(false), AtomicBool::new(false));
        Ok(Self { shared: Arc::new(PythonField { function: function.unbind(), strongest, failure, failed, stopped }) })
    }

    /// The function.
    #[getter]
    fn function(&self, py: Python<'_>) -> Py<PyAny> {
        self.shared.function.clone_ref(py)
    }

    /// The bound on the length of the forces.
    #[getter]
    fn strongest(&self) -> f32 {
        self.shared.strongest
    }

    /// Whether both ask the same function, within the same bound.
    fn __eq__(&self, py: Python<'_>, other: &Self) -> PyResult<bool> {
        self.shared.is(py, &other.shared)
    }

    fn __hash__(&self, py: Python<'_>) -> PyResult<isize> {
        self.shared.function.bind(py).hash()
    }

    fn __repr__(&self, py: Python<'_>) -> String {
        let function = self.shared.function.bind(py);
        let name = function.getattr(intern!(py, "__qualname__")).and_then(|name| name.extract::<String>());
        format!("<nabiki.Field {}, strongest {}>", name.unwrap_or_else(|_| shown(function)), self.shared.strongest)
    }
}

/// The function, and what went wrong when it was asked. A step cannot fail, so that from then on the force is none.
#[derive(Debug)]
pub struct PythonField {
    function: Py<PyAny>,
    strongest: f32,
    failure: Mutex<Option<PyErr>>,
    failed: AtomicBool,
    stopped: AtomicBool,
}

impl PythonField {
    /// Whether both ask the same function, within the same bound.
    pub fn is(&self, py: Python<'_>, other: &Self) -> PyResult<bool> {
        Ok(self.strongest == other.strongest && self.function.bind(py).eq(&other.function)?)
    }

    /// Before work begins.
    pub fn begin(&self) {
        self.take_failure();
        self.stopped.store(false, Ordering::Relaxed);
    }

    /// Asks the function no more.
    pub fn stop(&self) {
        self.stopped.store(true, Ordering::Relaxed);
    }

    /// Whether it went wrong.
    pub fn failed(&self) -> bool {
        self.failed.load(Ordering::Relaxed)
    }

    /// What went wrong, if anything did.
    pub fn take_failure(&self) -> Option<PyErr> {
        self.failed.store(false, Ordering::Relaxed);
        self.failure.lock().unwrap_or_else(PoisonError::into_inner).take()
    }

    fn ask(&self, points: &[[f32; 3]], frame: u32) -> Vec<[f32; 3]> {
        let none = || vec![[0.0; 3]; points.len()];
        if self.failed() || self.stopped.load(Ordering::Relaxed) {
            return none();
        }
        Python::attach(|py| {
            self.answer(py, points, frame).unwrap_or_else(|error| {
                self.failure.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert(error);
                self.failed.store(true, Ordering::Relaxed);
                none()
            })
        })
    }

    fn answer(&self, py: Python<'_>, points: &[[f32; 3]], frame: u32) -> PyResult<Vec<[f32; 3]>> {
        let rows = points.len();
        let given = PyArray2::<f32>::zeros(py, [rows, 3], false);
        given.readwrite().as_slice_mut()?.copy_from_slice(points.as_flattened());
        let answer = self.function.call1(py, (given, frame))?.into_bound(py);
        let forces = match answer.extract::<PyReadonlyArray2<'_, f32>>() {
            Ok(forces) => forces,
            Err(_) => asked_of_numpy(&answer, rows)?,
        };
        let view = forces.as_array();
        if view.shape() != [rows, 3] {
            let shape = format!("{:?}", view.shape());
            return Err(error::argument(py, "a field's forces", shape, "must have the shape of the points, or (3,)"));
        }
        // A bound of one number has to hold for lengths that are rounded.
        let most = f64::from(self.strongest) * (1.0 + 1e-5);
        let mut found = Vec::with_capacity(rows);
        for force in view.rows() {
            let force = [force[0], force[1], force[2]];
            let strength = force.iter().map(|&x| f64::from(x).powi(2)).sum::<f64>().sqrt();
            if strength.is_nan() || strength > most {
                let way_out = if strength.is_nan() {
                    format!("is not finite in frame {frame}: let the function return finite forces")
                } else {
                    format!("is above its bound in frame {frame}: give Field(function, strongest=...) a larger one")
                };
                return Err(error::argument(py, "a field's force", strength, &way_out));
            }
            found.push(force);
        }
        Ok(found)
    }
}

/// Whatever NumPy makes (rows, 3) floats of.
fn asked_of_numpy<'py>(answer: &Bound<'py, PyAny>, rows: usize) -> PyResult<PyReadonlyArray2<'py, f32>> {
    let py = answer.py();
    let numpy = py.import(intern!(py, "numpy"))?;
    given_arrays::check_depth("a field's forces", answer, 0)?;
    let array = numpy.call_method1(intern!(py, "asarray"), (answer, intern!(py, "float32")))?;
    let shape: Vec<usize> = array.getattr(intern!(py, "shape"))?.extract()?;
    if shape == [3] {
        let all = numpy.call_method1(intern!(py, "broadcast_to"), (array, (rows, 3)))?;
        return Ok(numpy.call_method1(intern!(py, "ascontiguousarray"), (all,))?.extract()?);
    }
    array.extract().map_err(|_| {
        let shape = format!("{shape:?}");
        error::argument(py, "a field's forces", shape, "must have the shape of the points, or (3,)")
    })
}

impl nabiki::field::Field for PythonField {
    fn at(&self, point: Vec3, frame: u32) -> Vec3 {
        Vec3::from(self.ask(&[point.to_array()], frame)[0])
    }

    fn strongest(&self) -> f32 {
        self.strongest
    }

    fn at_row(&self, points: &VectorRow, frame: u32, forces: &mut VectorRow) {
        let given: [[f32; 3]; ROW] = std::array::from_fn(|i| points.map(|along| along[i]));
        for (i, force) in self.ask(&given, frame).into_iter().enumerate() {
            [forces[0][i], forces[1][i], forces[2][i]] = force;
        }
    }
}
