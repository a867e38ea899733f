//! What the free form of the motion takes: `motion.form`, `[free]`, `[contact]`, `[[body]]`, `[neighbours]`.

use std::path::PathBuf;

use glam::Vec3;
use nabiki::body::Contact;
use nabiki::dynamics::Motion;
use nabiki::free_form::{FreeForm, Tie};
use nabiki::{Profile, SettingError};
use nabiki_io::motion::{Axis, MotionSource};
use nabiki_io::{Placement, Unit};
use nabiki_render::settings::BodyLook;
use serde::{Deserialize, Serialize};
use toml::Table;

use super::flat;
use super::head::check_placement;
use super::read::Refusal;
use super::tree::{Unwritable, table_of};

/// The equations that hair moves by: `motion.form`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum FormChoice {
    /// The paper's (the default).
    #[default]
    Paper,
    /// The free form: hair comes back to rest, stays out of bodies and rides on a head that turns.
    Free,
}

/// The key of `[motion]` that is not the method's.
#[derive(Default, Deserialize, Serialize)]
#[serde(deny_unknown_fields, default)]
struct FormKey {
    form: FormChoice,
}

/// The table `[motion]`, read.
pub(super) fn read_motion(table: &Table) -> Result<(Motion, FormChoice), Refusal> {
    let (motion, FormKey { form }) = flat::read(table, &[], "")?;
    Ok((motion, form))
}

/// The table `[motion]`, to be written.
pub(super) fn motion_table(motion: &Motion, form: FormChoice) -> Result<Table, Unwritable> {
    let mut table = table_of(motion)?;
    table.extend(table_of(&FormKey { form })?);
    Ok(table)
}

/// `[free]`: what holds hair in shape and calms it. Without effect on the paper's form.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields, default)]
pub struct FreeSettings {
    /// K: the moment with which a joint turns its two segments toward one another's rest shape; one number, or a list from
    /// root to tip (default [12000, 1000]).
    pub stiffness: Profile,
    /// H: what turns a segment toward its rest direction in the head's frame; one number, or a list (default 30).
    pub hold: Profile,
    /// Frames in which a swing dies to 1/e, 0: never; one number, or a list, in which hair beside a 0 hardly swings (default 20).
    pub settle: Profile,
    /// The weight of hair that has been moved: a strength, or "earth" for that of the earth at `motion.frame_rate`
    /// (default 100).
    pub gravity: Gravity,
    /// The share of the head's turn that hair follows at once is (1 - m/L)^lag (default 1).
    pub lag: f32,
    /// Whether `[pseudo_force]` weakens the field before the head, as in the paper's form (default false).
    pub pseudo_force: bool,
    /// Hair that passes `at` (head space, cm) at rest as near as `within` (cm) is tied there, and does not move before it;
    /// none if left out.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub tie: Option<Tie>,
}

impl Default for FreeSettings {
    fn default() -> Self {
        let FreeForm { stiffness, hold, settle, gravity, lag, tie } = FreeForm::default();
        Self { stiffness, hold, settle, gravity: Gravity::Strength(gravity), lag, pseudo_force: false, tie }
    }
}

impl FreeSettings {
    /// The method's settings, where weight has this strength.
    pub fn form(&self, gravity: f32) -> FreeForm {
        let Self { stiffness, hold, settle, lag, tie, .. } = self.clone();
        FreeForm { stiffness, hold, settle, gravity, lag, tie }
    }

    /// Refuses lists of no or too many numbers, and numbers out of range.
    ///
    /// # Errors
    /// Names the first such setting.
    pub fn check(&self) -> Result<(), SettingError> {
        self.form(match self.gravity {
            Gravity::Strength(strength) => strength,
            Gravity::Earth => 0.0,
        })
        .check()
    }
}

/// The weight of hair.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, Serialize)]
#[serde(untagged, expecting = "must be a number of at least 0, or \"earth\"")]
pub enum Gravity {
    /// In the unit of the force.
    Strength(f32),
    /// That of the earth for hair of the mean length, at the frame rate.
    #[serde(with = "earth")]
    Earth,
}

