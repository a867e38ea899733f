//! Bodies that hair collides with: the head, and any others of a scene.

use std::ops::RangeInclusive;
use std::sync::Arc;

use glam::{Affine3A, Vec3};

use crate::distance::SkinDistance;
use crate::error::SettingError;
use crate::head::Head;
use crate::mesh::Mesh;
use crate::obstacle::Obstacle;
use crate::pose::{Pose, check_poses};
use crate::setting::{Place, refused};
use crate::settings;
use crate::strands::bounds;

/// The largest margin (cm).
pub(crate) const MOST_MARGIN: f64 = 5.0;

settings! {
    /// How hair and a body touch in the free form.
    #[derive(Copy)]
    pub struct Contact where holds_what_lies_still {
        /// Distance that nodes keep from the skin. A node that is closer at rest keeps its rest distance.
        pub margin: f32 = 0.1 => "Margin", unit "cm", least 0.0, most MOST_MARGIN;
        /// Friction of sliding hair: the share of the push that it loses as speed along the skin (Coulomb).
        pub friction: f32 = 0.1 => "Friction", least 0.0, most 10.0;
        /// Friction of hair that does not slide, at least `friction`. Hair starts to slide when the force along the
        /// skin exceeds this share of the push.
        pub static_friction: f32 = 0.15 => "Static friction", least 0.0, most 10.0;
    }
}

impl Contact {
    /// Refuses a static friction below the sliding friction.
    pub fn holds_what_lies_still(&self, at: &Place) -> Result<(), SettingError> {
        if self.static_friction >= self.friction {
            return Ok(());
        }
        let remedy = format!("must be at least the friction of sliding hair, {}, and at most 10", self.friction);
        refused(&at.key("static_friction"), self.static_friction, remedy)
    }
}

/// The shape of a body.
#[derive(Clone, Debug)]
pub enum Shape {
    /// A rigid mesh with a sampled distance. Contact is compiled for this case.
    Mesh(Arc<SkinDistance>),
    /// Any other shape, called through its trait object.
    Other(Arc<dyn Obstacle>),
}

impl From<Arc<SkinDistance>> for Shape {
    fn from(skin: Arc<SkinDistance>) -> Self {
        Self::Mesh(skin)
    }
}

impl Shape {
    /// The shape as a trait object.
    pub fn obstacle(&self) -> &dyn Obstacle {
        match self {
            Self::Mesh(skin) => &**skin,
            Self::Other(shape) => &**shape,
        }
    }
}

impl PartialEq for Shape {
    /// Compares by identity: true for the same shared shape.
    fn eq(&self, other: &Self) -> bool {
        std::ptr::addr_eq(self.obstacle(), other.obstacle())
    }
}

/// A surface of a body.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Surface {
    /// The skin.
    Skin,
    /// The skin with its folds filled.
    Filled,
}

/// The motion of a body.
#[derive(Clone, Debug, PartialEq)]
pub enum BodyWay {
    /// The body moves with the head, in head space: the head itself, or a hat.
    WithHead,
    /// Poses in the world: one per frame from frame 0 on, or a single one for a body that does not move. Every frame up
    /// to `motion.frames` needs a pose, and the last pose also holds after it. If you do not know the motion
    /// beforehand, give only the pose at rest, and pass the actual poses of each step in
    /// [`FrameInput::bodies`](crate::dynamics::FrameInput::bodies).
    InWorld(Arc<[Pose]>),
}

impl BodyWay {
    /// The body's pose in the world in `frame`, where the head has the pose `head`.
    pub fn pose(&self, frame: u32, head: &Pose) -> Pose {
        match self {
            Self::WithHead => *head,
            Self::InWorld(poses) => poses.get(frame as usize).or(poses.last()).copied().unwrap_or_default(),
        }
    }

    /// The same motion, resampled from `of` to `frames` frames.
    pub(crate) fn resampled(&self, of: u32, frames: u32) -> Self {
        match self {
            Self::InWorld(poses) if poses.len() > 1 => {
                let pose = |n: usize| poses[n.min(poses.len() - 1)];
                let at = |n: u32| {
                    let place = f64::from(n) * f64::from(of) / f64::from(frames);
                    pose(place as usize).between(&pose(place as usize + 1), place.fract() as f32)
                };
                Self::InWorld((0..=frames).map(at).collect())
            }
            way => way.clone(),
        }
    }

    /// Refuses a motion that ends before `frames` or has invalid poses. `name` is the body's name in the error.
    ///
    /// # Errors
    /// Names the frame.
    pub fn check(&self, name: &str, frames: u32) -> Result<(), SettingError> {
        let Self::InWorld(poses) = self else { return Ok(()) };
        if poses.len() != 1 {
            self.check_length(name, frames)?;
        }
        check_poses(&format!("{name}.motion"), poses)
    }

