//! The scene: everything that determines a movie. It is built in code or read from TOML, and can be written back.
//!
//! Tables of the file: `[head]`, `[hair]` with `[hair.style]` and `[hair.hairline]`, `[motion]`, `[free]`, `[contact]`,
//! one `[[body]]` per body, one `[[aim]]` per aim, `[neighbours]`, `[pseudo_force]`, one `[[force]]` per interval of the paper's field, the
//! other fields ([`FieldSettings`]), `[disturbance]`, `[picture]`, `[output]`. All are optional, except that the
//! paper's form needs a field. The defaults are the paper's. Paths are relative to the scene file.

mod aim;
mod body;
mod edit;
mod error;
mod field;
mod flat;
mod force;
mod form;
mod free;
mod hair;
mod head;
mod output;
mod quantity;
pub(crate) mod read;
mod settings;
pub(crate) mod tree;

use std::path::{Path, PathBuf};

use nabiki::SettingError;
use nabiki::body::Contact;
use nabiki::disturbance::Disturbance;
use nabiki::dynamics::Motion;
use nabiki::field::{BodyWind, Fan, Flow, Gust, Point, Turbulence, Vortex, Wind};
use nabiki::free_form::NeighbourForces;
use nabiki::pseudo_force::PseudoForce;
use nabiki::setting::Key;
use nabiki_io::motion::MotionSource;
use nabiki_io::{input, kind};
use nabiki_render::Picture;
use nabiki_render::settings::{Camera, CameraKey};
use serde::Deserialize;
use toml::{Table, Value};
use toml_edit::DocumentMut;

pub use aim::AimSettings;
pub use body::{BodySettings, CapsuleSettings};
pub use error::{Problem, SceneError};
pub use field::{FieldBound, FieldSettings, OwnField};
pub(crate) use field::{FieldParts, FieldPlace};
pub use force::ForceSettings;
pub(crate) use force::given_as;
pub use form::FormChoice;
pub(crate) use form::FormKey;
pub use free::FreeSettings;
pub(crate) use free::MeanLengths;
pub(crate) use hair::AnyHair;
pub use hair::{GrownHair, HairSettings, HairSource, ImportedHair, RootEnd};
pub(crate) use head::{AnyHead, BuiltinHead};
pub use head::{EllipsoidChoice, HeadSettings, HeadSource, ImportedHead};
pub use output::{Output, check_first_frame};
pub use quantity::{Amount, Length, Measure, Quantity, Speed, Strength, Time, Weight};
pub(crate) use tree::BACKSLASHES;

use read::{Node, Refusal};
use tree::{Unwritable, table_of};

/// A scene. Two scenes are equal if they mean the same, whatever their origin.
///
/// ```
/// use glam::Vec3;
/// use nabiki::field::Keyframe;
/// use nabiki_scene::Scene;
///
/// let text = "[[force]]          # the gust\nthrough = 50\nvector = [-100, 0, 0]\n";
/// let mut scene = Scene::parse(text, "gust.toml".as_ref(), &[])?;
/// scene.field.force = vec![Keyframe { through: 50, vector: Vec3::new(-80.0, 0.0, 0.0) }.into()];
/// assert_eq!(scene.to_toml()?, text.replace("-100", "-80"));
/// # Ok::<(), nabiki_scene::scene::SceneError>(())
/// ```
#[derive(Clone, Debug, Default)]
pub struct Scene {
    /// `[head]`
    pub head: HeadSettings,
    /// `[hair]`
    pub hair: HairSettings,
    /// `[motion]`
    pub motion: Motion,
    /// `motion.form`: the equations of motion.
    pub form: FormChoice,
    /// `[free]`: shape and damping of hair in the free form.
    pub free: FreeSettings,
    /// `[contact]`: contact of hair and head in the free form.
    pub contact: Contact,
    /// `[[body]]`: other bodies that hair collides with in the free form.
    pub bodies: Vec<BodySettings>,
    /// `[[aim]]`: shapes that hair is led to in the free form.
    pub aims: Vec<AimSettings>,
    /// `[neighbours]`: hair against hair in the free form.
    pub neighbours: Option<NeighbourForces>,
    /// `[pseudo_force]`
    pub pseudo_force: PseudoForce,
    /// The fields: `[[force]]` and others. A scene made in code starts without fields.
    pub field: FieldSettings,
    /// `[disturbance]`
    pub disturbance: Option<Disturbance>,
    /// `[picture]`
    pub picture: Picture,
    /// `[output]`
    pub output: Output,
    /// The text it was read from, empty if it was made in code.
    text: String,
    origins: tree::Origins,
}

