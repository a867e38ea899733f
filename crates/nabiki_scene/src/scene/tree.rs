//! A scene file as a tree of TOML values with their positions, for errors.

use std::{
    collections::BTreeMap,
    path::{Path, PathBuf},
};

use nabiki::setting::Key;
use toml::{
    Table, Value,
    de::{DeTable, DeValue},
};

use serde::Serialize;

use super::error::{Problem, SceneError};

/// Where the values of a scene come from: lines of the file, or overrides.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Origins {
    /// The scene file.
    pub file: PathBuf,
    /// Line of each dotted path (`force.1.vector`).
    lines: BTreeMap<String, usize>,
    /// Text of the override that set each dotted path.
    overrides: BTreeMap<String, String>,
    /// Overrides of whole tables, each with the keys of the file that it removed.
    replaced: Vec<(String, Vec<String>)>,
}

impl Origins {
    /// An error about the value at `path` (dotted, or with indices in brackets): its file and line, or its override.
    pub fn error(&self, path: &str, problem: Problem) -> SceneError {
        let problem = Box::new(problem);
        let whole = SceneError { file: self.file.clone(), line: None, set: None, key: Key::from(path), problem };
        let dotted = dotted(path).join(".");
        let mut at = dotted.as_str();
        loop {
            if let Some(text) = self.overrides.get(at) {
                return SceneError { set: Some(text.clone()), ..whole };
            }
            if let Some(&line) = self.lines.get(at) {
                return SceneError { line: Some(line), ..whole };
            }
            // What is not in the file has the position of its table.
            match at.rsplit_once('.') {
                Some((parent, _)) => at = parent,
                None => return whole,
            }
        }
    }

    /// Whether an override set the value at a path (dotted), or a table around it.
    pub fn is_overridden(&self, path: &str) -> bool {
        self.overrides
            .keys()
            .any(|set| path.strip_prefix(set.as_str()).is_some_and(|rest| rest.is_empty() || rest.starts_with('.')))
    }

    /// Keys of the file that overrides of whole tables removed: a line each.
    pub fn replaced(&self) -> impl Iterator<Item = String> {
        let line = |(text, gone): &(String, Vec<String>)| {
            let keys = gone.join(", ");
            format!(
                "--set {text} replaces the whole table, including {keys}; set each key separately to keep the others"
            )
        };
        self.replaced.iter().map(line)
    }

    /// Records that the value at a path (dotted, or with indices in brackets) no longer comes from an override.
    pub fn set_anew(&mut self, path: &str) {
        let path = dotted(path).join(".");
        let below = format!("{path}.");
        self.overrides.retain(|at, _| *at != path && !at.starts_with(&below));
        self.replaced.clear();
    }

    /// Records that an override set the value at a path and all below it, and created the missing tables on the way.
    fn override_at(&mut self, steps: &[String], text: &str) {
        let path = steps.join(".");
        let below = format!("{path}.");
        self.lines.retain(|at, _| *at != path && !at.starts_with(&below));
        self.overrides.retain(|at, _| !at.starts_with(&below));
        for depth in 1..steps.len() {
            let table = steps[..depth].join(".");
            if !self.lines.contains_key(&table) {
                self.overrides.entry(table).or_insert_with(|| text.to_owned());
            }
        }
        self.overrides.insert(path, text.to_owned());
    }
}

/// Why TOML cannot store some settings.
#[derive(Debug)]
pub(super) struct Unwritable(pub String);

/// Settings as the tree from which they are read.
pub(super) fn table_of(settings: &impl Serialize) -> Result<Table, Unwritable> {
    // Via text, in which a number of 32 bits has only the digits that distinguish it from its neighbours.
    let text = toml::to_string(settings).map_err(|e| Unwritable(e.to_string()))?;
    text.parse().map_err(|e: toml::de::Error| Unwritable(e.message().to_owned()))
}

