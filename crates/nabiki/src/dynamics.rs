//! The motion of hair: projective equations (1) and (2), their gains (6) and (8), and two steppers of (7).
//!
//! [`Reference`] is the specification: scalar f64 code to read next to the paper. [`Simulation`] is its fast twin: f32,
//! blocks of 16 strands, all cores. Both take the same [`Dynamics`] and [`FrameInput`]s and compute the same frames.
//! [`Timeline`] is the fast twin for all frames at once.
//!
//! [`Form`] chooses between two sets of equations: the paper's (docs/equations.md) and the free form
//! (docs/motion-forms.md). Files that ask which form it is: this one, `reference.rs`, `runner.rs`, `simulation.rs`,
//! `stability.rs`, `standing.rs`, `tangents.rs`, and those of the solver. No file below `paper/` or `free/` does.
//!
//! | file | holds |
//! |---|---|
//! | `reference.rs`, `runner.rs` | the f64 twin and the fast twin of either form |
//! | `paper/`, `free/` | the equations of each form |
//! | `gain.rs` | inertia and gain of the paper's form; the acceleration A of the free form; places along a strand |
//! | `pull.rs`, `stability.rs` | what pulls on hair besides the field; the check that refuses what is too strong |
//! | `tangents.rs`, `air.rs` | strands of the f64 twins with derivatives, for the solver, and the field that they ask |
//! | `ride.rs` | the effect of skin that moves on the strands that it carries |
//! | `state.rs` | saved states, as bytes with a checksum |
//! | `sweep.rs` | all blocks, on all cores, through any number of frames |
//! | `block.rs`, `row.rs`, `transpose.rs` | sixteen strands side by side, and the way of their points into [`Strands`] |
//! | `field_frame.rs` | the field of one frame, asked for sixteen points at a time |

mod air;
mod block;
mod field_frame;
mod free;
mod gain;
mod paper;
mod pull;
mod reference;
mod ride;
mod row;
mod runner;
mod simulation;
mod stability;
mod standing;
mod state;
mod straighten;
mod sweep;
mod tangents;
mod timeline;
mod transpose;
mod trigonometry;

use std::sync::Arc;

use glam::{Affine3A, Quat, Vec3};

use crate::body::Body;
use crate::disturbance::Disturbance;
use crate::ellipsoid::Ellipsoid;
use crate::error::{SettingError, check_positive};
use crate::field::Field;
use crate::free_form::FreeMotion;
use crate::pose::Pose;
use crate::pseudo_force::{Gamma, PseudoForce};
use crate::skin::{Skin, SkinFrame};
use crate::strands::Strands;
use crate::{settings, words};

pub use free::substeps;
pub use gain::{carrying_force, earth_gravity, gain, period, push, stiffness_of};
pub use reference::Reference;
pub use simulation::{Simulation, VectorWidth};
pub(crate) use stability::Stability;
pub use stability::{check_field, largest_gain};
pub(crate) use standing::{Crowds, Moved, Standing};
pub use straighten::straightened;
pub(crate) use tangents::{Asked, Change, Points, tangents};
pub use timeline::{Played, Timeline};

settings! {
    /// Length and pace of the motion, and the mass of hair. The defaults are Table 1 of the paper.
    pub struct Motion in "motion" {
        /// Number of frames after the rest frame 0 (N_f).
        pub frames: u32 = 100 => "Frames", least 1.0, most Motion::MOST_FRAMES as f64;
        /// Frames per second, for playback and for sampling a recorded head. Hair moves by frames, so only settings in
        /// world units such as "1 g" depend on this.
        pub frame_rate: f64 = 24.0 => "Frame rate", unit "per second", above 0.0;
        /// Delta t of equation (7), in the method's own unit. A frame is one step; a larger value makes hair swing
        /// faster.
        pub time_step: f32 = 0.1 => "Time step", above 0.0;
        /// Slow motion of the hair: 4 shows hair as if filmed at four times the frame rate. The head and the fields
        /// keep their pace.
        pub slow: f32 = 1.0 => "Slow motion", unit "times", least 0.1, most 100.0;
        /// Mass of 1 cm of hair, in the units of the force: lambda of equation (6).
        pub linear_density: f32 = 0.05 => "Density", unit "per cm", above 0.0;
        /// Hair shorter than this gets the inertia of hair this long, as if longer neighbours held it. Raise it to calm
        /// short hair, which otherwise swings very fast. 0, as in the paper, gives each strand the inertia of its own
        /// length.
        pub inertia_length_floor: f32 = 0.0 => "Inertia floor", unit "cm", least 0.0;
        /// Makes segments exactly vertical that are within this angle of the vertical at rest. They can then swing in
        /// the plane of any force (section 4.2). Raise it if straight hair is blown apart: a nearly vertical segment
        /// otherwise keeps the plane of its small lean. 0, as in the paper, leaves the hair as it is.
        // It belongs to the making of the rest shape, see `straightened`: steppers take hair as it is.
        pub straighten: f32 = 0.0 => "Straighten", unit "degrees", least 0.0, most 45.0;
        /// The space of the forces. It matters if the head turns.
        pub force_space: ForceSpace = ForceSpace::World => "Force space";
    }
}

