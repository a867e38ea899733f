//! Reads settings from a TOML tree, with errors that name the wrong key and a likely correction.

use std::fmt::{self, Display};

use serde::{
    de::{
        self, DeserializeSeed, Deserializer, EnumAccess, Expected, IntoDeserializer, MapAccess, SeqAccess, Unexpected,
        VariantAccess, Visitor, value::StrDeserializer,
    },
    forward_to_deserialize_any,
};
use toml::Value;

use nabiki_io::names::nearest;

use super::error::Problem;

/// A value refused while reading settings.
#[derive(Debug)]
pub(crate) struct Refusal {
    /// Keys and indices from the refused value outward.
    outward: Vec<String>,
    problem: Problem,
}

impl Refusal {
    fn new(problem: Problem) -> Self {
        Self { outward: Vec::new(), problem }
    }

    fn text(text: impl Into<String>) -> Self {
        Self::new(Problem::Other(text.into()))
    }

    /// A value out of its range.
    pub fn range(value: String, remedy: String) -> Self {
        Self::new(Problem::Range { value, remedy })
    }

    /// A key without effect in this scene.
    pub fn useless(why: &str) -> Self {
        Self::new(Problem::Useless(why.to_owned()))
    }

    /// A key that is not one of `known`.
    pub fn unknown_key(found: &str, known: impl Iterator<Item = &'static str> + Clone) -> Self {
        let near = nearest(found, known.clone()).map(str::to_owned);
        let known = known.map(str::to_owned).collect();
        Self { outward: vec![found.to_owned()], problem: Problem::UnknownKey { near, known } }
    }

    /// A value of the wrong kind.
    fn kind(found: impl Into<String>, wanted: impl Into<String>) -> Self {
        Self::new(Problem::Kind { found: found.into(), wanted: wanted.into() })
    }

    /// A list in place of a table.
    fn not_one_table(list: &[Value], wanted: &str) -> Self {
        match list {
            [Value::Table(_), ..] => {
                Self::kind("a list of tables", format!("{wanted}; in a file, write [...] instead of [[...]]"))
            }
            _ => Self::kind(words(Unexpected::Seq), wanted),
        }
    }

    /// The same with the value, if a choice of types only says what it must be.
    fn found(self, value: &Value) -> Self {
        match &self.problem {
            Problem::Other(text) if self.outward.is_empty() => match text.strip_prefix("must be ") {
                Some(wanted) => Self::kind(words(unexpected(value)), wanted),
                None => self,
            },
            _ => self,
        }
    }

    /// The same for a choice that was named without its content; `wanted` describes all choices.
    fn of_choice(self, name: &str, wanted: &str) -> Self {
        match &self.problem {
            Problem::Kind { found, .. } if found == ALONE => Self::kind(format!("\"{name}\" alone"), wanted),
            _ => self,
        }
    }

    /// The same for a value below `key`.
    pub fn below(mut self, key: impl Into<String>) -> Self {
        self.outward.push(key.into());
        self
    }

    /// The dotted path of the refused value, and the problem.
    pub fn into_parts(self) -> (String, Problem) {
        let path = join(self.outward.iter().rev());
        let problem = match self.problem {
            Problem::UnknownKey { known, near } => {
                let whole = |near: &String| join(self.outward.iter().skip(1).rev().chain([near]));
                Problem::UnknownKey { near: near.as_ref().map(whole), known }
            }
            Problem::Kind { found, wanted } => {
                let names = self.outward.iter().rev().filter(|step| !is_index(step));
                Problem::Kind { found, wanted: wanted.replace("[...]", &format!("[{}]", join(names))) }
            }
            other => other,
        };
        (path, problem)
    }
}

fn join<'a>(steps: impl Iterator<Item = &'a String>) -> String {
    let mut path = String::new();
    for step in steps {
        if is_index(step) {
            path = format!("{path}[{step}]");
        } else if path.is_empty() {
            path.push_str(step);
        } else {
            path = format!("{path}.{step}");
        }
    }
    path
}

/// Whether a step of a path is an index of a list.
fn is_index(step: &str) -> bool {
    step.bytes().all(|b| b.is_ascii_digit())
}

impl Display for Refusal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {:?}", join(self.outward.iter().rev()), self.problem)
    }
}

impl std::error::Error for Refusal {}

impl de::Error for Refusal {
    fn custom<T: Display>(text: T) -> Self {
        Self::text(text.to_string())
    }

    fn invalid_type(found: Unexpected, wanted: &dyn Expected) -> Self {
        let wanted = match (&found, plain(wanted)) {
            // TOML has no numbers above 64 bits, so the limit is that of 32 bits.
            (Unexpected::Signed(0..) | Unexpected::Unsigned(_), text) if text == AT_LEAST_0 => {
                format!("a whole number of at most {}", u32::MAX)
            }
            (_, text) => text,
        };
        Self::kind(words(found), wanted)
    }

    fn invalid_value(found: Unexpected, wanted: &dyn Expected) -> Self {
        Self::invalid_type(found, wanted)
    }

    fn invalid_length(found: usize, wanted: &dyn Expected) -> Self {
        Self::text(format!("has {}, must be {}", entries_of(found), plain(wanted)))
    }

