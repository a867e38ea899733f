//! What changes the scene.

use nabiki::field::Ease;
use nabiki_scene::Scene;
use nabiki_scene::scene::{ForceSettings, Output};

use super::{Session, taken};
use crate::actions::Action;
use crate::command::Command;
use crate::document::Phase;
use crate::timeline;
use crate::tools::Tool;

/// What changes the scene.
pub(super) const CHANGES: [Action; 11] = [
    Action::Undo,
    Action::Redo,
    Action::Cut,
    Action::Paste,
    Action::Delete,
    Action::Add,
    Action::Split,
    Action::Join,
    Action::Ease,
    Action::UseCamera,
    Action::Exchange,
];

/// What is refused while a text is being mended.
pub(super) const BEHIND_TEXT: &str = "the scene behind a text";

/// How it is said that the contact sheet has fewer frames.
const SHEET_LOST: &str = "the contact sheet loses frames ";

impl Session {
    /// Whether a text is being mended, behind which the scene is left alone; says so.
    pub(super) fn is_behind_text(&mut self) -> bool {
        let Some(broken) = &self.broken else { return false };
        let text = format!("{}: fix or close this text first; the scene behind it stays unchanged", broken.name());
        self.refuse(BEHIND_TEXT, text);
        true
    }

    pub(super) fn apply_to_document(&mut self, command: Command) {
        match command {
            Command::Set { .. }
            | Command::SetAll { .. }
            | Command::Intervals { .. }
            | Command::Vector { .. }
            | Command::Pulled { .. }
            | Command::Scene { .. }
            | Command::Painted { .. }
            | Command::Combed { .. }
                if self.is_behind_text() => {}
            Command::Set { key, value, phase } => self.set(&key, value, phase),
            Command::SetAll { name, settings } => self.set_all(&name, &settings),
            Command::Intervals { name, keys, chosen, phase } => {
                self.change(name, phase, |scene| set_intervals(scene, keys));
                self.chosen = chosen.unwrap_or_else(|| std::mem::take(&mut self.chosen));
            }
            Command::Vector { interval, vector, phase } => {
                let name = format!("Vector of interval {}", interval + 1);
                self.change(&name, phase, |scene| {
                    let key = scene.field.force.get_mut(interval);
                    key.into_iter().for_each(|key| (key.vector, key.speed) = (vector, None));
                });
            }
            // It was undone, or something else was done, in the picture in which more was found: nobody wants that any more.
            Command::Pulled { name, phase: Phase::After, .. } if !self.is_last_step(name) => {}
            Command::Pulled { name, answer, interval, phase } => {
                let Some(take) = self.take.clone() else { return };
                self.change(name, phase, |scene| scene.accept(&answer, &take.built));
                let before = std::mem::replace(&mut self.chosen, vec![interval]);
                self.chosen_before = match phase {
                    Phase::Dragging => Some(self.chosen_before.take().unwrap_or(before)),
                    _ => None,
                };
            }
            Command::Painted { region, painted } => self.painted(region, *painted),
            Command::Combed { frame, strands } => self.combed(frame, &strands),
            Command::Scene { name, scene, phase } => drop(self.change(&name, phase, |now| *now = *scene)),
            Command::EndDrag => self.document.iter_mut().for_each(|document| document.end_drag()),
            Command::GiveUpDrag => {
                self.document.iter_mut().for_each(|document| document.give_up_drag());
                self.chosen = self.chosen_before.take().unwrap_or_else(|| std::mem::take(&mut self.chosen));
            }
            command => self.apply_to_files(command),
        }
    }

    /// Whether the last thing done is a step of this name, which has not been undone.
    fn is_last_step(&self, name: &str) -> bool {
        let last = self.document.as_ref().filter(|document| document.redo_name().is_none());
        last.and_then(|document| document.undo_name()) == Some(name)
    }

