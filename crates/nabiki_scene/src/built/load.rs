//! What a scene names, read and put into head space.

mod free;

use std::io::ErrorKind;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use glam::Vec3;
use nabiki::dynamics::{Dynamics, Form, straightened};
use nabiki::groom::{Growth, grow_run_while};
use nabiki::roots::{self, Root};
use nabiki::strands::check_points;
use nabiki::{Hair, Head, Pose, SettingError, Strands, subset};
use nabiki_io::{
    DeclaredSpace, GroomCurves, GroomFile,
    cache::Shard,
    declared_space,
    hair::{self, ImportReport},
    identity::StrandSum,
    mesh::{self, MeshReport},
    motion::{self, HeadMotion},
    placement::Placement,
};

use nabiki_render::colour;

use super::{BuiltScene, ShardOf, Shown};
use crate::error::{Error, Result};
use crate::scene::{
    EllipsoidChoice, FieldParts, FieldPlace, FormChoice, GrownHair, HairSource, HeadSource, ImportedHair, Scene,
};
use crate::seat;

/// Asked again and again, by any thread, whether to go on; told how much is done, 0..1.
pub(super) type GoesOn<'a> = &'a (dyn Fn(f32) -> bool + Sync);

/// Builds a scene, or one `shard` of it. What it has in common with a scene that is `known` is taken from there, and files
/// are not read again. `goes_on`, told how much of the hair is grown, is asked whether it is still wanted: between any two files,
/// and while roots are chosen and hair grows.
pub(super) fn build(
    scene: Scene,
    shown: Shown,
    shard: Option<Shard>,
    known: Option<&BuiltScene>,
    goes_on: GoesOn<'_>,
) -> Result<BuiltScene> {
    let known = known.filter(|known| known.scene.file() == scene.file());
    let same_head = known.filter(|known| {
        let (head, was) = (&scene.head, &known.scene.head);
        head.source == was.source && head.ellipsoid == was.ellipsoid
    });
    let LoadedHead { head, placement, report: mesh_report, declared: head_declared } = match same_head {
        Some(known) => LoadedHead::of(known),
        None => load_head(&scene)?,
    };
    still_wanted(goes_on, 0.0)?;
    let same_rate = known.filter(|known| known.scene.frame_rate() == scene.frame_rate());
    let (poses, motion_report, motion_begins) =
        match same_rate.filter(|known| known.scene.head.motion == scene.head.motion) {
            Some(known) => {
                check_length(&scene, &known.poses)?;
                (known.poses.clone(), known.motion_report.clone(), known.motion_begins)
            }
            None => head_motion(&scene)?.map_or_else(Default::default, |m| (m.poses, Some(m.report), m.first_frame)),
        };
    let mut dynamics = dynamics(&scene, &head)?;
    let rest_pose = poses.first().copied().unwrap_or_default();
    dynamics.polar_axis = rest_pose.up_in_head();
    let FieldParts { field, wind, .. } = field(&scene, &head, &poses)?;
    let same_hair = same_head.filter(|known| {
        scene.hair == known.scene.hair
            && scene.motion.straighten == known.scene.motion.straighten
            && dynamics.polar_axis == known.dynamics.polar_axis
            && free::first_wanted(&scene) == free::first_wanted(&known.scene)
            && shard.is_none()
            && known.shard.is_none()
            && shown.of(known.strands_of_scene).is_ok_and(|count| count == known.hair.strands.len())
    });
    let LoadedHair { mut hair, roots, ids, of_scene, shard, first, imported, frames, begins } = match same_hair {
        Some(known) => LoadedHair::of(known),
        None => {
            let mut loaded = load_hair(&scene, &head, &placement, Wanted { shown, shard }, same_head, goes_on)?;
            loaded.hair.strands = straightened(&loaded.hair.strands, &dynamics.motion, dynamics.polar_axis);
            loaded.first = straightened(&loaded.first, &dynamics.motion, dynamics.polar_axis);
            loaded
        }
    };
    if imported.is_none() {
        // As it is drawn, so that it goes out as it looks.
        hair.attributes.constant.width = Some(scene.picture.hair.width);
        hair.attributes.constant.colour = Some(colour::of_mass(&scene.picture.hair));
    }
    let (hair_placement, report) = imported.as_ref().map(|found| (found.placement, found.report)).unzip();
    let imported = imported.map(|found| (Some(found.groom), found.declared, found.judged));
    let (groom, hair_declared, judged) = imported.unwrap_or_default();
    let mut bodies = Vec::new();
    if scene.form == FormChoice::Free {
        let known = free::Known { same_head, same_rate };
        bodies = free::set(&mut dynamics, &scene, &head, &first, rest_pose, known, goes_on)?;
    }
    Ok(BuiltScene {
        scene,
        head,
        placement,
        mesh_report,
        hair,
        roots,
        strands_of_scene: of_scene,
        shard,
        first,
        hair_placement,
        groom,
        import_report: report,
        frames_in_file: frames,
        dynamics,
        field,
        wind,
        head_declared,
        hair_declared,
        judged,
        motion_report,
        motion_begins,
        hair_begins: begins,
        bodies,
        ids,
        poses,
    })
}