    /// Refuses a motion that ends before `frames`, including a single pose.
    ///
    /// # Errors
    /// Names the length.
    pub fn check_length(&self, name: &str, frames: u32) -> Result<(), SettingError> {
        match self {
            Self::InWorld(poses) if poses.len() <= frames as usize => {
                let length = if poses.len() == 1 { "1 frame".to_owned() } else { format!("{} frames", poses.len()) };
                let remedy = format!(
                    "ends before frame {frames}, the last (frames count from 0): lower motion.frames, or give a longer motion"
                );
                Err(SettingError::new(format!("{name}.motion"), length, remedy))
            }
            _ => Ok(()),
        }
    }
}

/// An object that hair collides with.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Body {
    /// The scene table of its contact settings: `contact` for the head, `body[0]`.
    pub name: String,
    /// The shape, in the body's space (cm).
    pub shape: Shape,
    /// The skin with its folds filled, for a body that hair lies on. Nodes that rest outside this surface stay outside
    /// it, so they are not caught behind an ear.
    pub filled: Option<Arc<SkinDistance>>,
    /// The motion.
    pub way: BodyWay,
    /// Margin and friction.
    pub contact: Contact,
}

/// Radius of the ball whose reach defines the folds that [`Body::head`] fills (cm).
const FOLD_CM: f32 = 3.0;
/// Only heads of a person's size are filled, from a newborn's to one and a half times an adult's (mean half axis, cm).
/// A head in a wrong unit would need too many samples.
const FILLED_HEADS_CM: RangeInclusive<f32> = 5.0..=14.0;
/// Most samples of a filled head; a whole body has a third of that.
const MOST_FILLED: f32 = 2e7;
/// Step size of the samples of a filled head (cm).
const FILLED_CM: f32 = 0.5;

/// Step size of the distance samples near a body's skin (cm): a twelfth of its thinnest side, within these limits.
/// Around a body thinner than the finest step, distances are right from one step away, and too shallow inside.
const FINEST_CM: f32 = 0.05;
const COARSEST_CM: f32 = 0.4;
/// Width of the sampled region around a body (cm). The margin within which hair is kept out is at most 5 cm.
const AROUND_CM: f32 = 6.0;
/// Most samples of a body, 4 bytes each.
const MOST_SAMPLES: f64 = 4e7;

/// Samples the signed distance to a mesh (body space, cm). Triangles that face inward are turned.
///
/// # Errors
/// Meshes without triangles or with invalid indices or coordinates, sheets that enclose no space, and meshes that are
/// too large. `thing` is the name of the mesh in the error.
pub fn skin_of(mut mesh: Mesh, thing: &str) -> Result<SkinDistance, SettingError> {
    let count = mesh.positions.len();
    let refused = |what: &str, remedy: &str| Err(SettingError::new(thing, what, remedy));
    if mesh.triangles.is_empty() || mesh.triangles.iter().flatten().any(|&v| v as usize >= count) {
        return refused("", "has no triangles, or names vertices that it lacks: give a valid mesh");
    }
    if mesh.positions.iter().any(|p| !p.is_finite()) {
        return refused("", "has a vertex that is not finite: every coordinate must be a finite number");
    }
    let [low, high] = bounds(&mesh.positions);
    let side = |cm: f32| if cm < 1e5 { format!("{}", (1e3 * cm).round() / 1e3) } else { format!("{cm:.1e}") };
    let size = format!("{} cm", (high - low).to_array().map(side).join(" x "));
    let sheet = "a sheet encloses no space: make it thicker";
    let thickness = (high - low).min_element();
    if thickness <= 0.0 {
        return refused(&size, sheet);
    }
    // Must come before anything that could overflow in a mesh of this size.
    let spacing = (thickness / 12.0).clamp(FINEST_CM, COARSEST_CM);
    let samples = SkinDistance::count_samples(&mesh, low - AROUND_CM, high + AROUND_CM, spacing);
    if samples.is_nan() || samples > MOST_SAMPLES {
        let remedy = format!(
            "is too large to be sampled every {spacing:.2} cm: check its unit, remove parts far from the hair, or make a \
             thin body thicker"
        );
        return refused(&size, &remedy);
    }
    if !mesh.turn_outward().has_inside {
        return refused(&size, sheet);
    }
    Ok(SkinDistance::new(&mesh, low - AROUND_CM, high + AROUND_CM, spacing))
}

impl Body {
    /// A body whose folds are not filled.
    pub fn new(name: impl Into<String>, shape: impl Into<Shape>, way: BodyWay, contact: Contact) -> Self {
        Self { name: name.into(), shape: shape.into(), filled: None, way, contact }
    }

    /// The head as a body. Its folds are filled if the head has the size of a person's.
    pub fn head(head: &Head, contact: Contact) -> Self {
        let size = head.ellipsoid.half_axes.element_product().cbrt();
        let [low, high] = head.skin().sampled_box();
        let samples = ((high - low) / FILLED_CM).element_product();
        let is_filled = FILLED_HEADS_CM.contains(&size) && samples <= MOST_FILLED;
        let filled = is_filled.then(|| Arc::new(head.skin().filled(FOLD_CM, FILLED_CM)));
        Self { filled, ..Self::new("contact", head.skin().clone(), BodyWay::WithHead, contact) }
    }