    /// Changes the scene, as a step of this name. Returns what the change does, if a scene is open.
    pub(super) fn change<T>(&mut self, name: &str, phase: Phase, change: impl FnOnce(&mut Scene) -> T) -> Option<T> {
        let document = self.document.as_mut()?;
        let mut scene = document.scene().clone();
        let done = change(&mut scene);
        document.edit(name, scene, phase);
        Some(done)
    }

    fn set(&mut self, key: &str, value: Option<toml::Value>, phase: Phase) {
        let Some(document) = &mut self.document else { return };
        match document.scene().with_setting(key, value) {
            Ok(mut scene) => {
                let name = name_of(key);
                let before = document.before_drag(&name);
                let lost = (key == "motion.frames").then(|| shorten_sheet(&mut scene, before));
                let mut taken = taken::by_hair(&mut scene, before, key);
                taken.extend(taken::by_pair(&mut scene, before, key));
                document.edit(&name, scene, phase);
                self.accept(key);
                lost.into_iter().for_each(|lost| self.say_what_the_sheet_lost(lost));
                self.say_taken(&taken);
            }
            Err(refused) => {
                let text = refused.to_string();
                self.refuse(key, text);
            }
        }
    }

    fn say_what_the_sheet_lost(&mut self, Shortened { lost, instead }: Shortened) {
        // Of a drag the last word counts.
        self.words.retain(|word| !word.text.starts_with(SHEET_LOST));
        if !lost.is_empty() {
            let list = |frames: &[u32]| frames.iter().map(u32::to_string).collect::<Vec<_>>().join(", ");
            let instead = instead.map(|frames| format!("; it gets {} instead", list(&frames))).unwrap_or_default();
            self.say(format!("{SHEET_LOST}{}, which are beyond the end of the motion{instead}", list(&lost)), false);
        }
    }

    fn say_taken(&mut self, taken: &[String]) {
        self.words.retain(|word| !word.text.starts_with(taken::TAKEN));
        if !taken.is_empty() {
            self.say(format!("{}{}", taken::TAKEN, taken.join("; ")), false);
        }
    }

    fn set_all(&mut self, name: &str, settings: &[(String, Option<toml::Value>)]) {
        let Some(document) = &mut self.document else { return };
        let set = |scene: Scene, (key, value): &(String, Option<toml::Value>)| scene.with_setting(key, value.clone());
        match settings.iter().try_fold(document.scene().clone(), set) {
            Ok(scene) => {
                document.edit(name, scene, Phase::Done);
                self.accept(name);
            }
            Err(refused) => {
                let text = refused.to_string();
                self.refuse(name, text);
            }
        }
    }

    pub(super) fn act_on_intervals(&mut self, action: Action) {
        let Some(document) = &mut self.document else { return };
        let keys = document.scene().field.force.clone();
        let (frame, last) = (self.play.frame(), document.scene().motion.frames);
        let chosen = self.chosen.clone();
        match action {
            Action::Undo => drop(document.undo()),
            Action::Redo => drop(document.redo()),
            Action::Copy => self.clip = timeline::copy(&keys, &chosen),
            Action::Cut => {
                self.clip = timeline::copy(&keys, &chosen);
                self.edit_intervals("Cut", timeline::remove(&keys, &chosen), Vec::new());
            }
            Action::Paste if !self.clip.0.is_empty() => {
                let (keys, chosen) = timeline::paste(&keys, frame, &self.clip);
                self.edit_intervals("Paste", keys, chosen);
            }
            Action::Delete if !chosen.is_empty() => {
                self.edit_intervals("Remove intervals", timeline::remove(&keys, &chosen), Vec::new());
            }
            Action::SelectAll => self.chosen = (0..keys.len()).collect(),
            Action::SelectNone if self.tools.tool != Tool::Pull => self.tools.tool = Tool::Pull,
            Action::SelectNone => self.chosen.clear(),
            Action::Add => {
                let (keys, j) = timeline::add(&keys, frame, last);
                self.edit_intervals("Add an interval", keys, vec![j]);
            }
            Action::Split => {
                if let (Some(keys), Some(j)) = (timeline::split(&keys, frame), timeline::at(&keys, frame)) {
                    self.edit_intervals("Split", keys, vec![j + 1]);
                }
            }
            Action::Join => match timeline::join(&keys, &chosen) {
                Some(joined) => {
                    let at = chosen.first().map_or(0, |&first| first.min(joined.len() - 1));
                    self.edit_intervals("Join", joined, vec![at]);
                    self.accept("Join");
                }
                None => self.refuse("Join", "select two or more adjacent intervals to join them"),
            },
            Action::Ease => self.next_ease(),
            Action::NextBorder => {
                let next = keys.iter().map(|key| key.through.saturating_add(1)).find(|&first| first > frame);
                self.apply(Command::Go(next.unwrap_or(last)));
            }
            Action::PreviousBorder => {
                let before = keys.iter().rev().map(|key| key.through.saturating_add(1)).find(|&first| first < frame);
                self.apply(Command::Go(before.unwrap_or(if frame > 1 { 1 } else { 0 })));
            }
            _ => {}
        }
    }

