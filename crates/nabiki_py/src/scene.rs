//! The scene as Python has it: settings by key, and what can be done with them.

mod tasks;

use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::SystemTime;

use nabiki_scene::scene::OwnField;
use nabiki_scene::{BuiltScene, Shown};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList, PyMapping, PyTuple, PyType};
use toml::{Table, Value};

use crate::error;
use crate::field::{Field, PythonField};
use crate::hints::{Anything, ByName, Dictionary, Given, Hinted, SameClass};
use crate::made::Files;
use crate::values;
use crate::watched::{Ears, watched};

/// Everything that decides a movie. `scene["motion.frames"]` is a setting by the key that it has in a scene file.
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
    fn built(&self, py: Python<'_>, strands: Option<usize>, ears: Ears<'_, '_>) -> PyResult<Arc<BuiltScene>> {
        let shown = strands.map_or(Shown::All, Shown::First);
        let State { scene, built: known, made: _held, .. } = self.state().clone();
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
            let changed = state.scene.with_setting(key, value)?;
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

/// Whether one of two keys lies in the other.
fn concerns(thing: &str, key: &str) -> bool {
    let steps = |key: &str| key.replace('[', ".").replace(']', "");
    let (thing, key) = (steps(thing), steps(key));
    let within = |a: &str, b: &str| a.strip_prefix(b).is_some_and(|rest| rest.is_empty() || rest.starts_with('.'));
    within(&thing, &key) || within(&key, &thing)
}

#[pymethods]
impl Scene {
    #[new]
    #[pyo3(signature = (*_arguments: "object", **_settings: "object"))]
    fn new(_arguments: &Bound<'_, PyTuple>, _settings: Option<&Bound<'_, PyDict>>) -> Self {
        Self::default()
    }

    /// Reads a scene file. `settings` are put in their places by their keys before anything is read: `{"motion.frames": 50}`.
    #[classmethod]
    #[pyo3(signature = (path, settings=None))]
    fn open<'py>(
        class: &Bound<'py, PyType>,
        path: PathBuf,
        settings: Option<Given<'py, ByName>>,
    ) -> PyResult<Hinted<'py, SameClass>> {
        let py = class.py();
        let (mut made, mut given) = (Files::default(), Vec::new());
        if let Some(settings) = settings {
            for entry in settings.0.cast::<PyMapping>()?.items()?.iter() {
                let (key, value): (String, Bound<'_, PyAny>) = entry.extract()?;
                if !value.is_none() {
                    given.push((key.clone(), setting(&key, &value, None, &mut made)?.to_string()));
                }
            }
        }
        let scene = nabiki_scene::Scene::load(&path, &given).map_err(|refused| Self::refused(py, refused))?;
        Self::another(class, State { scene, made, ..State::default() }).map(Hinted::new)
    }

    /// Reads the text of a scene file; `path` names it in errors, and paths in it are relative to the folder of `path`.
    #[classmethod]
    #[pyo3(signature = (text, path=PathBuf::new()))]
    fn parse<'py>(class: &Bound<'py, PyType>, text: &str, path: PathBuf) -> PyResult<Hinted<'py, SameClass>> {
        let scene = nabiki_scene::Scene::parse(text, &path, &[]);
        let scene = scene.map_err(|refused| error::raised(class.py(), refused.into()))?;
        Self::another(class, State { scene, ..State::default() }).map(Hinted::new)
    }

    /// The same scene once more, to be changed by itself.
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
    fn __reduce__<'py>(this: &Bound<'py, Self>) -> PyResult<(Bound<'py, PyAny>, (String, String))> {
        let (py, scene) = (this.py(), this.get());
        if !scene.functions().is_empty() {
            let line = "the fields of this scene are functions of Python, which stay in their process: \
                        send a scene without them, and give it there its fields";
            return Err(error::line(py, line));
        }
        let (text, file) = (scene.to_toml(py)?, scene.now().file().to_owned());
        // The other process had better not find it out: a pool that cannot read what it was sent says nothing.
        nabiki_scene::Scene::parse(&text, &file, &[]).map_err(|refused| error::raised(py, refused.into()))?;
        let file = file.to_string_lossy().into_owned();
        Ok((this.get_type().getattr("parse")?, (text, file)))
    }

    /// Its file, or nothing for a scene made in code.
    #[getter]
    fn file(&self) -> Option<String> {
        let scene = self.now();
        let file = scene.file();
        (!file.as_os_str().is_empty()).then(|| file.display().to_string())
    }

    /// Every setting with the value that it has, given or not: what a file that says everything would hold.
    fn settings<'py>(&self, py: Python<'py>) -> PyResult<Hinted<'py, Dictionary>> {
        values::dict(py, &self.now().settings().map_err(|refused| Self::refused(py, refused))?).map(Hinted::new)
    }

    /// The value of a setting, `scene["force[0].vector"]`; None where it has none, or its table is not in the scene. What no setting is
    /// called is refused.
    fn __getitem__<'py>(&self, py: Python<'py>, key: &str) -> PyResult<Hinted<'py, Anything>> {
        match self.now().setting(key).map_err(|refused| Self::refused(py, refused))? {
            Some(value) => values::to_python(py, &value).map(Hinted::new),
            None => Ok(Hinted::new(py.None().into_bound(py))),
        }
    }

    /// Gives a setting another value; None takes it out, so that it is what it is when nobody says. Meshes may be files or
    /// (points, faces), `hair.file` may be (points, offsets), motions may be matrices (frames, 4, 4).
    fn __setitem__(&self, py: Python<'_>, key: &str, value: &Bound<'_, PyAny>) -> PyResult<()> {
        let mut files = Files::default();
        let value = match value {
            none if none.is_none() => None,
            given => Some(setting(key, given, Some(self.now().frame_rate()), &mut files)?),
        };
        self.put(py, key, value, files)
    }

    /// Takes a setting, a table or an entry of a list out.
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

    /// The scene as TOML: the text it was read from with what has changed since in its place, comments as they were.
    fn to_toml(&self, py: Python<'_>) -> PyResult<String> {
        self.writable(py)?.to_toml().map_err(|refused| Self::refused(py, refused))
    }

    /// Writes it, comments and layout as they were. From then on `path` is its file.
    #[pyo3(signature = (path))]
    fn save(&self, py: Python<'_>, path: PathBuf) -> PyResult<()> {
        let mut scene = self.writable(py)?;
        // Only a scene that has a place of its own has paths that are relative to it.
        if !scene.file().as_os_str().is_empty() {
            scene = scene.moved_to(&path);
        }
        scene.save(&path).map_err(|refused| Self::refused(py, refused))?;
        self.state().scene = scene;
        Ok(())
    }

    fn __repr__(&self) -> String {
        match self.file() {
            None => "<nabiki.Scene>".to_owned(),
            Some(file) => format!("<nabiki.Scene {file}>"),
        }
    }
}

