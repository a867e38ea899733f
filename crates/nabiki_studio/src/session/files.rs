//! Opening, saving, and what lies between.

use std::path::{Path, PathBuf};

use nabiki_scene::Scene;
use toml::Value;

use super::{Broken, Session, Wish};
use crate::actions::Action;
use crate::command::Command;
use crate::desktop::{Answer, Asked};
use crate::dialog::{Chooser, Dialog, Import, Next, Purpose, Role, as_folder, as_scene_file};
use crate::document::{Document, Phase};
use crate::recovery::{Keeper, Kept};
use crate::tasks;

/// The scene of the first start.
pub const FIRST: &str = include_str!("../first.toml");

impl Session {
    /// Opens a scene at the start: the one named, or the one opened last, or that of the first start.
    pub fn begin(&mut self, named: Option<&Path>) {
        let last = self.preferences.recent.iter().find(|path| path.is_file()).cloned();
        match named.map(Path::to_owned).or(last) {
            Some(path) => self.open(&path),
            None => self.open_first(),
        }
        if self.document.is_none() && self.broken.is_none() {
            self.open_first();
        }
        if !self.preferences.welcomed && self.dialog.is_none() {
            self.dialog = Some(Dialog::Welcome);
        }
    }

    fn open_first(&mut self) {
        match Scene::parse(FIRST, "gust.toml".as_ref(), &[]) {
            Ok(scene) => self.take_over(Document::untitled(scene)),
            Err(e) => self.say(e.to_string(), true),
        }
    }

    fn take_over(&mut self, document: Document) {
        // What can be pulled is seen at once.
        let strengths = document.scene().field.force.iter().map(|key| key.vector.length());
        let strongest = strengths.enumerate().max_by(|a, b| a.1.total_cmp(&b.1));
        self.chosen = strongest.map(|(j, _)| j).into_iter().collect();
        self.document = Some(document);
        // Of the one before nothing is left to be lost, and this one's changes count from 0 as that one's did.
        self.keeper.iter_mut().for_each(Keeper::forget);
        (self.broken, self.trouble, self.said_changed) = (None, None, false);
        self.forget_what_was_said();
        // The hair of another scene is not this one's, nor is what is still on its way.
        (self.take, self.swings, self.kept) = (None, None, None);
        self.opened += 1;
        self.tools.region = None;
        self.play.set_playing(false);
        self.play.go(0);
        self.move_again(true);
        self.first_asked = self.asked;
    }

    pub(super) fn open(&mut self, path: &Path) {
        match Document::open(path) {
            Ok(document) => {
                self.preferences.used(path);
                self.take_over(document);
            }
            // What can be read as text can be mended; what cannot is only said.
            Err(error) => match std::fs::read(path).map(|bytes| (String::from_utf8(bytes.clone()), bytes)) {
                Ok((Ok(text), on_disk)) if text.len() < MOST_TEXT && !text.contains('\0') => {
                    self.broken = Some(Broken { path: path.to_owned(), text, error: Some(error), on_disk });
                }
                _ => self.say(error.to_string(), true),
            },
        }
    }

    pub(super) fn apply_to_files(&mut self, command: Command) {
        match command {
            Command::Open(path) => self.open_any(path),
            Command::SaveTo(path) => self.save_to(&path, None),
            Command::SaveOver => {
                let Some(Dialog::Conflict(_, next)) = self.dialog.take() else { return };
                self.save(next, true);
            }
            Command::Recover(n) => {
                let Some(Dialog::Recover(kept)) = &self.dialog else { return };
                let Some(kept) = kept.get(n).cloned() else { return };
                self.forget(n);
                self.recover(kept);
            }
            Command::Forget(n) => {
                let Some(Dialog::Recover(kept)) = &self.dialog else { return };
                kept.get(n).into_iter().for_each(Kept::remove);
                self.forget(n);
            }
            Command::Mend(text) => {
                if let Some(broken) = &mut self.broken {
                    broken.mend(text);
                }
            }
            Command::UseMended if self.may_go(Next::UseMended) => self.use_mended(),
            Command::LeaveBroken if self.may_go(Next::LeaveText) => self.broken = None,
            Command::SaveAndGoOn(next) => self.save(Some(next), false),
            Command::GoOn => self.go_on_anyway(),
            _ => {}
        }
    }

