//! One frame of a motion, as Python has it.

use std::sync::Arc;

use nabiki::Pose;
use nabiki_scene::BuiltScene;
use numpy::{PyArray1, PyArrayMethods};
use pyo3::prelude::*;

use crate::arrays::{self, Points};
use crate::hints::{Float32, Float64, Hinted, UInt32};

/// The hair in one frame.
#[pyclass(frozen, module = "nabiki")]
pub struct Frame {
    pub built: Arc<BuiltScene>,
    pub points: Py<Points>,
    pub offsets: Py<PyArray1<u32>>,
    pub number: u32,
    /// Of the head.
    pub pose: Pose,
}

#[pymethods]
impl Frame {
    /// The points of all strands, strand after strand, root first: (P, 3) float32, head space, cm. Read-only and
    /// without a copy: the array is the memory that the frame was computed into, and keeps it alive. To write, use
    /// `points.copy()`.
    #[getter]
    fn points<'py>(&self, py: Python<'py>) -> Hinted<'py, Float32> {
        Hinted::new(arrays::flat(self.points.bind(py)))
    }

    /// Where strands begin in `points`, with the end as the last value: (S + 1,) uint32. Strand s is
    /// `points[offsets[s]:offsets[s + 1]]`.
    #[getter]
    fn offsets<'py>(&self, py: Python<'py>) -> Hinted<'py, UInt32> {
        Hinted::new(self.offsets.bind(py).clone())
    }

    /// The number of the frame; 0 is rest.
    #[getter]
    fn number(&self) -> u32 {
        self.number
    }

    /// The pose of the head: a (4, 4) float64 matrix from head space into the world (cm). Apply it as
    /// `points @ m[:3, :3].T + m[:3, 3]`.
    #[getter]
    fn head_pose<'py>(&self, py: Python<'py>) -> PyResult<Hinted<'py, Float64>> {
        let pose = self.pose;
        let rotation = glam::DMat3::from_quat(pose.rotation.as_dquat()).transpose();
        let rows = [rotation.x_axis, rotation.y_axis, rotation.z_axis];
        let at = pose.position_cm.as_dvec3();
        let mut matrix: Vec<f64> = Vec::with_capacity(16);
        for (row, at) in rows.iter().zip(at.to_array()) {
            matrix.extend([row.x, row.y, row.z, at]);
        }
        matrix.extend([0.0, 0.0, 0.0, 1.0]);
        PyArray1::from_vec(py, matrix).reshape([4, 4]).map(Hinted::new)
    }

    /// The points in the world (cm): (P, 3) float32, a copy.
    fn world_points<'py>(&self, py: Python<'py>) -> PyResult<Hinted<'py, Float32>> {
        let world = self.pose.world_from_head();
        let points = self.points.get().points();
        let moved: Vec<f32> = points.iter().flat_map(|&p| world.transform_point3(p).to_array()).collect();
        PyArray1::from_vec(py, moved).reshape([points.len(), 3]).map(Hinted::new)
    }

    fn __repr__(&self) -> String {
        let (strands, points) = (self.built.strands().len(), self.points.get().points().len());
        format!("<nabiki.Frame {}: {strands} strands, {points} points (cm, head space)>", self.number)
    }
}

/// The offsets of the strands of a scene, to be shared by its frames.
pub fn offsets(py: Python<'_>, built: &BuiltScene) -> Py<PyArray1<u32>> {
    let array = PyArray1::from_slice(py, built.strands().starts());
    array.readwrite().make_nonwriteable();
    array.unbind()
}