impl PartialEq for Scene {
    fn eq(&self, other: &Self) -> bool {
        let Self { head, hair, motion, form, free, contact, .. } = self;
        let Self { bodies, aims, neighbours, pseudo_force, field, disturbance, picture, output, .. } = self;
        *head == other.head
            && *hair == other.hair
            && *motion == other.motion
            && *form == other.form
            && *free == other.free
            && *contact == other.contact
            && *bodies == other.bodies
            && *aims == other.aims
            && *neighbours == other.neighbours
            && *pseudo_force == other.pseudo_force
            && *field == other.field
            && *disturbance == other.disturbance
            && *picture == other.picture
            && *output == other.output
    }
}

/// The tables of the file. Those that belong to several structs are split by these.
#[derive(Deserialize)]
#[serde(deny_unknown_fields, default, rename = "a scene")]
#[derive(Default)]
struct Tables {
    head: Table,
    hair: Table,
    motion: Table,
    free: FreeSettings,
    contact: Contact,
    body: Vec<BodySettings>,
    aim: Vec<AimSettings>,
    neighbours: Option<NeighbourForces>,
    pseudo_force: PseudoForce,
    force: Vec<ForceSettings>,
    wind: Wind,
    gust: Option<Gust>,
    body_wind: Option<BodyWind>,
    flow: Option<Flow>,
    turbulence: Option<Turbulence>,
    point: Vec<Point>,
    vortex: Vec<Vortex>,
    fan: Vec<Fan>,
    disturbance: Option<Disturbance>,
    picture: Picture,
    output: Output,
}

impl Scene {
    /// Reads a scene file. `overrides` are dotted keys with values in TOML, such as `motion.time_step` and `0.05`, or
    /// `force.1.vector` and `[0, -100, 0]`. They are applied before the settings are read.
    ///
    /// # Errors
    /// If the file or an override is invalid: position, key, value and remedy.
    pub fn load(path: &Path, overrides: &[(String, String)]) -> Result<Self, SceneError> {
        let text = kind::check_scene(path).and_then(|()| input::read_text(path, input::MOST_SCENE_BYTES));
        let text = text.map_err(|e| file_error(path, e))?;
        Self::parse(&text, path, overrides)
    }

    /// Reads a scene from text. `path` is its name in errors, and paths in it are relative to the folder of `path`.
    ///
    /// # Errors
    /// As for [`load`](Self::load).
    pub fn parse(text: &str, path: &Path, overrides: &[(String, String)]) -> Result<Self, SceneError> {
        let scene = Self::read(text, path, overrides)?;
        scene.check().map_err(|refused| scene.refusal(refused))?;
        Ok(scene)
    }

    /// The meaning of the text, whether or not it is in range.
    fn read(text: &str, path: &Path, overrides: &[(String, String)]) -> Result<Self, SceneError> {
        let (table, origins) = tree::parse(text, path, overrides, Self::whole_tree)?;
        match Self::of_tree(table) {
            Ok(scene) => Ok(Self { text: text.to_owned(), origins, ..scene }),
            Err(refusal) => Err(Self::unreadable(refusal, &origins)),
        }
    }

    /// The tree of the defaults, including optional tables.
    fn whole_tree() -> Table {
        Self::default().with_optional_tables().tree().unwrap_or_default()
    }

    /// A tree that is refused, with the position of the error.
    fn unreadable(refusal: Refusal, origins: &tree::Origins) -> SceneError {
        let (key, mut problem) = refusal.into_parts();
        // If another table has this key, it was meant as spelled, whatever is spelled like it here.
        if let Problem::UnknownKey { near, .. } = &mut problem
            && let Some(there) = tree::elsewhere(&Self::whole_tree(), &key)
        {
            *near = Some(there);
        }
        origins.error(&key, problem)
    }