words! {
    /// The space that forces are given in.
    pub enum ForceSpace = World {
        /// Forces stay fixed in the world while the head turns.
        World = "world",
        /// Forces turn with the head.
        Head = "head",
    }
}

impl Motion {
    /// Largest number of frames: days of film. A larger number is most likely mistyped.
    pub const MOST_FRAMES: u32 = 10_000_000;

    /// Delta t in slow motion.
    fn slowed_time_step(&self) -> f64 {
        f64::from(self.time_step) / f64::from(self.slow)
    }
}

/// Everything that determines how hair responds to a force. It is checked when you build a stepper.
#[derive(Clone, Debug, PartialEq)]
pub struct Dynamics {
    /// Length, pace and inertia.
    pub motion: Motion,
    /// The segment length d (cm, above 0) in which the paper counts k and i. A strand of length L has k = L/d reference
    /// segments, however many segments it is stored in.
    pub segment_length: f32,
    /// Where and how much the force is weakened in front of the head. In the free form this applies only if
    /// [`weakening`](Self::weakening) asks for it.
    pub pseudo_force: PseudoForce,
    /// The head ellipsoid E (head space, cm).
    pub ellipsoid: Ellipsoid,
    /// C is E scaled by this factor, above 1.
    pub shell: f32,
    /// The axis from which theta is measured (head space, any length except 0): the world's vertical at frame 0, which
    /// then moves with the head. Use [`Pose::up_in_head`] of the first pose, or y for a head that starts upright.
    pub polar_axis: Vec3,
    /// Disturbance of the segments, if any. Paper's form only.
    pub disturbance: Option<Disturbance>,
    /// The skin that carries the roots, if it moves in head space. Without it, the head carries them.
    pub skin: Option<Arc<Skin>>,
    /// The equations of motion.
    pub form: Form,
}

/// The equations of motion.
#[allow(clippy::large_enum_variant, reason = "a stepper has one")]
#[derive(Clone, Debug, Default, PartialEq)]
pub enum Form {
    /// The paper's form: two angles per segment, equation (7).
    #[default]
    Paper,
    /// The free form: a chain of segments with tension, bending and torsion. See docs/motion-forms.md.
    Free(FreeMotion),
}

impl Dynamics {
    /// The paper's settings for a head with this ellipsoid (head space, cm): segments of 1 cm, C 25 % larger than E,
    /// and a head that starts upright. Later versions may add settings. Change the fields you need, or end a literal
    /// with `..Dynamics::new(ellipsoid)`.
    pub fn new(ellipsoid: Ellipsoid) -> Self {
        Self {
            motion: Motion::default(),
            segment_length: 1.0,
            pseudo_force: PseudoForce::default(),
            ellipsoid,
            shell: 1.25,
            polar_axis: Vec3::Y,
            disturbance: None,
            skin: None,
            form: Form::default(),
        }
    }

    /// Refuses settings out of range. Stability depends on the strands as well; see [`Simulation::new`].
    pub fn check(&self) -> Result<(), SettingError> {
        self.motion.check()?;
        check_positive("hair.segment_length", self.segment_length)?;
        self.pseudo_force.check()?;
        if !(self.shell > 1.0 && self.shell.is_finite()) {
            let remedy = "must be a finite number above 1: C encloses the head ellipsoid";
            return Err(SettingError::new("head.shell", self.shell, remedy));
        }
        self.ellipsoid.check_at("head.ellipsoid")?;
        if !(self.polar_axis.is_finite() && self.polar_axis.length() > 0.0) {
            let remedy = "the vertical of frame 0 in head space must be a direction";
            return Err(SettingError::new("head.motion", self.polar_axis, remedy));
        }
        match (&self.form, &self.disturbance) {
            (Form::Paper, None) => Ok(()),
            (Form::Paper, Some(disturbance)) => disturbance.check(),
            (Form::Free(free), None) => free.check(self.motion.frames),
            (Form::Free(_), Some(disturbance)) => Err(disturbance.refused_in_the_free_form()),
        }
    }

