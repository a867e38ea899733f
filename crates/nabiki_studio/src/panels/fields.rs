//! One setting as a field.

mod amounts;
mod lists;
mod values;

use eframe::egui::{self, Response, Ui};
use nabiki_render::colour;
use nabiki_render::settings::HairLook;
use nabiki_render::tone_mapping::srgb_from_linear;
use toml::{Table, Value};

use super::hands::Hands;
use super::number::Number;
use super::{Commands, theme};
use crate::command::Command;
use crate::dialog::{Chooser, Dialog, Purpose, as_folder};
use crate::document::Phase;
use crate::settings::{Kind, Row, value_at};
use amounts::Taken;
pub use values::number_of;
use values::{finite, rgb_of, rgb_value, table};

/// Width of the names beside the fields (points).
const NAMES: f32 = 96.0;

/// What a field of many numbers wants.
const NUMBERS: &str = "numbers separated by commas";

/// A name and a field beside it.
pub fn row<R>(ui: &mut Ui, label: &str, help: &str, marked: bool, field: impl FnOnce(&mut Ui) -> R) -> R {
    row_of(ui, NAMES, label, help, marked, field)
}

/// The same with so many points for the name.
pub fn row_of<R>(
    ui: &mut Ui,
    names: f32,
    label: &str,
    help: &str,
    marked: bool,
    field: impl FnOnce(&mut Ui) -> R,
) -> R {
    ui.horizontal(|ui| {
        let height = ui.spacing().interact_size.y;
        let ink = if marked { theme::WRONG } else { theme::FAINT };
        // Painted, so that all fields begin at one place however long their names are.
        let (rect, response) = ui.allocate_exact_size(egui::vec2(names, height), egui::Sense::hover());
        let font = egui::TextStyle::Body.resolve(ui.style());
        let within = ui.painter().with_clip_rect(rect.intersect(ui.clip_rect()));
        within.text(rect.left_center(), egui::Align2::LEFT_CENTER, label, font, ink);
        response.hint(help);
        field(ui)
    })
    .inner
}

/// Fields beside each other, each as wide as its number and so many points at least; those for which there is no room begin
/// another line.
pub fn side_by_side<R>(ui: &mut Ui, least: f32, fields: impl FnOnce(&mut Ui) -> R) -> R {
    ui.horizontal_wrapped(|ui| {
        ui.spacing_mut().item_spacing.x = 3.0;
        ui.spacing_mut().button_padding.x = 2.0;
        ui.spacing_mut().interact_size.x = least;
        fields(ui)
    })
    .inner
}

/// What a field sends when it was touched.
pub fn send(response: &Response, commands: &mut Commands, make: impl FnOnce(Phase) -> Command) {
    if response.changed() {
        commands.push(make(if response.dragged() { Phase::Dragging } else { Phase::Done }));
    }
    if response.drag_stopped() {
        commands.push(Command::EndDrag);
    }
}

/// The field of one setting, with its name.
pub struct Field<'a> {
    /// The setting.
    pub setting: &'a Row,
    /// Its whole key.
    pub key: String,
    /// Its value.
    pub value: Option<&'a Value>,
    /// The title of its group, for who does not see it.
    pub group: &'a str,
    /// What it comes to in its own unit, where it is given in one of the world.
    pub comes_to: Option<String>,
    /// Whether it is to blame for an error.
    pub blamed: bool,
    /// All settings of the scene.
    pub settings: &'a Table,
    /// The folder of the scene, from which paths lead.
    pub folder: &'a std::path::Path,
}

