//! A scene with everything in its place: the head, the hair, what moves them.

use nabiki::groom::{Growth, grow};
use nabiki::{Hair, Head, SettingError, dynamics::Dynamics, subset};

use nabiki_io::{
    Error, Result,
    cache::Origin,
    exchange::{self, Said},
    hair::{self, ImportReport},
    identity::{Digest, SceneId},
    mesh::{self, MeshReport},
    motion::{self, HeadMotion},
    placement::Placement,
};

use crate::scene::{EllipsoidChoice, HairSettings, Scene};

/// All that a scene names, loaded and in head space.
#[derive(Clone, Debug)]
pub struct Stage {
    /// The scene it was built from.
    pub scene: Scene,
    /// The head.
    pub head: Head,
    /// How the head's file lies in head space; the identity for the built-in head.
    pub placement: Placement,
    /// What the head's file held; `None` for the built-in head.
    pub mesh_report: Option<MeshReport>,
    /// The hair at rest: all of it, or the strands that [`Scene::build_first`] was asked for.
    pub hair: Hair,
    /// Strands of the whole.
    pub whole: usize,
    /// How the hair's file lies in head space; `None` for hair grown here.
    pub hair_placement: Option<Placement>,
    /// What the hair's file held; `None` for hair grown here.
    pub import_report: Option<ImportReport>,
    /// What moves the hair.
    pub dynamics: Dynamics,
}

impl Scene {
    /// Loads the head, grows or imports the hair.
    ///
    /// # Errors
    /// One line: file, thing, value and the way out.
    pub fn build(self) -> Result<Stage> {
        self.build_with(hair::import, None)
    }

    /// The same of `shown` strands only, those that come first in the farthest-first order of the roots: to the bit as
    /// they are in the whole.
    ///
    /// # Errors
    /// As [`build`](Self::build).
    pub fn build_first(self, shown: usize) -> Result<Stage> {
        self.build_with(hair::import, Some(shown))
    }

    /// The same, with a reader of hair files that may know more formats than this crate.
    pub fn build_with(
        self,
        import: impl Fn(&std::path::Path, &Placement, &hair::Cleaning) -> Result<(Hair, ImportReport)>,
        shown: Option<usize>,
    ) -> Result<Stage> {
        let (head, placement, mesh_report) = load_head(&self)?;
        let dynamics = dynamics(&self, &head)?;
        let (hair, whole, hair_placement, import_report) = match &self.hair.file {
            None => {
                let hair = grown(&self, &head, shown)?;
                (hair, self.hair.strands.unwrap_or(HairSettings::STRANDS), None, None)
            }
            Some(file) => {
                let said = exchange::said(&self.resolve(file))?;
                let placement = hair_placement(&self.hair, &placement, said);
                placement.check("hair").map_err(|refused| self.refusal(refused))?;
                let (hair, report) = import(&self.resolve(file), &placement, &self.hair.cleaning())?;
                let whole = hair.strands.len().min(self.hair.strands.unwrap_or(usize::MAX));
                let count = shown.unwrap_or(whole).min(whole);
                let chosen = if count < hair.strands.len() { choose(&hair, count) } else { hair };
                let chosen = match self.hair.segments {
                    Some(segments) => cut_anew(&chosen, segments).map_err(|refused| self.refusal(refused))?,
                    None => chosen,
                };
                (chosen, whole, Some(placement), Some(report))
            }
        };
        Ok(Stage { scene: self, head, placement, mesh_report, hair, whole, hair_placement, import_report, dynamics })
    }
}

impl Stage {
    /// What a motion cache of this stage is marked with: everything that decides how its hair moves, but not how many
    /// frames are made of it, nor how it is drawn. Two scenes spelled differently that mean the same have the same.
    pub fn identity(&self) -> Result<SceneId> {
        let mut digest = Digest::new();
        digest.bytes("starts", bytemuck::cast_slice(&little_endian(self.hair.strands.starts())));
        let points: &[f32] = bytemuck::cast_slice(self.hair.strands.points());
        let bits: Vec<u32> = points.iter().map(|x| x.to_bits()).collect();
        digest.bytes("points", bytemuck::cast_slice(&little_endian(&bits)));
        let motion = nabiki::dynamics::Motion { frames: 1, ..self.dynamics.motion.clone() };
        digest.settings("motion", &motion)?;
        digest.settings("segment_length", &[self.dynamics.segment_length, self.dynamics.shell])?;
        digest.settings("ellipsoid", &self.dynamics.ellipsoid)?;
        digest.settings("pseudo_force", &self.dynamics.pseudo_force)?;
        digest.settings("force", &self.dynamics.field.keyframes())?;
        if let Some(disturbance) = &self.dynamics.disturbance {
            digest.settings("disturbance", disturbance)?;
        }
        if let Some(source) = &self.scene.head.motion {
            digest.settings("head.motion", source)?;
            // Where the head is in a frame depends on how many of them make a second.
            digest.settings("picture.video.fps", &self.scene.picture.video.fps)?;
            let files = [("head.motion.file", Some(&source.file)), ("head.motion.skeleton", source.skeleton.as_ref())];
            for (name, file) in files.into_iter().filter_map(|(name, file)| Some((name, file?))) {
                let path = self.scene.resolve(file);
                let bytes = std::fs::read(&path).map_err(|e| Error::from(e).in_file(&path))?;
                digest.bytes(name, &bytes);
            }
        }
        Ok(digest.finish())
    }

