//! What needs no scene: files of hair in and out.

use std::path::PathBuf;

use nabiki_io::Unit;
use nabiki_io::exchange::{self, DeclaredSpace};
use nabiki_scene::Error;
use nabiki_scene::tasks::{self, ConvertOptions, NewOptions};
use pyo3::prelude::*;
use pyo3::types::PyTuple;

use crate::error;
use crate::made;
use crate::watched::{Ears, watched};

/// Reads hair of one format and writes it in another: .hair, .tfx, .obj, .usda, .usdc, .abc, or frames of a motion cache,
/// .nabiki.
///
/// `frame`: this frame alone. `segments`: cuts every strand anew into so many. `unit` and `z_up`: what the input does not say
/// of itself, for a USD layer to name. `layer`: the prim path of the groom over which samples alone are laid.
#[pyfunction]
#[pyo3(signature = (input: "str | os.PathLike[str]", output: "str | os.PathLike[str]", *, frame=None, segments=None, unit: "str | float | None"=None, z_up=false, layer=None,
    progress: "typing.Callable[[int, int], object] | None"=None, report: "typing.Callable[[str], object] | None"=None))]
#[expect(clippy::too_many_arguments, reason = "named in Python")]
pub fn convert(
    py: Python<'_>,
    input: PathBuf,
    output: PathBuf,
    frame: Option<u32>,
    segments: Option<usize>,
    unit: Option<Bound<'_, PyAny>>,
    z_up: bool,
    layer: Option<String>,
    progress: Option<Bound<'_, PyAny>>,
    report: Option<Bound<'_, PyAny>>,
) -> PyResult<()> {
    let unit = unit.as_ref().map(unit_of).transpose()?;
    let options = ConvertOptions { input, output, frame, segments, unit, z_up, layer };
    let ears = Ears { progress: progress.as_ref(), report: report.as_ref() };
    watched(py, ears, &[], |watch| tasks::convert(&options, watch))
}

/// A unit by its name, or in centimetres.
fn unit_of(given: &Bound<'_, PyAny>) -> PyResult<Unit> {
    let text = given.str()?.to_string();
    text.parse().map_err(|refused: String| error::line(given.py(), format!("unit = {text}: {refused}")))
}

/// What is in a scene, hair file, cache or mesh, as a dictionary; its `kind` says which.
#[pyfunction]
#[pyo3(signature = (file: "str | os.PathLike[str]") -> "dict[str, typing.Any]")]
pub fn info(py: Python<'_>, file: PathBuf) -> PyResult<Bound<'_, PyAny>> {
    let found = watched(py, Ears::default(), &[], |_| nabiki_scene::info::info(&file))?;
    let text = serde_json::to_string(&found).map_err(|e| error::line(py, format!("{}: {e}", file.display())))?;
    py.import("json")?.call_method1("loads", (text,))
}

/// Writes a commented scene to begin with, about a head and hair of files or the built-in ones.
///
/// `groups`: those of the head's file to keep. `replace`: whether a scene that is there already is replaced.
#[pyfunction]
#[pyo3(signature = (file: "str | os.PathLike[str]", *, head: "str | os.PathLike[str] | None"=None, groups=Vec::new(), hair: "str | os.PathLike[str] | None"=None, replace=false,
    report: "typing.Callable[[str], object] | None"=None))]
pub fn new(
    py: Python<'_>,
    file: PathBuf,
    head: Option<PathBuf>,
    groups: Vec<String>,
    hair: Option<PathBuf>,
    replace: bool,
    report: Option<Bound<'_, PyAny>>,
) -> PyResult<()> {
    let options = NewOptions { head, groups, hair, replace };
    let ears = Ears { progress: None, report: report.as_ref() };
    watched(py, ears, &[], |watch| tasks::new(&file, &options, watch))
}

/// Writes hair that stands still: points (P, 3), strand after strand, and offsets (S + 1,), into a .hair, .tfx, .usda, .usdc or
/// .abc file. `unit` and `z_up` are named in a USD layer.
#[pyfunction]
#[pyo3(signature = (file: "str | os.PathLike[str]", points: "numpy.typing.ArrayLike", offsets: "numpy.typing.ArrayLike", *, unit: "str | float"=None, z_up=false))]
pub fn write_hair(
    py: Python<'_>,
    file: PathBuf,
    points: Bound<'_, PyAny>,
    offsets: Bound<'_, PyAny>,
    unit: Option<Bound<'_, PyAny>>,
    z_up: bool,
) -> PyResult<()> {
    let unit = unit.as_ref().map(unit_of).transpose()?;
    let hair = made::hair(&PyTuple::new(py, [points, offsets])?)?;
    watched(py, Ears::default(), &[], |_| {
        if exchange::is_usd(&file) || exchange::is_alembic(&file) {
            let up = if z_up { nabiki_io::Axis::PlusZ } else { nabiki_io::Axis::PlusY };
            let unit = unit.or("cm".parse().ok());
            exchange::write(&file, &hair, DeclaredSpace { unit, up: Some(up) })?;
        } else {
            nabiki_io::hair::write(&file, &hair).map_err(Error::from)?;
        }
        Ok(())
    })
}