    fn forget(&mut self, n: usize) {
        if let Some(Dialog::Recover(kept)) = &mut self.dialog {
            kept.remove(n);
            if kept.is_empty() {
                self.dialog = None;
            }
        }
    }

    pub(super) fn recover(&mut self, kept: Kept) {
        match Scene::parse(&kept.text, &kept.path, &[]) {
            Ok(scene) => {
                let on_disk = kept.has_file.then(|| std::fs::read(&kept.path).unwrap_or_default());
                self.dialog = None;
                self.take_over(Document::unsaved(scene, on_disk));
            }
            // What was being mended can go on being so.
            Err(error) => {
                let on_disk = std::fs::read(&kept.path).unwrap_or_default();
                let (path, text) = (kept.path.clone(), kept.text.clone());
                self.dialog = None;
                self.broken = Some(Broken { path, text, error: Some(error), on_disk });
            }
        }
        // The scene that was recovered may be what ended the window that had it.
        if self.keep() {
            kept.remove();
        }
    }

    pub(super) fn use_mended(&mut self) {
        let Some(Broken { path, text, error: None, on_disk }) = &self.broken else { return };
        if text.as_bytes() == on_disk {
            let path = path.clone();
            self.open(&path);
        } else if let Ok(scene) = Scene::parse(text, path, &[]) {
            let document = Document::unsaved(scene, Some(on_disk.clone()));
            self.preferences.used(&path.clone());
            self.take_over(document);
        }
    }

    /// Opens a scene, or asks what another file is for.
    fn open_any(&mut self, path: PathBuf) {
        if matches!(self.dialog, Some(Dialog::File(_))) {
            // What the desktop may still answer was asked of the scene before.
            (self.dialog, self.desktop) = (None, None);
        }
        let roles = Role::of(&path);
        let Some(&role) = roles.first() else {
            if self.may_go(Next::Open(path.clone())) {
                self.open(&path);
            }
            return;
        };
        if self.document.is_none() {
            self.say(format!("{}: open a scene first, then drop this file on it", path.display()), true);
            return;
        }
        let empty = String::new;
        let node = "Head".to_owned();
        self.dialog =
            Some(Dialog::Import(Import { path, roles, role, unit: empty(), up: empty(), facing: empty(), node }));
    }

    /// Whether the dialog of the desktop is open.
    pub fn asks_desktop(&self) -> bool {
        self.desktop.is_some()
    }

    /// Whether the desktop has a dialog for files, as far as is known.
    pub fn has_desktop(&self) -> bool {
        self.has_desktop
    }

    pub(super) fn ask_desktop(&mut self) {
        let Some(Dialog::File(chooser)) = &self.dialog else { return };
        let wake = self.wake.clone();
        match Asked::desktop(chooser.clone(), move || wake.0()) {
            Ok(asked) => self.desktop = Some(asked),
            Err(e) => self
                .say_of_window(format!("the dialog of the desktop cannot be opened: {e}; type the path instead"), true),
        }
    }

    /// Takes what the desktop has answered.
    pub(super) fn hear_desktop(&mut self) {
        let Some(answer) = self.desktop.as_ref().and_then(Asked::answer) else { return };
        let Some(asked) = self.desktop.take() else { return };
        match answer {
            Answer::Path(path) => {
                let chooser = asked.chooser().clone();
                let named = as_scene_file(&path);
                if matches!(chooser.purpose, Purpose::SaveAs(_)) && named != path && named.exists() {
                    // The desktop has asked about another file, if about any.
                    self.dialog = Some(Dialog::File(Chooser { path: named.display().to_string(), ..chooser }));
                } else {
                    self.chosen_file(chooser, path);
                }
            }
            Answer::Closed => {}
            Answer::None => self.has_desktop = false,
        }
    }

