//! Every setting of a scene, once: its key, its name, unit, range and help. The panels are drawn from these tables.

mod hair;
mod head;
mod motion;
mod picture;
mod wind;

use toml::{Table, Value};

/// Where a group of settings is shown.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, serde::Deserialize, serde::Serialize)]
pub enum Page {
    /// What pushes the hair.
    Wind,
    /// How hair answers.
    Motion,
    /// How hair lies at rest.
    Style,
    /// The head, other bodies, and the files that they come from.
    Head,
    /// What is drawn.
    Picture,
}

impl Page {
    /// All of them, in the order of their tabs.
    pub const ALL: [Self; 5] = [Self::Wind, Self::Motion, Self::Style, Self::Head, Self::Picture];

    /// Its title.
    pub fn title(self) -> &'static str {
        match self {
            Self::Wind => "Wind",
            Self::Motion => "Motion",
            Self::Style => "Style",
            Self::Head => "Head",
            Self::Picture => "Picture",
        }
    }

    /// Its groups.
    pub fn groups(self) -> &'static [Group] {
        match self {
            Self::Wind => wind::GROUPS,
            Self::Motion => motion::GROUPS,
            Self::Style => hair::GROUPS,
            Self::Head => head::GROUPS,
            Self::Picture => picture::GROUPS,
        }
    }
}

/// Settings that belong together: a table of the scene file, or a few of its keys.
#[derive(Debug)]
pub struct Group {
    /// Its title.
    pub title: &'static str,
    /// The table, as `hair.style.comb`.
    pub table: &'static str,
    /// How often the table is there.
    pub shape: Shape,
    /// What it is for.
    pub help: &'static str,
    /// Whether it is open at first.
    pub open: bool,
    /// When it has an effect.
    pub when: When,
    /// What is in it.
    pub settings: &'static [Setting],
}

/// How often a table stands in a scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Shape {
    /// Always: all its keys have defaults.
    Always,
    /// Or not at all, which says something too. In TOML: what a new one is given.
    Optional(&'static str),
    /// Any number of times. In TOML: what a new one is given.
    List(&'static str),
}

/// In which scenes a group has an effect.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum When {
    /// In all.
    Always,
    /// In those of the paper's form.
    Paper,
    /// In those of the free form.
    Free,
    /// Where hair is grown.
    Grown,
    /// Where hair comes from a file.
    Imported,
    /// Where the head comes from a file.
    ImportedHead,
}

/// One setting.
#[derive(Debug)]
pub struct Setting {
    /// Its key within the table, as `stiffness.top`.
    pub key: &'static str,
    /// Its name.
    pub label: &'static str,
    /// Its unit, or nothing.
    pub unit: &'static str,
    /// What it may be.
    pub kind: Kind,
    /// Whether it may be left open, and what is then taken.
    pub open: Option<&'static str>,
    /// What it does, in a sentence or two.
    pub help: &'static str,
}

/// What a setting may be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Kind {
    /// A number.
    Number {
        /// At least this.
        least: f64,
        /// At most this.
        most: f64,
        /// What a drag by one point adds.
        step: f64,
    },
    /// A whole number.
    Whole {
        /// At least this.
        least: i64,
        /// At most this.
        most: i64,
    },
    /// Yes or no.
    Flag,
    /// One of a few words.
    Choice(&'static [&'static str]),
    /// Numbers, as many as have a name.
    Numbers {
        /// What each is called.
        names: &'static [&'static str],
        /// What a drag by one point adds.
        step: f64,
    },
    /// Whole numbers, as many as have a name.
    Wholes {
        /// What each is called.
        names: &'static [&'static str],
        /// At least this.
        least: i64,
        /// At most this.
        most: i64,
    },
    /// Red, green, blue, 0..1.
    Colour {
        /// Whether they are amounts of light rather than sRGB.
        linear: bool,
    },
    /// A colour by name, pigment or as it looks.
    HairColour,
    /// A number of at least 0, or a list of them from root to tip.
    Profile {
        /// At most this.
        most: f64,
        /// What a drag by one point adds.
        step: f64,
    },
    /// A number of at least 0, or a word.
    NumberOr {
        /// The word.
        word: &'static str,
        /// At most this.
        most: f64,
        /// What a drag by one point adds.
        step: f64,
    },
    /// "fit", or centre and half axes.
    Ellipsoid,
    /// A file of one of these endings.
    File(&'static [&'static str]),
    /// Words.
    Text,
    /// Words, separated by commas.
    Texts,
    /// Any number of numbers, separated by commas.
    List {
        /// Whether they are whole.
        whole: bool,
    },
    /// A unit of length: its name or its centimetres.
    Unit,
    /// Frames and parts of a strength.
    Envelope,
}

