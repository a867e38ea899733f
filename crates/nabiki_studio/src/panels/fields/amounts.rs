//! Numbers that may have a unit of the world, one or a list from root to tip: each field works in the unit that its number has.

use eframe::egui::Ui;
use nabiki::setting::Datum;
use nabiki_scene::schema;
use toml::Value;

use super::values::{finite, number_of};
use super::{Field, name, side_by_side};
use crate::document::Phase;
use crate::panels::Commands;
use crate::panels::hands::Hands;
use crate::panels::number::Number;

/// The most that a field takes of a unit of the world.
const MOST: f64 = 1e4;

/// A number, and its unit where it has one of the world.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Amount {
    number: f64,
    unit: Option<&'static str>,
}

impl Amount {
    /// What a scene has, where it may have these units.
    fn of(value: &Value, units: &'static [&'static str]) -> Option<Self> {
        let Value::String(text) = value else {
            return number_of(value).map(|number| Self { number, unit: None });
        };
        units.iter().find_map(|unit| {
            let number = finite(text.trim().strip_suffix(unit)?.trim_end())?;
            Some(Self { number, unit: Some(unit) })
        })
    }

    /// What a new one of a unit is: hair as it is in life.
    fn usual(unit: &'static str) -> Self {
        let number = match unit {
            "cm" => 4.5,
            "s" => 0.8,
            "km/h" => 20.0,
            _ => 1.0,
        };
        Self { number, unit: Some(unit) }
    }

    fn value(self) -> Value {
        match self.unit {
            None => Value::Float(self.number),
            // As a scene keeps it, in 32 bits.
            Some(unit) => Value::String(format!("{} {unit}", self.number as f32)),
        }
    }
}

/// What fields of a setting take.
#[derive(Clone, Copy, Debug)]
pub(super) struct Taken {
    pub units: &'static [&'static str],
    pub least: f64,
    pub most: f64,
    pub step: f64,
}

impl Taken {
    fn field<'a>(&self, what: &'a str, amount: Amount) -> Number<'a> {
        let (least, most, step, unit) = match amount.unit {
            None => (self.least, self.most, self.step, ""),
            Some(unit) => (0.0, MOST, 0.01, unit),
        };
        let step = step.max(amount.number.abs() * 0.005);
        Number { range: least..=most, step, unit, ..Number::of(what) }
    }
}

/// A number, or a list of them.
fn as_value(datum: &Datum) -> Option<Value> {
    match datum {
        Datum::Number(number) => Some(Value::Float(*number)),
        Datum::List(all) => all.iter().map(as_value).collect::<Option<Vec<_>>>().map(Value::Array),
        _ => None,
    }
}

impl Field<'_> {
    /// One number.
    pub(super) fn amount(&self, ui: &mut Ui, value: Option<&Value>, taken: Taken, commands: &mut Commands) {
        let none = Amount { number: 0.0, unit: None };
        let mut amount = value.and_then(|value| Amount::of(value, taken.units)).unwrap_or(none);
        let field = taken.field(&self.key, amount);
        let unit = if amount.unit.is_some() { field.unit } else { self.setting.unit };
        let response = name(Number { unit, ..field }.ui(ui, &mut amount.number, commands), self);
        self.sent(&response, commands, amount.value());
        self.other_unit(ui, taken.units, amount.unit, commands);
    }

    /// A button to the other way of giving the setting: in a unit of the world, or as a number at its default.
    fn other_unit(&self, ui: &mut Ui, units: &[&'static str], unit: Option<&str>, commands: &mut Commands) {
        let (label, hint, value) = match (unit, units) {
            (Some(_), _) => {
                let default = schema::find(&self.key.as_str().into()).first().map(|setting| (setting.default)());
                ("#", "A number in the unit of the force, or in frames.", default.and_then(|it| as_value(&it)))
            }
            (None, [unit, ..]) => (*unit, "In a physical unit.", Some(Amount::usual(unit).value())),
            (None, []) => return,
        };
        if ui.small_button(label).hint(hint).clicked() {
            self.set(commands, value, Phase::Done);
        }
    }

    /// One number, or several from root to tip.
    pub(super) fn profile(&self, ui: &mut Ui, value: Option<&Value>, taken: Taken, commands: &mut Commands) {
        let read = |value: &Value| Amount::of(value, taken.units);
        let mut amounts: Vec<Amount> = match value {
            Some(Value::Array(values)) => values.iter().filter_map(read).collect(),
            other => other.and_then(read).into_iter().collect(),
        };
        let wrap = |amounts: &[Amount]| match amounts {
            [one] => one.value(),
            all => all.iter().map(|amount| amount.value()).collect::<Vec<_>>().into(),
        };
        let last = amounts.len().saturating_sub(1);
        let of_world = amounts.iter().find_map(|amount| amount.unit);
        let unit = if of_world.is_some() { None } else { self.unit_beside(ui, 50.0 + 47.0 * amounts.len() as f32) };
        side_by_side(ui, 44.0, |ui| {
            for i in 0..amounts.len() {
                let place = match (i, last) {
                    (_, 0) => "from root to tip",
                    (0, _) => "at the root",
                    (i, last) if i == last => "at the tip",
                    _ => "between root and tip",
                };
                let what = format!("{}, {place}", self.key);
                let field = taken.field(&what, amounts[i]);
                let response = field.ui(ui, &mut amounts[i].number, commands).hint(place);
                let response = response.accessible_name(format!("{} {}: {place}", self.group, self.setting.label));
                self.sent(&response, commands, wrap(&amounts));
            }
            unit.into_iter().for_each(|(unit, _)| drop(ui.label(unit)));
            self.other_unit(ui, taken.units, of_world, commands);
            if amounts.len() < 6 && ui.small_button("+").hint("Adds a number toward the tip.").clicked() {
                amounts.extend(amounts.last().copied());
                self.set(commands, Some(wrap(&amounts)), Phase::Done);
            }
            if amounts.len() > 1 && ui.small_button("-").hint("Removes a number.").clicked() {
                amounts.pop();
                self.set(commands, Some(wrap(&amounts)), Phase::Done);
            }
        });
    }
}
