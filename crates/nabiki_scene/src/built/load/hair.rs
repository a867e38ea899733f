//! A scene's hair: grown on its head, or read from a file and put into head space.

use std::fmt::Display;
use std::ops::Range;
use std::sync::Arc;

use glam::Vec3;
use nabiki::strands::check_points;
use nabiki::{Hair, Head, SettingError, Strands, subset};
use nabiki_groom::roots::{self, Root};
use nabiki_groom::{Growth, grow_run_while};
use nabiki_io::cache::Shard;
use nabiki_io::hair::{self, ImportReport};
use nabiki_io::identity::StrandSum;
use nabiki_io::placement::Placement;
use nabiki_io::{DeclaredSpace, GroomCurves, GroomFile};

use super::{GoesOn, free, still_wanted, there};
use crate::built::{BuiltScene, ShardOf, Shown};
use crate::error::{Error, Result};
use crate::memory;
use crate::root_ends;
use crate::scene::{EllipsoidChoice, GrownHair, HairSource, ImportedHair, RootEnd, Scene};
use crate::seat;

/// Hair at rest, some or all of the scene's.
pub(super) struct LoadedHair {
    pub hair: Hair,
    /// Where it grows; none for hair of a file.
    pub roots: Arc<[Root]>,
    /// Number of each strand in the whole.
    pub ids: Vec<u32>,
    /// Strands of the whole.
    pub of_scene: usize,
    /// Which shard it is.
    pub shard: Option<ShardOf>,
    /// The first strands of the farthest-first order of the whole, whichever are shown: those that the free form asks of.
    pub first: Strands,
    /// What its file was; `None` for hair grown here.
    pub imported: Option<Imported>,
    /// Frames of the file.
    pub frames: usize,
    /// When the shot begins that the file is of (s), where it says so.
    pub begins: Option<f64>,
}

/// What there is to know of a hair file.
pub(super) struct Imported {
    pub placement: Placement,
    /// Where its curves are.
    pub groom: GroomCurves,
    pub report: ImportReport,
    pub declared: DeclaredSpace,
    /// Strands by which it is judged (the file's unit and axes).
    pub judged: Strands,
}

impl LoadedHair {
    /// That of a scene that is built.
    pub fn of(built: &BuiltScene) -> Self {
        let imported = match (built.hair_placement, &built.groom, built.import_report) {
            (Some(placement), Some(groom), Some(report)) => {
                let (groom, judged) = (groom.clone(), built.judged.clone());
                Some(Imported { placement, groom, report, declared: built.hair_declared, judged })
            }
            _ => None,
        };
        Self {
            hair: built.hair.clone(),
            roots: built.roots.clone(),
            ids: built.ids.clone(),
            of_scene: built.strands_of_scene,
            shard: built.shard,
            first: built.first.clone(),
            imported,
            frames: built.frames_in_file,
            begins: built.hair_begins,
        }
    }
}

/// Which strands are wanted.
#[derive(Clone, Copy)]
pub(super) struct Wanted {
    pub shown: Shown,
    /// One run of these alone.
    pub shard: Option<Shard>,
}

impl Wanted {
    /// How many strands of `of_scene` are shown, and which run of these is wanted.
    fn of(self, of_scene: usize, grown: bool) -> Result<(usize, Range<usize>)> {
        let count = self.shown.of(of_scene, grown)?;
        let Some(shard) = self.shard else { return Ok((count, 0..count)) };
        if shard.of() as usize > count {
            let line = format!("shard {shard}: more shards than there are strands; part them into {count} at the most");
            return Err(Error::refused(line));
        }
        Ok((count, shard.range(count)))
    }
}

