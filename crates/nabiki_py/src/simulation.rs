//! A motion, frame by frame.

use std::sync::{Arc, Mutex};

use nabiki::dynamics::Stepper;
use nabiki_scene::BuiltScene;
use numpy::PyArray1;
use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;

use crate::arrays::{Points, Rooms};
use crate::error;
use crate::field::PythonField;
use crate::frame::{self, Frame};
use crate::hints::{Hinted, UInt32};
use crate::threads::{alone, detached};
use crate::watched::{Ears, watched};

/// The motion of a scene's hair: an iterator over its frames, from rest, frame 0, to the last. Each is computed when it is
/// asked for; those that nobody keeps take no memory. `len()` is the number of all frames.
#[pyclass(frozen, module = "nabiki")]
pub struct Simulation {
    built: Arc<BuiltScene>,
    place: Mutex<Place>,
    fields: Vec<Arc<PythonField>>,
    rooms: Arc<Rooms>,
    offsets: Py<PyArray1<u32>>,
}

/// How far it is.
struct Place {
    stepper: nabiki::dynamics::Simulation,
    next: u32,
    /// Whether a field failed in a step, which is nobody's motion.
    failed: bool,
}

impl Simulation {
    pub fn of(py: Python<'_>, built: Arc<BuiltScene>, fields: Vec<Arc<PythonField>>) -> PyResult<Self> {
        let stepper = detached(py, || built.simulation()).map_err(|refused| error::raised(py, refused))?;
        let offsets = frame::offsets(py, &built);
        let place = Mutex::new(Place { stepper, next: 0, failed: false });
        Ok(Self { built, place, fields, rooms: Arc::default(), offsets })
    }
}

#[pymethods]
impl Simulation {
    fn __iter__(this: PyRef<'_, Self>) -> PyRef<'_, Self> {
        this
    }

    fn __next__(&self, py: Python<'_>) -> PyResult<Option<Frame>> {
        let Self { built, place, fields, rooms, offsets } = self;
        let mut place = alone(place, "simulation", "simulate")?;
        let Place { stepper, next, failed } = &mut *place;
        if *failed {
            let line = "a step of this simulation failed: begin another, scene.simulate()";
            return Err(PyRuntimeError::new_err(line));
        }
        let number = *next;
        if number > built.frames() {
            return Ok(None);
        }
        let count = built.hair.strands.points().len();
        let mut step = || {
            let mut points = rooms.take(count);
            match number {
                0 => points.copy_from_slice(stepper.strands().points()),
                _ => stepper.step_frame_into(&built.input(number), &mut points),
            }
            points
        };
        let points = match fields.is_empty() {
            true => detached(py, step),
            // Only then may a step take long.
            false => watched(py, Ears::default(), fields, |_| Ok(step())).inspect_err(|_| *failed = true)?,
        };
        *next += 1;
        let points = Py::new(py, Points::new(points, Some(rooms.clone())))?;
        Ok(Some(Frame { built: built.clone(), points, offsets: offsets.clone_ref(py), number }))
    }

    fn __len__(&self) -> usize {
        self.built.frames() as usize + 1
    }

    /// Frames that are still to come, for bars of progress.
    fn __length_hint__(&self) -> PyResult<usize> {
        let next = alone(&self.place, "simulation", "simulate")?.next;
        Ok((self.built.frames() + 1).saturating_sub(next) as usize)
    }

    /// Where strands begin in the points of each frame, and at last where they end: (S + 1,) uint32.
    #[getter]
    fn offsets<'py>(&self, py: Python<'py>) -> Hinted<'py, UInt32> {
        Hinted::new(self.offsets.bind(py).clone())
    }

    /// The number of each strand in the whole hair of the scene: (S,) uint32.
    #[getter]
    fn ids<'py>(&self, py: Python<'py>) -> Hinted<'py, UInt32> {
        Hinted::new(PyArray1::from_slice(py, self.built.ids()))
    }
}
