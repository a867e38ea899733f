//! What is said: good news for a while, what went wrong until it is read, what is refused until it is given as it may be.

use super::Session;

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
    /// When it was said, by the session's clock (seconds).
    pub at: f64,
}

impl Session {
    /// What has been said and not been read.
    pub fn words(&self) -> &[Word] {
        &self.words
    }

    /// Says something.
    pub fn say(&mut self, text: impl Into<String>, wrong: bool) {
        self.speak(Word { text: text.into(), wrong, about: None, at: self.clock });
    }

    /// Says why something is refused, and no more what was said of it before.
    pub(super) fn refuse(&mut self, about: &str, why: impl Into<String>) {
        self.accept(about);
        self.speak(Word { text: why.into(), wrong: true, about: Some(about.to_owned()), at: self.clock });
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

    /// What was refused is refused of this scene alone.
    pub(super) fn forget_refusals(&mut self) {
        self.words.retain(|word| word.about.is_none());
    }
}

#[cfg(test)]
#[path = "words_tests.rs"]
mod tests;
