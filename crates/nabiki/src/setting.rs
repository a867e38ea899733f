//! Settings, declared once. From one declaration, [`settings!`](crate::settings) and [`words!`](crate::words) generate
//! the struct, its defaults, its check, its serialisation, and a description as data, a [`Table`].
//!
//! Each setting is declared in the crate that uses it. Code that shows, writes or explains settings reads the tables.
//! The schema of a whole scene is `nabiki_scene::schema`.

mod declare;
mod value;

use std::fmt;

pub use crate::key::{Key, Place, Step};
pub use value::Value;

use crate::error::SettingError;

/// The description of a struct of settings.
#[derive(Debug)]
pub struct Table {
    /// The struct's name.
    pub name: &'static str,
    /// Its doc comment, unchanged.
    pub help: &'static str,
    /// Its settings, in order.
    pub settings: &'static [Setting],
}

impl Table {
    /// The setting with this key. In a constant, a missing key is a compile error.
    #[doc(hidden)]
    pub const fn setting(&self, key: &str) -> &'static Setting {
        let mut rest = self.settings;
        while let [setting, after @ ..] = rest {
            if is_same(setting.key.as_bytes(), key.as_bytes()) {
                return setting;
            }
            rest = after;
        }
        panic!("no such setting")
    }
}

/// Whether two texts are equal, for constants.
const fn is_same(mut a: &[u8], mut b: &[u8]) -> bool {
    while let ([of_a, after_a @ ..], [of_b, after_b @ ..]) = (a, b) {
        if *of_a != *of_b {
            return false;
        }
        (a, b) = (after_a, after_b);
    }
    a.is_empty() && b.is_empty()
}

/// The description of one setting.
#[derive(Debug)]
pub struct Setting {
    /// Its key within the table.
    pub key: &'static str,
    /// Its label in a panel.
    pub label: &'static str,
    /// Its doc comment, unchanged. The first sentence says what the setting does.
    pub help: &'static str,
    /// Its type.
    pub kind: Kind,
    /// Its unit and range.
    pub range: Range,
    /// The default. A setting that [must](Self::must) be given has no default when a file is read.
    pub default: fn() -> Datum,
    /// An example value, if the setting is required.
    pub must: Option<&'static str>,
    /// What applies if the setting is left out, if it may be.
    pub open: Option<&'static str>,
}

