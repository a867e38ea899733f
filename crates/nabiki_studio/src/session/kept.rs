//! A take that is kept, so that what the scene has become since can be seen against it.

use std::sync::Arc;

use nabiki_scene::Scene;
use toml::{Table, Value};

use super::{Session, edit};
use crate::actions::Action;
use crate::command::Command;
use crate::document::Phase;
use crate::motion::{Manner, Motion, Moved};
use crate::take::Take;

/// What is refused where no take is kept.
const KEPT: &str = "the take that is kept";
const NONE: &str = "no take is kept yet: press K to keep the one you see";

/// A take that is kept.
#[derive(Debug)]
pub(super) struct KeptTake {
    take: Arc<Take>,
    /// Whether it is seen in place of the scene's own.
    seen: bool,
    /// What the scene has otherwise, while it is seen.
    differences: Vec<Difference>,
    /// Moves it with as many strands as the scene's own take has, where that is another number.
    motion: Option<Motion>,
    /// For how many strands it was moved last, or is being moved.
    strands: usize,
}

/// A setting that the scene has otherwise than the take that is kept.
#[derive(Clone, Debug, PartialEq)]
pub struct Difference {
    /// What it is, in words.
    pub name: String,
    /// Its value in the take that is kept, in words.
    pub kept: String,
    /// Its value in the scene.
    pub now: String,
}

impl KeptTake {
    fn new(take: Arc<Take>) -> Self {
        let strands = take.strands().len();
        Self { take, seen: false, differences: Vec::new(), motion: None, strands }
    }

    pub fn is_working(&self) -> bool {
        self.motion.as_ref().is_some_and(Motion::is_working)
    }

    pub fn wait(&self) {
        self.motion.iter().for_each(Motion::wait);
    }

    pub fn moved(&self) -> Option<Moved> {
        self.motion.as_ref()?.take()
    }
}

impl Session {
    /// The take that is kept, if one is.
    pub fn kept_take(&self) -> Option<&Arc<Take>> {
        self.kept.as_ref().map(|kept| &kept.take)
    }

    /// The take that is kept, and what the scene has otherwise, while it is seen in place of the scene's own.
    pub fn seen_instead(&self) -> Option<(&Arc<Take>, &[Difference])> {
        self.kept.as_ref().filter(|kept| kept.seen).map(|kept| (&kept.take, kept.differences.as_slice()))
    }

    pub(super) fn act_on_kept(&mut self, action: Action) {
        match action {
            Action::Keep => self.keep_take(),
            Action::Compare => self.compare(),
            Action::Exchange => self.exchange(),
            _ => {}
        }
    }

    fn keep_take(&mut self) {
        // What is seen is what is kept: the last one that moved, while the scene is being moved or cannot be.
        if self.seen_instead().is_none()
            && let Some(take) = &self.take
        {
            self.kept = Some(KeptTake::new(take.clone()));
            self.accept(KEPT);
            self.say("this take is kept: press X to switch between it and the scene", false);
        }
    }

    fn compare(&mut self) {
        let Some(scene) = self.kept_scene() else { return self.refuse(KEPT, NONE) };
        let settings = scene.settings().unwrap_or_default();
        let found = differences(&settings, &self.settings);
        if let Some(kept) = &mut self.kept {
            (kept.seen, kept.differences) = (!kept.seen, found);
        }
        self.accept(KEPT);
        self.match_strands();
    }

    /// The scene becomes what was kept, and what it was is kept.
    fn exchange(&mut self) {
        // What is kept of the scene is all of it, the last touch, too.
        self.motion.wait();
        self.receive();
        let Some(scene) = self.kept_scene() else { return self.refuse(KEPT, NONE) };
        if let Some(trouble) = &self.trouble {
            let text = format!("this scene cannot be moved, so it cannot become the kept take: {}", trouble.text);
            return self.refuse(KEPT, text);
        }
        let kept = self.kept.take().map(|kept| kept.take);
        // Seen at once, before it is moved again.
        self.kept = std::mem::replace(&mut self.take, kept).map(KeptTake::new);
        self.accept(KEPT);
        let (name, scene) = ("Swap takes".to_owned(), Box::new(scene));
        self.apply_to_document(Command::Scene { name, scene, phase: Phase::Done });
    }

