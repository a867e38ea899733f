//! Points on their way to NumPy, which looks at the very memory that they were computed into. The one place with `unsafe`:
//! a frame of 20,000 strands is 5 MB, and copying it takes longer than moving the hair.
#![allow(unsafe_code)]

use std::sync::{Arc, Mutex, PoisonError};

use bytemuck::cast_slice;
use glam::Vec3;
use numpy::ndarray::{ArrayView2, ArrayView3};
use numpy::{PyArray2, PyArray3, PyArrayMethods};
use pyo3::prelude::*;

/// Rooms of points that are used again once Python has let go of the frame that they held, so that frames which nobody keeps
/// take no new memory.
#[derive(Debug, Default)]
pub struct Rooms(Mutex<Vec<Vec<Vec3>>>);

impl Rooms {
    /// Rooms that wait for use: the frame at hand, the one before it and one in making.
    const KEPT: usize = 3;

    /// Room for so many points, whatever is in it.
    pub fn take(&self, points: usize) -> Vec<Vec3> {
        let room = self.0.lock().unwrap_or_else(PoisonError::into_inner).pop();
        room.filter(|room| room.len() == points).unwrap_or_else(|| vec![Vec3::ZERO; points])
    }

    fn give_back(&self, room: Vec<Vec3>) {
        let mut rooms = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if rooms.len() < Self::KEPT {
            rooms.push(room);
        }
    }
}

/// Memory that arrays of points look into; it lives as long as any of them.
#[pyclass(frozen, name = "_Points", module = "nabiki")]
pub struct Points {
    points: Vec<Vec3>,
    rooms: Option<Arc<Rooms>>,
}

impl Points {
    /// Points that nothing changes from now on; they go back to `rooms` when the last array is gone.
    pub fn new(points: Vec<Vec3>, rooms: Option<Arc<Rooms>>) -> Self {
        Self { points, rooms }
    }

    /// The points.
    pub fn points(&self) -> &[Vec3] {
        &self.points
    }
}

#[pymethods]
impl Points {
    fn __repr__(&self) -> String {
        format!("<the memory of {} points>", self.points.len())
    }
}

impl Drop for Points {
    fn drop(&mut self) {
        if let Some(rooms) = &self.rooms {
            rooms.give_back(std::mem::take(&mut self.points));
        }
    }
}

/// The points as a read-only array of shape (P, 3).
pub fn flat<'py>(points: &Bound<'py, Points>) -> Bound<'py, PyArray2<f32>> {
    let numbers: &[f32] = cast_slice(points.get().points());
    let view = ArrayView2::from_shape((numbers.len() / 3, 3), numbers).expect("three numbers a point");
    // SAFETY: `points` is frozen, so that its memory is neither moved nor written while the array, whose base it is, holds it.
    let array = unsafe { PyArray2::borrow_from_array(&view, points.clone().into_any()) };
    array.readwrite().make_nonwriteable();
    array
}

/// The points of some frames as a read-only array of shape (frames, P, 3).
pub fn film<'py>(points: &Bound<'py, Points>, frames: usize) -> Bound<'py, PyArray3<f32>> {
    let numbers: &[f32] = cast_slice(points.get().points());
    let shape = (frames, numbers.len() / 3 / frames, 3);
    let view = ArrayView3::from_shape(shape, numbers).expect("as many points in every frame");
    // SAFETY: as above.
    let array = unsafe { PyArray3::borrow_from_array(&view, points.clone().into_any()) };
    array.readwrite().make_nonwriteable();
    array
}
