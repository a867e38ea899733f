//! What is asked in front of everything else.

use std::time::{SystemTime, UNIX_EPOCH};

use eframe::egui::{self, Key, Ui};

use super::hands::Hands;
use super::number::Number;
use super::{Commands, files, theme};
use crate::actions::{ACTIONS, MENUS};
use crate::command::Command;
use crate::dialog::{Chooser, Dialog, Import, Next, Purpose, Role, as_folder};
use crate::finding::{Found, matching};
use crate::gestures::{GESTURES, PLACES};
use crate::preferences::{ALL, Preferences};
use crate::recovery::Kept;
use crate::session::Session;
use crate::tasks::{Kind, Order};
use crate::view::Navigation;

/// Draws the question that is asked, if one is.
pub fn ui(ctx: &egui::Context, session: &Session, commands: &mut Commands) {
    let Some(dialog) = session.dialog().filter(|dialog| **dialog != Dialog::Welcome) else { return };
    let wide: f32 = match dialog {
        Dialog::Keys => 1080.0,
        Dialog::File(_) | Dialog::Recover(_) => 560.0,
        Dialog::Palette { .. } => 640.0,
        _ => 460.0,
    };
    let frame = egui::Frame::window(&ctx.global_style()).inner_margin(egui::Margin::same(18));
    // Each kind has a size of its own.
    let modal = egui::Modal::new(egui::Id::unique(("dialog", std::mem::discriminant(dialog)))).frame(frame);
    let modal = modal.backdrop_color(egui::Color32::from_black_alpha(120));
    let response = modal.show(ctx, |ui| {
        ui.set_width(wide.min(ctx.content_rect().width() - 60.0));
        match dialog {
            Dialog::File(chooser) => files::ui(ui, session, chooser, commands),
            Dialog::Conflict(path, _) => conflict(ui, path, commands),
            Dialog::Unsaved(next) => unsaved(ui, session, next, commands),
            Dialog::Exporting => exporting(ui, commands),
            Dialog::Recover(kept) => recover(ui, kept, commands),
            Dialog::Palette { query, line } => palette(ui, query, *line, commands),
            Dialog::Keys => keys(ui, session, commands),
            Dialog::Welcome => {}
            Dialog::Preferences => preferences(ui, session, commands),
            Dialog::Export(order) => export(ui, session, order, commands),
            Dialog::Import(import) => self::import(ui, session, import, commands),
        }
        if let Some(wrong) = session.wrong_with_dialog() {
            ui.add_space(6.0);
            paragraph(ui, egui::RichText::new(wrong).color(theme::WRONG));
        }
    });
    // A list that opens in it lies over it: both ask for the top, and the one that was there before would get it.
    raise_popups(ctx, response.response.layer_id);
    // A question of what is lost is answered, not passed by.
    let must = matches!(dialog, Dialog::Conflict(..) | Dialog::Recover(_));
    if response.should_close() && !must {
        commands.push(Command::CloseDialog);
    }
}

/// Puts what has been opened within a dialog over it.
fn raise_popups(ctx: &egui::Context, dialog: egui::LayerId) {
    let open: Vec<egui::LayerId> = ctx.memory(|memory| {
        let popups = memory.layer_ids().filter(|layer| layer.order == dialog.order && *layer != dialog);
        popups.filter(|layer| memory.areas().is_visible(layer)).collect()
    });
    open.into_iter().for_each(|popup| ctx.set_sublayer(dialog, popup));
}

fn buttons(ui: &mut Ui, add: impl FnOnce(&mut Ui)) {
    ui.add_space(10.0);
    // In a row as high as they are: a layout that is centred would take all the height there is.
    ui.horizontal(|ui| ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), add));
}

fn paragraph(ui: &mut Ui, text: impl Into<egui::WidgetText>) {
    ui.add(egui::Label::new(text).wrap());
}

