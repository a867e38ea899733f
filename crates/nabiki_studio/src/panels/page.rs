//! A page of settings: groups that open and close, drawn from the tables of `settings`.

use std::path::Path;

use eframe::egui::{self, Ui};
use toml::Value;

use super::fields::Field;
use super::hands::Hands;
use super::{Commands, theme};
use crate::command::Command;
use crate::document::Phase;
use crate::session::Session;
use crate::settings::{Group, Page, Shape, When, value_at};

/// Room for a switch at the end of a title (points).
const SWITCH: f32 = 30.0;

/// Draws a page.
pub fn ui(ui: &mut Ui, session: &Session, page: Page, commands: &mut Commands) {
    let Some(document) = session.document() else {
        ui.add_space(12.0);
        ui.label(theme::faint("No scene is open."));
        return;
    };
    let scene = document.scene();
    let has_effect = |when: When| when.holds(scene);
    if let Some(broken) = session.broken() {
        let words = format!("{} has an error and is open as text. The scene behind it stays unchanged.", broken.name());
        ui.add(egui::Label::new(theme::faint(words)).wrap());
        ui.add_space(4.0);
        ui.disable();
    }
    let list = Panel { session, folder: scene.file().parent().unwrap_or(Path::new("")) };
    egui::ScrollArea::vertical().id_salt(page).auto_shrink(false).show(ui, |ui| {
        ui.set_width(ui.available_width() - 6.0);
        let groups = page.groups().iter();
        for group in groups.filter(|group| has_effect(group.when) && parent(page, group).is_none()) {
            list.group(ui, page, group, group.table.to_owned(), commands);
        }
        ui.add_space(24.0);
    });
}

/// The list of which a group is a part: the motion of a body.
fn parent(page: Page, group: &Group) -> Option<&'static Group> {
    let lists = page.groups().iter().filter(|of| matches!(of.shape, Shape::List(_)));
    lists.into_iter().find(|of| group.table.strip_prefix(of.table).is_some_and(|rest| rest.starts_with('.')))
}

struct Panel<'a> {
    session: &'a Session,
    folder: &'a Path,
}

