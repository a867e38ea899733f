//! What a scene names, read and put into head space.

mod free;
mod hair;

use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use nabiki::dynamics::{Dynamics, straightened};
use nabiki::{Head, Pose, SettingError};
use nabiki_io::{
    DeclaredSpace,
    cache::Shard,
    declared_space, exchange,
    mesh::{self, MeshReport},
    motion::{self, HeadMotion},
    placement::Placement,
};

use nabiki_groom::bust;
use nabiki_render::colour;

use hair::{LoadedHair, Wanted, load_hair};

use super::{BuiltScene, Shown};
use crate::error::{Error, Result};
use crate::scene::{EllipsoidChoice, FieldParts, FieldPlace, FormChoice, HeadSource, Problem, Scene};
use crate::size::of_head_size;

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
    let head = match same_head {
        Some(known) => LoadedHead::of(known),
        None => load_head(&scene)?,
    };
    still_wanted(goes_on, 0.0)?;
    let size = of_head_size(&scene.head, &head.head.ellipsoid, head.declared, &head.placement);
    build_about(head, scene, (shown, shard), (known, same_head), goes_on).map_err(|refused| refused.blamed_on(size))
}

/// The same about a head that is loaded.
fn build_about(
    head: LoadedHead,
    scene: Scene,
    (shown, shard): (Shown, Option<Shard>),
    (known, same_head): (Option<&BuiltScene>, Option<&BuiltScene>),
    goes_on: GoesOn<'_>,
) -> Result<BuiltScene> {
    let LoadedHead { head, placement, report: mesh_report, declared: head_declared } = head;
    let same_rate = known.filter(|known| known.scene.frame_rate() == scene.frame_rate());
    let (poses, motion_report, motion_begins) =
        match same_rate.filter(|known| same_head.is_some() && known.scene.head.motion == scene.head.motion) {
            Some(known) => {
                check_length(&scene, &known.poses)?;
                (known.poses.clone(), known.motion_report.clone(), known.motion_begins)
            }
            None => head_motion(&scene, &placement)?
                .map_or_else(Default::default, |m| (m.poses, Some(m.report), m.first_frame)),
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
            && shown
                .of(known.strands_of_scene, scene.hair.grown().is_some())
                .is_ok_and(|count| count == known.hair.strands.len())
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
    let LoadedHead { head, placement, declared, .. } = load_head(scene)?;
    let poses = head_motion(scene, &placement)?.map_or_else(Vec::new, |motion| motion.poses);
    let size = || of_head_size(&scene.head, &head.ellipsoid, declared, &placement);
    field(scene, &head, &poses).map_err(|refused| refused.blamed_on(size()))
}

/// Where the head is in each frame; `None` for a head that stands still.
fn head_motion(scene: &Scene, placement: &Placement) -> Result<Option<HeadMotion>> {
    let Some(source) = &scene.head.motion else { return Ok(None) };
    let mesh = match &scene.head.source {
        HeadSource::Imported(head) => Some(scene.resolve(&head.mesh)),
        HeadSource::Builtin => None,
    };
    let motion = read_motion(scene, source, "head.motion", (mesh.as_deref(), placement))?;
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

/// The motion that the scene names under `key`, at its frame rate, of a mesh and how its file holds it. A motion out of the
/// mesh's own file faces and is measured as the mesh is, and what binds it there is where its mesh stands.
fn read_motion(
    scene: &Scene,
    source: &motion::MotionSource,
    key: &str,
    (mesh, placement): (Option<&Path>, &Placement),
) -> Result<HeadMotion> {
    let there = |part: &str, file: &Path| there(scene, &format!("{key}.{part}"), file);
    let source = motion::MotionSource {
        file: there("file", &source.file)?,
        skeleton: source.skeleton.as_ref().map(|file| there("skeleton", file)).transpose()?,
        ..source.clone()
    };
    let of_mesh = mesh == Some(&source.file) && holds_scenes(&source.file);
    let facing = source.facing.or(of_mesh.then_some(placement.facing));
    let unit_cm = source.unit_cm.or(of_mesh.then_some(100.0 * placement.unit.metres()));
    let source = motion::MotionSource { facing, unit_cm, ..source };
    let mut motion = motion::read(&source, scene.frame_rate()).map_err(|e| e.below(key))?;
    motion.bound = motion.bound.filter(|_| of_mesh);
    Ok(if source.bind_at_start { motion.bound_at(placement.origin_in_world().as_vec3()) } else { motion })
}

/// Whether files of this kind hold meshes and what moves them in one space.
pub(crate) fn holds_scenes(file: &Path) -> bool {
    exchange::is_usd(file) || exchange::is_alembic(file) || mesh::is_gltf(file)
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
    let value = format!("\"{}\"", file.display());
    let refused = |remedy: String, system: ErrorKind| {
        let mut refused = scene.refusal(SettingError::new(key, &value, &*remedy));
        *refused.problem = Problem::NoFile { value: value.clone(), remedy, path: path.clone(), system };
        refused.into()
    };
    if file.as_os_str().is_empty() {
        return Err(scene.refusal(SettingError::new(key, &value, "name a file")).into());
    }
    match std::fs::metadata(&path) {
        Ok(there) if there.is_dir() => Err(refused("is a folder: name a file".to_owned(), ErrorKind::IsADirectory)),
        Err(e) if matches!(e.kind(), ErrorKind::NotFound | ErrorKind::NotADirectory) => {
            let remedy = match path == file {
                true => "there is no such file".to_owned(),
                false => format!("there is no {}; paths are relative to the scene's folder", path.display()),
            };
            Err(refused(remedy, e.kind()))
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
            None => bust(),
            Some(given) => bust().with_ellipsoid(given).map_err(|refused| scene.refusal(refused))?,
        };
        let (placement, declared) = (Placement::default(), DeclaredSpace::default());
        return Ok(LoadedHead { head, placement, report: None, declared });
    };
    let file = there(scene, "head.mesh", &imported.mesh)?;
    let declared = declared_space(&file)?;
    let mut placement = imported.placement(declared.unit, declared.up);
    placement.check("head").map_err(|refused| scene.refusal(refused))?;
    let (mut mesh, report) = mesh::import(&file, &placement, &imported.groups)?;
    let refused = |refused: SettingError| {
        let value = format!("{}, {}", imported.mesh.display(), refused.value);
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

fn dynamics(scene: &Scene, head: &Head) -> Result<Dynamics> {
    let build = || -> std::result::Result<Dynamics, SettingError> {
        let dynamics = Dynamics {
            motion: scene.motion.clone(),
            segment_length: scene.hair.segment_length,
            pseudo_force: scene.pseudo_force.clone(),
            shell: scene.head.shell,
            disturbance: scene.disturbance.clone(),
            ..Dynamics::new(head.ellipsoid)
        };
        dynamics.check()?;
        Ok(dynamics)
    };
    build().map_err(|refused| scene.refusal(refused).into())
}