    /// The scene of a tree of settings, as if made in code.
    fn of_tree(tree: Table) -> Result<Self, Refusal> {
        let tables = Tables::deserialize(Node(&Value::Table(tree)))?;
        let (motion, form) = form::read_motion(&tables.motion).map_err(|e| e.below("motion"))?;
        Ok(Self {
            head: HeadSettings::read(&tables.head).map_err(|e| e.below("head"))?,
            hair: HairSettings::read(&tables.hair).map_err(|e| e.below("hair"))?,
            motion,
            form,
            free: tables.free,
            contact: tables.contact,
            bodies: tables.body,
            aims: tables.aim,
            neighbours: tables.neighbours,
            pseudo_force: tables.pseudo_force,
            field: FieldSettings {
                force: tables.force,
                wind: tables.wind,
                gust: tables.gust,
                body_wind: tables.body_wind,
                flow: tables.flow,
                turbulence: tables.turbulence,
                point: tables.point,
                vortex: tables.vortex,
                fan: tables.fan,
                own: Vec::new(),
            },
            disturbance: tables.disturbance,
            picture: tables.picture,
            output: tables.output,
            text: String::new(),
            origins: tree::Origins::default(),
        })
    }

    /// Refuses values out of range. Checks that depend on the head or the hair are made when those are loaded.
    ///
    /// # Errors
    /// Names the first such setting.
    pub fn check(&self) -> Result<(), SettingError> {
        self.head.check()?;
        self.hair.check()?;
        self.motion.check()?;
        self.free.check()?;
        self.contact.check_at("contact")?;
        self.bodies.iter().enumerate().try_for_each(|(i, body)| body.check_at(&format!("body[{i}]")))?;
        self.aims.iter().enumerate().try_for_each(|(i, aim)| self.check_aim(aim, &format!("aim[{i}]")))?;
        self.neighbours.as_ref().map_or(Ok(()), NeighbourForces::check)?;
        self.pseudo_force.check()?;
        self.field.check(self.head.motion.is_some(), self.form == FormChoice::Free)?;
        self.check_speeds()?;
        if let Some(disturbance) = &self.disturbance {
            disturbance.check()?;
            if self.form == FormChoice::Free {
                return Err(disturbance.refused_in_the_free_form());
            }
        }
        self.picture.check()?;
        self.output.check()?;
        self.output.check_frames(self.motion.frames)
    }

    /// Refuses an aim that leads to no shape, or leads a region that there is not.
    pub(crate) fn check_aim(&self, aim: &AimSettings, name: &str) -> Result<(), SettingError> {
        aim.check_at(name)?;
        let Some(region) = aim.region.as_ref().filter(|region| self.region_named(region).is_none()) else {
            return Ok(());
        };
        let there: Vec<String> = self
            .free
            .regions
            .iter()
            .filter(|region| !region.name.is_empty())
            .map(|region| format!("\"{}\"", region.name))
            .collect();
        let remedy = match &there[..] {
            [] => "no [[free.regions]] has a name: add the region, or leave it out to lead all hair".to_owned(),
            _ => format!("there is no such region: give one of {}", there.join(", ")),
        };
        Err(SettingError::new(format!("{name}.region"), format!("\"{region}\""), remedy))
    }

    /// The index of the region of this name.
    pub(crate) fn region_named(&self, name: &str) -> Option<usize> {
        self.free.regions.iter().position(|region| !name.is_empty() && region.name == name)
    }

    /// Refuses a wind given by its speed if no air carries the hair.
    fn check_speeds(&self) -> Result<(), SettingError> {
        let mut speeds = self.field.force.iter().enumerate().filter_map(|(j, force)| Some((j, force.speed?)));
        let Some((j, speed)) = speeds.next() else { return Ok(()) };
        let refused = |remedy: &str| Err(SettingError::new(format!("force[{j}].speed"), speed, remedy));
        if self.form == FormChoice::Paper {
            return refused(
                "the paper's form has no air to carry hair: set motion.form = \"free\", or give the strength in vector",
            );
        }
        if self.free.settle.values().iter().all(Amount::is_zero) {
            return refused(
                "with free.settle = 0 there is no air to carry hair: give settle, or give the strength in vector",
            );
        }
        Ok(())
    }