/// Parses a scene's text and applies the overrides in order.
///
/// An override of an entry of a list that the text does not give changes that entry of the `defaults`.
pub(crate) fn parse(
    text: &str,
    file: &Path,
    overrides: &[(String, String)],
    defaults: impl Fn() -> Table,
) -> Result<(Table, Origins), SceneError> {
    let mut origins = Origins { file: file.to_owned(), ..Origins::default() };
    let line_starts: Vec<usize> = std::iter::once(0).chain(text.match_indices('\n').map(|(i, _)| i + 1)).collect();
    let line_at = |offset: usize| line_starts.partition_point(|&start| start <= offset);
    let syntax = |e: toml::de::Error| {
        let line = e.span().map(|span| line_at(span.start));
        let mut message = e.message().split_whitespace().collect::<Vec<_>>().join(" ");
        if message == "duplicate key"
            && let Some(key) = e.span().and_then(|span| text.get(span))
        {
            message = format!("duplicate key {key}: already given above; give it once");
        }
        let written = e.span().and_then(|span| text.get(..span.start)?.rsplit('\n').next().zip(text.get(span.start..)));
        let written = written.map(|(before, after)| format!("{before}{}", after.lines().next().unwrap_or_default()));
        if written.is_some_and(|line| line.contains('\\') && line.contains('"')) {
            message += &format!("; {BACKSLASHES}");
        }
        let problem = Box::new(Problem::NotToml(message));
        SceneError { file: file.to_owned(), line, set: None, key: Key::default(), problem }
    };
    let spanned = DeTable::parse(text).map_err(syntax)?;
    record_table(spanned.get_ref(), "", &line_at, &mut origins.lines);
    let mut table: Table = toml::from_str(text).map_err(syntax)?;
    for (path, value) in overrides {
        let text = format!("{path}={value}");
        let steps = dotted(path);
        let before = look(&table, &steps).and_then(Value::as_table).cloned();
        set(&mut table, path, value, &defaults).map_err(|what| SceneError {
            file: file.to_owned(),
            line: None,
            set: Some(short(&text)),
            key: Key::default(),
            problem: Box::new(Problem::Other(what)),
        })?;
        origins.override_at(&steps, &text);
        let gone = gone(before, look(&table, &steps));
        if !gone.is_empty() {
            let key = |name: &String| format!("{}.{name}", steps.join("."));
            origins.replaced.push((text, gone.iter().map(key).collect()));
        }
    }
    Ok((table, origins))
}

/// The keys of a table that are missing in its replacement.
fn gone(before: Option<Table>, after: Option<&Value>) -> Vec<String> {
    let Some(after) = after.and_then(Value::as_table) else { return Vec::new() };
    before.into_iter().flatten().map(|(key, _)| key).filter(|key| !after.contains_key(key)).collect()
}

/// Records the line of every entry of a table.
fn record_table(table: &DeTable, path: &str, line_at: &impl Fn(usize) -> usize, lines: &mut BTreeMap<String, usize>) {
    for (key, value) in table {
        let below = if path.is_empty() { key.get_ref().to_string() } else { format!("{path}.{}", key.get_ref()) };
        lines.insert(below.clone(), line_at(key.span().start));
        record_value(value.get_ref(), &below, line_at, lines);
    }
}

fn record_value(value: &DeValue, path: &str, line_at: &impl Fn(usize) -> usize, lines: &mut BTreeMap<String, usize>) {
    match value {
        DeValue::Table(table) => record_table(table, path, line_at, lines),
        DeValue::Array(values) => {
            for (i, value) in values.iter().enumerate() {
                let below = format!("{path}.{i}");
                lines.insert(below.clone(), line_at(value.span().start));
                record_value(value.get_ref(), &below, line_at, lines);
            }
        }
        _ => {}
    }
}

/// The steps of a path, `force.1.vector` or `force[1].vector`.
fn dotted(path: &str) -> Vec<String> {
    // An index has one spelling only, by which errors find it: 0, not 00.
    let step = |step: &str| step.parse::<usize>().map_or_else(|_| step.to_owned(), |place| place.to_string());
    path.replace('[', ".").replace(']', "").split('.').map(|name| step(name.trim())).collect()
}

/// Puts `text`, a TOML value or else a string, at `path`, and creates missing tables on the way.
fn set(table: &mut Table, path: &str, text: &str, defaults: &impl Fn() -> Table) -> Result<(), String> {
    let text = text.trim();
    let value: Value = match text.parse() {
        Ok(value) => value,
        Err(_) if text.parse::<i128>().is_ok() => {
            return Err(format!("{text} is outside TOML's whole numbers, {} to {}", i64::MIN, i64::MAX));
        }
        Err(_) if begins_as_toml(text) => {
            return Err(format!("{text} is not a TOML value: write 0.5, not .5, and close each bracket and quote"));
        }
        Err(_) => Value::String(text.to_owned()),
    };
    let steps = dotted(path);
    if let Some(list) =
        (1..steps.len()).find(|&depth| steps[depth].parse::<usize>().is_ok()).map(|depth| &steps[..depth])
        && look(table, list).is_none()
        && let Some(default @ Value::Array(_)) = look(&defaults(), list)
    {
        *place(table, &list.join("."))? = default.clone();
    }
    place(table, path).map(|place| *place = value)
}

/// What helps where somebody pastes a path of Windows.
pub(crate) const BACKSLASHES: &str = r"in a path, write / or single quotes: 'C:\hair\new.obj'";

/// Whether a text that is not TOML was meant as a number, a list or a table, and not as a word without its quotes.
fn begins_as_toml(text: &str) -> bool {
    let number = text.trim_start_matches(['+', '-']).trim_start_matches('.');
    text.starts_with(['[', '{', '"', '\''])
        || (number.starts_with(|c: char| c.is_ascii_digit()) && text.parse::<f64>().is_ok())
}

/// The value at the end of `steps`.
fn look<'a>(table: &'a Table, steps: &[String]) -> Option<&'a Value> {
    let (first, rest) = steps.split_first()?;
    rest.iter().try_fold(table.get(first)?, |place, step| match place {
        Value::Array(values) => values.get(step.parse::<usize>().ok()?),
        place => place.get(step),
    })
}

/// Most steps of a path; no setting has half as many.
const DEEPEST: usize = 32;