/// Gives up what is wanted no more, of which so much is grown.
fn still_wanted(goes_on: GoesOn<'_>, part: f32) -> Result<()> {
    if goes_on(part) { Ok(()) } else { Err(Error::Cancelled) }
}

/// What pushes the hair, about a head on its way.
fn field(scene: &Scene, head: &Head, poses: &[Pose]) -> Result<FieldParts> {
    let place = FieldPlace {
        ellipsoid: head.ellipsoid,
        poses,
        frame_rate: scene.frame_rate(),
        frames: scene.motion.frames,
        space: scene.motion.force_space,
        may_be_none: scene.form == FormChoice::Free,
    };
    scene.field.build(&place).map_err(|refused| scene.refusal(refused).into())
}

/// What pushes the hair, once the head and its motion are loaded.
pub(crate) fn load_field(scene: &Scene) -> Result<FieldParts> {
    let poses = head_motion(scene)?.map_or_else(Vec::new, |motion| motion.poses);
    field(scene, &load_head(scene)?.head, &poses)
}

/// Hair at rest, some or all of the scene's.
struct LoadedHair {
    hair: Hair,
    /// Where it grows; none for hair of a file.
    roots: Arc<[Root]>,
    /// Number of each strand in the whole.
    ids: Vec<u32>,
    /// Strands of the whole.
    of_scene: usize,
    /// Which shard it is.
    shard: Option<ShardOf>,
    /// The first strands of the farthest-first order of the whole, whichever are shown: those that the free form asks of.
    first: Strands,
    /// What its file was; `None` for hair grown here.
    imported: Option<Imported>,
    /// Frames of the file.
    frames: usize,
    /// When the shot begins that the file is of (s), where it says so.
    begins: Option<f64>,
}

/// What there is to know of a hair file.
struct Imported {
    placement: Placement,
    /// Where its curves are.
    groom: GroomCurves,
    report: ImportReport,
    declared: DeclaredSpace,
    /// Strands by which it is judged (the file's unit and axes).
    judged: Strands,
}

