//! The name of a setting in a scene file.

use std::borrow::Cow;
use std::convert::Infallible;
use std::fmt;
use std::str::FromStr;

/// A setting's name, such as `force[1].vector`. Empty if no particular setting is meant.
#[derive(Clone, Debug, Default, PartialEq, Eq, Hash)]
pub struct Key(Vec<Step>);

/// One step of a [`Key`].
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub enum Step {
    /// A table or a setting in it.
    Name(Cow<'static, str>),
    /// An entry of a list, counted from 0.
    Entry(usize),
}

impl Step {
    /// The name, or `None` for an entry of a list.
    pub fn name(&self) -> Option<&str> {
        match self {
            Self::Name(name) => Some(name),
            Self::Entry(_) => None,
        }
    }
}

impl Key {
    /// Its steps, outermost first.
    pub fn steps(&self) -> &[Step] {
        &self.0
    }

    /// Whether the key is empty.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Whether the setting is `table` or lies within it.
    pub fn is_within(&self, table: &Key) -> bool {
        self.0.starts_with(&table.0)
    }

    /// The last name, without entries of lists.
    pub fn last_name(&self) -> &str {
        self.0.iter().rev().find_map(Step::name).unwrap_or_default()
    }

    /// The key one step deeper.
    #[must_use]
    pub fn below(mut self, step: Step) -> Self {
        self.0.push(step);
        self
    }
}

impl From<&str> for Key {
    fn from(text: &str) -> Self {
        let mut steps = Vec::new();
        for part in text.split('.').filter(|part| !part.is_empty()) {
            let (name, entries) = part.split_at(part.find('[').unwrap_or(part.len()));
            match name.parse() {
                // `force.0` is `force[0]`.
                Ok(entry) if !steps.is_empty() => steps.push(Step::Entry(entry)),
                _ if name.is_empty() => {}
                _ => steps.push(Step::Name(Cow::Owned(name.to_owned()))),
            }
            for entry in entries.split('[').skip(1) {
                let text = entry.strip_suffix(']').unwrap_or(entry);
                steps.push(text.parse().map_or_else(|_| Step::Name(Cow::Owned(text.to_owned())), Step::Entry));
            }
        }
        Self(steps)
    }
}

impl From<String> for Key {
    fn from(text: String) -> Self {
        Self::from(text.as_str())
    }
}

impl FromStr for Key {
    type Err = Infallible;

    fn from_str(text: &str) -> Result<Self, Infallible> {
        Ok(Self::from(text))
    }
}

impl FromIterator<Step> for Key {
    fn from_iter<I: IntoIterator<Item = Step>>(steps: I) -> Self {
        Self(steps.into_iter().collect())
    }
}

impl fmt::Display for Key {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (i, step) in self.0.iter().enumerate() {
            match step {
                Step::Entry(place) => write!(f, "[{place}]")?,
                Step::Name(name) if i == 0 => f.write_str(name)?,
                Step::Name(name) => write!(f, ".{name}")?,
            }
        }
        Ok(())
    }
}

impl PartialEq<str> for Key {
    fn eq(&self, other: &str) -> bool {
        self.0 == Self::from(other).0
    }
}

impl PartialEq<&str> for Key {
    fn eq(&self, other: &&str) -> bool {
        *self == **other
    }
}

impl PartialEq<String> for Key {
    fn eq(&self, other: &String) -> bool {
        *self == **other
    }
}

/// The position of a check in the settings. A [`Key`] is built from it only for an error.
#[derive(Clone, Copy, Debug)]
pub enum Place<'a> {
    /// A table by its name.
    Table(&'a str),
    /// A key of a table.
    Key(&'a Place<'a>, &'static str),
    /// An entry of a list.
    Entry(&'a Place<'a>, usize),
}

impl Place<'_> {
    /// The key at this place of a table.
    pub fn key(&self, key: &'static str) -> Place<'_> {
        Place::Key(self, key)
    }

    /// An entry of the list at this place.
    pub fn entry(&self, i: usize) -> Place<'_> {
        Place::Entry(self, i)
    }
}

impl From<&Place<'_>> for Key {
    fn from(place: &Place) -> Self {
        match *place {
            Place::Table(name) => Self::from(name),
            Place::Key(above, key) => Self::from(above).below(Step::Name(Cow::Borrowed(key))),
            Place::Entry(above, i) => Self::from(above).below(Step::Entry(i)),
        }
    }
}