    fn unknown_variant(found: &str, known: &'static [&'static str]) -> Self {
        let hint = nearest(found, known.iter().copied()).map(|near| format!("; did you mean \"{near}\"?"));
        Self::kind(format!("\"{found}\""), one_of(known) + &hint.unwrap_or_default())
    }

    fn unknown_field(found: &str, known: &'static [&'static str]) -> Self {
        Self::unknown_key(found, known.iter().copied())
    }

    fn missing_field(name: &'static str) -> Self {
        Self::new(Problem::Missing).below(name)
    }

    fn duplicate_field(name: &'static str) -> Self {
        Self::text("is given twice").below(name)
    }
}

fn entries_of(count: usize) -> String {
    format!("{count} {}", if count == 1 { "entry" } else { "entries" })
}

fn one_of(names: &[&str]) -> String {
    let list: Vec<String> = names.iter().map(|name| format!("\"{name}\"")).collect();
    format!("one of {}", list.join(", "))
}

/// Found: a choice given only by its name.
const ALONE: &str = "the name alone";

/// What was found, in the user's words.
fn words(found: Unexpected) -> String {
    match found {
        Unexpected::UnitVariant => ALONE.to_owned(),
        Unexpected::Seq => "a list".to_owned(),
        Unexpected::Map => "a table".to_owned(),
        Unexpected::Bool(flag) => flag.to_string(),
        Unexpected::Signed(number) => number.to_string(),
        Unexpected::Unsigned(number) => number.to_string(),
        Unexpected::Float(number) => format!("{number:?}"),
        Unexpected::Str(text) => format!("{text:?}"),
        found => found.to_string(),
    }
}

const AT_LEAST_0: &str = "a whole number of at least 0";

/// Type names of the language in the user's words.
fn plain(wanted: &dyn Expected) -> String {
    match wanted.to_string().as_str() {
        "u8" => whole_up_to(u8::MAX.into()),
        "u16" => whole_up_to(u16::MAX.into()),
        "u32" | "u64" | "usize" => AT_LEAST_0.to_owned(),
        "i8" | "i16" | "i32" | "i64" | "isize" => "a whole number".to_owned(),
        "f32" | "f64" => "a number".to_owned(),
        "a boolean" => "true or false".to_owned(),
        "a map" => "a table".to_owned(),
        "a sequence" => "a list".to_owned(),
        text if text.starts_with("struct ") => "a table".to_owned(),
        text if text.starts_with("a sequence of 2 f32") || text == "an array of length 2" => {
            "two numbers, [a, b]".to_owned()
        }
        text if text.starts_with("a sequence of 3 f32") || text == "an array of length 3" => {
            "three numbers, [x, y, z]".to_owned()
        }
        text => text.to_owned(),
    }
}

fn whole_up_to(most: u64) -> String {
    format!("a whole number, 0 to {most}")
}

fn unexpected(value: &Value) -> Unexpected<'_> {
    match value {
        Value::String(text) => Unexpected::Str(text),
        Value::Integer(number) => Unexpected::Signed(*number),
        Value::Float(number) => Unexpected::Float(*number),
        Value::Boolean(flag) => Unexpected::Bool(*flag),
        Value::Datetime(_) => Unexpected::Other("a date"),
        Value::Array(_) => Unexpected::Seq,
        Value::Table(_) => Unexpected::Map,
    }
}

/// A value of the tree.
pub(crate) struct Node<'a>(pub &'a Value);

impl<'de> IntoDeserializer<'de, Refusal> for Node<'_> {
    type Deserializer = Self;

    fn into_deserializer(self) -> Self {
        self
    }
}