/// A value of a setting, or of a table of them, in which arrays of hair, meshes and motion become files. `rate`: matrices a second,
/// where they do not say it themselves.
fn setting(key: &str, given: &Bound<'_, PyAny>, rate: Option<f64>, files: &mut Files) -> PyResult<Value> {
    let name = key.rsplit('.').next().unwrap_or(key);
    let is_motion = name == "motion" && key != name;
    if is_motion && is_array(given)? {
        return Ok(Value::Table(moved(key, given, rate, files)?));
    }
    let pair = match given.cast::<PyList>() {
        Ok(list) => Ok(list.to_tuple()),
        Err(_) => given.cast::<PyTuple>().cloned(),
    };
    if let Ok(arrays) = pair {
        let path = match name {
            "mesh" => Some(files.mesh(key, &arrays)?),
            "file" if key == "hair.file" => Some(files.hair(&arrays)?),
            _ => None,
        };
        if let Some(path) = path {
            return Ok(text(&path));
        }
    }
    if let Ok(table) = given.cast::<PyMapping>() {
        let (mut values, mut matrices, mut own_rate) = (Table::new(), None, None);
        for entry in table.items()?.iter() {
            let (name, value): (String, Bound<'_, PyAny>) = entry.extract()?;
            if is_motion && name == "file" && is_array(&value)? {
                matrices = Some(value);
            } else if !value.is_none() {
                values.insert(name.clone(), setting(&format!("{key}.{name}"), &value, rate, files)?);
            }
        }
        if let Some(matrices) = matrices {
            // Of a table of poses it is known by its times.
            if let Some(given) = values.remove("frames_per_second") {
                own_rate = given.as_float().or(given.as_integer().map(|whole| whole as f64));
                if !own_rate.is_some_and(|rate| rate.is_finite() && rate > 0.0) {
                    let (thing, way_out) = (format!("{key}.frames_per_second"), "must be a finite number above 0");
                    return Err(error::argument(matrices.py(), &thing, given, way_out));
                }
            }
            let mut moved = moved(key, &matrices, own_rate.or(rate), files)?;
            moved.extend(values);
            return Ok(Value::Table(moved));
        }
        return Ok(Value::Table(values));
    }
    if key == "body"
        && let Ok(bodies) = given.cast::<PyList>()
    {
        let entry = |(i, body): (usize, Bound<'_, PyAny>)| setting(&format!("body[{i}]"), &body, rate, files);
        return bodies.iter().enumerate().map(entry).collect::<PyResult<_>>().map(Value::Array);
    }
    values::to_toml(given)
}

/// Whether numbers are given, and neither a file nor a table.
fn is_array(given: &Bound<'_, PyAny>) -> PyResult<bool> {
    Ok(given.is_instance_of::<PyList>() || given.is_instance_of::<PyTuple>() || given.hasattr("__array__")?)
}

/// The table of a motion of matrices, in the space of the scene unless it says otherwise.
fn moved(key: &str, matrices: &Bound<'_, PyAny>, rate: Option<f64>, files: &mut Files) -> PyResult<Table> {
    let Some(rate) = rate else {
        let way_out =
            "needs {\"file\": matrices, \"frames_per_second\": ...}, as the scene that says it is not read yet";
        return Err(error::argument(matrices.py(), key, "an array", way_out));
    };
    let file = text(&files.motion(key, matrices, rate)?);
    let axis = |axis: &str| Value::String(axis.to_owned());
    let values = [("file", file), ("up", axis("+y")), ("facing", axis("+x"))];
    Ok(values.map(|(key, value)| (key.to_owned(), value)).into_iter().collect())
}

fn text(path: &Path) -> Value {
    Value::String(path.to_string_lossy().into_owned())
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
            "a scene file names files, and this scene has hair, meshes or motion of arrays: write them with \
             nabiki.write_hair, with any writer of meshes, or as a table of poses, and give the scene these files",
        ))
    }
}