fn conflict(ui: &mut Ui, path: &std::path::Path, commands: &mut Commands) {
    ui.heading("Another program has changed the file");
    ui.add_space(6.0);
    paragraph(
        ui,
        format!("{} has changed since you opened it. If you save over it, those changes are lost.", path.display()),
    );
    buttons(ui, |ui| {
        if ui.button("Cancel").clicked() {
            commands.push(Command::CloseDialog);
        }
        if ui.button("Save under another name...").clicked() {
            commands.push(Command::Act(crate::actions::Action::SaveAs));
        }
        if ui.button("Read theirs").hint("Undo brings yours back.").clicked() {
            commands.extend([Command::CloseDialog, Command::Act(crate::actions::Action::Reload)]);
        }
        if ui.button("Save over it").clicked() {
            commands.push(Command::SaveOver);
        }
    });
}

fn unsaved(ui: &mut Ui, session: &Session, next: &Next, commands: &mut Commands) {
    let text = session.broken().filter(|_| session.loses_text(next)).map(|broken| broken.name());
    let name = text.or_else(|| session.document().map(|document| document.name())).unwrap_or_default();
    ui.heading("Save the changes?");
    ui.add_space(6.0);
    let what = match next {
        Next::Quit => "close the window",
        Next::LeaveText => "close its text",
        Next::Open(_) | Next::Recover(_) | Next::UseMended => "open another scene",
    };
    paragraph(ui, format!("{name} has unsaved changes. They are lost if you {what}."));
    buttons(ui, |ui| {
        if ui.button("Cancel").clicked() {
            commands.push(Command::CloseDialog);
        }
        if ui.button("Do not save").clicked() {
            commands.push(Command::GoOn);
        }
        if ui.button("Save").clicked() {
            commands.push(Command::SaveAndGoOn(next.clone()));
        }
    });
}

fn exporting(ui: &mut Ui, commands: &mut Commands) {
    ui.heading("Stop the export?");
    ui.add_space(6.0);
    paragraph(ui, "An export is still running. If you close the window, it is cancelled and its files are removed.");
    buttons(ui, |ui| {
        if ui.button("Cancel").clicked() {
            commands.push(Command::CloseDialog);
        }
        if ui.button("Stop and close").clicked() {
            commands.push(Command::GoOn);
        }
    });
}

fn recover(ui: &mut Ui, kept: &[Kept], commands: &mut Commands) {
    ui.heading("Unsaved work from a window that did not close normally");
    ui.add_space(6.0);
    let now = SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |passed| passed.as_secs());
    for (n, kept) in kept.iter().enumerate() {
        ui.horizontal(|ui| {
            if ui.button("Open").clicked() {
                commands.push(Command::Recover(n));
            }
            if ui.button("Discard").clicked() {
                commands.push(Command::Forget(n));
            }
            let name = kept.path.file_name().unwrap_or_default().to_string_lossy();
            let minutes = now.saturating_sub(kept.seconds) / 60;
            let ago = match minutes {
                0 => "just now".to_owned(),
                1..120 => format!("{minutes} min ago"),
                _ => format!("{} h ago", minutes / 60),
            };
            ui.add(egui::Label::new(format!("{name}, {ago}")).truncate()).hint(kept.path.display().to_string());
        });
    }
    buttons(ui, |ui| {
        if ui.button("Later").hint("Asks again at the next start.").clicked() {
            commands.push(Command::CloseDialog);
        }
    });
}