impl LoadedHair {
    /// That of a scene that is built.
    fn of(built: &BuiltScene) -> Self {
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
struct Wanted {
    shown: Shown,
    /// One run of these alone.
    shard: Option<Shard>,
}

impl Wanted {
    /// How many strands of `of_scene` are shown, and which run of these is wanted.
    fn of(self, of_scene: usize) -> Result<(usize, Range<usize>)> {
        let count = self.shown.of(of_scene)?;
        let Some(shard) = self.shard else { return Ok((count, 0..count)) };
        if shard.of() as usize > count {
            let line = format!("shard {shard}: more shards than there are strands; part them into {count} at the most");
            return Err(Error::refused(line));
        }
        Ok((count, shard.range(count)))
    }
}

/// `same_head`: a scene that is built, with the same head.
fn load_hair(
    scene: &Scene,
    head: &Head,
    head_placement: &Placement,
    wanted: Wanted,
    same_head: Option<&BuiltScene>,
    goes_on: GoesOn<'_>,
) -> Result<LoadedHair> {
    match &scene.hair.source {
        HairSource::Grown(settings) => {
            let (count, run) = wanted.of(settings.strands)?;
            let first = free::first_wanted(scene).min(settings.strands);
            let rooted = run.end.max(first);
            let roots = match same_head.and_then(|known| known_roots(known, settings, rooted)) {
                Some(roots) => roots,
                None => {
                    let GrownHair { strands, seed, hairline, .. } = settings;
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
        HairSource::Imported(settings) => import(scene, settings, head_placement, wanted, goes_on),
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
    head_placement: &Placement,
    wanted: Wanted,
    goes_on: GoesOn<'_>,
) -> Result<LoadedHair> {
    let file = there(scene, "hair.file", &settings.file)?;
    let mut groom = GroomFile::open(&file)?;
    let declared = groom.declared_space()?;
    let placement = hair_placement(settings, head_placement, declared);
    placement.check("hair").map_err(|refused| scene.refusal(refused))?;
    let in_file = groom.hair_in_place(0, None)?;
    still_wanted(goes_on, 0.0)?;
    let judged = seat::judged(&in_file);
    let placed = hair::place_and_clean(in_file, &placement, &settings.cleaning());
    let (hair, report) = placed.map_err(|e| e.in_file(&file))?;
    still_wanted(goes_on, 0.0)?;
    let hair = match settings.strands {
        Some(count) if count < hair.strands.len() => hair.select(&evenly(&hair, count, goes_on)?),
        _ => hair,
    };
    let of_scene = hair.strands.len();
    let first = free::first_wanted(scene).min(of_scene);
    let first = if first == 0 { Hair::default() } else { hair.select(&farthest_first(&hair, first, goes_on)?) };
    let (count, run) = wanted.of(of_scene)?;
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
    let cut = |hair: Hair| match settings.segments {
        Some(segments) => cut_anew(&hair, segments).map_err(|refused| scene.refusal(refused)),
        None => Ok(hair),
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

/// Where the head is in each frame; `None` for a head that stands still.
fn head_motion(scene: &Scene) -> Result<Option<HeadMotion>> {
    let Some(source) = &scene.head.motion else { return Ok(None) };
    let motion = read_motion(scene, source, "head.motion")?;
    check_length(scene, &motion.poses)?;
    Ok(Some(motion))
}

/// Refuses a head's motion that ends too soon; none is that of a head that stands still.
fn check_length(scene: &Scene, poses: &[Pose]) -> Result<()> {
    let (frames, given) = (scene.motion.frames as usize, poses.len());
    if scene.head.motion.is_none() || given > frames {
        return Ok(());
    }
    let remedy = format!(
        "head.motion ends at frame {} and motion.frames = {frames}: make motion.frames smaller, or the file longer",
        given.saturating_sub(1)
    );
    Err(nabiki_io::Error::new(remedy).in_file(scene.file()).into())
}

/// The motion that the scene names under `key`, at its frame rate.
fn read_motion(scene: &Scene, source: &motion::MotionSource, key: &str) -> Result<HeadMotion> {
    let there = |part: &str, file: &Path| there(scene, &format!("{key}.{part}"), file);
    let source = motion::MotionSource {
        file: there("file", &source.file)?,
        skeleton: source.skeleton.as_ref().map(|file| there("skeleton", file)).transpose()?,
        ..source.clone()
    };
    Ok(motion::read(&source, scene.frame_rate()).map_err(|e| e.below(key))?)
}

/// A head in its place.
pub(super) struct LoadedHead {
    pub head: Head,
    placement: Placement,
    report: Option<MeshReport>,
    declared: DeclaredSpace,
}

impl LoadedHead {
    /// That of a scene that is built.
    fn of(built: &BuiltScene) -> Self {
        let (head, placement) = (built.head.clone(), built.placement);
        Self { head, placement, report: built.mesh_report.clone(), declared: built.head_declared }
    }
}

/// The file that the scene names under `key`; that it is not there is said with the scene's line.
fn there(scene: &Scene, key: &str, file: &Path) -> Result<PathBuf> {
    let path = scene.resolve(file);
    match std::fs::metadata(&path) {
        Err(e) if matches!(e.kind(), ErrorKind::NotFound | ErrorKind::NotADirectory) => {
            let remedy = match path == file {
                true => "there is no such file".to_owned(),
                false => format!("there is no {}; paths are relative to the scene's folder", path.display()),
            };
            Err(scene.refusal(SettingError::new(key, format!("\"{}\"", file.display()), remedy)).into())
        }
        _ => Ok(path),
    }
}

pub(super) fn load_head(scene: &Scene) -> Result<LoadedHead> {
    let settings = &scene.head;
    let given = match settings.ellipsoid {
        EllipsoidChoice::Fit => None,
        EllipsoidChoice::Given(ellipsoid) => Some(ellipsoid),
    };
    let HeadSource::Imported(imported) = &settings.source else {
        let head = match given {
            None => Head::builtin(),
            Some(given) => Head::builtin().with_ellipsoid(given).map_err(|refused| scene.refusal(refused))?,
        };
        let (placement, declared) = (Placement::default(), DeclaredSpace::default());
        return Ok(LoadedHead { head, placement, report: None, declared });
    };
    let file = there(scene, "head.mesh", &imported.file)?;
    let declared = declared_space(&file)?;
    let mut placement = imported.placement(declared.unit, declared.up);
    placement.check("head").map_err(|refused| scene.refusal(refused))?;
    let (mut mesh, report) = mesh::import(&file, &placement, &imported.groups)?;
    let refused = |refused: SettingError| {
        let value = format!("{}, {}", imported.file.display(), refused.value);
        scene.refusal(if refused.thing == "head.mesh" { SettingError { value, ..refused } } else { refused })
    };
    let mut ellipsoid = given;
    if imported.origin.is_none() && given.is_none() {
        let mut fitted = Head::fit(&mesh).map_err(refused)?;
        placement.origin = placement.file_from_head().transform_point3(fitted.center);
        for p in &mut mesh.positions {
            *p -= fitted.center;
        }
        fitted.center = glam::Vec3::ZERO;
        ellipsoid = Some(fitted);
    }
    let head = Head::from_mesh(mesh, ellipsoid).map_err(refused)?;
    Ok(LoadedHead { head, placement, report: Some(report), declared })
}

/// How the hair's file lies in head space: as the head's file does, but for what the scene or the file itself says.
pub(crate) fn hair_placement(settings: &ImportedHair, head: &Placement, declared: DeclaredSpace) -> Placement {
    let unmoved = Placement {
        unit: settings.unit.or(declared.unit).unwrap_or(head.unit),
        up: settings.up.or(declared.up).unwrap_or(head.up),
        facing: settings.facing.unwrap_or(head.facing),
        origin: glam::Vec3::ZERO,
    };
    if unmoved == (Placement { origin: glam::Vec3::ZERO, ..*head }) {
        return Placement { origin: settings.origin.unwrap_or(head.origin), ..unmoved };
    }
    // The head's origin is a place in the world that both files share.
    let shared = Placement { origin: glam::Vec3::ZERO, ..*head }.head_from_file().transform_point3(head.origin);
    let origin = settings.origin.unwrap_or_else(|| unmoved.file_from_head().transform_point3(shared));
    Placement { origin, ..unmoved }
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
    let grown = grow_run_while(head, &growth, roots, first, goes_on).map_err(|refused| scene.refusal(refused))?;
    grown.ok_or(Error::Cancelled)
}

/// The same strands in `segments` equally long segments each.
fn cut_anew(hair: &Hair, segments: usize) -> std::result::Result<Hair, SettingError> {
    check_points("hair.segments", segments, hair.strands.len())?;
    Ok(hair.resampled(segments + 1))
}

fn dynamics(scene: &Scene, head: &Head) -> Result<Dynamics> {
    let build = || -> std::result::Result<Dynamics, SettingError> {
        let dynamics = Dynamics {
            motion: scene.motion.clone(),
            segment_length: scene.hair.segment_length,
            pseudo_force: scene.pseudo_force.clone(),
            ellipsoid: head.ellipsoid,
            shell: scene.head.shell,
            polar_axis: Vec3::Y,
            disturbance: scene.disturbance.clone(),
            form: Form::Paper,
        };
        dynamics.check()?;
        Ok(dynamics)
    };
    build().map_err(|refused| scene.refusal(refused).into())
}
