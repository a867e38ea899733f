//! What the solver found.

use nabiki_scene::solve::Solved;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};

use crate::hints::{Dictionaries, Hinted, SceneClass};

/// A number as a file has it, with no more digits than it takes to tell it from its neighbours of 32 bits.
fn in_file(number: f32) -> f64 {
    number.to_string().parse().unwrap_or(f64::from(number))
}

/// The wind found for some wishes.
#[pyclass(frozen, module = "nabiki")]
pub struct Solution {
    pub scene: Py<PyAny>,
    pub solved: Solved,
}

#[pymethods]
impl Solution {
    /// The scene with the new settings.
    #[getter]
    fn scene<'py>(&self, py: Python<'py>) -> Hinted<'py, SceneClass> {
        Hinted::new(self.scene.bind(py).clone())
    }

    /// The intervals of the new force: (last frame, vector) each.
    #[getter]
    fn forces(&self) -> Vec<(u32, (f64, f64, f64))> {
        self.solved
            .report
            .answer
            .keyframes
            .iter()
            .map(|key| (key.through, key.vector.to_array().map(in_file).into()))
            .collect()
    }

    /// Distance of the hair from the wishes before (root mean square, cm).
    #[getter]
    fn before_cm(&self) -> f64 {
        self.solved.report.before_cm
    }

    /// Distance of the hair from the wishes after (root mean square, cm).
    #[getter]
    fn after_cm(&self) -> f64 {
        self.solved.report.after_cm
    }

    /// Whether each wish is met to within half a centimetre.
    #[getter]
    fn all_met(&self) -> bool {
        self.solved.all_met()
    }

    /// For each wish and nail: its name, `before_cm` and `after_cm`.
    #[getter]
    fn wishes<'py>(&self, py: Python<'py>) -> PyResult<Hinted<'py, Dictionaries>> {
        let all = self.solved.names.iter().zip(&self.solved.report.wishes);
        let found = PyList::empty(py);
        for (name, left) in all {
            let wish = PyDict::new(py);
            wish.set_item("name", name)?;
            wish.set_item("before_cm", left.before_cm)?;
            wish.set_item("after_cm", left.after_cm)?;
            found.append(wish)?;
        }
        Ok(Hinted::new(found))
    }

    /// The text that the command prints.
    fn __str__(&self) -> String {
        self.solved.to_string().trim().to_owned()
    }

    fn __repr__(&self) -> String {
        let report = &self.solved.report;
        let (before, after, wishes) = (report.before_cm, report.after_cm, report.wishes.len());
        let met = if self.solved.all_met() { "all met" } else { "not all met" };
        format!("<nabiki.Solution: {before:.2} cm before, {after:.2} cm after; wishes and nails: {wishes}, {met}>")
    }
}
