//! Writes changed settings into the original text: only what differs is changed, so comments and layout stay.

use toml::{Table, Value};
use toml_edit::{Array, ArrayOfTables, DocumentMut, InlineTable, Item, TableLike};

/// Longest line for which a new table within a table is written in braces (characters).
const INLINE: usize = 100;

/// The meaning of missing keys: the trees of the defaults.
pub(super) struct Defaults {
    /// Without anything optional.
    pub bare: Table,
    /// With every optional table, at its own defaults.
    pub full: Table,
}

/// Writes the difference between `held`, the current meaning of `document`, and `wanted` into `document`.
pub(super) fn apply(document: &mut DocumentMut, held: &Table, wanted: &Table, defaults: &Defaults) {
    let Defaults { bare, full } = defaults;
    let context = Context { bare: Some(bare), full: Some(full), depth: 0, inline: false };
    edit_table(document.as_table_mut(), held, wanted, &context);
}

/// The surroundings of a table: its defaults, its depth, and whether it is in braces.
#[derive(Clone, Copy)]
struct Context<'a> {
    bare: Option<&'a Table>,
    full: Option<&'a Table>,
    depth: usize,
    inline: bool,
}

impl<'a> Context<'a> {
    /// The surroundings of the table at `key` of this one.
    fn below(&self, key: &str, inline: bool) -> Self {
        let table = |of: Option<&'a Table>| of?.get(key)?.as_table();
        let full = table(self.full);
        Self { bare: table(self.bare).or(full), full, depth: self.depth + 1, inline: self.inline || inline }
    }

    fn is_default(&self, key: &str, value: &Value) -> bool {
        self.bare.is_some_and(|bare| bare.get(key) == Some(value))
    }
}

fn edit_table(table: &mut dyn TableLike, held: &Table, wanted: &Table, context: &Context) {
    // Text before a closing brace belongs to the last value.
    let closing = if context.inline { set_closing(table, "") } else { None };
    edit_entries(table, held, wanted, context);
    if let Some(closing) = closing {
        set_closing(table, &closing);
    }
}

/// Sets the text after the last value of a table in braces, and returns the old one.
fn set_closing(table: &mut dyn TableLike, space: &str) -> Option<String> {
    let (_, last) = table.iter_mut().last()?;
    let decor = last.as_value_mut()?.decor_mut();
    let before = decor.suffix().and_then(|suffix| suffix.as_str()).map(str::to_owned);
    decor.set_suffix(space);
    before
}

fn edit_entries(table: &mut dyn TableLike, held: &Table, wanted: &Table, context: &Context) {
    for key in held.keys().filter(|key| !wanted.contains_key(*key)) {
        table.remove(key);
    }
    for (key, value) in wanted {
        let was = held.get(key);
        if was == Some(value) || (!table.contains_key(key) && context.is_default(key, value)) {
            continue;
        }
        match value {
            Value::Table(wanted) => edit_below(table, key, was, wanted, context),
            Value::Array(wanted) if tables(wanted).is_some() => edit_list(table, key, was, wanted, context),
            value => edit_value(table, key, value),
        }
    }
}

/// Edits the table at `key`; creates it if it is missing.
fn edit_below(table: &mut dyn TableLike, key: &str, was: Option<&Value>, wanted: &Table, context: &Context) {
    let none = Table::new();
    let held = was.and_then(Value::as_table).unwrap_or(&none);
    if let Some(below) = table.get_mut(key) {
        let inline = below.is_value();
        if let Some(below) = below.as_table_like_mut() {
            return edit_table(below, held, wanted, &context.below(key, inline));
        }
    }
    table.insert(key, new_table(wanted, &context.below(key, false)));
}

/// A table that is new in the text, without values at their defaults.
fn new_table(wanted: &Table, context: &Context) -> Item {
    let mut inline = InlineTable::new();
    edit_table(&mut inline, &Table::new(), wanted, &Context { inline: true, ..*context });
    let within = inline.iter().any(|(_, value)| value.is_inline_table());
    let short = context.depth > 1 && !within && inline.to_string().len() <= INLINE;
    if context.inline || short {
        return Item::Value(inline.into());
    }
    let mut own = toml_edit::Table::new();
    edit_table(&mut own, &Table::new(), wanted, context);
    // A header above only other headers is redundant; alone, it creates the table.
    own.set_implicit(!own.is_empty() && own.iter().all(|(_, item)| item.is_table()));
    Item::Table(own)
}

fn edit_value(table: &mut dyn TableLike, key: &str, value: &Value) {
    match table.get_mut(key).and_then(Item::as_value_mut) {
        Some(there) => *there = replaced(there, value),
        None => {
            table.insert(key, Item::Value(fresh(value)));
        }
    }
}

/// `value` as written in the place of `there`: keeps its comment, and the spelling of equal parts.
fn replaced(there: &toml_edit::Value, value: &Value) -> toml_edit::Value {
    let mut new = match (there, value) {
        (toml_edit::Value::Array(there), Value::Array(values)) if there.len() == values.len() => {
            let mut array = there.clone();
            for (there, value) in array.iter_mut().zip(values) {
                if !means(there, value) {
                    *there = replaced(there, value);
                }
            }
            toml_edit::Value::Array(array)
        }
        (toml_edit::Value::Integer(_), Value::Float(number)) => whole(*number),
        _ => fresh(value),
    };
    *new.decor_mut() = there.decor().clone();
    new
}