fn palette(ui: &mut Ui, query: &str, line: usize, commands: &mut Commands) {
    let mut text = query.to_owned();
    let edit = egui::TextEdit::singleline(&mut text)
        .hint_text("a few letters of a command or a setting")
        .desired_width(f32::INFINITY);
    let response = ui.add(edit).accessible_name("Command or setting");
    response.request_focus();
    let found = matching(query);
    let count = found.len();
    let (up, down, enter) = ui.input(|input| {
        (input.key_pressed(Key::ArrowUp), input.key_pressed(Key::ArrowDown), input.key_pressed(Key::Enter))
    });
    let line = line.min(count.saturating_sub(1));
    let moved = match (up, down) {
        (true, _) => line.saturating_sub(1),
        (_, true) => (line + 1).min(count.saturating_sub(1)),
        _ => line,
    };
    if response.changed() || moved != line {
        let line = if response.changed() { 0 } else { moved };
        commands.push(Command::Show(Box::new(Dialog::Palette { query: text, line })));
    }
    let mut done = |found: Found| {
        commands.push(Command::CloseDialog);
        commands.push(match found {
            Found::Action(entry) => Command::Act(entry.action),
            found => Command::Reveal(found.key()),
        });
    };
    if enter && let Some(found) = found.get(line) {
        done(*found);
    }
    ui.add_space(4.0);
    egui::ScrollArea::vertical().max_height(360.0).auto_shrink([false, true]).show(ui, |ui| {
        for (n, found) in found.iter().enumerate() {
            let button = egui::Button::selectable(n == line, found.title()).right_text(theme::faint(found.key()));
            let button = button.truncate().min_size(egui::vec2(ui.available_width(), 22.0));
            let response = ui.add(button).hint(found.help());
            if n == line && moved != line {
                response.scroll_to_me(None);
            }
            if response.clicked() {
                done(*found);
            }
        }
        if count == 0 {
            ui.label(theme::faint("No command or setting matches."));
        }
    });
}

fn keys(ui: &mut Ui, session: &Session, commands: &mut Commands) {
    ui.heading("Keys");
    ui.add_space(6.0);
    let height = (ui.ctx().content_rect().height() - 150.0).max(100.0);
    let scrolled = egui::ScrollArea::vertical().max_height(height).min_scrolled_height(height);
    scrolled.show(ui, |ui| {
        (ui.spacing_mut().item_spacing.y, ui.spacing_mut().interact_size.y) = (2.0, 16.0);
        // As many columns as have room for their words.
        let count = ((ui.available_width() / 330.0) as usize).clamp(1, 3);
        ui.columns(count, |columns| {
            let column = |n: usize| n.min(count - 1);
            for (n, menu) in MENUS.into_iter().enumerate() {
                let rows = ACTIONS.iter().filter(|entry| entry.menu == menu && entry.key.is_some());
                let rows = rows.map(|entry| (entry.keys_text(), entry.name.trim_end_matches("..."), entry.help));
                key_rows(&mut columns[column(usize::from(n >= 3))], menu, 120.0, rows);
            }
            let ui = &mut columns[column(2)];
            let camera = session.preferences().navigation.hands();
            let camera = camera.map(|(hand, what)| (hand.to_owned(), what, "Set in Preferences."));
            key_rows(ui, "Camera", 140.0, camera.into_iter());
            for place in PLACES {
                let rows = GESTURES.iter().filter(|gesture| gesture.place == place);
                key_rows(ui, place, 140.0, rows.map(|gesture| (gesture.hand.to_owned(), gesture.what, gesture.what)));
            }
        });
    });
    buttons(ui, |ui| {
        if ui.button("Close").clicked() {
            commands.push(Command::CloseDialog);
        }
    });
}

/// Keys, or what a hand does, with what comes of it. `wide`: room of the first.
fn key_rows(ui: &mut Ui, title: &str, wide: f32, rows: impl Iterator<Item = (String, &'static str, &'static str)>) {
    ui.label(egui::RichText::new(title).color(theme::ACCENT));
    for (key, what, help) in rows {
        ui.horizontal_top(|ui| {
            let left = egui::Layout::left_to_right(egui::Align::Center);
            ui.allocate_ui_with_layout(egui::vec2(wide, 16.0), left, |ui| {
                ui.set_min_width(wide);
                ui.add(egui::Label::new(egui::RichText::new(key).size(theme::SMALL)).truncate());
            });
            ui.add(egui::Label::new(what).wrap()).hint(help);
        });
    }
    ui.add_space(8.0);
}