/// The six axes of files.
const AXES: &[&str] = &["+x", "-x", "+y", "-y", "+z", "-z"];
/// Files of hair.
pub const HAIR_FILES: &[&str] = &["hair", "tfx", "obj", "usda", "usdc", "usd", "abc"];
/// Files of surfaces.
pub const MESH_FILES: &[&str] = &["obj", "glb", "gltf", "ply", "tfxmesh", "usda", "usdc", "usd", "abc"];
/// Files of motion.
pub const MOTION_FILES: &[&str] = &["bvh", "amc", "tof", "glb", "gltf", "csv", "usda", "usdc", "usd", "abc"];

impl Setting {
    const fn new(key: &'static str, label: &'static str, unit: &'static str, kind: Kind, help: &'static str) -> Self {
        Self { key, label, unit, kind, open: None, help }
    }

    /// The same, which may be left open; `what` is taken then.
    const fn or(mut self, what: &'static str) -> Self {
        self.open = Some(what);
        self
    }
}

const fn number(
    key: &'static str,
    label: &'static str,
    unit: &'static str,
    range: [f64; 2],
    help: &'static str,
) -> Setting {
    let [least, most] = range;
    // A drag across a panel goes through an ordinary range; those without an end have steps that suit small values.
    let step = if most - least > 200.0 { 0.5 } else { (most - least) / 400.0 };
    Setting::new(key, label, unit, Kind::Number { least, most, step }, help)
}

const fn fine(
    key: &'static str,
    label: &'static str,
    unit: &'static str,
    range: [f64; 2],
    step: f64,
    help: &'static str,
) -> Setting {
    let [least, most] = range;
    Setting::new(key, label, unit, Kind::Number { least, most, step }, help)
}

const fn whole(
    key: &'static str,
    label: &'static str,
    unit: &'static str,
    range: [i64; 2],
    help: &'static str,
) -> Setting {
    Setting::new(key, label, unit, Kind::Whole { least: range[0], most: range[1] }, help)
}

const fn flag(key: &'static str, label: &'static str, help: &'static str) -> Setting {
    Setting::new(key, label, "", Kind::Flag, help)
}

const fn choice(key: &'static str, label: &'static str, words: &'static [&'static str], help: &'static str) -> Setting {
    Setting::new(key, label, "", Kind::Choice(words), help)
}

const fn vector(key: &'static str, label: &'static str, unit: &'static str, step: f64, help: &'static str) -> Setting {
    Setting::new(key, label, unit, Kind::Numbers { names: &["x", "y", "z"], step }, help)
}

const fn colour(key: &'static str, label: &'static str, linear: bool, help: &'static str) -> Setting {
    Setting::new(key, label, "", Kind::Colour { linear }, help)
}

const fn file(key: &'static str, label: &'static str, endings: &'static [&'static str], help: &'static str) -> Setting {
    Setting::new(key, label, "", Kind::File(endings), help)
}

impl Group {
    const fn new(title: &'static str, table: &'static str, help: &'static str, settings: &'static [Setting]) -> Self {
        Self { title, table, shape: Shape::Always, help, open: false, when: When::Always, settings }
    }

    /// The same, open at first.
    const fn open(mut self) -> Self {
        self.open = true;
        self
    }

    const fn shaped(mut self, shape: Shape) -> Self {
        self.shape = shape;
        self
    }

    const fn when(mut self, when: When) -> Self {
        self.when = when;
        self
    }

    /// What a new table of an optional group or list is given.
    pub fn fresh(&self) -> Option<Value> {
        match self.shape {
            Shape::Always => None,
            Shape::Optional(text) | Shape::List(text) => text.parse::<Table>().ok().map(Value::Table),
        }
    }
}

/// The value at a dotted key, with indices in brackets.
pub fn value_at<'a>(settings: &'a Table, key: &str) -> Option<&'a Value> {
    let key = key.replace('[', ".").replace(']', "");
    let mut steps = key.split('.');
    let mut value = settings.get(steps.next()?)?;
    for step in steps {
        value = match value {
            Value::Table(table) => table.get(step)?,
            Value::Array(values) => values.get(step.parse::<usize>().ok()?)?,
            _ => return None,
        };
    }
    Some(value)
}

/// The setting of a key, as an error names it, with its group: `fan[1].strength` is the strength of a fan.
pub fn find(key: &str) -> Option<(Page, &'static Group, &'static Setting)> {
    let bare: String = {
        let mut depth = 0;
        key.chars()
            .filter(|c| {
                depth += i32::from(*c == '[');
                let outside = depth == 0;
                depth -= i32::from(*c == ']');
                outside
            })
            .collect()
    };
    Page::ALL.into_iter().flat_map(|page| page.groups().iter().map(move |group| (page, group))).find_map(
        |(page, group)| {
            let rest = bare.strip_prefix(group.table)?.strip_prefix('.')?;
            let setting = group.settings.iter().find(|setting| {
                rest == setting.key || rest.strip_prefix(setting.key).is_some_and(|below| below.starts_with('.'))
            })?;
            Some((page, group, setting))
        },
    )
}

#[cfg(test)]
#[path = "settings_tests.rs"]
mod tests;
