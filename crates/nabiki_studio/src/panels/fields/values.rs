//! Values of settings, as fields take them and give them.

use toml::Value;

/// The number that a word is, if it has an end.
pub fn finite(word: &str) -> Option<f64> {
    word.parse().ok().filter(|number: &f64| number.is_finite())
}

/// A number, whole or not.
pub fn number_of(value: &Value) -> Option<f64> {
    value.as_float().or_else(|| value.as_integer().map(|whole| whole as f64))
}

/// A colour's channels.
pub fn rgb_of(value: Option<&Value>) -> [f32; 3] {
    let mut channels = value.and_then(Value::as_array).into_iter().flatten().filter_map(number_of);
    std::array::from_fn(|_| channels.next().unwrap_or_default() as f32)
}

/// A colour as a setting has it.
pub fn rgb_value(rgb: [f32; 3]) -> Value {
    rgb.map(|c| Value::Float((f64::from(c) * 1e4).round() / 1e4)).to_vec().into()
}

/// A table of these entries.
pub fn table<const N: usize>(entries: [(&str, Value); N]) -> Value {
    Value::Table(entries.into_iter().map(|(key, value)| (key.to_owned(), value)).collect())
}