fn preferences(ui: &mut Ui, session: &Session, commands: &mut Commands) {
    ui.heading("Preferences");
    ui.add_space(6.0);
    let mut changed: Preferences = session.preferences().clone();
    super::fields::row(ui, "Navigation", "Which mouse buttons turn, pan and zoom the view.", false, |ui| {
        ui.selectable_value(&mut changed.navigation, Navigation::Blender, "Blender");
        ui.selectable_value(&mut changed.navigation, Navigation::Maya, "Maya");
    });
    super::fields::row(ui, "Strands", "How many strands the view shows.", false, |ui| {
        let what = "Strands shown at first";
        let mut strands = changed.strands as f64;
        let field = Number { range: 1.0..=ALL as f64, step: 10.0, decimals: 0, most: "all", ..Number::of(what) };
        if field.ui(ui, &mut strands, commands).accessible_name(what).changed() {
            changed.strands = strands as usize;
        }
    });
    super::fields::row(ui, "Size", "Size of text and panels, relative to the system's setting.", false, |ui| {
        let mut percent = f64::from((100.0 * changed.zoom).round());
        let field = Number { range: 50.0..=400.0, decimals: 0, unit: "%", ..Number::of("Text size") };
        if field.ui(ui, &mut percent, commands).changed() {
            changed.zoom = percent as f32 / 100.0;
        }
    });
    super::fields::row(ui, "Final picture", "Renders all strands when you pause.", false, |ui| {
        ui.checkbox(&mut changed.final_picture, "");
    });
    super::fields::row(ui, "Tip paths", "Shows where the tips were and will be.", false, |ui| {
        ui.checkbox(&mut changed.ghosts, "");
    });
    super::fields::row(ui, "Wind arrows", "Shows the wind as arrows where it varies in space.", false, |ui| {
        ui.checkbox(&mut changed.arrows, "");
    });
    if let Some(folder) = session.folder() {
        ui.add_space(6.0);
        ui.add(egui::Label::new(theme::faint(format!("Stored in {}", folder.display()))).wrap().selectable(true));
    }
    if changed != *session.preferences() {
        commands.push(Command::Prefer(Box::new(changed)));
    }
    buttons(ui, |ui| {
        if ui.button("Close").clicked() {
            commands.push(Command::CloseDialog);
        }
    });
}

fn export(ui: &mut Ui, session: &Session, order: &Order, commands: &mut Commands) {
    let Some(document) = session.document() else { return };
    ui.heading("Export");
    ui.add_space(6.0);
    let mut changed = order.clone();
    ui.horizontal(|ui| {
        for kind in Kind::ALL {
            if ui.selectable_label(order.kind == kind, kind.name()).clicked() && order.kind != kind {
                (changed.kind, changed.place) = (kind, kind.place(document.scene()));
            }
        }
    });
    ui.add_space(4.0);
    paragraph(ui, theme::faint(order.kind.help()));
    ui.add_space(4.0);
    let label = if order.kind.ending().is_some() { "File" } else { "Folder" };
    let mut chooses = false;
    super::fields::row(
        ui,
        label,
        "Where the export goes. Existing files are replaced once the new ones are complete.",
        false,
        |ui| {
            let mut place = changed.place.display().to_string();
            let edit = egui::TextEdit::singleline(&mut place).desired_width(ui.available_width() - 34.0);
            if ui.add(edit).accessible_name("Place").changed() {
                changed.place = place.into();
            }
            chooses = ui.small_button("...").clicked();
            if chooses {
                let path = match order.kind.ending() {
                    Some(_) => changed.place.display().to_string(),
                    None => as_folder(&changed.place),
                };
                let endings = order.kind.ending().into_iter().collect();
                let chooser = Chooser { purpose: Purpose::Export(changed.clone()), path, endings };
                commands.push(Command::Show(Box::new(Dialog::File(chooser))));
            }
        },
    );
    if order.kind == Kind::Still {
        super::fields::row(ui, "Frame", "The frame to draw.", false, |ui| {
            let mut frame = f64::from(changed.frame);
            let range = 0.0..=f64::from(document.scene().motion.frames);
            Number { range, decimals: 0, ..Number::of("Frame") }.ui(ui, &mut frame, commands);
            changed.frame = frame as u32;
        });
    }
    super::fields::row(ui, "Strands", "All strands of the scene, or only the first few for a test.", false, |ui| {
        let mut all = changed.strands.is_none();
        ui.checkbox(&mut all, "all");
        changed.strands = match (all, changed.strands) {
            (true, _) => None,
            (false, None) => Some(1000),
            (false, some) => some,
        };
        if let Some(strands) = &mut changed.strands {
            let mut number = *strands as f64;
            let field = Number { range: 1.0..=1e7, step: 10.0, decimals: 0, ..Number::of("Strands") };
            field.ui(ui, &mut number, commands);
            *strands = number as usize;
        }
    });
    if changed != *order && !chooses {
        commands.push(Command::Show(Box::new(Dialog::Export(changed.clone()))));
    }
    buttons(ui, |ui| {
        let may = !changed.place.as_os_str().is_empty();
        if ui.add_enabled(may, egui::Button::new("Start export")).clicked() {
            commands.push(Command::Export(changed));
        }
        if ui.button("Cancel").clicked() {
            commands.push(Command::CloseDialog);
        }
    });
}