    /// The same motion in seconds, to first order, at another step rate (frames per second). With R times as many
    /// steps: the time step becomes 1 / R of its value; settling, aims, disturbances and [`Motion::frames`] get R times as
    /// many frames; and cohesion per cm per frame becomes R times as strong. Motions of bodies and skin
    /// are interpolated.
    /// Forces, stiffness, hold, gravity, pressure, drag and contact stay the same. Settings of fields that count frames
    /// are not changed here: build those fields, and a
    /// [`BendingSkin`](crate::distance::BendingSkin), for the new rate. The random turns of disturbances differ.
    ///
    /// A lower rate may be unstable for the forces. The stepper then refuses them.
    ///
    /// # Errors
    /// An invalid rate, a rate that needs too many frames, or settings out of range.
    pub fn at_frame_rate(&self, rate: f64) -> Result<Self, SettingError> {
        self.check()?;
        let ratio = rate / self.motion.frame_rate;
        let frames = |count: u32| (f64::from(count) * ratio).round().max(1.0) as u32;
        let mut dynamics = self.clone();
        let motion = &mut dynamics.motion;
        motion.frame_rate = rate;
        motion.frames = frames(motion.frames);
        motion.time_step = (f64::from(motion.time_step) / ratio) as f32;
        motion.check()?;
        if let Some(disturbance) = &mut dynamics.disturbance {
            disturbance.every = frames(disturbance.every);
            disturbance.from = frames(disturbance.from);
            disturbance.over = frames(disturbance.over).min(disturbance.every);
        }
        if let Some(skin) = &mut dynamics.skin {
            *skin = Arc::new(skin.resampled(self.motion.frames, dynamics.motion.frames));
        }
        if let Form::Free(free) = &mut dynamics.form {
            free.form.settle = free.form.settle.times(ratio);
            if let Some(neighbours) = &mut free.neighbours {
                neighbours.forces.cohesion = (f64::from(neighbours.forces.cohesion) * ratio) as f32;
            }
            for aim in &mut free.aims {
                *aim = aim.times(ratio);
            }
            for body in &mut free.bodies {
                body.way = body.way.resampled(self.motion.frames, dynamics.motion.frames);
            }
        }
        dynamics.check()?;
        Ok(dynamics)
    }

    /// What weakens the field in front of the head. `None` in the free form, unless it asks for it.
    pub fn weakening(&self) -> Option<&PseudoForce> {
        match &self.form {
            Form::Free(free) if !free.form.pseudo_force => None,
            _ => Some(&self.pseudo_force),
        }
    }

    fn gamma(&self) -> Gamma {
        Gamma { ellipsoid: self.ellipsoid, shell: self.shell, alpha: self.pseudo_force.alpha }
    }
}

