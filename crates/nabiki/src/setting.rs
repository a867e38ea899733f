//! Settings, declared once: [`settings!`](crate::settings) and [`words!`](crate::words) make of one declaration the struct, its
//! defaults, its check, how it is read and written, and what may be known of it as data, a [`Table`].
//!
//! A declaration stands in the crate that obeys it. All who show, write or explain settings read the tables; the schema of a whole scene
//! is `nabiki_scene::schema`.

mod declare;
mod value;

use std::fmt;

pub use crate::key::{Key, Place, Step};
pub use value::Value;

use crate::error::SettingError;

/// The settings of one struct.
#[derive(Debug)]
pub struct Table {
    /// The struct's name.
    pub name: &'static str,
    /// Its doc comment, as it is.
    pub help: &'static str,
    /// Its settings, in order.
    pub settings: &'static [Setting],
}

impl Table {
    /// The setting of this key, which it must have: a constant that asks for another does not compile.
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

/// Whether two texts are the same, as constants can ask.
const fn is_same(mut a: &[u8], mut b: &[u8]) -> bool {
    while let ([of_a, after_a @ ..], [of_b, after_b @ ..]) = (a, b) {
        if *of_a != *of_b {
            return false;
        }
        (a, b) = (after_a, after_b);
    }
    a.is_empty() && b.is_empty()
}

/// One setting, as it is declared.
#[derive(Debug)]
pub struct Setting {
    /// Its key within the table.
    pub key: &'static str,
    /// What a panel calls it.
    pub label: &'static str,
    /// Its doc comment, as it is. The first sentence says what it does.
    pub help: &'static str,
    /// What it may be.
    pub kind: Kind,
    /// Its unit and range.
    pub range: Range,
    /// The value of a new one. Where it [must](Self::must) be given, nothing stands in for it when a file is read.
    pub default: fn() -> Datum,
    /// An example of what must be given, where a file cannot do without it.
    pub must: Option<&'static str>,
    /// What is taken where it is left open, which it may be.
    pub open: Option<&'static str>,
}

/// What a setting may be.
#[derive(Clone, Copy, Debug)]
pub enum Kind {
    /// True or false.
    Flag,
    /// A whole number of a type that holds these.
    Whole {
        /// The least.
        least: i64,
        /// The most.
        most: i64,
    },
    /// A number.
    Number,
    /// Text.
    Text,
    /// A path, relative to the scene's file.
    Path,
    /// One of a few words.
    Words(&'static [Word]),
    /// A number with one of these units as text, `"4.5 cm"`.
    Quantity(&'static [&'static str]),
    /// So many numbers.
    Numbers(usize),
    /// So many whole numbers of at least 0.
    Wholes(usize),
    /// Any number of them.
    List(&'static Kind),
    /// A table of settings.
    Table(&'static Table),
    /// One of several.
    OneOf(&'static [Kind]),
}

/// A word that a setting may be.
#[derive(Clone, Copy, Debug)]
pub struct Word {
    /// The word.
    pub word: &'static str,
    /// What it means: its doc comment, as it is.
    pub help: &'static str,
}

/// A setting's unit, and what its numbers lie within; each of a list's.
#[derive(Clone, Copy, Debug, Default)]
pub struct Range {
    /// The unit, or nothing.
    pub unit: &'static str,
    /// More than this.
    pub above: Option<f64>,
    /// At least this.
    pub least: Option<f64>,
    /// At most this.
    pub most: Option<f64>,
}

impl Range {
    /// What a number must be that is not in the range, in words.
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

    /// The same of a whole number, which is finite anyway.
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
    /// Not there.
    Open,
    /// True or false.
    Flag(bool),
    /// A whole number.
    Whole(i64),
    /// A number; one of 32 bits with no more digits than tell it from its neighbours.
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
    /// What is declared of it.
    const TABLE: Table;
}

/// A doc comment as text: lines that were broken are joined, paragraphs stay apart, links of Rust's documentation are the words alone.
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

/// Takes the brackets and targets off ``[`name`](target)``.
fn without_links(text: &str) -> String {
    let mut plain = String::new();
    let mut rest = text;
    while let Some((before, link)) = rest.split_once("[`") {
        let Some((name, after)) = link.split_once("`]") else { break };
        let target = after.strip_prefix('(').and_then(|target| target.split_once(')'));
        plain.push_str(before);
        // What no link can be called is a table's header, `[[force]]`, or a list.
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

/// Refuses a value, by the name of its setting.
///
/// # Errors
/// Always.
pub fn refused(at: &Place, value: impl fmt::Display, remedy: impl Into<String>) -> Result<(), SettingError> {
    Err(SettingError::new(Key::from(at), value, remedy))
}

#[cfg(test)]
mod tests;