    /// The scene that is kept, as one of the file that the scene has now.
    fn kept_scene(&self) -> Option<Scene> {
        let (kept, document) = (self.kept.as_ref()?, self.document.as_ref()?);
        Some(kept.take.built.scene.clone().moved_to(document.scene().file()))
    }

    /// Both takes are seen with the same strands.
    pub(super) fn match_strands(&mut self) {
        let Some(strands) = self.take.as_ref().map(|take| take.strands().len()) else { return };
        let Some(kept) = self.kept.as_mut().filter(|kept| kept.seen && kept.strands != strands) else { return };
        kept.strands = strands;
        let wake = self.wake.clone();
        let motion = match kept.motion.take() {
            Some(motion) => Ok(motion),
            None => Motion::start(Manner::GivesWay, move || wake.0()),
        };
        match motion {
            Ok(mut motion) => {
                motion.ask(kept.take.built.scene.clone(), strands, false);
                kept.motion = Some(motion);
            }
            Err(e) => self.say(format!("the kept take cannot be moved with {strands} strands: {e}"), true),
        }
    }

    pub(super) fn receive_kept(&mut self, Moved { result, .. }: Moved) {
        match (result, &mut self.kept) {
            (Ok((take, _)), Some(kept)) => kept.take = take,
            (Err(error), Some(_)) => self.say(format!("the kept take: {error}"), true),
            (_, None) => {}
        }
    }

    /// The scene itself is seen.
    pub(super) fn see_scene(&mut self) {
        self.kept.iter_mut().for_each(|kept| kept.seen = false);
    }
}

/// All settings of which two scenes have different values, in the order of their keys.
fn differences(kept: &Table, now: &Table) -> Vec<Difference> {
    let mut found = Vec::new();
    compare_tables("", kept, now, &mut found);
    found
}

fn compare_tables(key: &str, kept: &Table, now: &Table, found: &mut Vec<Difference>) {
    let added = now.keys().filter(|name| !kept.contains_key(*name));
    for name in kept.keys().chain(added) {
        let key = if key.is_empty() { name.clone() } else { format!("{key}.{name}") };
        compare_values(&key, kept.get(name), now.get(name), found);
    }
}

fn compare_values(key: &str, kept: Option<&Value>, now: Option<&Value>, found: &mut Vec<Difference>) {
    let has_tables = |values: &[Value]| values.iter().any(Value::is_table);
    match (kept, now) {
        _ if kept == now => {}
        (Some(Value::Table(kept)), Some(Value::Table(now))) => compare_tables(key, kept, now, found),
        (Some(Value::Array(kept)), Some(Value::Array(now))) if has_tables(kept) || has_tables(now) => {
            for n in 0..kept.len().max(now.len()) {
                compare_values(&format!("{key}[{n}]"), kept.get(n), now.get(n), found);
            }
        }
        _ => found.push(Difference { name: name_of(key), kept: in_words(kept), now: in_words(now) }),
    }
}

/// What a setting is called beside its value; the intervals have no page, but numbers.
fn name_of(key: &str) -> String {
    if let Some((n, rest)) = key.strip_prefix("force[").and_then(|rest| rest.split_once(']'))
        && let Ok(n) = n.parse::<usize>()
    {
        return format!("Interval {}{}", n + 1, rest.replace('.', ": "));
    }
    edit::name_of(key)
}

/// A value as a person would write it.
fn in_words(value: Option<&Value>) -> String {
    match value {
        None => "none".to_owned(),
        Some(Value::Table(_)) => "on".to_owned(),
        Some(Value::String(text)) => text.clone(),
        Some(Value::Float(number)) => format!("{}", *number as f32),
        Some(Value::Array(values)) => {
            let words: Vec<String> = values.iter().map(|value| in_words(Some(value))).collect();
            format!("({})", words.join(", "))
        }
        Some(value) => value.to_string(),
    }
}

#[cfg(test)]
#[path = "kept_tests.rs"]
mod tests;
