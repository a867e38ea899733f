//! What can be done with a scene.

use std::path::{Path, PathBuf};

use nabiki_io::moving::ChainOptions;
use nabiki_render::output::{self, exr, png};
use nabiki_render::{RenderError, ToneMapping};
use nabiki_scene::Shown;
use nabiki_scene::exports::ExportOptions;
use nabiki_scene::solve::WishFile;
use nabiki_scene::tasks::{self, PREVIEW_STRANDS, SimulateOptions, Twin};
use numpy::{PyArray1, PyArrayMethods};
use pyo3::prelude::*;
use pyo3::types::PyBytes;

use super::{Scene, State};
use crate::arrays::{self, Points};
use crate::error;
use crate::hints::{ArrayLike, ByName, Float32, Given, Hinted, Progress, Report, UInt32};
use crate::numbers::{FrameNumber, Strands};
use crate::simulation::Simulation;
use crate::solution::Solution;
use crate::threads::detached;
use crate::timeline::Timeline;
use crate::values::Walk;
use crate::watched::{Ears, watched};

/// Refuses frames that the scene does not reach.
fn check_frame(py: Python<'_>, frame: u32, last: u32) -> PyResult<()> {
    if frame <= last {
        return Ok(());
    }
    Err(error::argument(py, "frame", frame, &format!("the frames are 0 to motion.frames = {last}")))
}

/// Refuses what no picture with this ending can be written to, before it is drawn.
fn check_picture(py: Python<'_>, file: &Path, ending: &str, others: &str) -> PyResult<()> {
    let refused = |way_out: &str| Err(error::argument(py, "file", file.display(), way_out));
    if !file.extension().is_some_and(|found| found.eq_ignore_ascii_case(ending)) {
        return refused(&format!("must end in .{ending}; {others}, scene.render gives light itself"));
    }
    match file.parent() {
        Some(folder) if !folder.as_os_str().is_empty() && !folder.is_dir() => {
            Err(error::place(py, file, "its folder does not exist: make it first", std::io::ErrorKind::NotFound))
        }
        _ => Ok(()),
    }
}

/// The bytes of a picture, which go into a file, too, if one is named.
fn encoded<'py>(
    py: Python<'py>,
    file: Option<&Path>,
    encode: impl FnOnce() -> Result<Vec<u8>, RenderError> + Send,
) -> PyResult<Bound<'py, PyBytes>> {
    let written = detached(py, || {
        let bytes = encode()?;
        file.map_or(Ok(()), |file| output::write_bytes(file, &bytes)).map(|()| bytes)
    });
    let bytes = written?.map_err(|refused| error::raised(py, refused.into()))?;
    Ok(PyBytes::new(py, &bytes))
}

impl Scene {
    /// One frame as light, and what brings it onto a screen.
    fn drawn(
        &self,
        py: Python<'_>,
        FrameNumber(frame): FrameNumber,
        layers: bool,
        strands: Option<Strands>,
        ears: Ears<'_, '_>,
    ) -> PyResult<(nabiki_render::Frame, ToneMapping)> {
        check_frame(py, frame, self.now().motion.frames)?;
        let built = self.built(py, shown(strands), ears)?;
        let frame = watched(py, ears, &self.functions(), |watch| tasks::draw(&built, frame, layers, watch))?;
        Ok((frame, ToneMapping::new(&built.scene.picture)))
    }
}

