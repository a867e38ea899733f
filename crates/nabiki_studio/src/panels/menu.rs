//! The menus, and what they say of the scene beside them.

use eframe::egui::{self, Ui};

use super::hands::Hands;
use super::{Commands, theme};
use crate::actions::{ACTIONS, Action, MENUS};
use crate::command::Command;
use crate::session::Session;

/// Draws the bar.
pub fn ui(ui: &mut Ui, session: &Session, commands: &mut Commands) {
    egui::MenuBar::new().ui(ui, |ui| {
        for menu in MENUS {
            ui.menu_button(menu, |ui| {
                ui.set_min_width(210.0);
                for entry in ACTIONS.iter().filter(|entry| entry.menu == menu) {
                    item(ui, session, entry.action, commands);
                    if entry.action == Action::Open {
                        recent(ui, session, commands);
                    }
                }
            });
        }
        ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
            ui.add_space(6.0);
            let Some(document) = session.document() else { return };
            let mark = if document.is_dirty() { "\u{2022} " } else { "" };
            let text = egui::RichText::new(format!("{mark}{}", document.name())).color(theme::TEXT);
            let path = document.path().unwrap_or(document.scene().file()).display().to_string();
            ui.add(egui::Label::new(text).truncate().sense(egui::Sense::hover())).hint(if document.is_dirty() {
                format!("{path}\nIt has unsaved changes.")
            } else {
                path
            });
        });
    });
}

fn item(ui: &mut Ui, session: &Session, action: Action, commands: &mut Commands) {
    let entry = action.entry();
    // What is behind a text that is being mended is left alone.
    let document = session.document().filter(|_| session.broken().is_none());
    let (name, enabled) = match action {
        Action::Undo => named(entry.name, document.and_then(|document| document.undo_name())),
        Action::Redo => named(entry.name, document.and_then(|document| document.redo_name())),
        Action::Paste => (entry.name.to_owned(), session.has_clip()),
        Action::Cut | Action::Copy | Action::Delete => (entry.name.to_owned(), !session.chosen().is_empty()),
        Action::Join => (entry.name.to_owned(), session.chosen().len() > 1),
        Action::Compare => ticked_if(entry.name, session.seen_instead().is_some(), session.kept_take().is_some()),
        Action::Exchange => (entry.name.to_owned(), session.kept_take().is_some()),
        Action::Ghosts => ticked(entry.name, session.preferences().ghosts),
        Action::Arrows => ticked(entry.name, session.preferences().arrows),
        Action::FinalPicture => ticked(entry.name, session.preferences().final_picture),
        Action::Fewer | Action::More => {
            (format!("{} ({})", entry.name, session.preferences().strands_in_words()), true)
        }
        _ => (entry.name.to_owned(), true),
    };
    let key = entry.key.map(|key| key.text()).unwrap_or_default();
    let button = egui::Button::new(name).right_text(theme::faint(key));
    if ui.add_enabled(enabled, button).hint(entry.help).clicked() {
        commands.push(Command::Act(action));
        ui.close();
    }
}

fn named(name: &str, what: Option<&str>) -> (String, bool) {
    match what {
        Some(what) => {
            let what: String = what.chars().take(40).collect();
            (format!("{name}: {what}"), true)
        }
        None => (name.to_owned(), false),
    }
}

fn ticked(name: &str, on: bool) -> (String, bool) {
    (format!("{name}: {}", if on { "on" } else { "off" }), true)
}

fn ticked_if(name: &str, on: bool, enabled: bool) -> (String, bool) {
    (ticked(name, on).0, enabled)
}

fn recent(ui: &mut Ui, session: &Session, commands: &mut Commands) {
    let recent = &session.preferences().recent;
    ui.add_enabled_ui(!recent.is_empty(), |ui| {
        ui.menu_button("Open recent", |ui| {
            ui.set_max_width(460.0);
            for path in recent {
                let name = path.file_name().unwrap_or_default().to_string_lossy();
                let folder = path.parent().map(|folder| folder.display().to_string()).unwrap_or_default();
                let there = path.exists();
                let folder = if there { folder } else { format!("{folder} (missing)") };
                let button = egui::Button::new(name).right_text(theme::faint(folder)).truncate();
                if ui.add_enabled(there, button).clicked() {
                    commands.push(Command::Open(path.clone()));
                    ui.close();
                }
            }
        });
    });
}
