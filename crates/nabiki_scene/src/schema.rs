//! The schema of scenes: all tables and settings of a scene file, as data from the declarations of the structs.
//!
//! [`TABLES`] has the tables with their settings. [`json`] is the same as a JSON Schema (draft 2020-12), with which
//! editors complete and check scene files. In addition to the standard keywords it has `x-unit`, the unit of a number;
//! `x-units`, those of a text with number and unit; and `x-open`, what applies if a setting is left out.

use std::fmt::Write;

use nabiki::body::Contact;
use nabiki::disturbance::Disturbance;
use nabiki::dynamics::Motion;
use nabiki::field::{BodyWind, Fan, Flow, Gust, Point, Turbulence, Vortex, Wind};
use nabiki::free_form::NeighbourForces;
use nabiki::pseudo_force::PseudoForce;
use nabiki::setting::{Datum, Key, Kind, Range, Setting, Settings, Step, Table, plain};
use nabiki_render::Picture;

use crate::scene::{
    AimSettings, AnyHair, AnyHead, BodySettings, BuiltinHead, ForceSettings, FormKey, FreeSettings, GrownHair,
    ImportedHair, ImportedHead, Output,
};

/// A table at the top of a scene file.
#[derive(Debug)]
pub struct SceneTable {
    /// Its name.
    pub key: &'static str,
    /// How often it may occur.
    pub occurs: Occurs,
    /// Its purpose, in a sentence.
    pub help: &'static str,
    /// Its settings. If there are several kinds, a table is of one of them.
    pub kinds: &'static [Table],
    /// Settings common to all kinds.
    pub shared: Option<Table>,
}

/// How often a table occurs in a scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Occurs {
    /// Always, whether given or not.
    Always,
    /// Only if it is given.
    IfGiven,
    /// As often as it is given, like `[[force]]`.
    ManyTimes,
}

impl SceneTable {
    const fn of(key: &'static str, occurs: Occurs, kinds: &'static [Table]) -> Self {
        Self { key, occurs, help: kinds[0].help, kinds, shared: None }
    }

    const fn sharing(mut self, shared: Table, help: &'static str) -> Self {
        self.shared = Some(shared);
        self.help = help;
        self
    }

    /// The settings of all kinds, common ones first.
    pub fn settings(&self) -> impl Iterator<Item = &'static Setting> {
        self.shared.iter().chain(self.kinds).flat_map(|table| table.settings)
    }
}

use Occurs::{Always, IfGiven, ManyTimes};

/// All tables, in the order of a file.
pub const TABLES: &[SceneTable] = &[
    SceneTable::of("head", Always, &[BuiltinHead::TABLE, ImportedHead::TABLE])
        .sharing(AnyHead::TABLE, "The head that hair grows on: the built-in bust, or a mesh from a file."),
    SceneTable::of("hair", Always, &[GrownHair::TABLE, ImportedHair::TABLE])
        .sharing(AnyHair::TABLE, "The hair at rest. It grows from the scalp, or comes from a file if you give `file`."),
    SceneTable::of("motion", Always, &[Motion::TABLE]).sharing(FormKey::TABLE, Motion::TABLE.help),
    SceneTable::of("free", Always, &[FreeSettings::TABLE]),
    SceneTable::of("contact", Always, &[Contact::TABLE]),
    SceneTable::of("body", ManyTimes, &[BodySettings::TABLE]),
    SceneTable::of("aim", ManyTimes, &[AimSettings::TABLE]),
    SceneTable::of("neighbours", IfGiven, &[NeighbourForces::TABLE]),
    SceneTable::of("pseudo_force", Always, &[PseudoForce::TABLE]),
    SceneTable::of("force", ManyTimes, &[ForceSettings::TABLE]),
    SceneTable::of("wind", Always, &[Wind::TABLE]),
    SceneTable::of("gust", IfGiven, &[Gust::TABLE]),
    SceneTable::of("body_wind", IfGiven, &[BodyWind::TABLE]),
    SceneTable::of("flow", IfGiven, &[Flow::TABLE]),
    SceneTable::of("turbulence", IfGiven, &[Turbulence::TABLE]),
    SceneTable::of("point", ManyTimes, &[Point::TABLE]),
    SceneTable::of("vortex", ManyTimes, &[Vortex::TABLE]),
    SceneTable::of("fan", ManyTimes, &[Fan::TABLE]),
    SceneTable::of("disturbance", IfGiven, &[Disturbance::TABLE]),
    SceneTable::of("picture", Always, &[Picture::TABLE]),
    SceneTable::of("output", Always, &[Output::TABLE]),
];

