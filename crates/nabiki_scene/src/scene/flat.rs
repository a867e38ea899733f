//! Tables of a scene file whose keys belong to several structs: those of any head, and those of an imported one.
//!
//! Which key belongs to which is asked of serde, so that a struct's fields are the only list of them.

use serde::de::{DeserializeOwned, Deserializer, Visitor};
use serde::forward_to_deserialize_any;
use toml::{Table, Value};

use super::read::{Node, Refusal};

/// The keys that a struct reads.
pub(super) fn keys<T: DeserializeOwned>() -> &'static [&'static str] {
    let mut keys: &'static [&'static str] = &[];
    // The deserialiser returns nothing: it only records what is asked for.
    let _ = T::deserialize(Asked { keys: &mut keys });
    keys
}

/// Records the fields that a struct asks for, and refuses to return them.
struct Asked<'a> {
    keys: &'a mut &'static [&'static str],
}

impl<'de> Deserializer<'de> for Asked<'_> {
    type Error = serde::de::value::Error;

    fn deserialize_struct<V: Visitor<'de>>(
        self,
        _: &'static str,
        fields: &'static [&'static str],
        _: V,
    ) -> Result<V::Value, Self::Error> {
        *self.keys = fields;
        Err(serde::de::Error::custom("only the names are wanted"))
    }

    fn deserialize_any<V: Visitor<'de>>(self, _: V) -> Result<V::Value, Self::Error> {
        Err(serde::de::Error::custom("not a struct"))
    }

    forward_to_deserialize_any! {
        bool i8 i16 i32 i64 i128 u8 u16 u32 u64 u128 f32 f64 char str string bytes byte_buf option newtype_struct
        unit unit_struct seq tuple tuple_struct map enum identifier ignored_any
    }
}

/// Reads a table that holds the keys of `A` and of `B`. A key of `useless` is refused with its reason, any other as
/// unknown.
pub(super) fn read<A, B>(table: &Table, useless: &[&str], why: &str) -> Result<(A, B), Refusal>
where
    A: DeserializeOwned,
    B: DeserializeOwned,
{
    let (of_a, of_b) = (keys::<A>(), keys::<B>());
    let (mut a, mut b) = (Table::new(), Table::new());
    for (key, value) in table {
        if of_a.contains(&key.as_str()) {
            a.insert(key.clone(), value.clone());
        } else if of_b.contains(&key.as_str()) {
            b.insert(key.clone(), value.clone());
        } else if useless.contains(&key.as_str()) {
            return Err(Refusal::useless(why).below(key));
        } else {
            return Err(Refusal::unknown_key(key, of_b.iter().chain(of_a).copied()));
        }
    }
    Ok((A::deserialize(Node(&Value::Table(a)))?, B::deserialize(Node(&Value::Table(b)))?))
}
