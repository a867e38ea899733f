//! The text of a scene that cannot be read, with what is wrong at its line.

use eframe::egui::{self, TextBuffer, Ui};

use super::hands::Hands;
use super::{Commands, theme};
use crate::command::Command;
use crate::session::{Broken, Session};

/// Draws it, if there is one.
pub fn ui(ui: &mut Ui, session: &Session, commands: &mut Commands) {
    let Some(broken) = session.broken() else { return };
    let name = broken.path.file_name().unwrap_or_default().to_string_lossy();
    let row = egui::vec2(ui.available_width(), 24.0);
    ui.allocate_ui_with_layout(row, egui::Layout::right_to_left(egui::Align::Center), |ui| {
        if ui.button("Close the text").hint("Goes back to the scene that was open.").clicked() {
            commands.push(Command::LeaveBroken);
        }
        let mended = broken.error.is_none();
        let button = ui.add_enabled(mended, egui::Button::new("Open the fixed text"));
        if button.hint("Opens the text below. The file changes only when you save.").clicked() {
            commands.push(Command::UseMended);
        }
        ui.with_layout(egui::Layout::left_to_right(egui::Align::Center), |ui| {
            ui.add(egui::Label::new(format!("{name} has an error")).truncate());
        });
    });
    match &broken.error {
        Some(error) => {
            let text = egui::RichText::new(error.to_string()).color(theme::WRONG);
            ui.add(egui::Label::new(text).wrap().selectable(true));
        }
        None => drop(ui.label(egui::RichText::new("No errors are left.").color(theme::GOOD))),
    }
    ui.add_space(4.0);
    text(ui, broken, commands);
}

fn text(ui: &mut Ui, broken: &Broken, commands: &mut Commands) {
    let wrong = broken.error.as_ref().and_then(|error| error.line);
    let mut text = broken.text.clone();
    let lines = text.lines().count().max(1);
    egui::ScrollArea::both().id_salt("mend").auto_shrink(false).show(ui, |ui| {
        ui.horizontal_top(|ui| {
            let height = ui.text_style_height(&egui::TextStyle::Monospace);
            // Numbers of the lines, in the rhythm of the text beside them.
            let (rect, _) = ui.allocate_exact_size(egui::vec2(34.0, height * lines as f32 + 4.0), egui::Sense::hover());
            let id = ui.scope_id().with("scrolled");
            for n in 1..=lines {
                let y = rect.top() + 2.0 + height * (n as f32 - 0.5);
                let is_wrong = wrong == Some(n);
                if is_wrong {
                    let stripe = egui::Rect::from_x_y_ranges(
                        rect.left()..=ui.clip_rect().right(),
                        y - height / 2.0..=y + height / 2.0,
                    );
                    ui.painter().rect_filled(stripe, 0.0, theme::WRONG.gamma_multiply(0.25));
                    // Once for each error: afterwards the hand scrolls.
                    if ui.data(|data| data.get_temp::<usize>(id)) != Some(n) {
                        ui.scroll_to_rect(stripe, Some(egui::Align::Center));
                        ui.data_mut(|data| data.insert_temp(id, n));
                    }
                }
                let ink = if is_wrong { theme::WRONG } else { egui::Color32::from_gray(90) };
                let at = egui::pos2(rect.right() - 6.0, y);
                ui.painter().text(at, egui::Align2::RIGHT_CENTER, n, egui::FontId::monospace(11.0), ink);
            }
            // Lines are not broken, so that each keeps its number.
            let mut layout = |ui: &Ui, text: &dyn TextBuffer, _: f32| {
                let font = egui::TextStyle::Monospace.resolve(ui.style());
                ui.painter().layout_no_wrap(text.as_str().to_owned(), font, theme::TEXT)
            };
            let edit = egui::TextEdit::multiline(&mut text)
                .layouter(&mut layout)
                .font(egui::TextStyle::Monospace)
                .frame(egui::Frame::new())
                .margin(egui::Margin { left: 4, right: 4, top: 2, bottom: 2 })
                .desired_width(f32::INFINITY)
                .code_editor();
            let response = ui.add(edit).accessible_name("Text of the scene");
            if response.changed() {
                commands.push(Command::Mend(text.take()));
            }
        });
    });
}
