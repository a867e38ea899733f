//! `[head]`: the mesh, the ellipsoids of section 3.1 of the paper, and the motion.

use std::path::{Path, PathBuf};

use glam::Vec3;
use nabiki::setting::{Datum, Key, Kind, Place, Range, Settings, Value as Setting, Word, refused};
use nabiki::{Ellipsoid, SettingError, settings};
use nabiki_io::motion::{Axis, MotionSource};
use nabiki_io::{Placement, Unit};
use serde::{Deserialize, Serialize};
use toml::{Table, Value};

use super::flat;
use super::read::Refusal;
use super::tree::{Unwritable, table_of};

/// `[head]`.
#[derive(Clone, Debug, PartialEq)]
pub struct HeadSettings {
    /// The source of the mesh. Keys: `mesh`, and those of [`ImportedHead`].
    pub source: HeadSource,
    /// E: fitted, or given by centre and half axes (head space, cm).
    pub ellipsoid: EllipsoidChoice,
    /// C is E scaled by this factor, above 1.
    pub shell: f32,
    /// A file that moves the head, if one does.
    pub motion: Option<MotionSource>,
}

/// The source of the head's mesh.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum HeadSource {
    /// The built-in bust: `mesh = "builtin:bust"`.
    #[default]
    Builtin,
    /// A file.
    Imported(ImportedHead),
}

settings! {
    /// A head from a file.
    pub struct ImportedHead in "head" where is_placed {
        /// The mesh: a .obj, .glb, .gltf, .fbx, .ply, .tfxmesh, USD layer or Alembic archive.
        pub mesh: PathBuf = PathBuf::new() => "Mesh", must "\"head.obj\"";
        /// Groups, objects or nodes of the file to use. Uses all if empty.
        pub groups: Vec<String> = Vec::new() => "Groups";
        /// Length unit of the file.
        pub unit: Option<Unit> = None => "Unit", above 0.0, open "what the file says, or cm";
        /// Axis of the file that points up.
        pub up: Option<Axis> = None => "Up", open "what the file says, or +y";
        /// Axis of the file along which the face looks.
        pub facing: Option<Axis> = None => "Facing", open "+x";
        /// Point of the file that becomes the origin of head space, in the file's unit. By default the centre of the
        /// fitted ellipsoid, or the file's own origin if you give an ellipsoid.
        pub origin: Option<Vec3> = None => "Origin", open "the ellipsoid's centre";
    }
}

/// The source of the head ellipsoid E.
#[derive(Clone, Copy, Debug, Default, PartialEq, Deserialize, Serialize)]
#[serde(untagged, expecting = "must be \"fit\" or { center = [x, y, z], half_axes = [x, y, z] }")]
pub enum EllipsoidChoice {
    /// `"fit"`: fitted to the part of the mesh where hair grows. The built-in bust has its own.
    #[default]
    #[serde(with = "fit")]
    Fit,
    /// As given.
    Given(Ellipsoid),
}

impl Setting for EllipsoidChoice {
    const KIND: Kind = Kind::OneOf(&[
        Kind::Words(&[Word {
            word: "fit",
            help: "Fitted to the part of the mesh where hair grows; the built-in bust brings its own.",
        }]),
        Kind::Table(&Ellipsoid::TABLE),
    ]);

    fn check(&self, at: &Place, range: &Range) -> Result<(), SettingError> {
        match self {
            Self::Fit => Ok(()),
            Self::Given(ellipsoid) => ellipsoid.check(at, range),
        }
    }

    fn datum(&self) -> Datum {
        match self {
            Self::Fit => Datum::Text("fit".to_owned()),
            Self::Given(ellipsoid) => ellipsoid.datum(),
        }
    }
}

/// The word "fit".
mod fit {
    use serde::{Deserialize, Deserializer, Serializer, de::Error};

    pub fn serialize<S: Serializer>(serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str("fit")
    }

    pub fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<(), D::Error> {
        match String::deserialize(deserializer)?.as_str() {
            "fit" => Ok(()),
            other => Err(D::Error::custom(format!("found \"{other}\", must be \"fit\""))),
        }
    }
}

settings! {
    /// The keys of any head.
    pub(crate) struct AnyHead in "head" {
        /// The head ellipsoid E: fitted to the part of the head where hair grows, or given in head space.
        ellipsoid: EllipsoidChoice = EllipsoidChoice::Fit => "Ellipsoid", unit "cm";
        /// Scale of the shell C around the ellipsoid E. The pseudo-force acts only within this shell; a larger value
        /// reaches farther from the head.
        shell: f32 = 1.25 => "Shell", above 1.0;
        /// A file that moves the head.
        motion: Option<MotionSource> = None => "Motion of the head", open "no motion";
    }
}

settings! {
    /// The built-in bust.
    pub(crate) struct BuiltinHead {
        /// Name of the built-in head, "builtin:bust".
        mesh: String = HeadSettings::BUILTIN.to_owned() => "Mesh";
    }
}

