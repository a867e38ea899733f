//! The scene that is open: its file, what has been changed since, the way back.

use std::path::{Path, PathBuf};

use nabiki_scene::Scene;
use nabiki_scene::scene::SceneError;

/// Most steps that can be undone.
const MOST_STEPS: usize = 1000;

/// How a change goes on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Phase {
    /// One of many while something is dragged: all of them are one step.
    Dragging,
    /// A change by itself, or the last of a drag.
    Done,
    /// What is found after a drag has ended belongs to its step, as long as that is the last one.
    After,
}

/// A scene as it was before a step.
#[derive(Clone, Debug)]
struct Step {
    /// What the step did, for the menu.
    name: String,
    scene: Scene,
}

/// What is in the scene's file.
#[derive(Clone, Debug)]
struct Saved {
    /// Its bytes.
    bytes: Vec<u8>,
    /// What they mean; none where that is no scene.
    scene: Option<Scene>,
}

/// A scene being edited.
#[derive(Clone, Debug)]
pub struct Document {
    scene: Scene,
    /// The file as it was read or written last; none for a scene without a file.
    saved: Option<Saved>,
    undo: Vec<Step>,
    redo: Vec<Step>,
    /// Whether the last step is still being dragged.
    dragging: bool,
    /// Counts up with every change of the scene.
    version: u64,
}

/// Why a document was not saved.
#[derive(Debug, thiserror::Error)]
pub enum SaveError {
    /// Somebody else has written the file since it was read.
    #[error("{} has been changed by another program since it was opened here", .0.display())]
    Changed(PathBuf),
    /// It has no file yet.
    #[error("the scene has no file yet; use Save as")]
    NoFile,
    /// The scene cannot be written as it is, or the disk refuses.
    #[error(transparent)]
    Scene(#[from] SceneError),
}

impl Document {
    /// Opens a scene file.
    ///
    /// # Errors
    /// What is wrong with it: place, key, value and the way out.
    pub fn open(path: &Path) -> Result<Self, SceneError> {
        let scene = Scene::load(path, &[])?;
        // Gone in between, it is as a file that another program has changed.
        let bytes = std::fs::read(path).unwrap_or_default();
        Ok(Self { saved: Some(Saved { bytes, scene: Some(scene.clone()) }), ..Self::untitled(scene) })
    }

    /// A scene without a file, whose paths are relative to the folder of the path that it was read under.
    pub fn untitled(scene: Scene) -> Self {
        Self { scene, saved: None, undo: Vec::new(), redo: Vec::new(), dragging: false, version: 0 }
    }

    /// A scene that is not what its file holds, as one that was recovered, or whose text has been mended. `bytes`: those of
    /// the file; none where it has no file.
    pub fn unsaved(scene: Scene, bytes: Option<Vec<u8>>) -> Self {
        let undo = vec![Step { name: "Unsaved changes".to_owned(), scene: scene.clone() }];
        match bytes {
            Some(bytes) => Self { saved: Some(Saved { bytes, scene: None }), ..Self::untitled(scene) },
            // Without a file it counts as changed by having been.
            None => Self { redo: undo, ..Self::untitled(scene) },
        }
    }

    /// The scene as it is.
    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    /// Its file; none before it was saved.
    pub fn path(&self) -> Option<&Path> {
        self.saved.is_some().then(|| self.scene.file())
    }

    /// The file's name, or what stands for it.
    pub fn name(&self) -> String {
        match self.path() {
            Some(path) => path.file_name().unwrap_or_default().to_string_lossy().into_owned(),
            None => format!("{} (not saved)", self.scene.name()),
        }
    }

    /// Whether there is something to lose.
    pub fn is_dirty(&self) -> bool {
        match &self.saved {
            Some(saved) => saved.scene.as_ref() != Some(&self.scene),
            None => !self.undo.is_empty() || !self.redo.is_empty(),
        }
    }

    /// Counts up with every change of the scene.
    pub fn version(&self) -> u64 {
        self.version
    }

    /// Changes the scene; `name` says what that is. Changes of one name that follow one another in one drag are one step.
    /// Nothing is noted where nothing changes.
    pub fn edit(&mut self, name: &str, scene: Scene, phase: Phase) {
        let goes_on =
            (self.dragging || phase == Phase::After) && self.undo.last().is_some_and(|step| step.name == name);
        if scene != self.scene {
            let before = std::mem::replace(&mut self.scene, scene);
            if !goes_on {
                self.undo.push(Step { name: name.to_owned(), scene: before });
                if self.undo.len() > MOST_STEPS {
                    self.undo.remove(0);
                }
                self.dragging = true;
            }
            self.redo.clear();
            self.version += 1;
        }
        if phase != Phase::Dragging {
            self.end_drag();
        }
    }

