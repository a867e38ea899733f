//! The scene as Python has it: settings by key, and what can be done with them.

mod given;
pub(crate) mod said;
mod tasks;

use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::SystemTime;

use nabiki::setting::Key;
use nabiki_scene::scene::{HairSource, OwnField, RootEnd};
use nabiki_scene::{BuiltScene, Shown};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyMapping, PyTuple, PyType};
use toml::Value;

use crate::error;
use crate::field::{Field, PythonField};
use crate::hints::{Anything, ByName, Dictionary, Given, Hinted, SameClass};
use crate::made::Files;
use crate::scene::given::{HAIR_FILE, HAIR_ROOT, setting};
use crate::values;
use crate::watched::{Ears, watched};

/// Everything that decides a movie. `scene["motion.frames"]` is a setting by its key in a scene file.
#[pyclass(frozen, subclass, module = "nabiki")]
#[derive(Default)]
pub struct Scene(Mutex<State>);

/// What a scene is. Nobody of Python is called while it is locked, since whoever is called may ask the scene.
#[derive(Clone, Default)]
struct State {
    scene: nabiki_scene::Scene,
    fields: Vec<Arc<PythonField>>,
    made: Files,
    built: Option<Built>,
}

/// What was built last, and what its files were then.
#[derive(Clone)]
struct Built {
    shown: Shown,
    scene: Arc<BuiltScene>,
    files: Vec<FileState>,
}

type FileState = (PathBuf, Option<(SystemTime, u64)>);

/// Lengths and times of the files that a scene is read from, but for its own, which has been read.
fn files_of(scene: &nabiki_scene::Scene) -> Vec<FileState> {
    let state = |path: &PathBuf| {
        let data = std::fs::metadata(path).ok()?;
        Some((data.modified().ok()?, data.len()))
    };
    scene.inputs().split_off(1).into_iter().map(|path| (path.clone(), state(&path))).collect()
}

impl Scene {
    fn state(&self) -> MutexGuard<'_, State> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// What it is now.
    fn now(&self) -> nabiki_scene::Scene {
        self.state().scene.clone()
    }

    /// All that the scene names, loaded; what has not changed since it was built last is taken from there.
    fn built(&self, py: Python<'_>, shown: Shown, ears: Ears<'_, '_>) -> PyResult<Arc<BuiltScene>> {
        let State { scene, built: known, made: _held, .. } = self.checked(py)?;
        let files = files_of(&scene);
        let known = known.filter(|known| known.files == files);
        if let Some(known) = known.as_ref().filter(|known| known.shown == shown && known.scene.scene == scene) {
            return Ok(known.scene.clone());
        }
        let built = watched(py, ears, &self.functions(), |_| match known {
            Some(known) => known.scene.changed_to(scene, shown),
            None => scene.build(shown),
        })?;
        let scene = Arc::new(built);
        self.state().built = Some(Built { shown, scene: scene.clone(), files });
        Ok(scene)
    }

    /// What it is, unless a file of it would be refused: settings that do not go together may stand in a scene while it is changed, one
    /// after the other, and no longer.
    fn checked(&self, py: Python<'_>) -> PyResult<State> {
        let state = self.state().clone();
        state.scene.check().map_err(|wrong| Self::refused(py, state.scene.refusal(wrong)))?;
        Ok(state)
    }

    fn functions(&self) -> Vec<Arc<PythonField>> {
        self.state().fields.clone()
    }

    fn refused(py: Python<'_>, refused: nabiki_scene::scene::SceneError) -> PyErr {
        error::raised(py, refused.into())
    }

    /// Another value of a setting; what is out of its range is refused, and the scene is then as it was.
    fn put(&self, py: Python<'_>, key: &str, value: Option<Value>, files: Files) -> PyResult<()> {
        let put = || {
            let mut state = self.state();
            let root = (key == HAIR_FILE).then(|| root_of(&state, !files.is_empty())).flatten();
            let mut changed = state.scene.with_setting(key, value)?;
            if let Some(root) = root {
                changed = changed.with_setting(HAIR_ROOT, root)?;
            }
            match changed.check() {
                Err(wrong) if concerns(&wrong.thing, key) => Err(changed.refusal(wrong)),
                _ => {
                    state.made.take(files, &changed);
                    state.scene = changed;
                    Ok(())
                }
            }
        };
        put().map_err(|refused| Self::refused(py, refused))
    }

    /// A scene of the same class.
    fn another<'py>(class: &Bound<'py, PyType>, state: State) -> PyResult<Bound<'py, PyAny>> {
        let another = class.call0()?;
        *another.cast::<Self>()?.get().state() = state;
        Ok(another)
    }
}

