//! What would be lost by what is to come, and is asked for before: a scene, a text being mended, exports that run.

use std::path::{Path, PathBuf};

use nabiki_scene::Scene;
use nabiki_scene::scene::{SceneError, write_scene};

use super::{Session, Wish};
use crate::dialog::{Chooser, Dialog, Next, Purpose, as_scene_file};
use crate::document::SaveError;
use crate::recovery::Keeper;
use crate::tasks::Task;

/// The text of a scene that cannot be read, being mended.
#[derive(Clone, Debug)]
pub struct Broken {
    /// The file.
    pub path: PathBuf,
    /// Its text, as it has been mended so far.
    pub text: String,
    /// What is wrong; none once nothing is.
    pub error: Option<SceneError>,
    /// What is in the file.
    pub(super) on_disk: Vec<u8>,
}

impl Broken {
    /// Whether the text is not what the file holds.
    pub fn is_changed(&self) -> bool {
        self.text.as_bytes() != self.on_disk
    }

    /// The file's name.
    pub fn name(&self) -> String {
        self.path.file_name().unwrap_or_default().to_string_lossy().into_owned()
    }

    pub(super) fn mend(&mut self, text: String) {
        self.error = Scene::parse(&text, &self.path, &[]).err();
        self.text = text;
    }

    fn save(&mut self, replace: bool) -> Result<(), SaveError> {
        let theirs = || std::fs::read(&self.path).is_ok_and(|now| now != self.on_disk);
        if !replace && theirs() {
            return Err(SaveError::Changed(self.path.clone()));
        }
        self.save_as(&self.path.clone())
    }

    fn save_as(&mut self, path: &Path) -> Result<(), SaveError> {
        write_scene(path, &self.text)?;
        (self.path, self.on_disk) = (path.to_owned(), self.text.clone().into_bytes());
        self.mend(self.text.clone());
        Ok(())
    }
}

/// How it is said that something could not be saved.
const NOT_SAVED: &str = "not saved: ";

impl Session {
    /// What last went wrong since the question was asked that stands before all that is said.
    pub fn wrong_with_dialog(&self) -> Option<&str> {
        let asked = self.asked_at.filter(|_| self.dialog.is_some())?;
        self.words.iter().rev().find(|word| word.wrong && word.at >= asked).map(|word| word.text.as_str())
    }

    /// Notes when a question is asked, for as long as it or the next stands.
    pub(super) fn note_question(&mut self) {
        let clock = self.clock;
        self.asked_at = self.dialog.as_ref().map(|_| self.asked_at.unwrap_or(clock));
    }

    /// Whether the window may close now; asks if something would be lost.
    pub fn may_close(&mut self) -> bool {
        self.may_go(Next::Quit)
    }

    /// Whether the text being mended would be lost by what is to come.
    pub fn loses_text(&self, next: &Next) -> bool {
        *next != Next::UseMended && self.broken.as_ref().is_some_and(Broken::is_changed)
    }

    fn loses_scene(&self, next: &Next) -> bool {
        let Some(document) = &self.document else { return false };
        // Of a file that is no longer there this is the last copy.
        let is_last = || document.path().is_some() && document.changed_on_disk().is_none();
        *next != Next::LeaveText && (document.is_dirty() || is_last())
    }

    fn is_exporting(&self) -> bool {
        self.tasks.iter().any(|task| !task.is_cancelled() && !task.has_ended())
    }

    /// Whether what is open may go; if it may not, asks what to do, and goes on with `next` afterwards.
    pub(super) fn may_go(&mut self, next: Next) -> bool {
        let question = if self.loses_text(&next) || self.loses_scene(&next) {
            Some(Dialog::Unsaved(next))
        } else {
            (next == Next::Quit && self.is_exporting()).then_some(Dialog::Exporting)
        };
        let may = question.is_none();
        self.dialog = question.or(self.dialog.take());
        may
    }

    /// Goes on although something is lost.
    pub(super) fn go_on_anyway(&mut self) {
        match self.dialog.take() {
            Some(Dialog::Unsaved(next)) if self.loses_text(&next) => {
                self.broken = None;
                // The scene behind it may not be saved, either.
                if self.may_go(next.clone()) {
                    self.go_on(next);
                }
            }
            Some(Dialog::Unsaved(next)) => self.go_on(next),
            Some(Dialog::Exporting) => {
                self.tasks.iter().for_each(Task::cancel);
                self.go_on(Next::Quit);
            }
            other => self.dialog = other,
        }
    }

    /// Goes on with what a question stood before; what is not saved is lost.
    fn go_on(&mut self, next: Next) {
        match next {
            Next::Open(path) => self.open(&path),
            Next::Recover(kept) => self.recover(*kept),
            Next::UseMended => self.use_mended(),
            Next::LeaveText => self.broken = None,
            Next::Quit if self.is_exporting() => self.dialog = Some(Dialog::Exporting),
            Next::Quit => {
                (self.document, self.broken, self.text_keeper) = (None, None, None);
                self.keeper.iter_mut().for_each(Keeper::forget);
                self.wishes.push(Wish::Quit);
            }
        }
    }

    /// Whether it is the text being mended that is saved: it is what is seen, unless the scene behind it is asked about.
    fn saves_text(&self, next: Option<&Next>) -> bool {
        next.map_or(self.broken.is_some(), |next| self.loses_text(next))
    }