/// The word "earth".
mod earth {
    use serde::{Deserialize, Deserializer, Serializer, de::Error};

    pub fn serialize<S: Serializer>(serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str("earth")
    }

    pub fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<(), D::Error> {
        match String::deserialize(deserializer)?.as_str() {
            "earth" => Ok(()),
            other => Err(D::Error::custom(format!("found \"{other}\", must be \"earth\""))),
        }
    }
}

/// `[[body]]`: something besides the head that hair does not enter.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields, default)]
pub struct BodySettings {
    /// A .obj, .glb, .gltf, .ply, .tfxmesh, USD layer or Alembic archive.
    pub mesh: PathBuf,
    /// Groups, objects or nodes of the file to keep (default: all).
    pub groups: Vec<String>,
    /// Unit of the file (default: what the file says, or cm).
    pub unit: Option<Unit>,
    /// Axis of the file that points up (default: what the file says, or +y).
    pub up: Option<Axis>,
    /// Axis of the file that lies along +x of the scene (default +x).
    pub facing: Option<Axis>,
    /// Point of the file that the body's motion carries (file units; default: the file's own origin).
    pub origin: Option<Vec3>,
    /// A file that moves the body through the world, as `head.motion` moves the head (default: it stands still).
    pub motion: Option<MotionSource>,
    /// Whether it is worn: it stands in head space and goes with the head (default false).
    pub with_head: bool,
    /// Whether hair keeps out of it (default true); otherwise it is drawn and no more, and may be open.
    pub solid: bool,
    /// How far from its skin nodes are kept (cm; default 0.1).
    pub margin: f32,
    /// The part of a push that sliding hair loses of its speed (default 0.1).
    pub friction: f32,
    /// The same for hair that does not slide, at least `friction` (default 0.15).
    pub static_friction: f32,
    /// Whether it is drawn (default true).
    pub shown: bool,
    /// Its colour in pictures (sRGB, 0..1; default `[0.42, 0.46, 0.5]`, a grey).
    pub colour: [f32; 3],
}

impl Default for BodySettings {
    fn default() -> Self {
        let Contact { margin, friction, static_friction } = Contact::default();
        let BodyLook { shown, colour } = BodyLook::default();
        Self {
            mesh: PathBuf::new(),
            groups: Vec::new(),
            unit: None,
            up: None,
            facing: None,
            origin: None,
            motion: None,
            with_head: false,
            solid: true,
            margin,
            friction,
            static_friction,
            shown,
            colour,
        }
    }
}

impl BodySettings {
    /// How it is touched.
    pub fn contact(&self) -> Contact {
        Contact { margin: self.margin, friction: self.friction, static_friction: self.static_friction }
    }

    /// How it is drawn.
    pub fn look(&self) -> BodyLook {
        BodyLook { shown: self.shown, colour: self.colour }
    }

    /// How the file lies in the body's space. `up` and `unit`: what the file itself says.
    pub fn placement(&self, unit: Option<Unit>, up: Option<Axis>) -> Placement {
        let default = Placement::default();
        Placement {
            unit: self.unit.or(unit).unwrap_or(default.unit),
            up: self.up.or(up).unwrap_or(default.up),
            facing: self.facing.unwrap_or(default.facing),
            origin: self.origin.unwrap_or(Vec3::ZERO),
        }
    }

    /// Refuses what no body can be loaded from; `i` is its number.
    ///
    /// # Errors
    /// Names the first such setting.
    pub fn check(&self, i: usize) -> Result<(), SettingError> {
        let name = format!("body[{i}]");
        if self.mesh.as_os_str().is_empty() {
            return Err(SettingError::new(format!("{name}.mesh"), "nothing", "give the file of its mesh"));
        }
        if self.with_head && self.motion.is_some() {
            let remedy = "a body that goes with the head has no motion of its own: remove one of the two";
            return Err(SettingError::new(format!("{name}.with_head"), true, remedy));
        }
        check_placement(&name, self.unit, self.up, self.facing, self.origin)?;
        self.contact().check(&name)?;
        if let Some(motion) = &self.motion {
            motion.check_numbers(&format!("{name}.motion"))?;
        }
        self.look().check(&name)
    }
}