    /// Keys of the file that an override removed, a line each.
    pub(crate) fn replaced(&self) -> impl Iterator<Item = String> {
        self.origins.replaced()
    }

    /// Adds to an error the file and line, or the override, of the setting.
    pub fn refusal(&self, refused: SettingError) -> SceneError {
        let SceneError { key, problem, .. } = refused.into();
        self.origins.error(&key.to_string(), *problem)
    }

    /// Whether an override set the value of this key (dotted).
    pub(crate) fn is_overridden(&self, key: &str) -> bool {
        self.origins.is_overridden(key)
    }

    /// The scene file; empty for a scene made in code.
    pub fn file(&self) -> &Path {
        &self.origins.file
    }

    /// The scene file's name without folder and ending.
    pub fn name(&self) -> String {
        self.file().file_stem().unwrap_or_default().to_string_lossy().into_owned()
    }

    /// Frames per second of the movie and of the head's motion.
    pub fn frame_rate(&self) -> f64 {
        self.motion.frame_rate
    }

    /// All input files of this scene: its own, and those that it names.
    pub fn inputs(&self) -> Vec<PathBuf> {
        let mut named: Vec<&Path> = Vec::new();
        if let HairSource::Imported(hair) = &self.hair.source {
            named.push(&hair.file);
        }
        if let HeadSource::Imported(head) = &self.head.source {
            named.push(&head.mesh);
        }
        if let Some(motion) = &self.head.motion {
            named.push(&motion.file);
            named.extend(motion.skeleton.as_deref());
        }
        for body in &self.bodies {
            named.extend(body.capsule.is_none().then_some(&*body.mesh));
            if let Some(motion) = &body.motion {
                named.push(&motion.file);
                named.extend(motion.skeleton.as_deref());
            }
        }
        named.extend(self.free.regions.iter().filter_map(|region| region.map.as_deref()));
        named.extend(self.aims.iter().map(|aim| &*aim.file).filter(|file| !file.as_os_str().is_empty()));
        let mut inputs = vec![self.file().to_owned()];
        inputs.extend(named.into_iter().map(|path| self.resolve(path)));
        inputs
    }

    /// Resolves a path relative to the scene file.
    pub fn resolve(&self, path: &Path) -> PathBuf {
        resolved(self.file(), path)
    }

    /// The scene as TOML: the original text with only the changed settings replaced, so that comments and layout stay.
    /// A setting that has its default and is not in the text is not added.
    ///
    /// # Errors
    /// If TOML cannot store a setting: a whole number above 2^63, a path that is not text, or a program's own field.
    pub fn to_toml(&self) -> Result<String, SceneError> {
        if !self.field.own.is_empty() {
            let line = "a file cannot hold a field from a program: remove it from the scene before you save it";
            return Err(self.origins.error("", Problem::Other(line.to_owned())));
        }
        let unwritable = |Unwritable(why): Unwritable| self.origins.error("", Problem::Other(why));
        let held = Self::read(&self.text, self.file(), &[])?.tree().map_err(unwritable)?;
        let wanted = self.tree().map_err(unwritable)?;
        if held == wanted {
            return Ok(self.text.clone());
        }
        let bare = self.with_defaults();
        let defaults = edit::Defaults {
            bare: bare.tree().map_err(unwritable)?,
            full: bare.with_optional_tables().tree().map_err(unwritable)?,
        };
        let mut document: DocumentMut = self.text.parse().map_err(|e: toml_edit::TomlError| {
            let problem = Problem::NotToml(e.message().to_owned());
            self.origins.error("", problem)
        })?;
        edit::apply(&mut document, &held, &wanted, &defaults);
        let text = document.to_string();
        // The TOML editor knows only one kind of line ending.
        let of_two = self.text.contains("\r\n");
        Ok(if of_two { text.replace("\r\n", "\n").replace('\n', "\r\n") } else { text })
    }

    /// Writes [`to_toml`](Self::to_toml) to `path`. The file appears when it is complete. It then is the scene's file,
    /// and paths are relative to its folder. A text that could not be [loaded](Self::load) from there is refused.
    ///
    /// # Errors
    /// As for [`to_toml`](Self::to_toml) and [`load`](Self::load), and errors of the disk.
    pub fn save(&mut self, path: &Path) -> Result<(), SceneError> {
        let text = self.text_to_be(path)?;
        write_scene(path, &text)?;
        *self = Self { origins: Self::read(&text, path, &[])?.origins, text, ..self.clone() };
        Ok(())
    }