    /// Whether the last step is still being dragged.
    pub fn is_dragging(&self) -> bool {
        self.dragging
    }

    /// The scene as it was before the drag of this name that goes on; as it is where none does.
    pub fn before_drag(&self, name: &str) -> &Scene {
        let step = self.undo.last().filter(|step| self.dragging && step.name == name);
        step.map_or(&self.scene, |step| &step.scene)
    }

    /// What is changed next is another step.
    pub fn end_drag(&mut self) {
        // A drag that came back to where it began is no step.
        if self.dragging && self.undo.last().is_some_and(|step| step.scene == self.scene) {
            self.undo.pop();
        }
        self.dragging = false;
    }

    /// Takes back what is being dragged, as if it had never been touched.
    pub fn give_up_drag(&mut self) {
        if self.dragging
            && let Some(Step { scene, .. }) = self.undo.pop()
        {
            self.scene = scene;
            self.version += 1;
        }
        self.dragging = false;
    }

    /// What would be undone.
    pub fn undo_name(&self) -> Option<&str> {
        self.undo.last().map(|step| step.name.as_str())
    }

    /// What would be redone.
    pub fn redo_name(&self) -> Option<&str> {
        self.redo.last().map(|step| step.name.as_str())
    }

    /// Takes the last step back; `false` if there is none.
    pub fn undo(&mut self) -> bool {
        self.end_drag();
        self.travel(true)
    }

    /// Makes the last step again that was taken back; `false` if there is none.
    pub fn redo(&mut self) -> bool {
        self.end_drag();
        self.travel(false)
    }

    fn travel(&mut self, back: bool) -> bool {
        let (from, to) = if back { (&mut self.undo, &mut self.redo) } else { (&mut self.redo, &mut self.undo) };
        let Some(Step { name, scene }) = from.pop() else { return false };
        let scene = std::mem::replace(&mut self.scene, scene);
        to.push(Step { name, scene });
        self.version += 1;
        true
    }

    /// Whether the file is no longer what it was when it was read or written here; `None` for no file at all any more.
    pub fn changed_on_disk(&self) -> Option<bool> {
        let (path, saved) = (self.path()?, self.saved.as_ref()?);
        std::fs::read(path).ok().map(|now| now != saved.bytes)
    }

    /// Writes the scene into its file. `replace`: even if somebody else has written it since.
    ///
    /// # Errors
    /// Another program's changes, unless they are to be replaced; what the disk says. The file is then as it was.
    pub fn save(&mut self, replace: bool) -> Result<(), SaveError> {
        let path = self.path().ok_or(SaveError::NoFile)?.to_owned();
        if !replace && self.changed_on_disk() == Some(true) {
            return Err(SaveError::Changed(path));
        }
        self.write(&path)
    }

    /// Writes the scene into another file, which is its file from then on: relative paths lead where they led before.
    ///
    /// # Errors
    /// What the disk says; the document then has the file that it had.
    pub fn save_as(&mut self, path: &Path) -> Result<(), SaveError> {
        let mut moved = self.clone();
        let all = moved.undo.iter_mut().chain(&mut moved.redo).map(|step| &mut step.scene);
        for scene in all.chain([&mut moved.scene]) {
            *scene = std::mem::take(scene).moved_to(path);
        }
        moved.write(path)?;
        *self = moved;
        Ok(())
    }

    fn write(&mut self, path: &Path) -> Result<(), SaveError> {
        self.end_drag();
        self.scene.save(path)?;
        let bytes = self.scene.to_toml()?.into_bytes();
        self.saved = Some(Saved { bytes, scene: Some(self.scene.clone()) });
        self.version += 1;
        Ok(())
    }

    /// Takes what the file holds now, as a step that can be undone.
    ///
    /// # Errors
    /// What is wrong with the file; the document is then as it was.
    pub fn reload(&mut self) -> Result<(), SceneError> {
        let Some(path) = self.path().map(Path::to_owned) else { return Ok(()) };
        let Self { scene, saved, .. } = Self::open(&path)?;
        self.end_drag();
        self.edit("Reload", scene.clone(), Phase::Done);
        // What is equal by its settings may differ in its comments.
        (self.scene, self.saved) = (scene, saved);
        self.version += 1;
        Ok(())
    }
}

#[cfg(test)]
#[path = "document_tests.rs"]
mod tests;