impl Default for HeadSettings {
    fn default() -> Self {
        Self::of(AnyHead::default(), HeadSource::Builtin)
    }
}

impl HeadSettings {
    /// The name of the built-in head, in place of a file.
    pub const BUILTIN: &str = "builtin:bust";

    fn of(any: AnyHead, source: HeadSource) -> Self {
        let AnyHead { ellipsoid, shell, motion } = any;
        Self { source, ellipsoid, shell, motion }
    }

    fn any(&self) -> AnyHead {
        let Self { ellipsoid, shell, motion, .. } = self.clone();
        AnyHead { ellipsoid, shell, motion }
    }

    /// The mesh as named in a scene: its file, or the built-in head.
    pub fn mesh(&self) -> String {
        match &self.source {
            HeadSource::Builtin => Self::BUILTIN.to_owned(),
            HeadSource::Imported(head) => head.mesh.display().to_string(),
        }
    }

    /// Reads the table `[head]`.
    pub(super) fn read(table: &Table) -> Result<Self, Refusal> {
        match table.get("mesh") {
            Some(Value::String(mesh)) if !mesh.starts_with("builtin:") => {
                let (any, head) = flat::read(table, &[], "")?;
                Ok(Self::of(any, HeadSource::Imported(head)))
            }
            _ => {
                let why = "has no effect on the built-in head: remove it, or give head.mesh a file";
                let (any, BuiltinHead { mesh }) = flat::read(table, flat::keys::<ImportedHead>(), why)?;
                if mesh != Self::BUILTIN {
                    let remedy = format!("there is one built-in head, \"{}\"", Self::BUILTIN);
                    return Err(Refusal::range(format!("\"{mesh}\""), remedy).below("mesh"));
                }
                Ok(Self::of(any, HeadSource::Builtin))
            }
        }
    }

    /// The table `[head]`, for writing.
    pub(super) fn table(&self) -> Result<Table, Unwritable> {
        let mut table = match &self.source {
            HeadSource::Builtin => table_of(&BuiltinHead::default())?,
            HeadSource::Imported(head) => table_of(head)?,
        };
        table.extend(table_of(&self.any())?);
        Ok(table)
    }

    /// The same source with everything else at its default.
    pub(super) fn with_defaults(&self) -> Self {
        let source = match &self.source {
            HeadSource::Builtin => HeadSource::Builtin,
            // A file has no default: an empty path differs from any.
            HeadSource::Imported(_) => HeadSource::Imported(ImportedHead::default()),
        };
        Self { source, motion: None, ..Self::default() }
    }

    /// Refuses invalid settings.
    ///
    /// # Errors
    /// Names the first such setting.
    pub fn check(&self) -> Result<(), SettingError> {
        if let HeadSource::Imported(head) = &self.source {
            head.check()?;
        }
        self.any().check()
    }
}

impl ImportedHead {
    /// The file's placement in head space, before an origin is found for it. `up` and `unit` are what the file
    /// declares.
    pub fn placement(&self, unit: Option<Unit>, up: Option<Axis>) -> Placement {
        let default = Placement::default();
        Placement {
            unit: self.unit.or(unit).unwrap_or(default.unit),
            up: self.up.or(up).unwrap_or(default.up),
            facing: self.facing.unwrap_or(default.facing),
            origin: self.origin.unwrap_or(default.origin),
        }
    }

    /// Refuses what is wrong whatever the file declares: it may have its own unit and up axis.
    fn is_placed(&self, at: &Place) -> Result<(), SettingError> {
        check_named(&at.key("mesh"), &self.mesh)?;
        check_placement(&Key::from(at).to_string(), self.unit, self.up, self.facing, self.origin)
    }
}

/// Refuses an empty path, which a scene file would leave out.
pub(super) fn check_named(at: &Place, file: &Path) -> Result<(), SettingError> {
    if file.as_os_str().is_empty() { refused(at, "\"\"", "name a file") } else { Ok(()) }
}

/// Refuses given parts of a placement that are wrong whatever a file declares for the others.
pub(super) fn check_placement(
    table: &str,
    unit: Option<Unit>,
    up: Option<Axis>,
    facing: Option<Axis>,
    origin: Option<Vec3>,
) -> Result<(), SettingError> {
    let across = |axis: Axis| match axis {
        Axis::PlusX | Axis::MinusX => Axis::PlusY,
        _ => Axis::PlusX,
    };
    let default = Placement::default();
    let (up, facing) = match (up, facing) {
        (Some(up), Some(facing)) => (up, facing),
        (Some(up), None) => (up, across(up)),
        (None, Some(facing)) => (across(facing), facing),
        (None, None) => (default.up, default.facing),
    };
    let (unit, origin) = (unit.unwrap_or(default.unit), origin.unwrap_or(default.origin));
    Placement { unit, up, facing, origin }.check(table)
}