    /// Saves what is seen, or what `next` would lose, and goes on with that once nothing would be lost any more. `replace`:
    /// even if somebody else has written the file since.
    pub(super) fn save(&mut self, next: Option<Next>, replace: bool) {
        let saves_text = self.saves_text(next.as_ref());
        let result = match (&mut self.broken, &mut self.document) {
            (Some(broken), _) if saves_text => broken.save(replace),
            (_, Some(document)) => document.save(replace),
            _ => return,
        };
        match result {
            Ok(()) => self.saved(saves_text, next),
            Err(SaveError::Changed(path)) => self.dialog = Some(Dialog::Conflict(path, next)),
            Err(SaveError::NoFile) => self.ask_save_as(next),
            Err(e @ SaveError::Scene(_)) => {
                self.say(format!("{NOT_SAVED}{e}; use File > Save as to save it elsewhere"), true);
            }
        }
    }

    /// The same into another file.
    pub(super) fn save_to(&mut self, path: &Path, next: Option<Next>) {
        let path = as_scene_file(path);
        let saves_text = self.saves_text(next.as_ref());
        let is_same = |own: &Path| std::path::absolute(own).ok() == std::path::absolute(&path).ok();
        // Its own name is no other name: what somebody else has written there is asked about.
        let result = match (&mut self.broken, &mut self.document) {
            (Some(broken), _) if saves_text && is_same(&broken.path) => broken.save(false),
            (Some(broken), _) if saves_text => broken.save_as(&path),
            (_, Some(document)) if document.path().is_some_and(is_same) => document.save(false),
            (_, Some(document)) => document.save_as(&path),
            _ => return,
        };
        match result {
            Ok(()) => {
                self.preferences.used(&path);
                self.dialog = None;
                self.saved(saves_text, next);
            }
            Err(SaveError::Changed(path)) => self.dialog = Some(Dialog::Conflict(path, next)),
            Err(e) => self.say(format!("{NOT_SAVED}{e}"), true),
        }
    }

    fn saved(&mut self, text: bool, next: Option<Next>) {
        self.keep();
        let saved = match (&self.broken, &self.document) {
            (Some(broken), _) if text => Some((broken.path.clone(), broken.name())),
            (_, document) => document.as_ref().and_then(|open| Some((open.path()?.to_owned(), open.name()))),
        };
        if let Some((path, name)) = saved {
            // What was wrong with the file is so no longer.
            self.forget_what_was_said_of(&path);
            self.words.retain(|word| !word.text.starts_with(NOT_SAVED));
            self.say(format!("Saved {name}"), false);
        }
        if !text {
            self.said_changed = false;
        }
        match next {
            Some(next) if self.may_go(next.clone()) => {
                self.dialog = None;
                self.go_on(next);
            }
            None if text => self.open_saved_text(),
            _ => {}
        }
    }

    /// A text that is right and saved is a scene like any other.
    fn open_saved_text(&mut self) {
        let Some(Broken { path, error: None, .. }) = &self.broken else { return };
        let path = path.clone();
        match &self.document {
            Some(document) if document.is_dirty() => {}
            Some(document) if document.path() == Some(path.as_path()) => self.reload(true),
            _ => self.open(&path),
        }
    }

    pub(super) fn ask_save_as(&mut self, next: Option<Next>) {
        let next = match self.dialog.take() {
            Some(Dialog::Conflict(_, after)) => next.or(after),
            _ => next,
        };
        let file = match (&self.broken, &self.document) {
            (Some(broken), _) if self.saves_text(next.as_ref()) => broken.path.as_path(),
            (_, Some(document)) => document.scene().file(),
            _ => return,
        };
        let path = std::path::absolute(file).unwrap_or_default().display().to_string();
        self.dialog =
            Some(Dialog::File(Chooser { purpose: Purpose::SaveAs(next.map(Box::new)), path, endings: vec!["toml"] }));
    }

    /// Whether nothing is to be kept that is not kept already.
    pub(super) fn is_kept(&self) -> bool {
        let scene = match (&self.keeper, &self.document) {
            (Some(keeper), Some(document)) => keeper.has(document),
            _ => true,
        };
        let text = self.broken.as_ref().filter(|broken| broken.is_changed()).map(|broken| broken.text.as_str());
        let kept = self.text_keeper.as_ref().map(Keeper::text);
        let has_text = match text {
            None => kept.is_none(),
            Some(text) => self.folder.is_none() || kept == Some(Some(text)),
        };
        scene && has_text
    }

    /// Keeps what is not saved; whether it is kept.
    pub(super) fn keep(&mut self) -> bool {
        let scene = match (&mut self.keeper, &self.document) {
            (Some(keeper), Some(document)) => keeper.keep(document),
            _ => Ok(()),
        };
        let kept = scene.and(self.keep_text());
        if let Err(e) = &kept {
            let text = format!("{e}: unsaved changes cannot be recovered if this window is killed");
            self.say_of_window(text, true);
        }
        kept.is_ok() && self.keeper.is_some()
    }

    fn keep_text(&mut self) -> std::io::Result<()> {
        let Some(broken) = self.broken.as_ref().filter(|broken| broken.is_changed()) else {
            self.text_keeper = None;
            return Ok(());
        };
        if self.text_keeper.is_none()
            && let Some(folder) = &self.folder
        {
            self.text_keeper = Some(Keeper::begin(&folder.join("recovery"))?);
        }
        self.text_keeper.as_mut().map_or(Ok(()), |keeper| keeper.keep_text(&broken.path, &broken.text))
    }
}

#[cfg(test)]
#[path = "lost_tests.rs"]
mod tests;
