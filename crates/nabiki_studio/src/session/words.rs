//! What is said: good news for a while, what went wrong until it is read, what is refused until it is given as it may be.

use std::path::Path;

use super::Session;
use crate::tasks::Ended;

/// Seconds for which good news is said.
const GOOD_NEWS: f64 = 6.0;

/// A word about what has happened.
#[derive(Clone, Debug, PartialEq)]
pub struct Word {
    /// What.
    pub text: String,
    /// Whether it went wrong, and stays until it is read.
    pub wrong: bool,
    /// What it refuses, until that is given as it may be; what went wrong otherwise is about nothing.
    pub about: Option<String>,
    /// Whether it speaks of the scene that is open, and goes with it; otherwise of the window and its folder.
    pub of_scene: bool,
    /// When it was said, by the session's clock (seconds).
    pub at: f64,
}

impl Session {
    /// What has been said and not been read.
    pub fn words(&self) -> &[Word] {
        &self.words
    }

    /// Says something of the scene that is open.
    pub fn say(&mut self, text: impl Into<String>, wrong: bool) {
        self.speak(Word { text: text.into(), wrong, about: None, of_scene: true, at: self.clock });
    }

    /// Says something of the window itself, which is as true of the next scene.
    pub fn say_of_window(&mut self, text: impl Into<String>, wrong: bool) {
        self.speak(Word { text: text.into(), wrong, about: None, of_scene: false, at: self.clock });
    }

    /// Says why something is refused, and no more what was said of it before.
    pub(super) fn refuse(&mut self, about: &str, why: impl Into<String>) {
        self.accept(about);
        let about = Some(about.to_owned());
        self.speak(Word { text: why.into(), wrong: true, about, of_scene: true, at: self.clock });
    }

    /// What was refused is as it may be.
    pub(super) fn accept(&mut self, about: &str) {
        self.words.retain(|word| word.about.as_deref() != Some(about));
    }

    fn speak(&mut self, word: Word) {
        // Said twice, it is not twice as true.
        self.words.retain(|known| known.text != word.text);
        self.words.push(word);
    }

    /// What went well has been said for long enough.
    pub(super) fn forget_good_news(&mut self) {
        let clock = self.clock;
        self.words.retain(|word| word.wrong || clock - word.at < GOOD_NEWS);
    }

    /// Another scene is open: what was said of the one before goes with it, and so do exports of it that came to nothing and
    /// have said so.
    pub(super) fn forget_what_was_said(&mut self) {
        self.words.retain(|word| !word.of_scene);
        self.tasks.retain(|task| {
            let ended = task.progress().ended;
            !matches!(ended, Some(Ended::Failed(_) | Ended::Cancelled))
        });
    }

    /// What was said of a file is so no longer.
    pub(super) fn forget_what_was_said_of(&mut self, file: &Path) {
        let file = file.display().to_string();
        self.words.retain(|word| !word.text.starts_with(&file));
    }

    /// Seconds until the next good news has been said for long enough.
    pub(super) fn news_goes_in(&self) -> f64 {
        let news = self.words.iter().filter(|word| !word.wrong);
        news.map(|word| (word.at + GOOD_NEWS - self.clock).max(0.0)).fold(f64::INFINITY, f64::min)
    }
}

#[cfg(test)]
#[path = "words_tests.rs"]
mod tests;
