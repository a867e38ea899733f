//! The skin of a head that bends: read with the head's motion, from the file that holds both, or from a point cache.

use std::path::PathBuf;
use std::sync::{Arc, Mutex, PoisonError};

use glam::Vec3;
use nabiki::body::{Body, BodyWay, Contact, Shape};
use nabiki::distance::{BendingSkin, SkinDistance};
use nabiki::skin::SkinFrame;
use nabiki::strands::bounds;
use nabiki::{Mesh, Pose, SettingError, Skin};
use nabiki_io::{Placement, skin};

use super::groom::Groom;
use super::model::Model;
use super::stage::{At, Stage};
use super::way::{SkinFiles, Way};
use crate::error::{Error, Result};
use crate::memory;
use crate::scene::{HeadSource, Scene};

/// The vertices of the head's mesh in each frame. Other data of a motion is read frame by frame; these are kept, because
/// every step needs three frames and every picture one.
#[derive(Debug)]
pub(crate) struct Bent {
    inputs: BentInputs,
    /// Head space (cm), from frame 0 to the last; none for a head that does not bend.
    pub frames: Vec<Vec<Vec3>>,
    /// It as a body.
    body: Sampled,
}

/// The inputs of a skin that bends.
#[derive(Debug)]
pub(super) struct BentInputs {
    model: Arc<Model>,
    way: Arc<Way>,
    last: usize,
}

impl BentInputs {
    pub fn of(scene: &Scene, model: &Arc<Model>, way: &Arc<Way>) -> Self {
        Self { model: model.clone(), way: way.clone(), last: scene.motion.frames as usize }
    }
}

impl PartialEq for BentInputs {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.model, &other.model) && Arc::ptr_eq(&self.way, &other.way) && self.last == other.last
    }
}

impl Stage for Bent {
    type Inputs = BentInputs;

    fn is_of(&self, inputs: &BentInputs) -> bool {
        self.inputs == *inputs
    }

    fn make(inputs: BentInputs, at: At<'_>) -> Result<Self> {
        let BentInputs { model, way, last } = &inputs;
        let mut frames = Vec::new();
        if let (Some((files, clip, times, rate)), HeadSource::Imported(head)) = (way.of_mesh(), &model.inputs.source) {
            let vertices = model.head.mesh.positions.len();
            let groups = &head.groups;
            let motion = (&way.poses[..], times, rate);
            frames = frames_of(&files, (groups, clip), &model.placement, motion, (*last as u32, vertices), at)?;
        }
        Ok(Self { inputs, frames, body: Sampled::default() })
    }
}

/// The vertices of a mesh in each frame up to `last` (its own space, cm), if it bends; else none.
pub(super) fn frames_of(
    SkinFiles { mesh, motion: file }: &SkinFiles<'_>,
    (groups, clip): (&[String], &str),
    placement: &Placement,
    motion: (&[Pose], [f64; 2], f64),
    (last, vertices): (u32, usize),
    at: At<'_>,
) -> Result<Vec<Vec<Vec3>>> {
    let mut frames = Vec::new();
    if !skin::bends(file, groups, clip)? {
        return Ok(frames);
    }
    let count = last as usize + 1;
    if let Some(short) = memory::short_of((vertices * size_of::<Vec3>() * count) as u64) {
        let line = format!("the skin's {vertices} vertices in {count} frames {short}: lower motion.frames");
        return Err(nabiki_io::Error::new(line).in_file(file).into());
    }
    let mut wanted = true;
    let read = skin::each_frame(file, mesh, (groups, clip), placement, motion, last as usize, &mut |frame| {
        wanted = wanted && (at.goes_on)(0.0);
        frames.push(frame);
        if wanted { Ok(()) } else { Err(nabiki_io::Error::new("not wanted")) }
    });
    if !wanted {
        return Err(Error::Cancelled);
    }
    read?;
    Ok(frames)
}

impl Bent {
    /// The file that it is read from; none for a head that does not bend.
    pub fn file(&self) -> Option<PathBuf> {
        self.inputs.way.of_mesh().map(|(files, ..)| files.motion).filter(|_| !self.frames.is_empty())
    }

    /// The head as a body that bends; `None` for one that does not. `times`: the most that a strand multiplies the margin by.
    pub(super) fn body(&self, contact: Contact, times: f32) -> Result<Option<Body>> {
        if self.frames.is_empty() {
            return Ok(None);
        }
        let head = &self.inputs.model.head;
        // As far around as a rigid head is sampled.
        let (center, half) = (head.ellipsoid.center, head.ellipsoid.half_axes.max_element());
        let within = [center - 4.0 * half, center + 4.0 * half];
        let rest = || Ok(head.skin().clone());
        let skin = self.body.of(rest, (&head.mesh, &self.frames), within, contact.margin * times)?;
        Ok(Some(Body::new("contact", Shape::Other(skin), BodyWay::WithHead, contact)))
    }
}