    /// Does what a chooser was for.
    pub(super) fn chosen_file(&mut self, chooser: Chooser, path: PathBuf) {
        match chooser.purpose {
            Purpose::Open => self.apply(Command::Open(path)),
            Purpose::SaveAs(next) => {
                self.save_to(&path, next.map(|next| *next));
                self.move_if_changed();
            }
            Purpose::Setting(key) => {
                self.apply(Command::CloseDialog);
                let value = Some(self.from_scene(&path).display().to_string().into());
                self.apply(Command::Set { key, value, phase: Phase::Done });
            }
            Purpose::Export(order) => {
                self.dialog = Some(Dialog::Export(tasks::Order { place: path, ..order }));
            }
        }
    }

    pub(super) fn act_on_files(&mut self, action: Action) {
        match action {
            Action::Open => {
                let file =
                    self.document.as_ref().map(|document| document.scene().file().to_owned()).unwrap_or_default();
                let folder = std::path::absolute(&file).ok().and_then(|file| file.parent().map(as_folder));
                let path = folder.unwrap_or_default();
                self.dialog = Some(Dialog::File(Chooser { purpose: Purpose::Open, path, endings: vec!["toml"] }));
            }
            Action::Save => self.save(None, false),
            Action::SaveAs => self.ask_save_as(None),
            Action::Reload => match &self.broken {
                Some(broken) if broken.is_changed() || !self.is_open(&broken.path) => {
                    let path = broken.path.clone();
                    if self.may_go(Next::Open(path.clone())) {
                        self.open(&path);
                    }
                }
                _ => self.reload(true),
            },
            Action::Export => {
                let Some(document) = &self.document else { return };
                let kind = tasks::Kind::Movie;
                let order =
                    tasks::Order { kind, place: kind.place(document.scene()), frame: self.play.frame(), strands: None };
                self.dialog = Some(Dialog::Export(order));
            }
            Action::Quit if self.may_close() => self.wishes.push(Wish::Quit),
            _ => {}
        }
    }

    fn is_open(&self, path: &Path) -> bool {
        self.document.as_ref().and_then(Document::path) == Some(path)
    }

    /// Reads the scene's file again. `fresh`: and all files that it names.
    pub(super) fn reload(&mut self, fresh: bool) {
        let Some(document) = &mut self.document else { return };
        let Some(path) = document.path().map(Path::to_owned) else {
            self.move_again(fresh);
            return;
        };
        match document.reload() {
            Ok(()) => {
                (self.broken, self.said_changed) = (None, false);
                self.forget_what_was_said_of(&path);
                self.move_again(fresh);
                self.say(format!("Read {} again", path.display()), false);
            }
            Err(error) => match std::fs::read(&path).map(|bytes| (String::from_utf8(bytes.clone()), bytes)) {
                Ok((Ok(text), on_disk)) if text.len() < MOST_TEXT => {
                    self.broken = Some(Broken { path, text, error: Some(error), on_disk });
                }
                _ => self.say(error.to_string(), true),
            },
        }
    }

    /// Notices that somebody else has written the file, or taken it away.
    pub(super) fn look_at_file(&mut self) {
        let Some(document) = &self.document else { return };
        if let Some(broken) = &self.broken {
            // A text that is being mended does not give way; one that nobody has touched may be mended elsewhere.
            if broken.is_changed() {
                return;
            }
            let is_other = std::fs::read(&broken.path).is_ok_and(|now| now != broken.on_disk);
            if is_other && !document.is_dirty() {
                let path = broken.path.clone();
                return if self.is_open(&path) { self.reload(false) } else { self.open(&path) };
            }
        }
        let Some(path) = document.path().map(Path::to_owned) else { return };
        match document.changed_on_disk() {
            Some(false) => {
                if std::mem::take(&mut self.said_changed) {
                    self.forget_what_was_said_of(&path);
                }
            }
            _ if self.said_changed => {}
            Some(true) if !document.is_dirty() => {
                self.said_changed = true;
                self.reload(false);
            }
            Some(true) => {
                self.said_changed = true;
                let text = format!(
                    "{}: another program has changed this file; Save asks which version to keep",
                    path.display()
                );
                self.say(text, true);
            }
            None => {
                self.said_changed = true;
                self.say(format!("{}: this file is no longer there; Save writes it again", path.display()), true);
            }
        }
    }

