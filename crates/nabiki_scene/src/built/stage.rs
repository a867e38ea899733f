//! Stages of a scene: its parts, each built only from its inputs, so that the next scene with the same inputs shares
//! the part.

use std::io::ErrorKind;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use nabiki::SettingError;

use crate::error::{Error, Result};
use crate::scene::{BACKSLASHES, Problem, Scene, resolved};

/// Called regularly, by any thread, with the share done, 0..1; returns whether to go on.
pub(super) type GoesOn<'a> = &'a (dyn Fn(f32) -> bool + Sync);

/// A part of a scene. It depends only on its inputs, and is kept while these do not change.
pub(super) trait Stage: Sized {
    /// Everything that determines it. A file counts as it was when it was read.
    type Inputs;

    /// Whether these inputs would build it again as it is.
    fn is_of(&self, inputs: &Self::Inputs) -> bool;

    /// Makes it.
    ///
    /// # Errors
    /// What is wrong with a setting or a file; [`Error::Cancelled`] where it is wanted no more.
    fn make(inputs: Self::Inputs, at: At<'_>) -> Result<Self>;

    /// The first of the known ones with these inputs, or a new one.
    ///
    /// # Errors
    /// As [`make`](Self::make).
    fn of<'a>(inputs: Self::Inputs, known: impl IntoIterator<Item = &'a Arc<Self>>, at: At<'_>) -> Result<Arc<Self>>
    where
        Self: 'a,
    {
        match known.into_iter().find(|known| known.is_of(&inputs)) {
            Some(known) => Ok(known.clone()),
            None => Self::make(inputs, at).map(Arc::new),
        }
    }
}

/// What a stage sees of the scene besides its inputs: how to report errors, and whether it is still wanted.
#[derive(Clone, Copy)]
pub(super) struct At<'a> {
    scene: &'a Scene,
    pub goes_on: GoesOn<'a>,
}

impl<'a> At<'a> {
    pub fn new(scene: &'a Scene, goes_on: GoesOn<'a>) -> Self {
        Self { scene, goes_on }
    }

    /// The error for a refused setting.
    pub fn refusal(self, refused: SettingError) -> Error {
        self.scene.refusal(refused).into()
    }

    /// Cancels if the result is no longer wanted; `part` is the share that is done.
    pub fn still_wanted(self, part: f32) -> Result<()> {
        if (self.goes_on)(part) { Ok(()) } else { Err(Error::Cancelled) }
    }

    /// The file that the scene in the file `scene` names under `key`. The error about a missing file has the scene's
    /// line.
    pub fn there(self, scene: &Path, key: &str, file: &Path) -> Result<PathBuf> {
        let path = resolved(scene, file);
        let value = format!("\"{}\"", file.display());
        let refused = |remedy: String, system: ErrorKind| {
            let mut refused = self.scene.refusal(SettingError::new(key, &value, &*remedy));
            *refused.problem = Problem::NoFile { value: value.clone(), remedy, path: path.clone(), system };
            refused.into()
        };
        if file.as_os_str().is_empty() {
            return Err(self.refusal(SettingError::new(key, &value, "name a file")));
        }
        if file.to_string_lossy().contains(char::is_control) {
            let value = format!("{:?}", file.display().to_string());
            let remedy = format!("has a control character: {BACKSLASHES}");
            return Err(self.refusal(SettingError::new(key, value, remedy)));
        }
        match std::fs::metadata(&path) {
            Ok(there) if there.is_dir() => Err(refused("is a folder: name a file".to_owned(), ErrorKind::IsADirectory)),
            Err(e)
                if matches!(e.kind(), ErrorKind::NotFound | ErrorKind::NotADirectory | ErrorKind::InvalidFilename) =>
            {
                let remedy = match path == file {
                    true => "there is no such file".to_owned(),
                    false => format!("there is no {}; paths are relative to the scene's folder", path.display()),
                };
                Err(refused(remedy, e.kind()))
            }
            _ => Ok(path),
        }
    }
}
