//! The scene file: everything that decides a movie, in TOML.
//!
//! Tables: `[head]`, `[hair]` with `[hair.style]` and `[hair.hairline]`, `[motion]`, `[pseudo_force]`, one `[[force]]`
//! for each interval of the field, `[disturbance]`, `[picture]`, `[output]`. All but `[[force]]` may be left out: the
//! defaults are the paper's. Paths are relative to the scene file.

mod read;
mod settings;
mod tree;

use std::path::{Path, PathBuf};

use nabiki::{
    SettingError,
    disturbance::Disturbance,
    dynamics::Motion,
    field::{Field, Keyframe},
    pseudo_force::PseudoForce,
};
use nabiki_render::Picture;
use serde::{Deserialize, Serialize};
use toml::{Table, Value};

pub use settings::{EllipsoidChoice, HairSettings, HeadSettings, Output};

use nabiki_io::{Error, Result, input, kind};
use settings::{GROWN_ONLY, IMPORTED_ONLY, MESH_FILE_ONLY};

/// A scene, read and checked.
#[derive(Clone, Debug, PartialEq)]
pub struct Scene {
    /// `[head]`
    pub head: HeadSettings,
    /// `[hair]`
    pub hair: HairSettings,
    /// `[motion]`
    pub motion: Motion,
    /// `[pseudo_force]`
    pub pseudo_force: PseudoForce,
    /// `[[force]]`
    pub force: Vec<Keyframe>,
    /// `[disturbance]`
    pub disturbance: Option<Disturbance>,
    /// `[picture]`
    pub picture: Picture,
    /// `[output]`
    pub output: Output,
    origins: tree::Origins,
}

/// The tables of the file, as they stand in it.
#[derive(Deserialize, Serialize)]
#[serde(deny_unknown_fields, default, rename = "a scene")]
#[derive(Default)]
struct Tables {
    head: HeadSettings,
    hair: HairSettings,
    motion: Motion,
    pseudo_force: PseudoForce,
    force: Vec<Keyframe>,
    disturbance: Option<Disturbance>,
    picture: Picture,
    output: Output,
}

impl Scene {
    /// Reads a scene file. `overrides`: dotted keys with their values in TOML, `motion.time_step` and `0.05`, or
    /// `force.1.vector` and `[0, -100, 0]`, put in their places before anything is read.
    ///
    /// # Errors
    /// One line: file and line (or override), key, value and the way out.
    pub fn load(path: &Path, overrides: &[(String, String)]) -> Result<Self> {
        kind::check_scene(path)?;
        let text = input::read_text(path, input::MOST_SCENE_BYTES)?;
        Self::parse(&text, path, overrides)
    }

    /// The same from text; `path` names it in errors, and paths in it are relative to the folder of `path`.
    pub fn parse(text: &str, path: &Path, overrides: &[(String, String)]) -> Result<Self> {
        let (table, origins) = tree::parse(text, path, overrides)?;
        let useless = useless_key(&table);
        let table = Value::Table(table);
        let tables = Tables::deserialize(read::Node(&table)).map_err(|e| origins.error(&e.path(), &e.to_string()))?;
        if let Some((key, why)) = useless {
            return Err(origins.error(&key, &format!("{key}: {why}")));
        }
        let Tables { head, hair, motion, pseudo_force, force, disturbance, picture, output } = tables;
        let scene = Self { head, hair, motion, pseudo_force, force, disturbance, picture, output, origins };
        scene.check().map_err(|refused| scene.refusal(refused))?;
        Ok(scene)
    }

    /// Refuses every value out of its range. What depends on the head or the hair is checked when they are loaded.
    pub fn check(&self) -> Result<(), SettingError> {
        self.head.check()?;
        self.hair.check()?;
        self.motion.check()?;
        self.pseudo_force.check()?;
        self.field()?;
        if let Some(disturbance) = &self.disturbance {
            disturbance.check()?;
        }
        self.picture.check()?;
        self.output.check(self.motion.frames)
    }

    /// The force field of `[[force]]`.
    pub fn field(&self) -> Result<Field, SettingError> {
        Field::new(&self.force)
    }

    /// A refused setting as an error that names the file and the line, or the override, that set it.
    pub fn refusal(&self, refused: SettingError) -> Error {
        self.origins.error(&refused.thing, &refused.to_string())
    }

    /// The scene file.
    pub fn file(&self) -> &Path {
        self.origins.file()
    }

    /// The scene file's name without folder and ending.
    pub fn name(&self) -> String {
        self.file().file_stem().unwrap_or_default().to_string_lossy().into_owned()
    }

    /// A path in the scene, relative to the scene file.
    pub fn resolve(&self, path: &Path) -> PathBuf {
        self.file().parent().unwrap_or(Path::new("")).join(path)
    }
}

/// A key that has no effect beside what else the scene says, and why.
fn useless_key(scene: &Table) -> Option<(String, String)> {
    let table = |name: &str| scene.get(name).and_then(Value::as_table);
    let given = |name: &str, keys: &[&str]| {
        let table = table(name)?;
        keys.iter().find(|&&key| table.contains_key(key)).map(|key| format!("{name}.{key}"))
    };
    let imported = table("hair").is_some_and(|hair| hair.contains_key("file"));
    let mesh = table("head").and_then(|head| head.get("mesh")).and_then(Value::as_str);
    let own_head = mesh.is_none_or(|mesh| mesh.starts_with("builtin:"));
    if imported {
        let why = "has no effect on hair that hair.file imports: remove one of them";
        given("hair", &GROWN_ONLY).map(|key| (key, why.to_owned()))
    } else {
        let why = "has an effect only on hair that hair.file imports: give that or remove this";
        given("hair", &IMPORTED_ONLY).map(|key| (key, why.to_owned()))
    }
    .or_else(|| {
        let why = "has no effect on the built-in head: remove it, or give head.mesh a file";
        given("head", &MESH_FILE_ONLY).filter(|_| own_head).map(|key| (key, why.to_owned()))
    })
}