impl Field<'_> {
    /// Draws it.
    pub fn ui(&self, ui: &mut Ui, commands: &mut Commands) {
        let Row { label, unit, kind, open, help, .. } = self.setting;
        let comes_to = self.comes_to.as_ref().map(|told| format!("\nNow {told}.")).unwrap_or_default();
        let help = format!("{help}{}{comes_to}\n\n{}", range_text(*kind, unit), self.key);
        row(ui, label, &help, self.blamed, |ui| match (open, self.value) {
            (Some(what), None) => self.left_open(ui, what, commands),
            (open, value) => {
                self.field(ui, value, commands);
                if open.is_some()
                    && ui.small_button("x").hint("Clears the value, so that the default applies.").clicked()
                {
                    self.set(commands, None, Phase::Done);
                }
            }
        });
    }

    /// A setting that is left open says what is taken instead. It has a value of its own once one is typed or chosen: a click alone
    /// gives it none.
    fn left_open(&self, ui: &mut Ui, what: &'static str, commands: &mut Commands) {
        match self.setting.kind {
            Kind::Choice(words) => choose(ui, self, what, words, commands, |word| Value::String(word.to_owned())),
            Kind::Number { least, most, .. } => {
                let field = Number { range: least..=most, ..Number::of(&self.key) };
                self.typed(ui, what, commands, |text| field.typed(text).map(Value::Float));
            }
            Kind::Whole { least, most } => {
                let field = Number { range: least as f64..=most as f64, decimals: 0, ..Number::of(&self.key) };
                self.typed(ui, what, commands, |text| field.typed(text).map(|whole| Value::Integer(whole as i64)));
            }
            Kind::Numbers { names, .. } => {
                let count = names.len();
                self.typed(ui, what, commands, |text| {
                    let words = text.split([',', ' ']).filter(|word| !word.is_empty());
                    let numbers: Option<Vec<f64>> = words.map(finite).collect();
                    let numbers = numbers.filter(|numbers| numbers.len() == count);
                    let wanted = || format!("{count} {NUMBERS}");
                    Ok(numbers.ok_or_else(wanted)?.into_iter().map(Value::Float).collect::<Vec<_>>().into())
                });
            }
            _ => self.field(ui, None, commands),
        }
    }

    fn set(&self, commands: &mut Commands, value: Option<Value>, phase: Phase) {
        commands.push(Command::Set { key: self.key.clone(), value, phase });
    }

    fn sent(&self, response: &Response, commands: &mut Commands, value: Value) {
        send(response, commands, |phase| Command::Set { key: self.key.clone(), value: Some(value), phase });
    }

    fn field(&self, ui: &mut Ui, value: Option<&Value>, commands: &mut Commands) {
        let unit = self.setting.unit;
        let wide = ui.available_width().max(60.0);
        match self.setting.kind {
            Kind::Number { least, most, step } => {
                let mut number = value.and_then(number_of).unwrap_or_default();
                let wide = Some(wide.min(110.0));
                let field = Number { range: least..=most, step, unit, wide, ..Number::of(&self.key) };
                let response = name(field.ui(ui, &mut number, commands), self);
                self.sent(&response, commands, Value::Float(number));
            }
            Kind::Whole { least, most } => {
                let mut number = value.and_then(number_of).unwrap_or_default();
                let step = (number.abs() * 0.005).clamp(0.1, 1e4);
                let (range, wide) = (least as f64..=most as f64, Some(wide.min(110.0)));
                let field = Number { range, step, unit, wide, decimals: 0, ..Number::of(&self.key) };
                let response = name(field.ui(ui, &mut number, commands), self);
                self.sent(&response, commands, Value::Integer(number as i64));
            }
            Kind::Flag => {
                let mut flag = value.and_then(Value::as_bool).unwrap_or_default();
                let response = name(ui.checkbox(&mut flag, ""), self);
                self.sent(&response, commands, Value::Boolean(flag));
            }
            Kind::Choice(words) => {
                let now = value.and_then(Value::as_str).unwrap_or_default();
                choose(ui, self, now, words, commands, |word| Value::String(word.to_owned()));
            }
            Kind::Numbers { names, step } => {
                self.numbers(ui, value, names, commands, Number { step, ..Number::of(&self.key) }, Value::Float)
            }
            Kind::Wholes { names, least, most } => self.numbers(
                ui,
                value,
                names,
                commands,
                Number { range: least as f64..=most as f64, decimals: 0, ..Number::of(&self.key) },
                |number| Value::Integer(number as i64),
            ),
            Kind::Colour { linear } => self.colour(ui, value, linear, commands),
            Kind::HairColour => self.hair_colour(ui, value, commands),
            Kind::Profile { units, least, most, step } => {
                self.profile(ui, value, Taken { units, least, most, step }, commands);
            }
            Kind::Amount { units, most, step } => {
                self.amount(ui, value, Taken { units, least: 0.0, most, step }, commands)
            }
            Kind::Ellipsoid => self.ellipsoid(ui, value, commands),
            Kind::File(endings) => self.file(ui, value, endings, commands),
            // Of intervals, which have fields of their own.
            Kind::Text | Kind::Quantity { .. } => {
                self.text(ui, value.and_then(Value::as_str).unwrap_or_default().to_owned(), commands, |text| {
                    Ok(Value::String(text.to_owned()))
                })
            }
            Kind::Texts => {
                let words = value.and_then(Value::as_array).into_iter().flatten().filter_map(Value::as_str);
                self.text(ui, words.collect::<Vec<_>>().join(", "), commands, |text| {
                    let words = text.split(',').map(str::trim).filter(|word| !word.is_empty());
                    Ok(words.map(|word| Value::String(word.to_owned())).collect::<Vec<_>>().into())
                });
            }
            Kind::List { whole } => {
                let numbers = value.and_then(Value::as_array).into_iter().flatten().map(Value::to_string);
                self.text(ui, numbers.collect::<Vec<_>>().join(", "), commands, |text| {
                    let words = text.split([',', ' ']).map(str::trim).filter(|word| !word.is_empty());
                    let number = |word: &str| match whole {
                        true => word.parse().ok().map(Value::Integer),
                        false => finite(word).map(Value::Float),
                    };
                    let wanted = if whole { "whole numbers separated by commas" } else { NUMBERS };
                    words.map(number).collect::<Option<Vec<_>>>().map(Value::Array).ok_or(wanted)
                });
            }
            Kind::Unit => {
                let now = value.map_or(String::new(), |value| match value {
                    Value::String(name) => name.clone(),
                    other => format!("{other}"),
                });
                self.text(ui, now, commands, |text| {
                    Ok(finite(text).map_or_else(|| Value::String(text.to_owned()), Value::Float))
                });
            }
            Kind::Envelope => self.envelope(ui, value, commands),
            Kind::Shares => self.shares(ui, value, commands),
            Kind::Drawn(one) => {
                let count = value.and_then(Value::as_array).map_or(0, Vec::len);
                let words = match count {
                    0 => "none".to_owned(),
                    1 => format!("1 {one}"),
                    _ => format!("{count} {one}s"),
                };
                ui.label(theme::faint(words));
                if count > 0 && ui.small_button("x").hint("Removes them.").clicked() {
                    self.set(commands, None, Phase::Done);
                }
            }
        }
    }

    fn numbers(
        &self,
        ui: &mut Ui,
        value: Option<&Value>,
        names: &[&str],
        commands: &mut Commands,
        field: Number<'_>,
        wrap: impl Fn(f64) -> Value,
    ) {
        let mut numbers: Vec<f64> =
            value.and_then(Value::as_array).into_iter().flatten().filter_map(number_of).collect();
        numbers.resize(names.len(), 0.0);
        let count = names.len() as f32;
        let unit = self.unit_beside(ui, 22.0 + count * 43.0);
        let room = ui.available_width() - 22.0 - unit.as_ref().map_or(0.0, |(_, wide)| *wide);
        let wide = (room / count - 3.0).clamp(30.0, 64.0);
        side_by_side(ui, wide, |ui| {
            for i in 0..names.len() {
                let what = format!("{}, {}", self.key, names[i]);
                let field = Number { what: &what, ..field.clone() };
                let response = field.ui(ui, &mut numbers[i], commands).hint(names[i]);
                let response = response.accessible_name(format!("{} {}: {}", self.group, self.setting.label, names[i]));
                self.sent(&response, commands, numbers.iter().map(|number| wrap(*number)).collect::<Vec<_>>().into());
            }
            unit.into_iter().for_each(|(unit, _)| drop(ui.label(unit)));
        });
    }

    /// The unit after fields beside each other and what it takes (points), where that is left beside `taken`.
    fn unit_beside(&self, ui: &Ui, taken: f32) -> Option<(egui::RichText, f32)> {
        let text = egui::RichText::new(self.setting.unit).size(theme::SMALL).color(theme::FAINT);
        let font = egui::FontId::proportional(theme::SMALL);
        let drawn = ui.painter().layout_no_wrap(self.setting.unit.to_owned(), font, theme::FAINT);
        let wide = drawn.size().x + 3.0;
        (!self.setting.unit.is_empty() && ui.available_width() >= taken + wide).then_some((text, wide))
    }

    fn colour(&self, ui: &mut Ui, value: Option<&Value>, linear: bool, commands: &mut Commands) {
        let mut rgb = rgb_of(value);
        let before = rgb;
        let response = if linear {
            egui::color_picker::color_edit_button_rgb(ui, &mut rgb)
        } else {
            let mut bytes = rgb.map(|c| (c * 255.0).round() as u8);
            let was = bytes;
            let response = ui.color_edit_button_srgb(&mut bytes);
            if bytes != was {
                rgb = bytes.map(|b| f32::from(b) / 255.0);
            }
            response
        };
        name(response, self);
        if rgb != before {
            self.set(commands, Some(rgb_value(rgb)), Phase::Dragging);
        }
    }

    fn hair_colour(&self, ui: &mut Ui, value: Option<&Value>, commands: &mut Commands) {
        const NAMES: [&str; 5] = ["black", "brown", "blond", "red", "grey"];
        let now = match value {
            Some(Value::String(word)) => word.as_str(),
            Some(Value::Table(table)) if table.contains_key("melanin") => "by pigment",
            _ => "by RGB",
        };
        let words = [&NAMES[..], &["by pigment", "by RGB"]].concat();
        // Said in other words it is still the same colour.
        let look = || {
            let look = value_at(self.settings, "picture.hair").cloned();
            look.and_then(|look| look.try_into::<HairLook>().ok()).unwrap_or_default()
        };
        choose(ui, self, now, &words, commands, |word| match word {
            "by pigment" => {
                let [eumelanin, pheomelanin] = look()
                    .colour
                    .melanin()
                    .unwrap_or([1.1, 0.6])
                    .map(|n| Value::Float((f64::from(n) * 1e4).round() / 1e4));
                table([("melanin", table([("eumelanin", eumelanin), ("pheomelanin", pheomelanin)]))])
            }
            "by RGB" => table([("rgb", rgb_value(colour::of_mass(&look()).map(srgb_from_linear)))]),
            name => Value::String(name.to_owned()),
        });
        let Some(Value::Table(inner)) = value else { return };
        if let Some(melanin) = inner.get("melanin") {
            for (pigment, letter) in [("eumelanin", "e "), ("pheomelanin", "p ")] {
                let mut amount = melanin.get(pigment).and_then(number_of).unwrap_or_default();
                let what = format!("{}, {pigment}", self.key);
                let field = Number { range: 0.0..=100.0, step: 0.01, before: letter, ..Number::of(&what) };
                let response = field.ui(ui, &mut amount, commands).hint(pigment);
                let mut melanin = melanin.as_table().cloned().unwrap_or_default();
                melanin.insert(pigment.to_owned(), amount.into());
                self.sent(&response, commands, table([("melanin", melanin.into())]));
            }
        } else {
            let mut bytes = rgb_of(inner.get("rgb")).map(|c| (c * 255.0).round() as u8);
            let was = bytes;
            ui.color_edit_button_srgb(&mut bytes);
            if bytes != was {
                let rgb = rgb_value(bytes.map(|b| f32::from(b) / 255.0));
                self.set(commands, Some(table([("rgb", rgb)])), Phase::Dragging);
            }
        }
    }

    fn ellipsoid(&self, ui: &mut Ui, value: Option<&Value>, commands: &mut Commands) {
        let given = value.and_then(Value::as_table);
        let words: [&str; 2] = ["fit", "given"];
        choose(ui, self, words[usize::from(given.is_some())], &words, commands, |word| match word {
            "fit" => Value::String("fit".to_owned()),
            _ => table([
                ("center", [-1.0, 0.5, 0.0].map(Value::Float).to_vec().into()),
                ("half_axes", [9.5, 11.0, 7.8].map(Value::Float).to_vec().into()),
            ]),
        });
        if let Some(given) = given {
            ui.vertical(|ui| {
                for (key, value) in given {
                    let numbers = value.as_array().into_iter().flatten().map(Value::to_string);
                    let text = numbers.collect::<Vec<_>>().join(", ");
                    self.text(ui, text, commands, |text| {
                        let numbers = text.split(',').map(|word| finite(word.trim()).map(Value::Float));
                        let mut given = given.clone();
                        given.insert(key.clone(), numbers.collect::<Option<Vec<_>>>().ok_or(NUMBERS)?.into());
                        Ok(given.into())
                    });
                }
            });
        }
    }

    fn file(&self, ui: &mut Ui, value: Option<&Value>, endings: &'static [&'static str], commands: &mut Commands) {
        let now = value.and_then(Value::as_str).unwrap_or_default().to_owned();
        let choose = ui.small_button("...").hint("Choose a file.");
        if choose.clicked() {
            let folder = std::path::absolute(self.folder.join(&now)).unwrap_or_default();
            let path = folder.parent().map(as_folder).unwrap_or_default();
            let chooser = Chooser { purpose: Purpose::Setting(self.key.clone()), path, endings: endings.to_vec() };
            commands.push(Command::Show(Box::new(Dialog::File(chooser))));
        }
        self.text(ui, now, commands, |text| Ok(Value::String(text.to_owned())));
    }

    /// Text that is taken when it is finished. What `read` makes no sense of, saying what it wants, is refused and left as it was.
    fn text(
        &self,
        ui: &mut Ui,
        now: String,
        commands: &mut Commands,
        read: impl Fn(&str) -> Result<Value, &'static str>,
    ) {
        let instead = self.setting.open.unwrap_or_default();
        self.edited(ui, &now, instead, commands, |text| read(text).map_err(str::to_owned));
    }

    /// What is typed into an empty field, in which `instead` says what is taken without it.
    fn typed(&self, ui: &mut Ui, instead: &str, commands: &mut Commands, read: impl Fn(&str) -> Result<Value, String>) {
        self.edited(ui, "", instead, commands, read);
    }

    fn edited(
        &self,
        ui: &mut Ui,
        now: &str,
        instead: &str,
        commands: &mut Commands,
        read: impl Fn(&str) -> Result<Value, String>,
    ) {
        let id = ui.scope_id().with((&self.key, now.len()));
        let mut text = ui.data(|data| data.get_temp::<String>(id)).unwrap_or_else(|| now.to_owned());
        let wide = (ui.available_width() - 4.0).max(60.0);
        let edit = egui::TextEdit::singleline(&mut text).desired_width(wide).hint_text(theme::faint(instead));
        let response = name(ui.add(edit), self);
        let response = match (now, instead) {
            ("", "") => response,
            ("", _) => response.hint(format!("Not set: {instead}. Type a value to set it.")),
            _ => response.hint(now),
        };
        if response.lost_focus() {
            ui.data_mut(|data| data.remove::<String>(id));
            // As in a field for a number: Enter takes what was typed, Escape does not.
            if ui.input(|input| input.key_pressed(egui::Key::Escape)) {
                return;
            }
            match read(&text) {
                _ if text == now => commands.push(Command::Took(self.key.clone())),
                // Emptied, it is left open again.
                _ if text.trim().is_empty() && self.setting.open.is_some() => self.set(commands, None, Phase::Done),
                Ok(value) => self.set(commands, Some(value), Phase::Done),
                Err(wanted) => {
                    let why = format!("{}: \"{text}\" is not accepted: it must be {wanted}", self.key);
                    commands.push(Command::Refuse { about: self.key.clone(), why });
                }
            }
        } else if response.has_focus() {
            ui.data_mut(|data| data.insert_temp(id, text));
        }
    }
}

