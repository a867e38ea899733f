//! The aims of a scene: the curves of their files, in head space.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use nabiki::aim::{Aim, AimCurves, AimShape};
use nabiki::{Pose, SettingError, Strands};
use nabiki_io::cache::{Origin, Reader};
use nabiki_io::hair::{self, Cleaning};
use nabiki_io::{GroomFile, Placement};

use super::groom::Groom;
use super::stage::{At, Stage};
use super::way::Way;
use crate::error::Result;
use crate::scene::{AimSettings, ImportedHair, Scene};
use crate::seat;

/// The curves of an aim's file.
#[derive(Debug)]
pub(crate) struct AimFile {
    inputs: AimFileInputs,
    curves: Arc<AimCurves>,
}

/// The inputs of the curves.
#[derive(Debug, PartialEq)]
pub(super) struct AimFileInputs {
    /// The scene file, to whose folder paths are relative.
    scene: PathBuf,
    key: String,
    file: PathBuf,
    frame: Option<u32>,
    /// The head's pose in that frame.
    pose: Pose,
    /// The file that the hair came from, whose space exports are in.
    origin: Option<Origin>,
}

impl Stage for AimFile {
    type Inputs = AimFileInputs;

    fn is_of(&self, inputs: &AimFileInputs) -> bool {
        self.inputs == *inputs
    }

    fn make(inputs: AimFileInputs, at: At<'_>) -> Result<Self> {
        let key = format!("{}.file", inputs.key);
        let file = at.there(&inputs.scene, &key, &inputs.file)?;
        let strands = inputs.read(&file, at)?;
        let shown = inputs.file.display().to_string();
        let curves = AimCurves::new(strands, inputs.frame, &shown).map_err(|refused| at.refusal(refused))?;
        Ok(Self { inputs, curves: Arc::new(curves) })
    }
}

impl AimFileInputs {
    /// The curves in head space (cm).
    fn read(&self, file: &Path, at: At<'_>) -> Result<Strands> {
        if file.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("nabiki")) {
            let mut cache = Reader::open(file)?;
            let last = cache.frame_count() - 1;
            let frame = u64::from(self.frame.unwrap_or(0));
            self.check_frame(frame, last, at)?;
            let mut strands = cache.header().strands();
            cache.read(frame, &mut strands)?;
            return Ok(strands);
        }
        let mut groom = GroomFile::open(file)?;
        let frames = groom.frames()? as u64;
        let frame = u64::from(self.frame.filter(|_| frames > 1).unwrap_or(0));
        self.check_frame(frame, frames - 1, at)?;
        let declared = groom.declared_space()?;
        let base = self.origin.as_ref().map_or_else(Placement::default, |origin| origin.placement);
        let placement = seat::hair_placement(&ImportedHair::default(), &base, seat::heeded(declared, false));
        let in_file = groom.hair_in_place(frame as usize, None)?;
        let (hair, _) =
            hair::place_and_clean(in_file, &placement, &Cleaning::default()).map_err(|e| e.in_file(file))?;
        let mut strands = hair.strands;
        if self.frame.is_some() {
            let head_from_world = Origin::world_from_head(self.origin.as_ref(), &self.pose).inverse();
            let points = strands.points_mut().iter_mut();
            points.for_each(|p| *p = head_from_world.transform_point3(p.as_dvec3()).as_vec3());
        }
        Ok(strands)
    }

    fn check_frame(&self, frame: u64, last: u64, at: At<'_>) -> Result<()> {
        if frame <= last {
            return Ok(());
        }
        let remedy = format!("{} has frames 0 to {last}: give one of these", self.file.display());
        Err(at.refusal(SettingError::new(format!("{}.frame", self.key), frame, remedy)))
    }
}

/// The aims of a scene in the free form, and the files of their curves; `known` ones are reused. `earth`: the strength
/// of the earth's gravity, in F.
pub(super) fn aims<'a>(
    scene: &Scene,
    way: &Way,
    groom: &Groom,
    earth: f64,
    known: impl Iterator<Item = &'a Arc<AimFile>> + Clone,
    at: At<'_>,
) -> Result<(Vec<Aim>, Vec<Arc<AimFile>>)> {
    let (mut aims, mut files) = (Vec::new(), Vec::new());
    for (i, settings) in scene.aims.iter().enumerate() {
        let name = format!("aim[{i}]");
        scene.check_aim(settings, &name).map_err(|refused| at.refusal(refused))?;
        let shape = match settings {
            AimSettings { toward: Some(point), .. } => AimShape::Toward(*point),
            AimSettings { groom: true, .. } => AimShape::Groom,
            AimSettings { curves, frame, .. } if !curves.is_empty() => {
                let mut strands = Strands::default();
                curves.iter().for_each(|curve| strands.push(curve.iter().copied()));
                let curves = AimCurves::new(strands, *frame, &format!("{name}.curves"));
                AimShape::Curves(Arc::new(curves.map_err(|refused| at.refusal(refused))?))
            }
            AimSettings { file, frame, .. } => {
                let poses = &way.poses;
                let pose = frame.and_then(|n| poses.get(n as usize).or(poses.last())).copied().unwrap_or_default();
                let origin = super::hair_origin(scene, groom);
                let inputs = AimFileInputs {
                    scene: scene.file().to_owned(),
                    key: name.clone(),
                    file: file.clone(),
                    frame: *frame,
                    pose,
                    origin,
                };
                let of_file = AimFile::of(inputs, known.clone(), at)?;
                files.push(of_file.clone());
                AimShape::Curves(of_file.curves.clone())
            }
        };
        let region = settings.region.as_ref().and_then(|region| scene.region_named(region));
        aims.push(Aim { name, lead: settings.lead(earth), region, shape });
    }
    Ok((aims, files))
}