/// What [`HAIR_ROOT`] becomes where hair is given anew: arrays are root first, and the file that comes after them as files are. `None` leaves
/// it as it is.
fn root_of(state: &State, arrays: bool) -> Option<Option<Value>> {
    let HairSource::Imported(before) = &state.scene.hair.source else { return arrays.then(given::root_first) };
    let was_arrays = state.made.holds(&before.file);
    match (was_arrays, arrays) {
        (true, true) => None,
        (true, false) => (before.root == RootEnd::First).then_some(None),
        (false, arrays) => arrays.then(given::root_first),
    }
}

/// The scene without its functions, and with paths that mean the same from every folder.
fn anywhere(mut scene: nabiki_scene::Scene) -> nabiki_scene::Scene {
    scene.field.own.clear();
    scene.moved_to(Path::new("/scene.toml"))
}

/// Whether one of two keys lies in the other.
fn concerns(thing: &Key, key: &str) -> bool {
    let key = Key::from(key);
    thing.is_within(&key) || key.is_within(thing)
}

#[pymethods]
impl Scene {
    #[new]
    #[pyo3(signature = (*_arguments: "object", **_settings: "object"))]
    fn new(_arguments: &Bound<'_, PyTuple>, _settings: Option<&Bound<'_, PyDict>>) -> Self {
        Self::default()
    }

