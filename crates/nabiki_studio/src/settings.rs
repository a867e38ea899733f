//! The pages of the panels: which settings stand together, in which order. What each may be, its name, unit and help are those of the
//! scene's schema; a setting that no group names comes last in the last group of its table.

mod declare;
mod hair;
mod head;
mod motion;
mod picture;
mod wind;

use std::collections::HashMap;
use std::sync::OnceLock;

use nabiki::setting as declared;
use nabiki_scene::schema;
use toml::{Table, Value};

use declare::{is_table, setting};

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
    /// The keys of what is in it, in order.
    keys: &'static [&'static str],
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

/// A setting as a page shows it.
#[derive(Debug)]
pub struct Row {
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
    /// What it does, in a paragraph.
    pub help: String,
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
    /// A number, or a list of them from root to tip.
    Profile {
        /// Units of the world that each may have.
        units: &'static [&'static str],
        /// At least this, at least 0.
        least: f64,
        /// At most this.
        most: f64,
        /// What a drag by one point adds.
        step: f64,
    },
    /// A number of at least 0.
    Amount {
        /// Units of the world that it may have.
        units: &'static [&'static str],
        /// At most this.
        most: f64,
        /// What a drag by one point adds.
        step: f64,
    },
    /// A number of at least 0 with one of these units.
    Quantity {
        /// The units.
        units: &'static [&'static str],
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
    /// Fields of the scene and factors on them.
    Shares,
    /// What a tool of the view draws, so many of these: it is counted, and can be removed.
    Drawn(&'static str),
}

/// Files of hair.
pub const HAIR_FILES: &[&str] = &["hair", "tfx", "obj", "usda", "usdc", "usd", "abc"];
/// Files of surfaces.
pub const MESH_FILES: &[&str] = &["obj", "glb", "gltf", "fbx", "ply", "tfxmesh", "usda", "usdc", "usd", "abc"];
/// Files of motion.
pub const MOTION_FILES: &[&str] =
    &["bvh", "amc", "tof", "glb", "gltf", "fbx", "csv", "usda", "usdc", "usd", "abc", "pc2", "mdd"];
/// Files of shapes that hair is led to.
pub const AIM_FILES: &[&str] = &["usda", "usdc", "usd", "abc", "nabiki", "hair", "tfx", "obj"];

impl Group {
    const fn new(title: &'static str, table: &'static str, help: &'static str, keys: &'static [&'static str]) -> Self {
        Self { title, table, shape: Shape::Always, help, open: false, when: When::Always, keys }
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

    /// What is in it.
    pub fn settings(&self) -> &'static [Row] {
        static OF_GROUPS: OnceLock<HashMap<(&str, &str), Vec<Row>>> = OnceLock::new();
        let all = || Page::ALL.into_iter().flat_map(Page::groups);
        let made = || all().map(|group| ((group.title, group.table), group.make(all()))).collect();
        OF_GROUPS.get_or_init(made).get(&(self.title, self.table)).map_or(&[], Vec::as_slice)
    }

    /// Its settings out of the schema; `all` groups, since the last of a table takes what no other names.
    fn make(&self, all: impl DoubleEndedIterator<Item = &'static Self> + Clone) -> Vec<Row> {
        let mut settings: Vec<Row> = self.keys.iter().filter_map(|key| self.declared(key)).collect();
        let last = all.clone().rev().find(|group| group.table == self.table);
        if last.is_some_and(|last| last.title == self.title) {
            let named = |key: &str| all.clone().any(|group| group.table == self.table && group.keys.contains(&key));
            for left in self.declared_keys().filter(|key| !named(key)) {
                settings.extend(self.declared(left).filter(|_| !settings.iter().any(|setting| setting.key == left)));
            }
        }
        settings
    }

    /// Every key that the schema has of its table, but for tables, which are groups of their own.
    fn declared_keys(&self) -> impl Iterator<Item = &'static str> {
        let top = schema::TABLES.iter().filter(|table| table.key == self.table).flat_map(schema::SceneTable::settings);
        let inner = schema::find(&self.table.into()).into_iter().flat_map(|setting| schema::tables(&setting.kind));
        let settings = top.chain(inner.flat_map(|table| table.settings));
        settings.filter(|setting| !is_table(&setting.kind)).map(|setting| setting.key)
    }

    /// The setting of a key as the schema has it.
    fn declared(&self, key: &'static str) -> Option<Row> {
        let found = schema::find(&format!("{}.{key}", self.table).into());
        // Of hair that is grown and hair from a file each has its own; a head's mesh may be a file.
        let file = found.iter().find(|setting| matches!(setting.kind, declared::Kind::Path));
        let of_kind = if self.when == When::Imported { found.last() } else { found.first() };
        file.or(of_kind).map(|found| setting(self.table, key, found))
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
pub fn find(key: &str) -> Option<(Page, &'static Group, &'static Row)> {
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
            let setting = group.settings().iter().find(|setting| {
                rest == setting.key || rest.strip_prefix(setting.key).is_some_and(|below| below.starts_with('.'))
            })?;
            Some((page, group, setting))
        },
    )
}

#[cfg(test)]
#[path = "settings_tests.rs"]
mod tests;
