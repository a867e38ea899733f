//! Hair read from a file and put into head space.

use glam::Vec3;
use nabiki::strands::check_points;
use nabiki::{Hair, SettingError, Strands, subset};
use nabiki_io::hair::{self, ImportReport};
use nabiki_io::identity::StrandSum;
use nabiki_io::{DeclaredSpace, GroomCurves, GroomFile, Placement};

use super::members::Names;
use super::{Groom, GroomInputs, ShardOf, check_memory};
use crate::built::stage::At;
use crate::error::{Error, Result};
use crate::root_ends;
use crate::scene::{ImportedHair, RootEnd, resolved};
use crate::seat;

/// An imported hair file.
#[derive(Clone, Debug)]
pub struct Imported {
    /// Its placement in head space.
    pub placement: Placement,
    /// The file, and its curves in that file.
    pub curves: GroomCurves,
    /// The results of the import.
    pub report: ImportReport,
    /// Number of frames, of which the first is used; 1 for hair that does not move.
    pub frames: usize,
    /// Start of its shot (s), if the file has one.
    pub(crate) begins: Option<f64>,
    /// Unit and axes that it declares.
    pub(crate) declared: DeclaredSpace,
    /// Whether it is also the file of the head.
    pub(crate) of_head: bool,
    /// Strands by which its seat is judged, unchanged (its unit and axes).
    pub(crate) judged: Strands,
}

/// The wanted strands of a file.
pub(super) fn import(inputs: &GroomInputs, settings: &ImportedHair, at: At<'_>) -> Result<Groom> {
    let GroomInputs { model, first, wanted, .. } = inputs;
    let scene = &model.inputs.file;
    let file = at.there(scene, "hair.file", &settings.file)?;
    let mut groom = GroomFile::open(&file)?.keep(&settings.groups).map_err(|e| e.below("hair"))?;
    let declared = groom.declared_space()?;
    let of_head = model.file().is_some_and(|mesh| seat::is_one_file(&mesh, &resolved(scene, &settings.file)));
    let placement = seat::hair_placement(settings, &model.placement, seat::heeded(declared, of_head));
    placement.check("hair").map_err(|refused| at.refusal(refused))?;
    let in_file = groom.hair_in_place(0, None)?;
    at.still_wanted(0.0)?;
    let judged = seat::judged(&in_file);
    let placed = hair::place_and_clean(in_file, &placement, &settings.cleaning());
    let (hair, mut report) = placed.map_err(|e| e.in_file(&file))?;
    at.still_wanted(0.0)?;
    let tip_first = match settings.root {
        RootEnd::First => None,
        RootEnd::Last => Some(vec![true; hair.strands.len()]),
        // A few tell whether it is worth checking all.
        RootEnd::Skin => root_ends::tip_first(&judged, &model.head, &placement)
            .and_then(|_| root_ends::tip_first(&hair.strands, &model.head, &Placement::default())),
    };
    let hair = match tip_first {
        Some(tip_first) => {
            report.tip_first = tip_first.iter().filter(|&&turned| turned).count();
            hair.from_tip_first(tip_first)
        }
        None => hair,
    };
    at.still_wanted(0.0)?;
    let (frames, begins, curves) = (groom.frames()?, groom.start()?, groom.curves(&settings.file)?);
    let of_all = match &curves.curves[..] {
        [only] => only.path.rsplit('/').next().into_iter().chain([only.path.as_str()]).map(str::to_owned).collect(),
        _ => Vec::new(),
    };
    let names = Names { of_all, ..Names::default() };
    // Of all hair, so that any part of it has the same.
    let members = inputs.selectors.members(&[&hair], &model.head, &names).map_err(|refused| at.refusal(refused))?;
    let hair = match settings.strands {
        Some(count) if count > hair.strands.len() => {
            let (file, there) = (settings.file.display(), hair.strands.len());
            let remedy = format!("{file} has {there} strands: request fewer, or leave it out to use all");
            return Err(at.refusal(SettingError::new("hair.strands", count, remedy)));
        }
        Some(count) if count < hair.strands.len() => hair.select(&evenly(&hair, count, at)?),
        _ => hair,
    };
    let of_scene = hair.strands.len();
    let first = (*first).min(of_scene);
    let first = if first == 0 { Hair::default() } else { hair.select(&farthest_first(&hair, first, at)?) };
    let (count, run) = wanted.of(of_scene, false)?;
    let shard = wanted.shard.map(|shard| {
        let groom = StrandSum::of(&hair.strands, 0..of_scene, None);
        ShardOf { shard, strands: count, groom }
    });
    let (hair, ids) = if count < of_scene || run.len() < count {
        let mut chosen = if count < of_scene { evenly(&hair, count, at)? } else { (0..count).collect() };
        chosen = chosen[run].to_vec();
        (hair.select(&chosen), chosen.iter().map(|&s| s as u32).collect())
    } else {
        (hair, (0..of_scene as u32).collect())
    };
    let (hair, first) = (cut(hair, settings.segments, at)?, cut(first, settings.segments, at)?.strands);
    let imported = Some(Imported { placement, curves, report, frames, begins, declared, of_head, judged });
    Ok(Groom { inputs: inputs.clone(), hair, of_scene, shard, imported, ids, first, members })
}

/// Indices of the first strands in the farthest-first order of the roots.
fn farthest_first(hair: &Hair, count: usize, at: At<'_>) -> Result<Vec<usize>> {
    let roots: Vec<Vec3> = hair.strands.iter().map(|strand| strand[0]).collect();
    subset::evenly_while(&roots, count, &|| (at.goes_on)(0.0)).ok_or(Error::Cancelled)
}

/// The same in the order of the file.
fn evenly(hair: &Hair, count: usize, at: At<'_>) -> Result<Vec<usize>> {
    let mut chosen = farthest_first(hair, count, at)?;
    chosen.sort_unstable();
    Ok(chosen)
}

/// The same strands with this many equally long segments each.
fn cut(hair: Hair, segments: Option<usize>, at: At<'_>) -> Result<Hair> {
    let Some(segments) = segments else { return Ok(hair) };
    let points = (hair.strands.len() as u64).saturating_mul(segments as u64 + 1);
    let needed = points.saturating_mul(size_of::<Vec3>() as u64);
    check_memory(at, "hair.segments", segments, needed, "cutting the strands", "ask for fewer, or show fewer strands")?;
    check_points("hair.segments", segments, hair.strands.len()).map_err(|refused| at.refusal(refused))?;
    Ok(hair.resampled(segments + 1))
}