    fn edit_intervals(&mut self, name: &str, keys: Vec<ForceSettings>, chosen: Vec<usize>) {
        self.change(name, Phase::Done, |scene| set_intervals(scene, keys));
        self.chosen = chosen;
    }

    fn next_ease(&mut self) {
        if self.document.as_ref().is_some_and(|document| document.scene().field.force.is_empty()) {
            return self.refuse("Ease", "there is no wind to ease: add an interval (A) first");
        }
        self.accept("Ease");
        self.change("Ease", Phase::Done, |scene| {
            scene.field.wind.ease = match scene.field.wind.ease {
                Ease::Stepped => Ease::Linear,
                Ease::Linear => Ease::Smooth,
                Ease::Smooth => Ease::Stepped,
            };
        });
    }
}

/// What a shorter motion does to the frames of the contact sheet.
#[derive(Default)]
struct Shortened {
    /// Those taken out.
    lost: Vec<u32>,
    /// Those put in where none was left.
    instead: Option<Vec<u32>>,
}

/// Takes the frames out of the contact sheet that a shorter motion does not reach: nobody who drags its length thinks of them,
/// and with them no scene is right. They are those of the scene `before` the drag, so that a drag back brings them back. A sheet
/// of which none is left gets the frames that a scene without one of its own has: it was wanted, and a run would write none.
fn shorten_sheet(scene: &mut Scene, before: &Scene) -> Shortened {
    let Some(sheet) = &before.output.sheet else { return Shortened::default() };
    let frames = scene.motion.frames;
    let (kept, lost): (Vec<u32>, Vec<u32>) = sheet.iter().partition(|&&frame| frame <= frames);
    let instead = (kept.is_empty() && !lost.is_empty()).then(|| Output::default().sheet_frames(frames));
    scene.output.sheet = Some(instead.clone().unwrap_or(kept));
    Shortened { lost, instead }
}

/// Puts intervals into a scene. Without any there is nothing to ease and nothing to make gusty.
fn set_intervals(scene: &mut Scene, keys: Vec<ForceSettings>) {
    scene.field.force = keys;
    if scene.field.force.is_empty() {
        scene.field.wind.ease = Ease::Stepped;
        scene.field.gust = None;
        if scene.field.body_wind.is_none() {
            scene.field.flow = None;
        }
    }
}

/// What a setting is called away from its page: in the undo menu, beside its value.
pub(super) fn name_of(key: &str) -> String {
    match crate::settings::find(key) {
        Some((_, group, setting)) => format!("{}: {}", group.title, setting.label.to_lowercase()),
        None => key.to_owned(),
    }
}

#[cfg(test)]
#[path = "edit_tests.rs"]
mod tests;