/// Whether a scalar of the text equals `value`.
fn means(there: &toml_edit::Value, value: &Value) -> bool {
    match (there, value) {
        (toml_edit::Value::Integer(a), Value::Float(b)) => *a.value() as f64 == *b,
        (toml_edit::Value::Float(a), Value::Float(b)) => a.value() == b,
        (toml_edit::Value::Integer(a), Value::Integer(b)) => a.value() == b,
        (toml_edit::Value::String(a), Value::String(b)) => a.value() == b,
        (toml_edit::Value::Boolean(a), Value::Boolean(b)) => a.value() == b,
        _ => false,
    }
}

/// A number without a decimal point if it needs none, like the numbers around it.
fn whole(number: f64) -> toml_edit::Value {
    // Beyond this, not every whole number fits in 64 bits with a decimal point.
    const EXACT: f64 = 9_007_199_254_740_992.0;
    if number.fract() == 0.0 && number.abs() < EXACT && !(number == 0.0 && number.is_sign_negative()) {
        (number as i64).into()
    } else {
        number.into()
    }
}

/// A value that is new in the text.
fn fresh(value: &Value) -> toml_edit::Value {
    match value {
        Value::String(text) => text.as_str().into(),
        Value::Integer(number) => (*number).into(),
        Value::Float(number) => (*number).into(),
        Value::Boolean(flag) => (*flag).into(),
        // No setting is a date.
        Value::Datetime(date) => date.to_string().into(),
        Value::Array(values) => toml_edit::Value::Array(in_lines(values.iter().map(fresh).collect())),
        Value::Table(table) => {
            table.iter().map(|(key, value)| (key.as_str(), fresh(value))).collect::<InlineTable>().into()
        }
    }
}

/// A list of lists that is too long for a line, with a line for each entry.
fn in_lines(mut list: Array) -> Array {
    if list.iter().all(toml_edit::Value::is_array) && list.to_string().len() > INLINE {
        list.iter_mut().for_each(|entry| entry.decor_mut().set_prefix("\n    "));
        list.set_trailing("\n");
        list.set_trailing_comma(true);
    }
    list
}

/// The entries of a list of tables; none for other lists, or a missing one.
fn tables(values: &[Value]) -> Option<Vec<&Table>> {
    if values.is_empty() { None } else { values.iter().map(Value::as_table).collect() }
}

/// Edits a list of tables: what both lists share at the beginning and end does not change.
fn edit_list(table: &mut dyn TableLike, key: &str, was: Option<&Value>, wanted: &[Value], context: &Context) {
    let held = was.and_then(Value::as_array).map_or(&[][..], Vec::as_slice);
    let mut entries = match table.get(key) {
        Some(Item::ArrayOfTables(list)) if list.len() == held.len() => Entries::Headers(list.iter().cloned().collect()),
        Some(Item::Value(toml_edit::Value::Array(list))) if list.len() == held.len() => Entries::Braces(list.clone()),
        // A value that was only the default is written completely.
        _ => {
            let list = wanted.iter().filter_map(Value::as_table);
            let item = if context.inline {
                Item::Value(toml_edit::Value::Array(wanted.iter().map(fresh).collect()))
            } else {
                Item::ArrayOfTables(list.map(header_table).collect())
            };
            table.insert(key, item);
            return;
        }
    };
    let alike = |pairs: &mut dyn Iterator<Item = (&Value, &Value)>| pairs.take_while(|(a, b)| a == b).count();
    let first = alike(&mut held.iter().zip(wanted));
    let last = alike(&mut held[first..].iter().rev().zip(wanted[first..].iter().rev()));
    let (before, after) = (&held[first..held.len() - last], &wanted[first..wanted.len() - last]);
    for (i, (before, after)) in before.iter().zip(after).enumerate() {
        if let (Value::Table(before), Value::Table(after)) = (before, after) {
            entries.edit(first + i, before, after);
        }
    }
    let common = before.len().min(after.len());
    for _ in common..before.len() {
        entries.remove(first + common);
    }
    for (i, added) in after.iter().enumerate().skip(common) {
        entries.insert(first + i, added);
    }
    entries.put(table, key);
}

/// The entries of a list of tables, each with a `[[header]]` or in braces.
enum Entries {
    Headers(Vec<toml_edit::Table>),
    Braces(Array),
}

impl Entries {
    fn edit(&mut self, i: usize, held: &Table, wanted: &Table) {
        let context = |inline| Context { bare: None, full: None, depth: 2, inline };
        match self {
            Self::Headers(list) => edit_table(&mut list[i], held, wanted, &context(false)),
            Self::Braces(list) => match list.get_mut(i) {
                Some(toml_edit::Value::InlineTable(entry)) => edit_table(entry, held, wanted, &context(true)),
                Some(other) => *other = fresh(&Value::Table(wanted.clone())),
                None => {}
            },
        }
    }

    fn remove(&mut self, i: usize) {
        match self {
            Self::Headers(list) => {
                list.remove(i);
            }
            Self::Braces(list) => {
                list.remove(i);
            }
        }
    }

    fn insert(&mut self, i: usize, value: &Value) {
        match self {
            Self::Headers(list) => list.insert(i, value.as_table().map(header_table).unwrap_or_default()),
            Self::Braces(list) => list.insert(i, fresh(value)),
        }
    }

    fn put(self, table: &mut dyn TableLike, key: &str) {
        let item = match self {
            Self::Headers(list) => Item::ArrayOfTables(list.into_iter().collect::<ArrayOfTables>()),
            Self::Braces(list) => Item::Value(toml_edit::Value::Array(list)),
        };
        match table.get_mut(key) {
            Some(there) => *there = item,
            None => {
                table.insert(key, item);
            }
        }
    }
}

/// A complete new entry of a list of tables.
fn header_table(entry: &Table) -> toml_edit::Table {
    entry.iter().map(|(key, value)| (key.as_str(), Item::Value(fresh(value)))).collect()
}