    /// Reads a scene file. `settings` replaces settings by key before the scene is checked: `{"motion.frames": 50}`.
    #[classmethod]
    #[pyo3(signature = (path, settings=None))]
    fn open<'py>(
        class: &Bound<'py, PyType>,
        path: PathBuf,
        settings: Option<Given<'py, ByName>>,
    ) -> PyResult<Hinted<'py, SameClass>> {
        let py = class.py();
        let (mut made, mut given, mut arrays) = (Files::default(), Vec::new(), false);
        if let Some(settings) = settings {
            for entry in settings.0.cast::<PyMapping>()?.items()?.iter() {
                let (key, value): (String, Bound<'_, PyAny>) = entry.extract()?;
                if !value.is_none() {
                    let before = made.len();
                    given.push((key.clone(), setting(&key, &value, None, &mut made)?.to_string()));
                    arrays |= key == HAIR_FILE && made.len() > before;
                }
            }
        }
        if arrays && given.iter().all(|(key, _)| key != HAIR_ROOT) {
            given.extend(given::root_first().map(|first| (HAIR_ROOT.to_owned(), first.to_string())));
        }
        let scene = nabiki_scene::Scene::load(&path, &given).map_err(|refused| Self::refused(py, refused))?;
        Self::another(class, State { scene, made, ..State::default() }).map(Hinted::new)
    }

    /// Reads the text of a scene file. `path` names the file in errors; relative paths start from its folder.
    #[classmethod]
    #[pyo3(signature = (text, path=PathBuf::new()))]
    fn parse<'py>(class: &Bound<'py, PyType>, text: &str, path: PathBuf) -> PyResult<Hinted<'py, SameClass>> {
        let scene = nabiki_scene::Scene::parse(text, &path, &[]);
        let scene = scene.map_err(|refused| error::raised(class.py(), refused.into()))?;
        Self::another(class, State { scene, ..State::default() }).map(Hinted::new)
    }

    /// An independent copy of the scene.
    fn copy<'py>(this: &Bound<'py, Self>) -> PyResult<Hinted<'py, SameClass>> {
        let state = this.get().state().clone();
        Self::another(&this.get_type(), state).map(Hinted::new)
    }

    fn __copy__<'py>(this: &Bound<'py, Self>) -> PyResult<Hinted<'py, SameClass>> {
        Self::copy(this)
    }

    #[pyo3(signature = (_memo: "object"))]
    fn __deepcopy__<'py>(this: &Bound<'py, Self>, _memo: &Bound<'py, PyAny>) -> PyResult<Hinted<'py, SameClass>> {
        Self::copy(this)
    }

    /// Other processes get its text, with its file, beside which relative paths lie.
    fn __reduce__<'py>(this: &Bound<'py, Self>) -> PyResult<(Bound<'py, PyAny>, (String, OsString))> {
        let (py, scene) = (this.py(), this.get());
        if !scene.functions().is_empty() {
            let line = "this scene has Python functions as fields, which cannot leave their process: send a scene without them, and add its fields there";
            return Err(error::line(py, line));
        }
        // The other process had better not find out what is wrong: a pool that cannot read what it was sent says nothing.
        let (text, file) = (scene.to_toml(py)?, scene.now().file().as_os_str().to_owned());
        Ok((this.get_type().getattr("parse")?, (text, file)))
    }

    /// The file of the scene. None for a scene made in code.
    #[getter]
    fn file(&self) -> Option<OsString> {
        let file = self.state().scene.file().as_os_str().to_owned();
        (!file.is_empty()).then_some(file)
    }

    /// All settings with their values, as a dictionary, whether given or default.
    fn settings<'py>(&self, py: Python<'py>) -> PyResult<Hinted<'py, Dictionary>> {
        values::dict(py, &self.now().settings().map_err(|refused| Self::refused(py, refused))?).map(Hinted::new)
    }

    /// The value of a setting, `scene["force[0].vector"]`. None if it has no value or its table is not in the scene. An
    /// unknown key raises an error.
    fn __getitem__<'py>(&self, py: Python<'py>, key: &str) -> PyResult<Hinted<'py, Anything>> {
        match self.now().setting(key).map_err(|refused| Self::refused(py, refused))? {
            Some(value) => values::to_python(py, &value).map(Hinted::new),
            None => Ok(Hinted::new(py.None().into_bound(py))),
        }
    }

    /// Sets a setting. None restores its default. Meshes may be files or (points, faces), `hair.file` may be (points,
    /// offsets), motions may be matrices (frames, 4, 4).
    fn __setitem__(&self, py: Python<'_>, key: &str, value: &Bound<'_, PyAny>) -> PyResult<()> {
        let mut files = Files::default();
        let value = match value {
            none if none.is_none() => None,
            given => Some(setting(key, given, Some(self.now().frame_rate()), &mut files)?),
        };
        self.put(py, key, value, files)
    }

    /// Removes a setting, a table or an entry of a list.
    fn __delitem__(&self, py: Python<'_>, key: &str) -> PyResult<()> {
        self.put(py, key, None, Files::default())
    }

    /// Fields of Python functions; Python's own class has them as a list that may be changed.
    #[getter]
    fn _fields(&self) -> Vec<Field> {
        self.functions().into_iter().map(|shared| Field { shared }).collect()
    }

    #[setter(_fields)]
    fn set_fields(&self, fields: Vec<Bound<'_, Field>>) {
        let fields: Vec<Arc<PythonField>> = fields.iter().map(|field| field.get().shared.clone()).collect();
        let mut state = self.state();
        state.scene.field.own = fields.iter().map(|field| OwnField(field.clone())).collect();
        state.fields = fields;
    }

    /// The scene as TOML: the text that it was read from, with the changes and with its comments. Raises an error for
    /// what a file cannot contain.
    fn to_toml(&self, py: Python<'_>) -> PyResult<String> {
        let scene = self.writable(py)?;
        scene.text_to_be(scene.file()).map_err(|refused| Self::refused(py, refused))
    }

    /// Writes the scene with its comments and layout, and adjusts relative paths. `path` becomes the file of the scene.
    #[pyo3(signature = (path))]
    fn save(&self, py: Python<'_>, path: PathBuf) -> PyResult<()> {
        let scene = self.writable(py)?;
        // Under its old name first, whose lines the user has before him.
        scene.check().map_err(|wrong| Self::refused(py, scene.refusal(wrong)))?;
        let mut scene = scene.moved_to(&path);
        scene.save(&path).map_err(|refused| Self::refused(py, refused))?;
        self.state().scene = scene;
        Ok(())
    }

    /// Whether both scenes mean the same: settings, functions as fields, and named files.
    fn __eq__(&self, py: Python<'_>, other: &Self) -> PyResult<bool> {
        let same = anywhere(self.now()) == anywhere(other.now());
        let (fields, others) = (self.functions(), other.functions());
        if !same || fields.len() != others.len() {
            return Ok(false);
        }
        fields.iter().zip(&others).try_fold(true, |same, (field, other)| Ok(same && field.is(py, other)?))
    }

    fn __repr__(&self) -> String {
        said::scene(&self.now())
    }
}

impl Scene {
    /// The scene, unless it names what is gone with it.
    fn writable(&self, py: Python<'_>) -> PyResult<nabiki_scene::Scene> {
        let State { scene, made, .. } = self.state().clone();
        if !scene.inputs().iter().any(|file| made.holds(file)) {
            return Ok(scene);
        }
        Err(error::line(
            py,
            "a scene file can only name files, but this scene has hair, meshes or motion from arrays: write them to files \
             (hair with nabiki.write_hair), and give the scene those files",
        ))
    }
}