/// The place at `path`; creates missing tables on the way.
fn place<'a>(table: &'a mut Table, path: &str) -> Result<&'a mut Value, String> {
    let steps = dotted(path);
    if steps.iter().any(String::is_empty) || path.matches('[').count() != path.matches(']').count() {
        return Err("write a key as motion.time_step or force.0.vector".to_owned());
    }
    check_depth(&steps)?;
    let mut place = table.entry(steps[0].clone()).or_insert_with(|| below(&steps, 1));
    for (depth, step) in steps.iter().enumerate().skip(1) {
        let so_far = steps[..depth].join(".");
        place = match place {
            Value::Table(table) => table.entry(step.clone()).or_insert_with(|| below(&steps, depth + 1)),
            Value::Array(values) => {
                let count = values.len();
                let index = step.parse().ok().filter(|&i: &usize| i <= count).ok_or_else(|| {
                    format!("{so_far} is a list of {count}: name an entry by a number from 0 to {count}")
                })?;
                if index == count {
                    values.push(below(&steps, depth + 1));
                }
                &mut values[index]
            }
            other => return Err(format!("{so_far} is {} {other}, which has no keys", other.type_str())),
        };
    }
    Ok(place)
}

/// Refuses a path with too many steps.
fn check_depth(steps: &[String]) -> Result<(), String> {
    if steps.len() <= DEEPEST {
        return Ok(());
    }
    Err(format!("{} nested names: no setting is nested so deep", steps.len()))
}

/// The same for a path that is not split yet.
pub(super) fn check_path(path: &str) -> Result<(), String> {
    check_depth(&dotted(path))
}

/// A path for an error: cut if it is too long to read.
pub(super) fn short(path: &str) -> String {
    const MOST: usize = 80;
    match path.char_indices().nth(MOST) {
        Some((end, _)) => format!("{}...", &path[..end]),
        None => path.to_owned(),
    }
}

/// The value at `path`.
pub(super) fn at<'a>(table: &'a Table, path: &str) -> Option<&'a Value> {
    look(table, &dotted(path))
}

/// Puts `value` at `path` and creates missing tables on the way; without a value, removes what is there.
pub(super) fn put(table: &mut Table, path: &str, value: Option<Value>) -> Result<(), String> {
    match value {
        Some(value) => place(table, path).map(|place| *place = value),
        None => {
            remove(table, &dotted(path));
            Ok(())
        }
    }
}

/// Removes what is at the end of `steps`, if anything is.
fn remove(table: &mut Table, steps: &[String]) {
    match steps {
        [] => {}
        [last] => {
            table.remove(last);
        }
        [first, rest @ ..] => match (table.get_mut(first), rest) {
            (Some(Value::Table(below)), _) => remove(below, rest),
            (Some(Value::Array(values)), [index, rest @ ..]) => {
                let Some(index) = index.parse().ok().filter(|&i: &usize| i < values.len()) else { return };
                match &mut values[index] {
                    _ if rest.is_empty() => {
                        values.remove(index);
                    }
                    Value::Table(below) => remove(below, rest),
                    _ => {}
                }
            }
            _ => {}
        },
    }
}

/// What to create for the missing part of a path.
fn below(steps: &[String], depth: usize) -> Value {
    match steps.get(depth) {
        Some(step) if step.parse::<usize>().is_ok() => Value::Array(Vec::new()),
        _ => Value::Table(Table::new()),
    }
}

/// The setting of `tree` whose path ends like `key`, but begins with a table that was forgotten.
pub(crate) fn elsewhere(tree: &Table, key: &str) -> Option<String> {
    tree.iter().find_map(|(name, value)| {
        let below = value.as_table()?;
        let there = key.split('.').try_fold(value, |value, step| value.get(step)).map(|_| key.to_owned());
        there.or_else(|| elsewhere(below, key)).map(|path| format!("{name}.{path}"))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_that_a_table_takes_out_with_the_one_before_are_said() {
        let text = "[motion]\nform = \"free\"\nframes = 10\n[[force]]\nthrough = 5\nvector = [1, 0, 0]\n";
        let said = |overrides: &[(&str, &str)]| -> Vec<String> {
            let overrides: Vec<_> = overrides.iter().map(|(key, value)| (key.to_string(), value.to_string())).collect();
            parse(text, "a.toml".as_ref(), &overrides, Table::new).unwrap().1.replaced().collect()
        };
        let gone = |override_: &str, keys: &str| {
            format!(
                "--set {override_} replaces the whole table, including {keys}; set each key separately to keep the others"
            )
        };
        assert_eq!(
            said(&[("motion", "{time_step=0.1}"), ("force[0]", "{through=5}")]),
            [
                gone("motion={time_step=0.1}", "motion.form, motion.frames"),
                gone("force[0]={through=5}", "force.0.vector")
            ]
        );
        let kept =
            [("motion", "{form=\"paper\",frames=3}"), ("motion.time_step", "0.1"), ("gust", "{}"), ("force", "[]")];
        assert_eq!(said(&kept), [""; 0]);
    }
}