/// The distance to a skin that bends, as it was last asked for: with the box and the clearance.
#[derive(Debug, Default)]
pub(super) struct Sampled(Mutex<Option<(Asked, Arc<BendingSkin>)>>);

/// The box, and the clearance (cm).
type Asked = ([Vec3; 2], f32);

impl Sampled {
    /// As [`bending`], or the last one again. `rest`: the distance at rest, where that is needed.
    pub fn of(
        &self,
        rest: impl FnOnce() -> Result<Arc<SkinDistance>>,
        (mesh, frames): (&Mesh, &[Vec<Vec3>]),
        within: [Vec3; 2],
        clearance: f32,
    ) -> Result<Arc<BendingSkin>> {
        let mut known = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        match &*known {
            Some((asked, skin)) if *asked == (within, clearance) => Ok(skin.clone()),
            _ => {
                let skin = bending(&rest()?, mesh, frames, within, clearance)?;
                Ok(known.insert(((within, clearance), skin)).1.clone())
            }
        }
    }
}

/// The distance to a skin that bends, if it fits into memory. `within`: the box in which it is needed.
fn bending(
    rest: &Arc<SkinDistance>,
    mesh: &Mesh,
    frames: &[Vec<Vec3>],
    within: [Vec3; 2],
    clearance: f32,
) -> Result<Arc<BendingSkin>> {
    // Where the skin is at any time, with what hair may be kept off it.
    let about = clearance + AROUND_CM;
    let [low, high] = frames.iter().map(|frame| bounds(frame)).reduce(around).unwrap_or(within);
    let low = within[0].max(low - about).min(within[1]);
    let high = within[1].min(high + about).max(low + rest.spacing());
    let cells = ((high - low) / (4.0 * rest.spacing())).as_dvec3().ceil().element_product();
    let of = |frames| BendingSkin::new(rest.clone(), mesh, frames, [low, high], clearance);
    let short = memory::short_of((8.0 * cells) as u64 * frames.len() as u64);
    let short = short.or_else(|| memory::short_of(of(&frames[..1]).bytes() * frames.len() as u64));
    match short {
        None => Ok(Arc::new(of(frames))),
        Some(short) => {
            let (vertices, frames) = (mesh.positions.len(), frames.len());
            let line = format!("contact with a skin of {vertices} vertices that bends in {frames} frames {short}");
            Err(Error::refused(format!("{line}: lower motion.frames, or use only the parts near the hair")))
        }
    }
}

/// Around a skin that is sampled (cm).
const AROUND_CM: f32 = 6.0;

fn around([low, high]: [Vec3; 2], [from, to]: [Vec3; 2]) -> [Vec3; 2] {
    [low.min(from), high.max(to)]
}

/// The skin under the hair.
#[derive(Debug)]
pub(crate) struct Scalp {
    inputs: ScalpInputs,
    /// None for a head that does not bend.
    pub skin: Option<Arc<Skin>>,
    /// One line about it.
    pub report: Option<String>,
}

/// The part of a head's mesh that carries the hair, at rest.
pub(super) fn under_hair(mesh: &Mesh, groom: &Groom) -> Result<Skin, SettingError> {
    Ok(Skin::new(mesh, "head.mesh")?.under(&[&groom.hair.strands, &groom.first]))
}

/// The inputs of the skin under the hair.
#[derive(Debug)]
pub(super) struct ScalpInputs {
    pub bent: Arc<Bent>,
    pub groom: Arc<Groom>,
}

impl Stage for Scalp {
    type Inputs = ScalpInputs;

    fn is_of(&self, inputs: &ScalpInputs) -> bool {
        Arc::ptr_eq(&self.inputs.bent, &inputs.bent) && Arc::ptr_eq(&self.inputs.groom, &inputs.groom)
    }

    fn make(inputs: ScalpInputs, at: At<'_>) -> Result<Self> {
        let ScalpInputs { bent, groom } = &inputs;
        if bent.frames.is_empty() {
            return Ok(Self { inputs, skin: None, report: None });
        }
        let mesh = &bent.inputs.model.head.mesh;
        let refused = |refused| at.refusal(refused);
        let skin = under_hair(mesh, groom).map_err(refused)?;
        let frames = bent.frames.iter().map(|frame| skin.frame(frame));
        let frames: Vec<SkinFrame> = frames.collect::<Result<_, _>>().map_err(refused)?;
        let skin = skin.with_frames(frames);
        let mut report =
            format!("its skin bends, and carries {} roots on {} triangles", groom.hair.strands.len(), skin.len());
        if let Some((frame, roots)) = skin.folded(&groom.hair.strands).first() {
            report +=
                &format!("; in frame {frame}, it folds flat under {roots} of them, which then do not turn with it");
        }
        Ok(Self { inputs, skin: Some(Arc::new(skin)), report: Some(report) })
    }
}
