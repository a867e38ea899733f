//! All frames of a motion at hand.

use std::sync::{Arc, Mutex};

use glam::Vec3;
use nabiki_scene::BuiltScene;
use numpy::PyArray1;
use pyo3::prelude::*;

use crate::arrays::{self, Points};
use crate::error;
use crate::field::PythonField;
use crate::frame::{self, Frame};
use crate::hints::{Float32, Hinted, UInt32};
use crate::numbers::FrameNumber;
use crate::scene::said;
use crate::threads::{alone, detached};
use crate::watched::{Ears, watched};

/// A motion with random access: any frame of it, or all at once.
#[pyclass(frozen, module = "nabiki")]
pub struct Timeline {
    built: Arc<BuiltScene>,
    timeline: Mutex<nabiki::dynamics::Timeline>,
    fields: Vec<Arc<PythonField>>,
    offsets: Py<PyArray1<u32>>,
}

impl Timeline {
    pub fn of(py: Python<'_>, built: Arc<BuiltScene>, fields: Vec<Arc<PythonField>>) -> PyResult<Self> {
        let timeline = detached(py, || built.timeline())?.map_err(|refused| error::raised(py, refused))?;
        let offsets = frame::offsets(py, &built);
        Ok(Self { built, timeline: Mutex::new(timeline), fields, offsets })
    }

    /// What it answers, alone with it. Frames in which a field failed are nobody's motion, so that it then begins anew.
    fn asked<T: Send>(
        &self,
        py: Python<'_>,
        ask: impl FnOnce(&mut nabiki::dynamics::Timeline) -> T + Send,
    ) -> PyResult<T> {
        let mut alone = alone(&self.timeline, "timeline", "timeline")?;
        let timeline = &mut *alone;
        let answer = watched(py, Ears::default(), &self.fields, |_| Ok(ask(timeline)));
        if answer.is_err() {
            *timeline = detached(py, || self.built.timeline())?.map_err(|refused| error::raised(py, refused))?;
        }
        answer
    }
}

#[pymethods]
impl Timeline {
    /// All frames: (frames, P, 3) float32, head space, cm; read-only. They take frames x P x 12 bytes.
    fn play<'py>(&self, py: Python<'py>) -> PyResult<Hinted<'py, Float32>> {
        let frames = self.built.frames() as usize + 1;
        let film = self.asked(py, |timeline| {
            let mut film = vec![Vec3::ZERO; frames * self.built.strands().points().len()];
            timeline.play_into(&mut film);
            film
        })?;
        Ok(Hinted::new(arrays::film(&Bound::new(py, Points::new(film, None))?, frames)))
    }

    /// Any frame, computed from the latest requested one before it.
    fn frame(&self, py: Python<'_>, number: FrameNumber) -> PyResult<Frame> {
        let (number, last) = (number.0, self.built.frames());
        if number > last {
            return Err(error::argument(py, "frame", number, &format!("the frames are 0 to {last}")));
        }
        let points = self.asked(py, |timeline| timeline.seek(number).points().to_vec())?;
        let points = Py::new(py, Points::new(points, None))?;
        let (built, offsets) = (self.built.clone(), self.offsets.clone_ref(py));
        let pose = built.pose(number);
        Ok(Frame { built, points, offsets, number, pose })
    }

    fn __len__(&self) -> usize {
        self.built.frames() as usize + 1
    }

    /// Where strands begin in the points of each frame, with the end as the last value: (S + 1,) uint32.
    #[getter]
    fn offsets<'py>(&self, py: Python<'py>) -> Hinted<'py, UInt32> {
        Hinted::new(self.offsets.bind(py).clone())
    }

    /// The number of each strand among all strands of the scene: (S,) uint32.
    #[getter]
    fn ids<'py>(&self, py: Python<'py>) -> Hinted<'py, UInt32> {
        Hinted::new(PyArray1::from_slice(py, &self.built.groom.ids))
    }

    fn __repr__(&self) -> String {
        format!("<nabiki.Timeline {}>", said::motion(&self.built))
    }
}