fn import(ui: &mut Ui, session: &Session, import: &Import, commands: &mut Commands) {
    let name = import.path.file_name().unwrap_or_default().to_string_lossy().into_owned();
    ui.heading(name);
    ui.add_space(6.0);
    let mut changed = import.clone();
    super::fields::row(ui, "Use as", "What the file is for.", false, |ui| {
        for role in &import.roles {
            ui.selectable_value(&mut changed.role, *role, role.name());
        }
    });
    let says = "from the file";
    let choose = |ui: &mut Ui, id: &str, now: &mut String, words: &[&str]| {
        let text = if now.is_empty() { says.to_owned() } else { now.clone() };
        let list = egui::ComboBox::from_id_salt(id).selected_text(text).width(140.0).show_ui(ui, |ui| {
            for word in std::iter::once("").chain(words.iter().copied()) {
                ui.selectable_value(now, word.to_owned(), if word.is_empty() { says } else { word });
            }
        });
        list.response.accessible_name(format!("{id} of the file"));
    };
    const AXES: [&str; 6] = ["+x", "-x", "+y", "-y", "+z", "-z"];
    super::fields::row(
        ui,
        "Unit",
        "Required if the file does not give it: .bvh, .tof, .abc, and .hair, .tfx, .obj and .ply files that are not in cm.",
        false,
        |ui| {
            choose(ui, "Unit", &mut changed.unit, &["mm", "cm", "dm", "m", "in", "ft"]);
        },
    );
    super::fields::row(ui, "Up", "Axis of the file that points up.", false, |ui| {
        choose(ui, "Up", &mut changed.up, &AXES)
    });
    super::fields::row(ui, "Facing", "Axis of the file along which the face looks.", false, |ui| {
        choose(ui, "Facing", &mut changed.facing, &AXES);
    });
    if changed.role == Role::Motion {
        super::fields::row(
            ui,
            "Joint",
            "The joint, bone or node that carries the head. Not used for .csv.",
            false,
            |ui| {
                ui.add(egui::TextEdit::singleline(&mut changed.node).desired_width(140.0));
            },
        );
    }
    if changed != *import {
        commands.push(Command::Show(Box::new(Dialog::Import(changed.clone()))));
    }
    buttons(ui, |ui| {
        if ui.button("Import").clicked() {
            commands.push(Command::CloseDialog);
            match session.import(&changed) {
                Some(command) => commands.push(command),
                None => {
                    let why = format!(
                        "{}: this path is not valid UTF-8, so a scene file cannot name it",
                        import.path.display()
                    );
                    commands.push(Command::Refuse { about: why.clone(), why });
                }
            }
        }
        if ui.button("Cancel").clicked() {
            commands.push(Command::CloseDialog);
        }
    });
}