/// The type of a setting.
#[derive(Clone, Copy, Debug)]
pub enum Kind {
    /// True or false.
    Flag,
    /// A whole number.
    Whole {
        /// Smallest value of its type.
        least: i64,
        /// Largest value of its type.
        most: i64,
    },
    /// A number.
    Number,
    /// Text.
    Text,
    /// A path, relative to the scene's file.
    Path,
    /// One of these words.
    Words(&'static [Word]),
    /// A number with one of these units, as text: `"4.5 cm"`.
    Quantity(&'static [&'static str]),
    /// This many numbers.
    Numbers(usize),
    /// This many whole numbers of at least 0.
    Wholes(usize),
    /// A list of any length.
    List(&'static Kind),
    /// A table of settings.
    Table(&'static Table),
    /// One of several types.
    OneOf(&'static [Kind]),
}

/// A word of a setting.
#[derive(Clone, Copy, Debug)]
pub struct Word {
    /// The word.
    pub word: &'static str,
    /// Its meaning: its doc comment, unchanged.
    pub help: &'static str,
}

/// The unit and range of a setting's numbers, or of each number of a list.
#[derive(Clone, Copy, Debug, Default)]
pub struct Range {
    /// The unit, or empty.
    pub unit: &'static str,
    /// Exclusive lower bound.
    pub above: Option<f64>,
    /// Inclusive lower bound.
    pub least: Option<f64>,
    /// Inclusive upper bound.
    pub most: Option<f64>,
}

impl Range {
    /// The range in words, for the error about a number outside it.
    pub fn remedy(&self) -> String {
        match (self.above, self.least, self.most) {
            (_, Some(least), Some(most)) => format!("must lie in {least}..{most}"),
            (Some(above), _, Some(most)) => format!("must lie above {above} and not above {most}"),
            (Some(above), _, None) => format!("must be a finite number above {above}"),
            (_, Some(least), None) => format!("must be a finite number of at least {least}"),
            (None, None, Some(most)) => format!("must be a finite number of at most {most}"),
            (None, None, None) => "must be a finite number".to_owned(),
        }
    }

    /// The same for a whole number, which is always finite.
    fn whole_remedy(&self) -> String {
        let least = self.least.unwrap_or(0.0);
        match self.most {
            Some(most) => format!("must lie in {least}..{most}"),
            None => format!("must be at least {least}"),
        }
    }
}

/// A value as data.
#[derive(Clone, Debug, PartialEq)]
pub enum Datum {
    /// Not set.
    Open,
    /// True or false.
    Flag(bool),
    /// A whole number.
    Whole(i64),
    /// A number. An f32 has only the digits that distinguish it from its neighbours.
    Number(f64),
    /// A word, text or path.
    Text(String),
    /// A list.
    List(Vec<Datum>),
    /// A table, by its keys.
    Table(Vec<(&'static str, Datum)>),
}

impl serde::Serialize for Datum {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            Self::Open => serializer.serialize_none(),
            Self::Flag(flag) => serializer.serialize_bool(*flag),
            Self::Whole(number) => serializer.serialize_i64(*number),
            Self::Number(number) => serializer.serialize_f64(*number),
            Self::Text(text) => serializer.serialize_str(text),
            Self::List(values) => serializer.collect_seq(values),
            Self::Table(entries) => {
                let there = entries.iter().filter(|(_, value)| *value != Self::Open);
                serializer.collect_map(there.map(|(key, value)| (key, value)))
            }
        }
    }
}

/// A struct of settings.
pub trait Settings: Value {
    /// Its description.
    const TABLE: Table;
}

/// A doc comment as plain text: lines are joined into paragraphs, and links are replaced by their text.
pub fn plain(help: &str) -> String {
    let mut text = String::new();
    for line in help.lines().map(str::trim) {
        match line {
            "" => text.push_str("\n\n"),
            _ if text.is_empty() || text.ends_with('\n') => text.push_str(line),
            _ => {
                text.push(' ');
                text.push_str(line);
            }
        }
    }
    without_links(text.trim())
}

/// Removes the brackets and targets of ``[`name`](target)``.
fn without_links(text: &str) -> String {
    let mut plain = String::new();
    let mut rest = text;
    while let Some((before, link)) = rest.split_once("[`") {
        let Some((name, after)) = link.split_once("`]") else { break };
        let target = after.strip_prefix('(').and_then(|target| target.split_once(')'));
        plain.push_str(before);
        // Brackets around text that no link can have are a table's header, `[[force]]`, or a list.
        plain.push_str(&format!("`{name}`"));
        rest = target.map_or(after, |(_, after)| after);
    }
    plain + rest
}

impl fmt::Display for Range {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match (self.above, self.least, self.most) {
            (_, Some(least), Some(most)) => write!(f, "{least} to {most}"),
            (Some(above), _, Some(most)) => write!(f, "above {above}, at most {most}"),
            (Some(above), _, None) => write!(f, "above {above}"),
            (_, Some(least), None) => write!(f, "at least {least}"),
            (None, None, Some(most)) => write!(f, "at most {most}"),
            (None, None, None) => Ok(()),
        }
    }
}

/// The error for a value of the setting at `at`.
///
/// # Errors
/// Always.
pub fn refused(at: &Place, value: impl fmt::Display, remedy: impl Into<String>) -> Result<(), SettingError> {
    Err(SettingError::new(Key::from(at), value, remedy))
}

#[cfg(test)]
mod tests;