/// `same_head`: a scene that is built, with the same head.
pub(super) fn load_hair(
    scene: &Scene,
    head: &Head,
    head_placement: &Placement,
    wanted: Wanted,
    same_head: Option<&BuiltScene>,
    goes_on: GoesOn<'_>,
) -> Result<LoadedHair> {
    match &scene.hair.source {
        HairSource::Grown(settings) => {
            let (count, run) = wanted.of(settings.strands, true)?;
            let first = free::first_wanted(scene).min(settings.strands);
            let rooted = run.end.max(first);
            let roots = match same_head.and_then(|known| known_roots(known, settings, rooted)) {
                Some(roots) => roots,
                None => {
                    let GrownHair { strands, seed, hairline, .. } = settings;
                    // The roots of all are spread, however few are shown.
                    let needed = roots::least_bytes(*strands);
                    check_memory(scene, "hair.strands", strands, needed, "to spread its roots", "grow less")?;
                    let still = || goes_on(0.0);
                    let roots = roots::spread_first_while(head, hairline, *strands, rooted, *seed, &still);
                    roots.map_err(|refused| no_scalp(scene, refused))?.ok_or(Error::Cancelled)?.into()
                }
            };
            let (hair, first) = if run.start < first {
                // What is wanted first is grown anyway.
                let hair = grown(scene, settings, head, &roots, 0, goes_on)?;
                let first = hair.strands.select(&(0..first).collect::<Vec<_>>());
                (
                    if hair.strands.len() > run.len() { hair.select(&run.clone().collect::<Vec<_>>()) } else { hair },
                    first,
                )
            } else {
                let first = grown(scene, settings, head, &roots[..first], 0, &|_| goes_on(0.0))?.strands;
                (grown(scene, settings, head, &roots[run.clone()], run.start, goes_on)?, first)
            };
            let ids = run.map(|number| number as u32).collect();
            let shard = wanted.shard.map(|shard| ShardOf { shard, strands: count, groom: StrandSum::default() });
            let of_scene = settings.strands;
            Ok(LoadedHair { hair, roots, ids, of_scene, shard, first, imported: None, frames: 1, begins: None })
        }
        HairSource::Imported(settings) => import(scene, settings, (head, head_placement), wanted, goes_on),
    }
}

/// A refusal of roots. Hair grows where the skin lies near the ellipsoid: one that is given may be to blame as well.
fn no_scalp(scene: &Scene, mut refused: SettingError) -> Error {
    if refused.thing == "hair.hairline" && matches!(scene.head.ellipsoid, EllipsoidChoice::Given(_)) {
        refused.remedy += ", or mend head.ellipsoid: hair grows where the skin lies near that";
    }
    scene.refusal(refused).into()
}

fn import(
    scene: &Scene,
    settings: &ImportedHair,
    (head, head_placement): (&Head, &Placement),
    wanted: Wanted,
    goes_on: GoesOn<'_>,
) -> Result<LoadedHair> {
    let file = there(scene, "hair.file", &settings.file)?;
    let mut groom = GroomFile::open(&file)?.keep(&settings.groups).map_err(|e| e.below("hair"))?;
    let declared = groom.declared_space()?;
    let placement = seat::hair_placement(settings, head_placement, seat::heeded(declared, scene.hair_is_of_head()));
    placement.check("hair").map_err(|refused| scene.refusal(refused))?;
    let in_file = groom.hair_in_place(0, None)?;
    still_wanted(goes_on, 0.0)?;
    let judged = seat::judged(&in_file);
    let placed = hair::place_and_clean(in_file, &placement, &settings.cleaning());
    let (hair, mut report) = placed.map_err(|e| e.in_file(&file))?;
    still_wanted(goes_on, 0.0)?;
    let tip_first = match settings.root {
        RootEnd::First => None,
        RootEnd::Last => Some(vec![true; hair.strands.len()]),
        // Few tell whether it is worth asking all.
        RootEnd::Skin => root_ends::tip_first(&judged, head, &placement)
            .and_then(|_| root_ends::tip_first(&hair.strands, head, &Placement::default())),
    };
    let hair = match tip_first {
        Some(tip_first) => {
            report.tip_first = tip_first.iter().filter(|&&turned| turned).count();
            hair.from_tip_first(tip_first)
        }
        None => hair,
    };
    still_wanted(goes_on, 0.0)?;
    let hair = match settings.strands {
        Some(count) if count > hair.strands.len() => {
            let remedy = format!(
                "{} has {} strands: ask for fewer, or for all by leaving it out",
                settings.file.display(),
                hair.strands.len()
            );
            return Err(scene.refusal(SettingError::new("hair.strands", count, remedy)).into());
        }
        Some(count) if count < hair.strands.len() => hair.select(&evenly(&hair, count, goes_on)?),
        _ => hair,
    };
    let of_scene = hair.strands.len();
    let first = free::first_wanted(scene).min(of_scene);
    let first = if first == 0 { Hair::default() } else { hair.select(&farthest_first(&hair, first, goes_on)?) };
    let (count, run) = wanted.of(of_scene, false)?;
    let shard = wanted.shard.map(|shard| {
        let groom = StrandSum::of(&hair.strands, 0..of_scene, None);
        ShardOf { shard, strands: count, groom }
    });
    let (hair, ids) = if count < of_scene || run.len() < count {
        let mut chosen = if count < of_scene { evenly(&hair, count, goes_on)? } else { (0..count).collect() };
        chosen = chosen[run].to_vec();
        (hair.select(&chosen), chosen.iter().map(|&s| s as u32).collect())
    } else {
        (hair, (0..of_scene as u32).collect())
    };
    let cut = |hair: Hair| -> Result<Hair> {
        match settings.segments {
            Some(segments) => {
                let points = (hair.strands.len() as u64).saturating_mul(segments as u64 + 1);
                let needed = points.saturating_mul(size_of::<Vec3>() as u64);
                check_memory(
                    scene,
                    "hair.segments",
                    segments,
                    needed,
                    "to cut it",
                    "cut into fewer, or show fewer strands",
                )?;
                cut_anew(&hair, segments).map_err(|refused| scene.refusal(refused).into())
            }
            None => Ok(hair),
        }
    };
    let (hair, first) = (cut(hair)?, cut(first)?.strands);
    let (frames, begins, groom) = (groom.frames()?, groom.start()?, groom.curves(&settings.file)?);
    let imported = Some(Imported { placement, groom, report, declared, judged });
    Ok(LoadedHair { hair, roots: Arc::default(), ids, of_scene, shard, first, imported, frames, begins })
}