impl<'de> Deserializer<'de> for Node<'_> {
    type Error = Refusal;

    fn deserialize_any<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Refusal> {
        match self.0 {
            Value::String(text) => visitor.visit_str(text),
            Value::Integer(number) => visitor.visit_i64(*number),
            // It would be stored as infinity, and refused as that.
            Value::Float(number) if number.is_finite() && !(*number as f32).is_finite() => {
                Err(Refusal::range(format!("{number:e}"), "must lie in -3.4e38..3.4e38".to_owned()))
            }
            Value::Float(number) => visitor.visit_f64(*number),
            Value::Boolean(flag) => visitor.visit_bool(*flag),
            Value::Datetime(date) => Err(Refusal::text(format!("found the date {date}: no setting is a date"))),
            Value::Array(values) => {
                let mut entries = Entries { values, next: 0 };
                let value = visitor.visit_seq(&mut entries)?;
                match entries.next {
                    read if read < values.len() => {
                        Err(Refusal::text(format!("has {}, must have {read}", entries_of(values.len()))))
                    }
                    _ => Ok(value),
                }
            }
            Value::Table(table) => visitor.visit_map(Keys { entries: table.iter(), value: None }),
        }
    }

    fn deserialize_option<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Refusal> {
        visitor.visit_some(self)
    }

    fn deserialize_newtype_struct<V: Visitor<'de>>(self, _: &'static str, visitor: V) -> Result<V::Value, Refusal> {
        visitor.visit_newtype_struct(self)
    }

    fn deserialize_enum<V: Visitor<'de>>(
        self,
        _: &'static str,
        names: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Refusal> {
        // A choice with content describes itself.
        let wanted = match plain(&visitor) {
            text if text.starts_with("enum ") => one_of(names),
            text => text,
        };
        match self.0 {
            Value::String(text) => {
                visitor.visit_enum(StrDeserializer::new(text)).map_err(|e: Refusal| e.of_choice(text, &wanted))
            }
            Value::Table(table) if table.len() == 1 => match table.iter().next() {
                Some((name, content)) => visitor.visit_enum(Variant { name, content }),
                None => Err(Refusal::text("is empty")),
            },
            other => Err(Refusal::kind(words(unexpected(other)), wanted)),
        }
    }

    fn deserialize_seq<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Refusal> {
        if self.0.is_table() {
            let wanted = "a list in brackets, even of one entry; in a file, write [[...]] above each table of a list";
            return Err(Refusal::kind(words(Unexpected::Map), wanted));
        }
        self.deserialize_any(visitor)
    }

    fn deserialize_map<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Refusal> {
        match self.0 {
            Value::Array(list) => Err(Refusal::not_one_table(list, "a table")),
            _ => self.deserialize_any(visitor),
        }
    }

    fn deserialize_struct<V: Visitor<'de>>(
        self,
        _: &'static str,
        fields: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Refusal> {
        // Serde would read an array as the fields in order.
        if let Value::Array(list) = self.0 {
            let wanted = match fields.len() {
                ..=MOST_NAMED => format!("a table {{ {} }}", fields.join(", ")),
                _ => "a table".to_owned(),
            };
            return Err(Refusal::not_one_table(list, &wanted));
        }
        self.deserialize_any(visitor)
    }

    forward_to_deserialize_any! {
        bool i8 i16 i32 i64 i128 u8 u16 u32 u64 u128 f32 f64 char str string bytes byte_buf
        unit unit_struct tuple tuple_struct identifier ignored_any
    }
}

/// A table of at most this many keys is described by them.
const MOST_NAMED: usize = 6;

/// The entries of an array.
struct Entries<'a> {
    values: &'a [Value],
    next: usize,
}

impl<'de> SeqAccess<'de> for &mut Entries<'_> {
    type Error = Refusal;

    fn next_element_seed<T: DeserializeSeed<'de>>(&mut self, seed: T) -> Result<Option<T::Value>, Refusal> {
        let Some(value) = self.values.get(self.next) else { return Ok(None) };
        let index = self.next;
        self.next += 1;
        seed.deserialize(Node(value)).map(Some).map_err(|e| e.below(index.to_string()))
    }

    fn size_hint(&self) -> Option<usize> {
        Some(self.values.len() - self.next)
    }
}

/// The entries of a table.
struct Keys<'a> {
    entries: toml::map::Iter<'a, String, Value>,
    value: Option<(&'a str, &'a Value)>,
}

impl<'de> MapAccess<'de> for Keys<'_> {
    type Error = Refusal;

    fn next_key_seed<K: DeserializeSeed<'de>>(&mut self, seed: K) -> Result<Option<K::Value>, Refusal> {
        let Some((key, value)) = self.entries.next() else { return Ok(None) };
        self.value = Some((key, value));
        seed.deserialize(StrDeserializer::new(key)).map(Some)
    }

    fn next_value_seed<V: DeserializeSeed<'de>>(&mut self, seed: V) -> Result<V::Value, Refusal> {
        let (key, value) = self.value.take().ok_or_else(|| Refusal::text("a value without a key"))?;
        seed.deserialize(Node(value)).map_err(|e| e.found(value).below(key))
    }
}

/// `name = content` as a choice that has content.
struct Variant<'a> {
    name: &'a str,
    content: &'a Value,
}

impl<'de, 'a> EnumAccess<'de> for Variant<'a> {
    type Error = Refusal;
    type Variant = Self;

    fn variant_seed<V: DeserializeSeed<'de>>(self, seed: V) -> Result<(V::Value, Self), Refusal> {
        Ok((seed.deserialize(StrDeserializer::new(self.name))?, self))
    }
}

impl<'de> VariantAccess<'de> for Variant<'_> {
    type Error = Refusal;

    fn unit_variant(self) -> Result<(), Refusal> {
        Err(Refusal::text(format!("{} takes no content: write \"{}\"", self.name, self.name)))
    }

    fn newtype_variant_seed<T: DeserializeSeed<'de>>(self, seed: T) -> Result<T::Value, Refusal> {
        seed.deserialize(Node(self.content)).map_err(|e| e.below(self.name))
    }

    fn tuple_variant<V: Visitor<'de>>(self, _: usize, visitor: V) -> Result<V::Value, Refusal> {
        Node(self.content).deserialize_any(visitor).map_err(|e| e.below(self.name))
    }

    fn struct_variant<V: Visitor<'de>>(self, _: &'static [&'static str], visitor: V) -> Result<V::Value, Refusal> {
        Node(self.content).deserialize_any(visitor).map_err(|e| e.below(self.name))
    }
}
