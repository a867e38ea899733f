//! The Python package `nabiki`: scenes, their motion as NumPy arrays, and every task of the command.
//!
//! A shell of [`nabiki_scene`] like the command and the window. What Python code sees is told where it is defined; its type
//! stubs are made of the same lines.

#![deny(unsafe_code)]

mod arrays;
mod error;
mod field;
mod files;
mod frame;
mod given_arrays;
mod hints;
mod made;
mod numbers;
mod poses;
mod scene;
mod simulation;
mod solution;
mod threads;
mod timeline;
mod values;
mod watched;
mod way;

use pyo3::prelude::*;

/// Hair in the wind.
#[pymodule]
mod _nabiki {
    /// The version of the package.
    #[pymodule_export]
    #[allow(non_upper_case_globals)]
    const __version__: &str = env!("CARGO_PKG_VERSION");
    #[pymodule_export]
    use crate::arrays::Points;
    #[pymodule_export]
    use crate::field::Field;
    #[pymodule_export]
    use crate::files::{convert, info, new, write_hair};
    #[pymodule_export]
    use crate::frame::Frame;
    #[pymodule_export]
    use crate::scene::Scene;
    #[pymodule_export]
    use crate::simulation::Simulation;
    #[pymodule_export]
    use crate::solution::Solution;
    #[pymodule_export]
    use crate::timeline::Timeline;
}