/// The input of a step: the state of the scene in the frame that the step computes.
///
/// If you know the motion of the head beforehand, use [`new`](Self::new). An engine knows only the current pose: use
/// [`live`](Self::live), and [`with_bodies`](Self::with_bodies) for everything else that moves.
///
/// A step does not check its input. Poses must be [valid](Pose::is_valid); forces must be finite and within the bound
/// of the field that the stepper was built with. A NaN stays in the hair until you rewind it.
#[derive(Clone, Copy, Debug)]
#[non_exhaustive]
pub struct FrameInput<'a> {
    /// Number of the frame to compute; 1 is the first after rest. Fields, moving bodies and disturbances use it. It
    /// need not follow the previous number, and may exceed [`Motion::frames`].
    pub frame: u32,
    /// The pose of the head in that frame. World forces F(n + 1) are evaluated at p_i of frame n, carried by this pose:
    /// as if the hair had moved rigidly with the head.
    pub pose: Pose,
    /// The poses of the two previous frames, the later one first. The free form uses them for turns and accelerations.
    pub before: [Pose; 2],
    /// The field. Each step may use another one. Its strength is bounded when you build a stepper and is not checked
    /// here; see [`Simulation::strongest_force`].
    pub field: &'a dyn Field,
    /// World poses of bodies in that frame and in the frame before, by their index in [`FreeMotion::bodies`]: for
    /// example a hand that a player moves. `None`, or a missing entry, means that the body follows its [`BodyWay`].
    /// Contact is tested only at these poses: a thin blade that moves farther in a step than its width may pass through
    /// hair.
    ///
    /// [`BodyWay`]: crate::body::BodyWay
    pub bodies: &'a [Option<[Pose; 2]>],
    /// The skin in that frame, in the frame before and in the one before that, from [`Skin::frame`] of
    /// [`Dynamics::skin`]; ignored without such a skin. `None` means that it follows [`Skin::frames`]. If it jumps, pass the
    /// new shape three times, and call [`Simulation::jumped`].
    pub skin: Option<[&'a SkinFrame; 3]>,
}

impl<'a> FrameInput<'a> {
    /// A frame (from 1 on) of a head whose `poses` are all known, starting at frame 0. An empty slice is a head that
    /// does not move; after the last pose the head stays there. Before frame 0, the motion is continued backward. All
    /// bodies follow their own motions.
    pub fn new(frame: u32, poses: &[Pose], field: &'a dyn Field) -> Self {
        let pose = |n: u32| poses.get(n as usize).or(poses.last()).copied().unwrap_or_default();
        let before = frame.saturating_sub(1);
        let earlier = match before.checked_sub(1) {
            Some(earlier) => pose(earlier),
            None => pose(0).continued_back_from(&pose(1)),
        };
        Self { frame, pose: pose(frame), before: [pose(before), earlier], field, bodies: &[], skin: None }
    }

    /// A frame of a head whose pose is known from step to step. `before` holds the poses of the previous step and of
    /// the step before it. If the head jumps, pass `[pose; 2]`: the hair moves along and does not feel the jump. See
    /// [`Simulation::jumped`] for bodies.
    pub fn live(frame: u32, pose: Pose, before: [Pose; 2], field: &'a dyn Field) -> Self {
        Self { frame, pose, before, field, bodies: &[], skin: None }
    }

    /// Sets the poses of [`bodies`](Self::bodies).
    #[must_use]
    pub fn with_bodies(self, bodies: &'a [Option<[Pose; 2]>]) -> Self {
        Self { bodies, ..self }
    }

    /// Sets the shapes of the [`skin`](Self::skin), of this frame first.
    #[must_use]
    pub fn with_skin(self, frames: [&'a SkinFrame; 3]) -> Self {
        Self { skin: Some(frames), ..self }
    }

    /// Transforms points from the space of body number `b` to head space: at the end of this step of the frame, and at its beginning.
    fn head_from_body(&self, b: usize, body: &Body, [step, steps]: [u32; 2]) -> [Affine3A; 2] {
        let (frames, heads) = ([self.frame, self.frame.saturating_sub(1)], [self.pose, self.before[0]]);
        let told = self.bodies.get(b).copied().flatten();
        let [now, before] = [0, 1].map(|i| match &told {
            Some(poses) => heads[i].world_from_head().inverse() * poses[i].world_from_head(),
            None => body.head_from_body(frames[i], &heads[i]),
        });
        [step, step - 1].map(|step| match step {
            0 => before,
            _ if step == steps || now == before => now,
            _ => between(before, now, step as f32 / steps as f32),
        })
    }
}

/// The pose of a rigid body at the part `t` of the way between two poses.
fn between(from: Affine3A, to: Affine3A, t: f32) -> Affine3A {
    let [a, b] = [from, to].map(|place| Quat::from_mat3a(&place.matrix3));
    Affine3A::from_rotation_translation(a.slerp(b, t), from.translation.lerp(to.translation, t).into())
}

/// Hair that moves one frame at a time: the common interface of the two twins.
pub trait Stepper {
    /// Advances by one step, to the frame of `input`.
    fn step_frame(&mut self, input: &FrameInput);

    /// The frame that [`strands`](Self::strands) shows; 0 at rest.
    fn frame(&self) -> u32;

    /// The hair at this frame (head space, cm).
    fn strands(&self) -> &Strands;
}
