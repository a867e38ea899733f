//! Choosing a file: a path to type, what is in its folder to click, and the system's own dialog for who prefers it.

use std::path::{Path, PathBuf};

use eframe::egui::{self, Ui};

use super::hands::Hands;
use super::{Commands, theme};
use crate::command::Command;
use crate::dialog::{Chooser, Dialog, Purpose, as_scene_file};
use crate::session::Session;

/// Draws the chooser.
pub fn ui(ui: &mut Ui, session: &Session, chooser: &Chooser, commands: &mut Commands) {
    let verb = match &chooser.purpose {
        Purpose::Open => "Open",
        Purpose::SaveAs(_) => "Save",
        Purpose::Setting(_) | Purpose::Export(_) => "Choose",
    };
    ui.heading(chooser.title());
    ui.add_space(6.0);
    let show = |chooser: Chooser| Command::Show(Box::new(Dialog::File(chooser)));
    let chosen_file = |path: PathBuf| Command::Chosen(Box::new(chooser.clone()), path);
    let mut path = chooser.path.clone();
    let edit = egui::TextEdit::singleline(&mut path).desired_width(f32::INFINITY).hint_text("a path");
    let response = ui.add(edit).accessible_name("Path");
    // To be asked first: whoever has the focus again has not lost it.
    let entered = response.lost_focus() && ui.input(|input| input.key_pressed(egui::Key::Enter));
    if ui.memory(|memory| memory.focused().is_none()) {
        response.request_focus();
    }
    if response.changed() {
        commands.push(show(Chooser { path: path.clone(), ..chooser.clone() }));
    }
    ui.add_space(4.0);
    egui::Frame::new().fill(theme::GROUND).corner_radius(4.0).inner_margin(6.0).show(ui, |ui| {
        let height = (ui.ctx().content_rect().height() - 190.0).clamp(80.0, 300.0);
        egui::ScrollArea::vertical().max_height(height).min_scrolled_height(height).auto_shrink(false).show(ui, |ui| {
            if line(ui, "..", true, false).clicked() {
                commands.push(show(chooser.up()));
            }
            let listed = chooser.listed();
            if listed.is_empty() {
                ui.label(theme::faint(match chooser.has_folder() {
                    true => "There is no matching file here.",
                    false => "There is no such folder.",
                }));
            }
            for entry in listed {
                let chosen = !entry.folder && Path::new(&chooser.path) == entry.path;
                let response = line(ui, &entry.name, entry.folder, chosen);
                if response.double_clicked() && !entry.folder {
                    commands.push(chosen_file(entry.path.clone()));
                } else if response.clicked() {
                    commands.push(show(chooser.with(&entry)));
                }
            }
        });
    });
    ui.add_space(8.0);
    let chosen = PathBuf::from(&path);
    let is_file = !path.is_empty() && !path.ends_with(std::path::is_separator);
    let may = match chooser.purpose {
        Purpose::Open | Purpose::Setting(_) => chosen.is_file(),
        Purpose::SaveAs(_) | Purpose::Export(_) => is_file && !chosen.is_dir(),
    };
    ui.horizontal(|ui| {
        if !session.has_desktop() {
            let words = "This desktop has no file dialog. Type the path, or click in the list.";
            let why = "On Linux, install an XDG desktop portal with a file chooser, or zenity.";
            ui.label(theme::faint(words)).hint(why);
        } else if session.asks_desktop() {
            ui.label(theme::faint("Waiting for the dialog of your desktop..."));
        } else if ui.button("System dialog...").hint("Opens the file dialog of your desktop.").clicked() {
            commands.push(Command::AskDesktop);
        }
        ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
            let replaces = matches!(chooser.purpose, Purpose::SaveAs(_)) && as_scene_file(&chosen).is_file();
            let seen = session.broken().map(|broken| broken.path.as_path());
            let seen = seen.or_else(|| session.document().and_then(|document| document.path()));
            let own = seen.is_some_and(|own| own == as_scene_file(&chosen));
            let verb = if replaces && !own { "Replace" } else { verb };
            let done = ui.add_enabled(may, egui::Button::new(verb)).clicked();
            if (done || entered) && may {
                commands.push(chosen_file(chosen));
            }
            if ui.button("Cancel").clicked() {
                commands.push(Command::CloseDialog);
            }
        });
    });
}

fn line(ui: &mut Ui, name: &str, folder: bool, chosen: bool) -> egui::Response {
    let text =
        if folder { theme::faint(format!("{name}{}", std::path::MAIN_SEPARATOR)) } else { egui::RichText::new(name) };
    let button = egui::Button::selectable(chosen, text).truncate().min_size(egui::vec2(ui.available_width(), 20.0));
    ui.add(button)
}