/// The declarations of a setting, named as in an error: `fan[1].strength`. Several if a table has several kinds. Empty
/// for a top-level table or an unknown name.
pub fn find(key: &Key) -> Vec<&'static Setting> {
    let names: Vec<&str> = key.steps().iter().filter_map(Step::name).collect();
    let [table, names @ ..] = names.as_slice() else { return Vec::new() };
    let Some(table) = TABLES.iter().find(|known| known.key == *table) else { return Vec::new() };
    let mut found: Vec<&'static Setting> = Vec::new();
    for (depth, name) in names.iter().enumerate() {
        found = match depth {
            0 => table.settings().filter(|setting| setting.key == *name).collect(),
            _ => {
                let tables = found.iter().flat_map(|setting| tables(&setting.kind));
                tables.flat_map(|table| table.settings).filter(|setting| setting.key == *name).collect()
            }
        };
    }
    found
}

/// The tables of a setting that is a table or a list of tables.
pub fn tables(kind: &Kind) -> Vec<&'static Table> {
    match *kind {
        Kind::Table(table) => vec![table],
        Kind::List(kind) => tables(kind),
        Kind::OneOf(kinds) => kinds.iter().flat_map(tables).collect(),
        _ => Vec::new(),
    }
}

/// All settings, one per line, for reading and searching: key, default, unit, range and the first paragraph of the
/// help.
pub fn text() -> String {
    let mut text = String::new();
    for table in TABLES {
        for setting in table.settings() {
            lines(&format!("{}.{}", table.key, setting.key), setting, &mut text);
        }
    }
    text
}

fn lines(key: &str, setting: &Setting, text: &mut String) {
    for below in tables(&setting.kind).into_iter().flat_map(|table| table.settings) {
        lines(&format!("{key}.{}", below.key), below, text);
    }
    if matches!(setting.kind, Kind::Table(_)) {
        return;
    }
    let value = match ((setting.default)(), setting.open) {
        _ if setting.must.is_some() => "must be given".to_owned(),
        (Datum::Open, open) => format!("default: {}", open.unwrap_or("none")),
        (value, _) => format!("default {}", in_toml(&value)),
    };
    let range = setting.range.to_string();
    let notes = [setting.range.unit, &range, &value].into_iter().filter(|note| !note.is_empty());
    let help = plain(setting.help);
    let help = help.split("\n\n").next().unwrap_or_default();
    let _ = writeln!(text, "{key} ({}): {help}", notes.collect::<Vec<_>>().join("; "));
}

/// A value as written in a scene file.
pub fn in_toml(value: &Datum) -> String {
    match value {
        Datum::Open => String::new(),
        Datum::Flag(flag) => flag.to_string(),
        Datum::Whole(number) => number.to_string(),
        Datum::Number(number) => number.to_string(),
        Datum::Text(text) => toml::Value::String(text.clone()).to_string(),
        Datum::List(values) => format!("[{}]", values.iter().map(in_toml).collect::<Vec<_>>().join(", ")),
        Datum::Table(entries) => {
            let there = entries.iter().filter(|(_, value)| *value != Datum::Open);
            let entries = there.map(|(key, value)| format!("{key} = {}", in_toml(value)));
            format!("{{ {} }}", entries.collect::<Vec<_>>().join(", "))
        }
    }
}

/// The JSON Schema, as data to write as JSON.
pub fn json() -> Datum {
    let mut defs = Vec::new();
    let tables = TABLES.iter().map(|table| (table.key, scene_table(table, &mut defs))).collect();
    Datum::Table(vec![
        ("$schema", word("https://json-schema.org/draft/2020-12/schema")),
        ("title", word("A scene of Nabiki")),
        ("type", word("object")),
        ("additionalProperties", Datum::Flag(false)),
        ("properties", Datum::Table(tables)),
        ("$defs", Datum::Table(defs)),
    ])
}

fn word(text: &str) -> Datum {
    Datum::Text(text.to_owned())
}