    /// The surface that a node resting at this point (body space, cm) stays outside of, and its distance from that
    /// surface: the margin times the strand's factor on it, or the distance at rest if that is smaller.
    pub fn kept_from(&self, at_rest: Vec3, times: f64) -> (Surface, f32) {
        let margin = (f64::from(self.contact.margin) * times) as f32;
        let distance = |shape: &dyn Obstacle| shape.read_at_rest(at_rest).map_or(margin, |at| at.distance);
        match self.filled.as_deref().map(|filled| distance(filled)) {
            Some(distance) if distance >= 0.0 => (Surface::Filled, distance.min(margin)),
            _ => (Surface::Skin, distance(self.shape.obstacle()).min(margin)),
        }
    }

    /// The distance to one of its surfaces.
    pub fn surface(&self, surface: Surface) -> &dyn Obstacle {
        match (surface, &self.filled) {
            (Surface::Filled, Some(filled)) => &**filled,
            _ => self.shape.obstacle(),
        }
    }

    /// Refuses contact settings out of range, and a motion that ends before `frames` or has invalid poses.
    pub fn check(&self, frames: u32) -> Result<(), SettingError> {
        self.contact.check_at(&self.name)?;
        self.way.check(&self.name, frames)
    }

    /// Transforms points from body space to head space in `frame`, where the head has the pose `head`.
    pub fn head_from_body(&self, frame: u32, head: &Pose) -> Affine3A {
        match &self.way {
            BodyWay::WithHead => Affine3A::IDENTITY,
            BodyWay::InWorld(_) => head.world_from_head().inverse() * self.way.pose(frame, head).world_from_head(),
        }
    }
}

impl PartialEq for Body {
    /// Shapes are compared by identity.
    fn eq(&self, other: &Self) -> bool {
        self.name == other.name
            && self.shape == other.shape
            && self.filled.as_ref().map(Arc::as_ptr) == other.filled.as_ref().map(Arc::as_ptr)
            && self.way == other.way
            && self.contact == other.contact
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Ellipsoid;

    fn box_mesh(half: f32) -> Mesh {
        let corner = |i: u32| half * Vec3::new((i & 1) as f32, (i >> 1 & 1) as f32, (i >> 2) as f32) * 2.0 - half;
        let positions = (0..8).map(corner).collect();
        let sides = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
        let triangles = sides.into_iter().flat_map(|[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
        Mesh { positions, triangles, ..Mesh::default() }
    }

    /// A box about the origin with its ellipsoid.
    fn boxed(half: f32) -> Head {
        let ellipsoid = Ellipsoid { center: Vec3::ZERO, half_axes: Vec3::splat(half) };
        Head::from_mesh(box_mesh(half), Some(ellipsoid)).unwrap()
    }

    #[test]
    fn bodies_of_any_size_are_sampled_or_refused() {
        // A clip of thin metal; hair is kept out of its margin.
        let clip = |thickness: f32| {
            let mut clip = box_mesh(2.0);
            clip.positions.iter_mut().for_each(|p| p.y *= 0.25 * thickness);
            skin_of(clip, "body[0].mesh")
        };
        for thickness in [0.2, 0.05, 0.02] {
            let skin = clip(thickness).unwrap();
            for at in [0.05, 0.1, 0.15] {
                // Between samples a step apart, a distance bends only at the middle of the metal.
                let read = skin.at(Vec3::new(0.37, 0.5 * thickness + at, -0.61));
                assert!((read - at).abs() < 1e-3, "{thickness}: {read} at {at}");
            }
        }
        for (half, of) in [(400.0, "800 x 800 x 800 cm"), (1e30, "2.0e30 x 2.0e30 x 2.0e30 cm")] {
            let refused = skin_of(box_mesh(half), "body[0].mesh").unwrap_err();
            assert_eq!((refused.thing.to_string().as_str(), refused.value.as_str()), ("body[0].mesh", of));
            assert!(refused.remedy.contains("unit"), "{refused}");
        }
        assert!(skin_of(box_mesh(1e-6), "body[0].mesh").is_ok());
    }

    #[test]
    fn heads_of_any_size_are_bodies_and_those_of_persons_are_filled() {
        for (half, filled) in [(0.01, false), (9.0, true), (900.0, false), (9e4, false)] {
            let body = Body::head(&boxed(half), Contact::default());
            assert_eq!(body.filled.is_some(), filled, "{half} cm");
            let (_, clearance) = body.kept_from(Vec3::new(0.0, 1.05 * half, 0.0), 1.0);
            assert!((0.0..=body.contact.margin).contains(&clearance), "{half} cm: {clearance}");
        }
    }

    #[test]
    fn a_head_without_its_folds_filled_is_another_body() {
        let filled = Body::head(&boxed(9.0), Contact::default());
        assert_eq!(filled, filled.clone());
        assert_ne!(filled, Body { filled: None, ..filled.clone() });
    }
}
