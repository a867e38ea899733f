//! What needs no scene: files of hair in and out.

use std::path::PathBuf;

use nabiki_io::Unit;
use nabiki_io::exchange::{self, DeclaredSpace};
use nabiki_scene::Error;
use nabiki_scene::tasks::{self, ConvertOptions, NewOptions};
use pyo3::prelude::*;
use pyo3::types::{PyString, PyTuple};

use crate::error;
use crate::hints::{ArrayLike, Dictionary, Given, Hinted, Progress, Report, UnitName};
use crate::made;
use crate::numbers::{FirstFrame, FrameNumber, Segments};
use crate::values::shown;
use crate::watched::{Ears, watched};

/// Converts hair from one format to another: .hair, .tfx, .obj, .usda, .usdc, .abc, or frames of a motion cache,
/// .nabiki.
///
/// `frame`: only this frame. `segments`: resample each strand to this many. `unit` and `z_up`: what the input does not
/// contain, to be named in a USD layer. `layer`: the prim path of the groom that a layer of samples covers.
/// `first_frame`: number of the first frame on the time line of the output, instead of that of the input.
#[pyfunction]
#[pyo3(signature = (input, output, *, frame=None, segments=None, unit=None, z_up=false, layer=None,
    first_frame=None, progress=None, report=None))]
#[expect(clippy::too_many_arguments, reason = "named in Python")]
pub fn convert(
    py: Python<'_>,
    input: PathBuf,
    output: PathBuf,
    frame: Option<FrameNumber>,
    segments: Option<Segments>,
    unit: Option<Given<'_, UnitName>>,
    z_up: bool,
    layer: Option<String>,
    first_frame: Option<FirstFrame>,
    progress: Option<Given<'_, Progress>>,
    report: Option<Given<'_, Report>>,
) -> PyResult<()> {
    let unit = unit.as_ref().map(unit_of).transpose()?;
    let (frame, segments) = (frame.map(|FrameNumber(n)| n), segments.map(|Segments(count)| count));
    let first_frame = first_frame.map(|FirstFrame(n)| n);
    let options =
        ConvertOptions { input, output, frame, segments, unit, z_up, layer, first_frame, ..ConvertOptions::default() };
    let ears = Ears::new(&progress, &report);
    watched(py, ears, &[], |watch| tasks::convert(&options, watch))
}

/// A unit by its name, or in centimetres.
fn unit_of(Given(given, _): &Given<'_, UnitName>) -> PyResult<Unit> {
    let text = match given.is_instance_of::<PyString>() {
        true => given.extract()?,
        false => shown(given),
    };
    text.parse().map_err(|refused: String| error::line(given.py(), format!("unit = {text}: {refused}")))
}

/// What a scene, hair file, cache or mesh contains, as a dictionary. `kind` names the kind of file.
#[pyfunction]
#[pyo3(signature = (file))]
pub fn info(py: Python<'_>, file: PathBuf) -> PyResult<Hinted<'_, Dictionary>> {
    let found = watched(py, Ears::default(), &[], |_| nabiki_scene::info::info(&file))?;
    let text = serde_json::to_string(&found).map_err(|e| error::line(py, format!("{}: {e}", file.display())))?;
    py.import("json")?.call_method1("loads", (text,)).map(Hinted::new)
}

/// Writes a new scene with comments, for head and hair from files or the built-in ones.
///
/// `groups`: the groups of the head's file to use. `replace`: whether to replace an existing scene.
#[pyfunction]
#[pyo3(signature = (file, *, head=None, groups=Vec::new(), hair=None, replace=false,
    report=None))]
pub fn new(
    py: Python<'_>,
    file: PathBuf,
    head: Option<PathBuf>,
    groups: Vec<String>,
    hair: Option<PathBuf>,
    replace: bool,
    report: Option<Given<'_, Report>>,
) -> PyResult<()> {
    // The command would name its own option.
    if !replace && file.symlink_metadata().is_ok() {
        let what = "is there already; choose another name, or give replace=True";
        return Err(error::place(py, &file, what, std::io::ErrorKind::AlreadyExists));
    }
    let options = NewOptions { head, groups, hair, replace };
    let ears = Ears::new(&None, &report);
    watched(py, ears, &[], |watch| tasks::new(&file, &options, watch))
}

/// Writes hair at rest to a .hair, .tfx, .usda, .usdc or .abc file. The hair is points (P, 3), strand after strand, and
/// offsets (S + 1,). `unit` and `z_up` are named in a USD layer.
#[pyfunction]
#[pyo3(signature = (file, points, offsets, *, unit=None, z_up=false))]
pub fn write_hair(
    py: Python<'_>,
    file: PathBuf,
    points: Given<'_, ArrayLike>,
    offsets: Given<'_, ArrayLike>,
    unit: Option<Given<'_, UnitName>>,
    z_up: bool,
) -> PyResult<()> {
    let unit = unit.as_ref().map(unit_of).transpose()?;
    let hair = made::hair(&PyTuple::new(py, [points.0, offsets.0])?)?;
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