/// Names a field for who does not see it, and for tests.
fn name(response: Response, field: &Field) -> Response {
    response.accessible_name(format!("{} {}", field.group, field.setting.label))
}

fn choose(
    ui: &mut Ui,
    field: &Field,
    now: &str,
    words: &[&str],
    commands: &mut Commands,
    make: impl Fn(&str) -> Value,
) {
    let width = ui.available_width().clamp(40.0, 96.0);
    let combo = egui::ComboBox::from_id_salt(&field.key).selected_text(now).width(width).truncate();
    let response = combo.show_ui(ui, |ui| {
        for word in words {
            if ui.selectable_label(*word == now, *word).clicked() && *word != now {
                field.set(commands, Some(make(word)), Phase::Done);
            }
        }
    });
    name(response.response, field);
}

fn range_text(kind: Kind, unit: &str) -> String {
    let unit = if unit.is_empty() { String::new() } else { format!(" {unit}") };
    match kind {
        Kind::Number { least, most, .. } if most < 9e4 => format!("\n{least} to {most}{unit}."),
        Kind::Number { least, .. } if least > -9e4 => format!("\nAt least {least}{unit}."),
        Kind::Whole { least, most } if most < 1_000_000 => format!("\n{least} to {most}{unit}."),
        Kind::Whole { least, .. } => format!("\nAt least {least}{unit}."),
        _ if unit.is_empty() => String::new(),
        _ => format!("\nIn{unit}."),
    }
}