#[pymethods]
impl Scene {
    /// The hair at rest: points (P, 3) float32, head space, cm, and offsets (S + 1,) uint32.
    ///
    /// `strands`: use only this many, spread evenly over the scalp. `file`: also write the hair to this file.
    #[pyo3(signature = (*, strands=None, file=None, report=None))]
    fn groom<'py>(
        &self,
        py: Python<'py>,
        strands: Option<Strands>,
        file: Option<PathBuf>,
        report: Option<Given<'_, Report>>,
    ) -> PyResult<(Hinted<'py, Float32>, Hinted<'py, UInt32>)> {
        let ears = Ears::new(&None, &report);
        if let Some(file) = file {
            let State { scene, made: _held, .. } = self.checked(py)?;
            watched(py, ears, &[], |watch| tasks::groom(scene, shown(strands), &file, watch))?;
        }
        let built = self.built(py, shown(strands), ears)?;
        let points = Bound::new(py, Points::new(built.strands().points().to_vec(), None))?;
        Ok((Hinted::new(arrays::flat(&points)), Hinted::new(crate::frame::offsets(py, &built).into_bound(py))))
    }

    /// The motion, frame by frame, starting at rest. `strands`: use only this many, spread evenly over the scalp. Each
    /// moves exactly as it does among all.
    #[pyo3(signature = (strands=None))]
    fn simulate(&self, py: Python<'_>, strands: Option<Strands>) -> PyResult<Simulation> {
        let built = self.built(py, shown(strands), Ears::default())?;
        Simulation::of(py, built, self.functions())
    }

    /// The motion with random access: any frame, or all at once.
    #[pyo3(signature = (strands=None))]
    fn _timeline(&self, py: Python<'_>, strands: Option<Strands>) -> PyResult<Timeline> {
        let built = self.built(py, shown(strands), Ears::default())?;
        Timeline::of(py, built, self.functions())
    }

    /// The force at points (N, 3) in a frame: (N, 3) float32. Points (cm) and forces are in the space of the forces,
    /// the world unless `motion.force_space` is "head".
    #[pyo3(signature = (points, frame))]
    fn force_at<'py>(
        &self,
        py: Python<'py>,
        points: Given<'py, ArrayLike>,
        frame: FrameNumber,
    ) -> PyResult<Hinted<'py, Float32>> {
        let points = crate::made::points_of("points", &points.0)?;
        let built = self.built(py, self.shown_last(), Ears::default())?;
        let forces = watched(py, Ears::default(), &self.functions(), |_| {
            Ok(points.iter().flat_map(|&point| built.force_at(point, frame.0).to_array()).collect::<Vec<f32>>())
        })?;
        PyArray1::from_vec(py, forces).reshape([points.len(), 3]).map(Hinted::new)
    }

    /// Renders a frame as light: (height, width, 4) float32, linear Rec. 709, premultiplied.
    #[pyo3(signature = (frame, *, strands=None, progress=None))]
    fn render<'py>(
        &self,
        py: Python<'py>,
        frame: FrameNumber,
        strands: Option<Strands>,
        progress: Option<Given<'_, Progress>>,
    ) -> PyResult<Hinted<'py, Float32>> {
        let (frame, _) = self.drawn(py, frame, false, strands, Ears::new(&progress, &None))?;
        let [width, height] = frame.size.map(|side| side as usize);
        PyArray1::from_vec(py, frame.rgba.into_flattened()).reshape([height, width, 4]).map(Hinted::new)
    }

    /// Renders a frame as the bytes of a PNG file, like `nabiki render`. With `file`, also writes it.
    #[pyo3(signature = (frame, *, file=None, strands=None, progress=None))]
    fn render_png<'py>(
        &self,
        py: Python<'py>,
        frame: FrameNumber,
        file: Option<PathBuf>,
        strands: Option<Strands>,
        progress: Option<Given<'_, Progress>>,
    ) -> PyResult<Bound<'py, PyBytes>> {
        if let Some(file) = &file {
            check_picture(py, file, "png", "scene.render_exr writes OpenEXR")?;
        }
        let (frame, tone_mapping) = self.drawn(py, frame, false, strands, Ears::new(&progress, &None))?;
        encoded(py, file.as_deref(), || png::bytes(&frame, &tone_mapping))
    }

    /// Renders a frame as the bytes of an OpenEXR file, like `output.exr_frames`: 32-bit light, depth, coverage, and
    /// the directions and movement of hair and head. With `file`, also writes it.
    #[pyo3(signature = (frame, *, file=None, strands=None, progress=None))]
    fn render_exr<'py>(
        &self,
        py: Python<'py>,
        frame: FrameNumber,
        file: Option<PathBuf>,
        strands: Option<Strands>,
        progress: Option<Given<'_, Progress>>,
    ) -> PyResult<Bound<'py, PyBytes>> {
        if let Some(file) = &file {
            check_picture(py, file, "exr", "scene.render_png writes PNG")?;
        }
        let (frame, _) = self.drawn(py, frame, true, strands, Ears::new(&progress, &None))?;
        encoded(py, file.as_deref(), || exr::bytes(&frame))
    }

    /// Renders all frames into `folder`: a movie, a contact sheet and whatever else the settings of `output` request.
    #[pyo3(signature = (folder="out".into(), *, strands=None, progress=None,
        report=None))]
    fn run(
        &self,
        py: Python<'_>,
        folder: PathBuf,
        strands: Option<Strands>,
        progress: Option<Given<'_, Progress>>,
        report: Option<Given<'_, Report>>,
    ) -> PyResult<()> {
        let State { scene, fields, made: _held, .. } = self.checked(py)?;
        let (shown, none) = (shown(strands), ExportOptions::default());
        watched(py, Ears::new(&progress, &report), &fields, |watch| tasks::run(scene, shown, &folder, &none, watch))
    }

    /// Like `run`, but small and fast, with 300 strands unless you give `strands`.
    #[pyo3(signature = (folder="out".into(), *, strands=None, progress=None,
        report=None))]
    fn preview(
        &self,
        py: Python<'_>,
        folder: PathBuf,
        strands: Option<Strands>,
        progress: Option<Given<'_, Progress>>,
        report: Option<Given<'_, Report>>,
    ) -> PyResult<()> {
        let State { scene, fields, made: _held, .. } = self.checked(py)?;
        let shown = strands.map_or(Shown::AtMost(PREVIEW_STRANDS), |Strands(count)| Shown::First(count));
        watched(py, Ears::new(&progress, &report), &fields, |watch| tasks::preview(scene, shown, &folder, None, watch))
    }

    /// Writes the moving hair: .usdc, .usda or .abc for other programs, .glb or .exr for engines, .pc2 or .mdd point caches,
    /// or a motion cache, .nabiki. An .exr is a vertex-animation texture, with its mesh, .exr.glb, and a text, .exr.txt.
    ///
    /// `strands`: use only this many. `layer`: the prim path of the groom that a layer of samples covers. `head`:
    /// whether to add the head if it would be omitted: the built-in one, and any head in an .abc file. In a .glb:
    /// `chains`, the number of chains of joints and of joints in each; `cards`, the width of the ribbons in cm, 0 for
    /// lines (with an .exr, too); `springs`, whether to add VRM's spring bones.
    #[pyo3(signature = (file, *, strands=None, layer=None, head=false, chains=(64, 8), cards=0.4, springs=false, progress=None,
        report=None))]
    #[expect(clippy::too_many_arguments, reason = "named in Python")]
    fn export(
        &self,
        py: Python<'_>,
        file: PathBuf,
        strands: Option<Strands>,
        layer: Option<String>,
        head: bool,
        chains: (u32, u32),
        cards: f32,
        springs: bool,
        progress: Option<Given<'_, Progress>>,
        report: Option<Given<'_, Report>>,
    ) -> PyResult<()> {
        let (chains, joints) = chains;
        let chains = ChainOptions { chains, joints, cards, springs: None };
        let exports = ExportOptions { layer, head, chains, springs, ..ExportOptions::default() };
        let options = SimulateOptions { output: file, exports, twin: Twin::Fast, shard: None };
        let State { scene, fields, made: _held, .. } = self.checked(py)?;
        let shown = shown(strands);
        watched(py, Ears::new(&progress, &report), &fields, |watch| tasks::simulate(scene, shown, &options, watch))
    }

    /// Finds the wind that makes the hair do what the wishes ask for. This scene does not change; the answer has its
    /// own.
    ///
    /// `problem`: the contents of a wish file, as a dictionary. `strands`: how many strands to search for locks near a
    /// point.
    #[pyo3(signature = (problem, *, strands=Strands(300), progress=None, report=None))]
    fn _solve<'py>(
        this: &Bound<'py, Self>,
        problem: Given<'py, ByName>,
        strands: Strands,
        progress: Option<Given<'_, Progress>>,
        report: Option<Given<'_, Report>>,
    ) -> PyResult<Solution> {
        let py = this.py();
        let text = Walk::default().table("", problem.0.cast()?)?.to_string();
        let wishes = WishFile::parse(&text, "".as_ref()).map_err(|refused| error::raised(py, refused.into()))?;
        Self::found(this, &wishes, strands, Ears::new(&progress, &report))
    }

    /// The same for a wish file.
    #[pyo3(signature = (wishes, *, strands=Strands(300), progress=None, report=None))]
    fn _solve_file<'py>(
        this: &Bound<'py, Self>,
        wishes: PathBuf,
        strands: Strands,
        progress: Option<Given<'_, Progress>>,
        report: Option<Given<'_, Report>>,
    ) -> PyResult<Solution> {
        let wishes = WishFile::load(&wishes).map_err(|refused| error::raised(this.py(), refused.into()))?;
        Self::found(this, &wishes, strands, Ears::new(&progress, &report))
    }
}

impl Scene {
    fn found<'py>(
        this: &Bound<'py, Self>,
        wishes: &WishFile,
        Strands(strands): Strands,
        ears: Ears<'_, 'py>,
    ) -> PyResult<Solution> {
        let py = this.py();
        let State { scene, fields, made, built } = this.get().checked(py)?;
        let (scene, solved) = watched(py, ears, &fields, |watch| tasks::find(scene, wishes, strands, watch))?;
        let state = State { scene, fields, made, built };
        Ok(Solution { scene: Self::another(&this.get_type(), state)?.unbind(), solved })
    }

    /// The strands that were asked for last, so that they are not built anew.
    fn shown_last(&self) -> Shown {
        self.state().built.as_ref().map_or(Shown::All, |built| built.shown)
    }
}

fn shown(strands: Option<Strands>) -> Shown {
    strands.map_or(Shown::All, |Strands(count)| Shown::First(count))
}