    /// What a dropped file sets, once it is known how it lies.
    pub fn import(&self, import: &Import) -> Option<Command> {
        let document = self.document.as_ref()?;
        let Import { path, role, unit, up, facing, node, .. } = import;
        let file = Value::String(self.from_scene(path).to_str()?.to_owned());
        let mut settings: Vec<(String, Option<Value>)> = Vec::new();
        let mut set = |key: String, value: Option<Value>| settings.push((key, value));
        let text = |text: &str| (!text.is_empty()).then(|| Value::String(text.to_owned()));
        let unit_value = |unit: &str| unit.parse::<f64>().map(Value::Float).ok().or_else(|| text(unit));
        let lie = |table: &str, set: &mut dyn FnMut(String, Option<Value>)| {
            for (key, value) in [("unit", unit_value(unit)), ("up", text(up)), ("facing", text(facing))] {
                if value.is_some() {
                    set(format!("{table}.{key}"), value);
                }
            }
        };
        match role {
            Role::Hair => {
                // Keys of grown hair are none of imported hair's.
                let mut table = toml::Table::new();
                table.insert("file".to_owned(), file);
                table.insert("segment_length".to_owned(), f64::from(document.scene().hair.segment_length).into());
                set("hair".to_owned(), Some(table.into()));
                lie("hair", &mut set);
            }
            Role::Head => {
                let mut table = toml::Table::new();
                table.insert("mesh".to_owned(), file);
                if let Some(motion) = self.settings.get("head").and_then(|head| head.get("motion")) {
                    table.insert("motion".to_owned(), motion.clone());
                }
                set("head".to_owned(), Some(table.into()));
                lie("head", &mut set);
            }
            Role::Motion => {
                let mut table = toml::Table::new();
                table.insert("file".to_owned(), file);
                set("head.motion".to_owned(), Some(table.into()));
                if path.extension().is_none_or(|ending| !ending.eq_ignore_ascii_case("csv")) {
                    set("head.motion.node".to_owned(), text(node));
                }
                if let Some(cm) = centimetres(unit) {
                    set("head.motion.unit_cm".to_owned(), Some(cm.into()));
                }
                for (key, value) in [("up", text(up)), ("facing", text(facing))] {
                    if value.is_some() {
                        set(format!("head.motion.{key}"), value);
                    }
                }
            }
            Role::Body => {
                let table = format!("body[{}]", document.scene().bodies.len());
                set(format!("{table}.mesh"), Some(file));
                lie(&table, &mut set);
            }
        }
        let name = format!("{} from {}", role.name(), path.file_name().unwrap_or_default().to_string_lossy());
        Some(Command::SetAll { name, settings })
    }

    /// A path below the scene's folder from there, any other as it is.
    pub fn from_scene(&self, path: &Path) -> PathBuf {
        let file = self.document.as_ref().and_then(|document| std::path::absolute(document.scene().file()).ok());
        let folder = file.as_deref().and_then(Path::parent);
        folder.and_then(|folder| path.strip_prefix(folder).ok()).unwrap_or(path).to_owned()
    }
}

fn centimetres(unit: &str) -> Option<f64> {
    unit.parse::<nabiki_io::Unit>().ok().map(|unit| f64::from(unit.cm))
}

/// A scene's text that is larger than this is none (bytes).
const MOST_TEXT: usize = 1 << 20;

#[cfg(test)]
#[path = "files_tests.rs"]
mod tests;
