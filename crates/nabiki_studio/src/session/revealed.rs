//! A setting that was looked for, pointed out where it is.

use super::{Session, Wish};
use crate::finding;
use crate::settings::{self, Page};
use crate::timeline;

/// Seconds for which it is pointed out.
const SHOWN: f64 = 3.0;
/// Pictures for which its page goes to it: what opens on the way takes a few, however long each takes.
const GOES: u32 = 6;

/// What is refused where a setting has no effect.
const FOUND: &str = "what was found";

/// A setting that is pointed out.
#[derive(Clone, Debug, PartialEq)]
pub struct Revealed {
    /// Its key as its page shows it, or its table's.
    pub key: String,
    /// Since when it has been seen, by the session's clock, and in how many pictures.
    at: Option<f64>,
    pictures: u32,
}

impl Session {
    /// What is pointed out, and whether its page still goes there.
    pub fn revealed(&self) -> Option<(&str, bool)> {
        let revealed = self.revealed.as_ref()?;
        let goes = revealed.pictures < GOES;
        (goes || self.clock < revealed.at? + SHOWN).then_some((revealed.key.as_str(), goes))
    }

    /// Another picture is drawn.
    pub(super) fn see_revealed(&mut self) {
        if let Some(revealed) = &mut self.revealed {
            revealed.at.get_or_insert(self.clock);
            revealed.pictures = revealed.pictures.saturating_add(1);
        }
    }

    /// Seconds until another picture of it is wanted.
    pub(super) fn revealed_for(&self) -> f64 {
        match (self.revealed(), &self.revealed) {
            (Some((_, true)), _) => 0.0,
            (Some(_), Some(revealed)) => (revealed.at.unwrap_or(self.clock) + SHOWN - self.clock).max(0.0),
            _ => f64::INFINITY,
        }
    }

    /// Shows where a setting is: its page comes to the front, opens its group and goes there. What intervals have is shown by choosing one.
    pub(super) fn reveal(&mut self, key: &str) {
        let Some(document) = &self.document else { return };
        if key.starts_with("force") {
            let keys = &document.scene().field.force;
            match timeline::at(keys, self.play.frame()) {
                Some(j) if self.chosen.is_empty() => self.chosen = vec![j],
                Some(_) => {}
                None => self.refuse(FOUND, "there is no wind yet: add an interval (A) first"),
            }
            return;
        }
        let Some((page, group, setting)) = settings::find(key) else { return };
        if !group.when.holds(document.scene()) {
            let text = format!("{}: {} works only {}", group.title, setting.label, group.when.in_words());
            return self.refuse(FOUND, text);
        }
        self.accept(FOUND);
        let key = finding::shown_key(&self.settings, page, group, setting);
        self.show_page(page);
        self.revealed = Some(Revealed { key, at: None, pictures: 0 });
    }

    fn show_page(&mut self, page: Page) {
        self.wishes.push(Wish::Page(page));
    }
}