    /// The text that [`save`](Self::save) writes to `path`.
    ///
    /// # Errors
    /// As for [`save`](Self::save), except errors of the disk.
    pub fn text_to_be(&self, path: &Path) -> Result<String, SceneError> {
        // First, because it knows the lines that the user sees.
        self.check().map_err(|refused| self.refusal(refused))?;
        let text = self.to_toml()?;
        kind::check_scene_to_be(path, &text).map_err(|e| file_error(path, e))?;
        if text.len() as u64 > input::MOST_SCENE_BYTES {
            let line = format!("would be {} bytes: a scene may have at most {}", text.len(), input::MOST_SCENE_BYTES);
            return Err(file_error(path, nabiki_io::Error::new(line)));
        }
        Self::parse(&text, path, &[])?;
        Ok(text)
    }

    /// The settings as the tree from which they are read.
    fn tree(&self) -> Result<Table, Unwritable> {
        let mut tree = Table::new();
        tree.insert("head".to_owned(), self.head.table()?.into());
        tree.insert("hair".to_owned(), self.hair.table()?.into());
        tree.insert("motion".to_owned(), form::motion_table(&self.motion, self.form)?.into());
        tree.insert("free".to_owned(), table_of(&self.free)?.into());
        tree.insert("contact".to_owned(), table_of(&self.contact)?.into());
        let bodies = self.bodies.iter().map(|body| table_of(body).map(Value::Table)).collect::<Result<_, _>>()?;
        tree.insert("body".to_owned(), Value::Array(bodies));
        let aims = self.aims.iter().map(|aim| table_of(aim).map(Value::Table)).collect::<Result<_, _>>()?;
        tree.insert("aim".to_owned(), Value::Array(aims));
        if let Some(neighbours) = &self.neighbours {
            tree.insert("neighbours".to_owned(), table_of(neighbours)?.into());
        }
        tree.insert("pseudo_force".to_owned(), table_of(&self.pseudo_force)?.into());
        tree.extend(self.field.tables()?);
        if let Some(disturbance) = &self.disturbance {
            tree.insert("disturbance".to_owned(), table_of(disturbance)?.into());
        }
        tree.insert("picture".to_owned(), table_of(&self.picture)?.into());
        tree.insert("output".to_owned(), table_of(&self.output)?.into());
        Ok(tree)
    }

    /// The same sources with everything else at its default.
    fn with_defaults(&self) -> Self {
        Self { head: self.head.with_defaults(), hair: self.hair.with_defaults(), ..Self::default() }
    }

    /// The same with every optional table, at its own defaults.
    fn with_optional_tables(mut self) -> Self {
        self.head.motion = Some(MotionSource::default());
        self.field = self.field.with_optional_tables();
        self.disturbance = Some(Disturbance::default());
        self.neighbours = Some(NeighbourForces::default());
        self.picture.camera = Camera { to: Some(CameraKey::default()), ..self.picture.camera };
        self
    }
}

/// A path in the scene of the file `scene`, relative to that.
pub(crate) fn resolved(scene: &Path, path: &Path) -> PathBuf {
    scene.parent().unwrap_or(Path::new("")).join(path)
}

/// Writes the text of a scene to `path` unchanged. The file appears when it is complete.
///
/// # Errors
/// Errors of the disk.
pub fn write_scene(path: &Path, text: &str) -> Result<(), SceneError> {
    nabiki_file::write(path, text.as_bytes()).map_err(|e| {
        let mut refused = nabiki_io::Error::from(e);
        // The file need not exist, only its folder.
        if refused.system() == Some(std::io::ErrorKind::NotFound) {
            refused.what = "there is no such folder".to_owned();
        }
        file_error(path, refused)
    })
}

pub(crate) fn file_error(path: &Path, refused: nabiki_io::Error) -> SceneError {
    let system = refused.system();
    SceneError {
        file: path.to_owned(),
        line: None,
        set: None,
        key: Key::default(),
        problem: Box::new(Problem::File { what: refused.what, system }),
    }
}
