//! Fields of settings that are lists of tables: a row for each entry.

use eframe::egui::{ComboBox, Ui};
use toml::{Table, Value};

use super::{Field, number_of};
use crate::document::Phase;
use crate::panels::Commands;
use crate::panels::hands::Hands;
use crate::panels::number::Number;

/// The entries of a list.
fn tables(value: Option<&Value>) -> Vec<Table> {
    value.and_then(Value::as_array).into_iter().flatten().filter_map(|entry| entry.as_table().cloned()).collect()
}

/// A list of these entries.
fn wrap(entries: &[Table]) -> Value {
    Value::Array(entries.iter().cloned().map(Value::Table).collect())
}

/// The fields that hair of a region may feel more or less of, by the names that the scene has for them.
fn fields_of(settings: &Table) -> Vec<String> {
    let count = |table: &str| settings.get(table).and_then(Value::as_array).map_or(0, Vec::len);
    let has_wind = count("force") > 0 || settings.contains_key("body_wind");
    let alone = [("wind", has_wind), ("turbulence", settings.contains_key("turbulence"))];
    let several = ["point", "vortex", "fan"].into_iter();
    (alone.into_iter().filter(|of| of.1).map(|of| of.0.to_owned()))
        .chain(several.flat_map(|table| (0..count(table)).map(move |i| format!("{table}[{i}]"))))
        .collect()
}

impl Field<'_> {
    /// The shares of a region in the fields.
    pub(super) fn shares(&self, ui: &mut Ui, value: Option<&Value>, commands: &mut Commands) {
        let shares = tables(value);
        let named = |share: &Table| share.get("field").and_then(Value::as_str).unwrap_or_default().to_owned();
        let there = fields_of(self.settings);
        ui.vertical(|ui| {
            for i in 0..shares.len() {
                let changed = |key: &str, to: Value| {
                    let mut shares = shares.clone();
                    shares[i].insert(key.to_owned(), to);
                    wrap(&shares)
                };
                ui.horizontal(|ui| {
                    let now = named(&shares[i]);
                    let list = ComboBox::from_id_salt((&self.key, i)).width(96.0).selected_text(&now);
                    list.show_ui(ui, |ui| {
                        for field in &there {
                            if ui.selectable_label(*field == now, field).clicked() && *field != now {
                                self.set(commands, Some(changed("field", field.clone().into())), Phase::Done);
                            }
                        }
                    });
                    let mut share = shares[i].get("share").and_then(number_of).unwrap_or_default();
                    let what = format!("{}[{i}].share", self.key);
                    let field = Number { range: 0.0..=10.0, step: 0.01, before: "x ", ..Number::of(&what) };
                    let response = field.ui(ui, &mut share, commands).hint("Factor on the force of this field.");
                    self.sent(&response, commands, changed("share", share.into()));
                    if ui.small_button("x").hint("Removes it.").clicked() {
                        let mut shares = shares.clone();
                        shares.remove(i);
                        self.set(commands, Some(wrap(&shares)), Phase::Done);
                    }
                });
            }
            // A field that has no share yet.
            let next = there.iter().find(|field| shares.iter().all(|share| named(share) != **field));
            if let Some(field) = next
                && ui.small_button("+ field").hint("A factor on one of the fields.").clicked()
            {
                let mut shares = shares.clone();
                let share = [("field".to_owned(), field.clone().into()), ("share".to_owned(), 0.3.into())];
                shares.push(share.into_iter().collect());
                self.set(commands, Some(wrap(&shares)), Phase::Done);
            }
        });
    }

    /// The keys of a strength over time.
    pub(super) fn envelope(&self, ui: &mut Ui, value: Option<&Value>, commands: &mut Commands) {
        let keys = tables(value);
        ui.vertical(|ui| {
            for i in 0..keys.len() {
                ui.horizontal(|ui| {
                    let mut frame = keys[i].get("frame").and_then(number_of).unwrap_or_default();
                    let mut factor = keys[i].get("factor").and_then(number_of).unwrap_or_default();
                    let changed = |frame: f64, factor: f64| {
                        let mut keys = keys.clone();
                        keys[i].insert("frame".to_owned(), (frame as i64).into());
                        keys[i].insert("factor".to_owned(), factor.into());
                        wrap(&keys)
                    };
                    let low = i.checked_sub(1).and_then(|i| keys[i].get("frame")?.as_integer()).map_or(0, |n| n + 1);
                    let high = keys
                        .get(i + 1)
                        .and_then(|key| key.get("frame")?.as_integer())
                        .map_or(i64::from(u32::MAX), |n| n - 1);
                    let what = ["frame", "factor"].map(|part| format!("{}[{i}].{part}", self.key));
                    let field = Number { before: "frame ", decimals: 0, ..Number::of(&what[0]) };
                    let field = Number { range: low as f64..=high as f64, ..field };
                    let response = field.ui(ui, &mut frame, commands);
                    self.sent(&response, commands, changed(frame, factor));
                    let field = Number { step: 0.01, ..Number::of(&what[1]) };
                    let response = field.ui(ui, &mut factor, commands).hint("Factor on the strength.");
                    self.sent(&response, commands, changed(frame, factor));
                    if ui.small_button("x").clicked() {
                        let mut keys = keys.clone();
                        keys.remove(i);
                        self.set(commands, Some(wrap(&keys)), Phase::Done);
                    }
                });
            }
            if ui.small_button("+ key").clicked() {
                let after = keys.last().and_then(|key| key.get("frame")?.as_integer()).map_or(0, |n| n + 10);
                let mut keys = keys.clone();
                keys.push(
                    [("frame".to_owned(), after.into()), ("factor".to_owned(), 1.0.into())].into_iter().collect(),
                );
                self.set(commands, Some(wrap(&keys)), Phase::Done);
            }
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_fields_of_a_scene_have_the_names_that_a_region_takes() {
        let scene = "[[force]]\nthrough = 5\nvector = [1, 2, 3]\n[turbulence]\n[[fan]]\nposition = [0, 0, 0]\n\
                     direction = [1, 0, 0]\n[[fan]]\nposition = [0, 0, 0]\ndirection = [1, 0, 0]\n[motion]\nform = \"free\"\n";
        let named = fields_of(&scene.parse().unwrap());
        assert_eq!(named, ["wind", "turbulence", "fan[0]", "fan[1]"]);
        // A region takes each of them.
        let shares: String = named.iter().map(|field| format!("{{ field = {field:?}, share = 0.5 }}, ")).collect();
        let with = format!("{scene}[[free.regions]]\nnear = [0, 0, 0]\nfields = [{shares}]\n");
        let scene = nabiki_scene::Scene::parse(&with, "all.toml".as_ref(), &[]).unwrap();
        let built = scene.build(nabiki_scene::Shown::First(8)).unwrap();
        assert_eq!(built.forces.field.parts(), named);
    }
}