impl Panel<'_> {
    fn group(&self, ui: &mut Ui, page: Page, group: &'static Group, table: String, commands: &mut Commands) {
        let there = value_at(self.session.settings(), &table);
        let count = match group.shape {
            Shape::List(_) => there.and_then(Value::as_array).map_or(0, Vec::len),
            Shape::Always | Shape::Optional(_) => 0,
        };
        let title = if count == 0 { group.title.to_owned() } else { format!("{} ({count})", group.title) };
        let (switch, is_on) = match group.shape {
            Shape::Always => (None, true),
            Shape::Optional(_) => {
                let on = there.is_some();
                let value = if on { None } else { group.fresh() };
                (Some((on, Command::Set { key: table.clone(), value, phase: Phase::Done })), on)
            }
            Shape::List(_) => (None, count > 0),
        };
        let body = |ui: &mut Ui, commands: &mut Commands| match group.shape {
            Shape::Optional(_) if !is_on => {
                ui.label(theme::faint(group.help));
            }
            Shape::Always | Shape::Optional(_) => self.fields(ui, group, &table, commands),
            Shape::List(_) => {
                for i in 0..count {
                    self.entry(ui, page, group, i, commands);
                }
                if ui.button("Add").hint(group.help).clicked() {
                    let key = format!("{}[{count}]", group.table);
                    commands.push(Command::Set { key, value: group.fresh(), phase: Phase::Done });
                }
            }
        };
        self.fold(ui, group, &table, &title, switch, is_on, body, commands);
    }

    fn entry(&self, ui: &mut Ui, page: Page, group: &'static Group, i: usize, commands: &mut Commands) {
        let table = format!("{}[{i}]", group.table);
        ui.horizontal(|ui| {
            ui.label(format!("{}", i + 1));
            let remove = ui.small_button("Remove");
            if remove.clicked() {
                commands.push(Command::Set { key: table.clone(), value: None, phase: Phase::Done });
            }
        });
        self.fields(ui, group, &table, commands);
        for nested in
            page.groups().iter().filter(|nested| parent(page, nested).is_some_and(|of| of.table == group.table))
        {
            let below = nested.table.strip_prefix(group.table).unwrap_or_default();
            self.group(ui, page, nested, format!("{table}{below}"), commands);
        }
        ui.separator();
    }

    /// A title that opens and closes what is below it, with a switch beside it where it may be off.
    #[expect(clippy::too_many_arguments, reason = "it is a row of a table")]
    fn fold(
        &self,
        ui: &mut Ui,
        group: &Group,
        table: &str,
        title: &str,
        switch: Option<(bool, Command)>,
        is_on: bool,
        body: impl FnOnce(&mut Ui, &mut Commands),
        commands: &mut Commands,
    ) {
        let blamed = self.session.trouble().and_then(|trouble| trouble.key.as_deref()).is_some_and(|key| {
            key.strip_prefix(table).is_some_and(|rest| {
                group.settings().iter().any(|setting| blames(rest, setting.key)) || rest.starts_with('[')
            })
        });
        let id = ui.make_persistent_id((group.title, table));
        let mut state = egui::collapsing_header::CollapsingState::load_with_default_open(ui.ctx(), id, group.open);
        let (found, goes) = self.found(group, table);
        if found != Found::Nothing && goes {
            state.set_open(true);
        }
        let header = ui.horizontal(|ui| {
            ui.set_min_height(24.0);
            state.show_toggle_button(ui, egui::collapsing_header::paint_default_icon);
            let ink = match (blamed, is_on) {
                (true, _) => theme::WRONG,
                (_, true) => theme::TEXT,
                (_, false) => theme::FAINT,
            };
            let label = egui::Label::new(egui::RichText::new(title).color(ink)).truncate().sense(egui::Sense::click());
            // A long title leaves the switch its place.
            let room = ui.available_width() - if switch.is_some() { SWITCH } else { 0.0 };
            let response = ui.scope(|ui| {
                ui.set_max_width(room);
                ui.add(label)
            });
            let response = response.inner.hint(group.help);
            if response.clicked() {
                state.toggle(ui);
            }
            ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
                let Some((mut on, toggle)) = switch else { return };
                let response = ui.checkbox(&mut on, "").hint(group.help);
                if response.accessible_name(format!("{} on", group.title)).changed() {
                    if on {
                        state.set_open(true);
                    }
                    commands.push(toggle);
                }
            });
        });
        let rect = header.response.rect;
        if found == Found::Title {
            point_out(ui, rect, goes);
        }
        state.show_body_unindented(ui, |ui| {
            egui::Frame::new()
                .inner_margin(egui::Margin { left: 14, right: 0, top: 0, bottom: 6 })
                .show(ui, |ui| body(ui, commands));
        });
        ui.painter().hline(rect.x_range(), rect.top() - 2.0, egui::Stroke::new(1.0, theme::LINE));
    }

    /// What is pointed out of a group with this table, and whether the page still goes there.
    fn found(&self, group: &Group, table: &str) -> (Found, bool) {
        let Some((key, goes)) = self.session.revealed() else { return (Found::Nothing, false) };
        let is_of =
            || crate::settings::find(key).is_some_and(|(_, of, _)| (of.title, of.table) == (group.title, group.table));
        let found = match key.strip_prefix(table) {
            Some("") => Found::Title,
            Some(rest) if rest.starts_with('[') || is_of() => Found::Below,
            _ => Found::Nothing,
        };
        (found, goes)
    }

    fn fields(&self, ui: &mut Ui, group: &'static Group, table: &str, commands: &mut Commands) {
        let blamed = self.session.trouble().and_then(|trouble| trouble.key.as_deref());
        for setting in group.settings() {
            let key = format!("{table}.{}", setting.key);
            let value = value_at(self.session.settings(), &key);
            let blamed =
                blamed.and_then(|blamed| blamed.strip_prefix(table)).is_some_and(|rest| blames(rest, setting.key));
            let (settings, folder) = (self.session.settings(), self.folder);
            let found = self.session.revealed().filter(|(found, _)| *found == key);
            let top = ui.cursor().min;
            let comes_to = self.session.take().and_then(|take| take.built.comes_to(&key));
            Field { setting, key, value, group: group.title, comes_to, blamed, settings, folder }.ui(ui, commands);
            if let Some((_, goes)) = found {
                let rect = egui::Rect::from_min_max(top, egui::pos2(ui.max_rect().right(), ui.min_rect().bottom()));
                point_out(ui, rect, goes);
            }
        }
    }
}

/// What is pointed out of a group.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Found {
    Nothing,
    /// Its title.
    Title,
    /// Something in it.
    Below,
}

/// Points out what was looked for, and scrolls there.
fn point_out(ui: &Ui, rect: egui::Rect, goes: bool) {
    let rect = rect.expand2(egui::vec2(3.0, 1.0));
    ui.painter().rect(
        rect,
        3.0,
        theme::ACCENT.gamma_multiply(0.12),
        egui::Stroke::new(1.0, theme::ACCENT),
        egui::StrokeKind::Inside,
    );
    if goes {
        ui.scroll_to_rect(rect, Some(egui::Align::Center));
    }
}

/// Whether what follows a table's name in the key of an error means this setting.
fn blames(rest: &str, key: &str) -> bool {
    let Some(rest) = rest.strip_prefix('.').and_then(|rest| rest.strip_prefix(key)) else { return false };
    rest.is_empty() || rest.starts_with(['.', '[', ' '])
}