/// A table at the top; its kinds go to `defs`.
fn scene_table(table: &SceneTable, defs: &mut Vec<(&'static str, Datum)>) -> Datum {
    let shared = table.shared.as_ref().map_or(&[][..], |shared| shared.settings);
    for kind in table.kinds {
        define(kind, shared, defs);
    }
    let kinds: Vec<Datum> = table.kinds.iter().map(|kind| Datum::Table(vec![reference(kind)])).collect();
    let mut entries = vec![("description", Datum::Text(plain(table.help)))];
    match table.occurs {
        ManyTimes => {
            entries.extend([("type", word("array")), ("items", kinds.into_iter().next().unwrap_or(Datum::Open))])
        }
        _ if kinds.len() > 1 => entries.push(("anyOf", Datum::List(kinds))),
        _ => entries.push(reference(&table.kinds[0])),
    }
    if table.occurs == Always {
        entries.push(("default", Datum::Table(Vec::new())));
    }
    Datum::Table(entries)
}

fn reference(table: &Table) -> (&'static str, Datum) {
    ("$ref", Datum::Text(format!("#/$defs/{}", table.name)))
}

/// Adds a struct to the definitions, after those that it contains.
fn define(table: &Table, shared: &'static [Setting], defs: &mut Vec<(&'static str, Datum)>) {
    if defs.iter().any(|(name, _)| *name == table.name) {
        return;
    }
    let settings = || shared.iter().chain(table.settings);
    for below in settings().flat_map(|setting| tables(&setting.kind)) {
        define(below, &[], defs);
    }
    let must: Vec<Datum> =
        settings().filter(|setting| setting.must.is_some()).map(|setting| word(setting.key)).collect();
    let mut entries = vec![
        ("description", Datum::Text(plain(table.help))),
        ("type", word("object")),
        ("additionalProperties", Datum::Flag(false)),
        ("properties", Datum::Table(settings().map(|setting| (setting.key, property(setting))).collect())),
    ];
    if !must.is_empty() {
        entries.push(("required", Datum::List(must)));
    }
    defs.push((table.name, Datum::Table(entries)));
}

fn property(setting: &Setting) -> Datum {
    let mut entries = vec![("title", word(setting.label)), ("description", Datum::Text(plain(setting.help)))];
    entries.extend(kind(&setting.kind, &setting.range));
    if !setting.range.unit.is_empty() {
        entries.push(("x-unit", word(setting.range.unit)));
    }
    if let Some(open) = setting.open {
        entries.push(("x-open", word(open)));
    }
    match (setting.default)() {
        Datum::Open => {}
        _ if setting.must.is_some() || matches!(setting.kind, Kind::Table(_)) => {}
        default => entries.push(("default", default)),
    }
    Datum::Table(entries)
}

fn kind(kind: &Kind, range: &Range) -> Vec<(&'static str, Datum)> {
    let within = |entries: &mut Vec<(&'static str, Datum)>, as_whole: bool| {
        let number = |bound: f64| if as_whole { Datum::Whole(bound as i64) } else { Datum::Number(bound) };
        let bounds = [("exclusiveMinimum", range.above), ("minimum", range.least), ("maximum", range.most)];
        entries.extend(bounds.into_iter().filter_map(|(name, bound)| Some((name, number(bound?)))));
    };
    let list = |of: &Kind| ("items", Datum::Table(self::kind(of, range)));
    let several = |of: Kind, count: usize| {
        let count = Datum::Whole(count as i64);
        vec![("type", word("array")), list(&of), ("minItems", count.clone()), ("maxItems", count)]
    };
    match *kind {
        Kind::Flag => vec![("type", word("boolean"))],
        Kind::Number => {
            let mut entries = vec![("type", word("number"))];
            within(&mut entries, false);
            entries
        }
        Kind::Whole { least, .. } => {
            let mut entries = vec![("type", word("integer"))];
            within(&mut entries, true);
            if range.least.is_none() {
                entries.push(("minimum", Datum::Whole(least)));
            }
            entries
        }
        Kind::Text => vec![("type", word("string"))],
        Kind::Path => vec![("type", word("string")), ("format", word("path"))],
        Kind::Words(words) => {
            let mut entries = vec![("enum", Datum::List(words.iter().map(|known| word(known.word)).collect()))];
            if words.iter().any(|word| !word.help.is_empty()) {
                let help = words.iter().map(|word| Datum::Text(plain(word.help))).collect();
                entries.push(("enumDescriptions", Datum::List(help)));
            }
            entries
        }
        Kind::Quantity(units) => {
            let pattern = format!(r"^\d*\.?\d+(e[+-]?\d+)? ?({})$", units.join("|"));
            let units = units.iter().map(|unit| word(unit)).collect();
            vec![("type", word("string")), ("pattern", Datum::Text(pattern)), ("x-units", Datum::List(units))]
        }
        Kind::Numbers(count) => several(Kind::Number, count),
        Kind::Wholes(count) => several(Kind::Whole { least: 0, most: i64::from(u32::MAX) }, count),
        Kind::List(of) => vec![("type", word("array")), list(of)],
        Kind::Table(table) => vec![reference(table)],
        Kind::OneOf(kinds) => {
            vec![("anyOf", Datum::List(kinds.iter().map(|of| Datum::Table(self::kind(of, range))).collect()))]
        }
    }
}