    /// How imported hair lay in its file, for a motion cache to remember.
    pub fn hair_origin(&self) -> Option<Origin> {
        let (placement, report) = (self.hair_placement?, self.import_report?);
        Some(Origin { placement, points: report.points_in_file as u64 })
    }

    /// Where the head is in each frame, at `frame_rate` frames a second; `None` for a head that stands still.
    pub fn head_motion(&self, frame_rate: f64) -> Result<Option<HeadMotion>> {
        let Some(source) = &self.scene.head.motion else { return Ok(None) };
        let source = motion::MotionSource {
            file: self.scene.resolve(&source.file),
            skeleton: source.skeleton.as_ref().map(|skeleton| self.scene.resolve(skeleton)),
            ..source.clone()
        };
        motion::read(&source, frame_rate).map(Some)
    }

    /// A refused setting as an error that names the scene's file and line.
    pub fn refusal(&self, refused: SettingError) -> Error {
        self.scene.refusal(refused)
    }
}

fn little_endian(values: &[u32]) -> Vec<u32> {
    values.iter().map(|value| value.to_le()).collect()
}

fn load_head(scene: &Scene) -> Result<(Head, Placement, Option<MeshReport>)> {
    let settings = &scene.head;
    let given = match settings.ellipsoid {
        EllipsoidChoice::Fit => None,
        EllipsoidChoice::Given(ellipsoid) => Some(ellipsoid),
    };
    if settings.is_builtin() {
        let head = match given {
            None => Head::builtin(),
            Some(given) => Head::builtin().with_ellipsoid(given).map_err(|refused| scene.refusal(refused))?,
        };
        return Ok((head, Placement::default(), None));
    }
    let file = scene.resolve(settings.mesh.as_ref());
    let mut placement = settings.placement();
    let said = exchange::said(&file)?;
    placement.unit = settings.unit.or(said.unit).unwrap_or(placement.unit);
    placement.up = settings.up.or(said.up).unwrap_or(placement.up);
    let (mut mesh, report) = mesh::import(&file, &placement, &settings.groups)?;
    let mut ellipsoid = given;
    if settings.origin.is_none() && given.is_none() {
        let mut fitted = Head::fit(&mesh).map_err(|refused| scene.refusal(refused))?;
        placement.origin = placement.file_from_head().transform_point3(fitted.center);
        for p in &mut mesh.positions {
            *p -= fitted.center;
        }
        fitted.center = glam::Vec3::ZERO;
        ellipsoid = Some(fitted);
    }
    let head = Head::from_mesh(mesh, ellipsoid).map_err(|refused| scene.refusal(refused))?;
    Ok((head, placement, Some(report)))
}

/// How the hair's file lies in head space: as the head's file does, but for what the scene or the file itself says.
fn hair_placement(settings: &HairSettings, head: &Placement, said: Said) -> Placement {
    let unmoved = Placement {
        unit: settings.unit.or(said.unit).unwrap_or(head.unit),
        up: settings.up.or(said.up).unwrap_or(head.up),
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

fn grown(scene: &Scene, head: &Head, shown: Option<usize>) -> Result<Hair> {
    let HairSettings { hairline, style, segments, segment_length, seed, .. } = &scene.hair;
    let growth = Growth {
        hairline,
        style,
        strands: scene.hair.strands.unwrap_or(HairSettings::STRANDS),
        segments: segments.unwrap_or(HairSettings::SEGMENTS),
        segment_length: *segment_length,
        seed: *seed,
    };
    grow(head, &growth, shown.unwrap_or(growth.strands)).map_err(|refused| scene.refusal(refused))
}

/// The same strands in `segments` equally long segments each.
fn cut_anew(hair: &Hair, segments: usize) -> std::result::Result<Hair, SettingError> {
    let points = segments.checked_add(1).and_then(|points| points.checked_mul(hair.strands.len()));
    match points {
        Some(points) if points <= u32::MAX as usize => Ok(hair.resampled(segments + 1)),
        _ => Err(SettingError::new("hair.segments", segments, "more than 2^32 points in all: ask for fewer")),
    }
}

/// An even choice of `count` strands, in the order of the file.
fn choose(hair: &Hair, count: usize) -> Hair {
    let roots: Vec<glam::Vec3> = hair.strands.iter().map(|strand| strand[0]).collect();
    let mut chosen = subset::evenly(&roots, count);
    chosen.sort_unstable();
    hair.select(&chosen)
}

fn dynamics(scene: &Scene, head: &Head) -> Result<Dynamics> {
    let build = || -> std::result::Result<Dynamics, SettingError> {
        let dynamics = Dynamics {
            motion: scene.motion.clone(),
            segment_length: scene.hair.segment_length,
            pseudo_force: scene.pseudo_force.clone(),
            ellipsoid: head.ellipsoid,
            shell: scene.head.shell,
            field: scene.field()?,
            disturbance: scene.disturbance.clone(),
        };
        dynamics.check()?;
        Ok(dynamics)
    };
    build().map_err(|refused| scene.refusal(refused))
}