/// The first `count` strands of the farthest-first order of the roots.
fn farthest_first(hair: &Hair, count: usize, goes_on: GoesOn<'_>) -> Result<Vec<usize>> {
    let roots: Vec<Vec3> = hair.strands.iter().map(|strand| strand[0]).collect();
    subset::evenly_while(&roots, count, &|| goes_on(0.0)).ok_or(Error::Cancelled)
}

/// The same in the order of the file.
fn evenly(hair: &Hair, count: usize, goes_on: GoesOn<'_>) -> Result<Vec<usize>> {
    let mut chosen = farthest_first(hair, count, goes_on)?;
    chosen.sort_unstable();
    Ok(chosen)
}

/// The roots of a scene that is built, if they are those of this hair.
fn known_roots(known: &BuiltScene, settings: &GrownHair, wanted: usize) -> Option<Arc<[Root]>> {
    let was = known.scene.hair.grown()?;
    let same = was.strands == settings.strands && was.seed == settings.seed && was.hairline == settings.hairline;
    (same && known.roots.len() == wanted).then(|| known.roots.clone())
}

/// The strands that grow from a run of the scene's roots, from number `first` on.
fn grown(
    scene: &Scene,
    settings: &GrownHair,
    head: &Head,
    roots: &[Root],
    first: usize,
    goes_on: GoesOn<'_>,
) -> Result<Hair> {
    let GrownHair { strands, segments, seed, hairline, style } = settings;
    let growth = Growth {
        hairline,
        style,
        strands: *strands,
        segments: *segments,
        segment_length: scene.hair.segment_length,
        seed: *seed,
    };
    check_growth(scene, &growth, head, roots)?;
    let grown = grow_run_while(head, &growth, roots, first, goes_on).map_err(|refused| scene.refusal(refused))?;
    grown.ok_or(Error::Cancelled)
}

/// Refuses hair whose points take more memory than there is.
fn check_growth(scene: &Scene, growth: &Growth<'_>, head: &Head, roots: &[Root]) -> Result<()> {
    // So many show how long the others will be.
    const FEW: usize = 256;
    // As it grows, and as it is straightened or not.
    let bytes = |points: f64| (2.0 * points * size_of::<Vec3>() as f64) as u64;
    if memory::short_of(bytes(roots.len() as f64 * (growth.segments as f64 + 1.0))).is_none() {
        return Ok(());
    }
    // Short hair has fewer segments than it may have.
    let few = &roots[..roots.len().min(FEW)];
    let tried = grow_run_while(head, growth, few, 0, &|_| true).map_err(|refused| scene.refusal(refused))?;
    let mean = tried.map_or(0.0, |hair| hair.strands.points().len() as f64 / few.len().max(1) as f64);
    // What is certain: those tried may be longer than most.
    let needed = bytes(0.9 * mean * roots.len() as f64);
    let count = growth.strands;
    check_memory(
        scene,
        "hair.strands",
        count,
        needed,
        &format!("to grow {} of them", roots.len()),
        "show fewer strands",
    )
}

/// Refuses what takes more memory than there is.
fn check_memory(
    scene: &Scene,
    key: &str,
    value: impl Display,
    needed: u64,
    what_for: &str,
    way_out: &str,
) -> Result<()> {
    match memory::short_of(needed) {
        None => Ok(()),
        Some(short) => {
            Err(scene.refusal(SettingError::new(key, value, format!("{what_for} {short}: {way_out}"))).into())
        }
    }
}

/// The same strands in `segments` equally long segments each.
fn cut_anew(hair: &Hair, segments: usize) -> std::result::Result<Hair, SettingError> {
    check_points("hair.segments", segments, hair.strands.len())?;
    Ok(hair.resampled(segments + 1))
}
