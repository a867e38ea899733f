//! The last line: what is shown and how fast, what is wrong, what runs in the background.

use std::time::Duration;

use eframe::egui::{self, Ui};

use super::hands::Hands;
use super::{Commands, theme};
use crate::command::Command;
use crate::dialog::Dialog;
use crate::motion::{Stage, most_strands};
use crate::preferences::{ALL, FEWEST};
use crate::session::Session;
use crate::take::{TOUCHED, Take};
use crate::tasks::{Ended, Task};

/// Most of a window that is covered by what has to be said; the rest is scrolled.
const MOST_WORDS: f32 = 0.3;

fn has_words(session: &Session) -> bool {
    session.trouble().is_some() || !session.words().is_empty() || !session.tasks().is_empty()
}

/// What is said, as an area of the window.
fn area() -> egui::Id {
    egui::Id::unique("words")
}

/// Draws what has to be said: trouble, words and tasks. It lies over the lower end of a place, so that nothing changes its size
/// when words come and go.
pub fn words(ctx: &egui::Context, over: egui::Rect, session: &Session, commands: &mut Commands) {
    if !has_words(session) {
        return;
    }
    let area = egui::Area::new(area()).order(egui::Order::Middle).movable(false).constrain(false).fade_in(false);
    area.pivot(egui::Align2::LEFT_BOTTOM).fixed_pos(over.left_bottom()).show(ctx, |ui| {
        ui.set_width(over.width());
        ui.spacing_mut().item_spacing.y = 1.0;
        let most = (MOST_WORDS * ctx.content_rect().height()).min(over.height());
        // An area has the height that it had before: without a least height what is scrolled never grows over that.
        let scrolled = egui::ScrollArea::vertical().max_height(most).min_scrolled_height(most);
        let scrolled = scrolled.auto_shrink([false, true]);
        scrolled.show(ui, |ui| bars(ui, session, commands));
    });
}

/// How high that is (points).
pub fn height_of_words(ctx: &egui::Context, session: &Session) -> f32 {
    let drawn = ctx.memory(|memory| memory.area_rect(area())).filter(|_| has_words(session));
    drawn.map_or(0.0, |rect| rect.height())
}

fn bars(ui: &mut Ui, session: &Session, commands: &mut Commands) {
    if let Some(trouble) = session.trouble() {
        bar(ui, theme::WRONG, |ui| {
            let may_undo = session.document().is_some_and(|document| document.undo_name().is_some());
            if may_undo && ui.button("Undo").clicked() {
                commands.push(Command::Act(crate::actions::Action::Undo));
            }
            let text = egui::RichText::new(&trouble.text).color(theme::TEXT);
            ui.add(egui::Label::new(text).wrap().selectable(true));
        });
    }
    for (n, word) in session.words().iter().enumerate() {
        bar(ui, if word.wrong { theme::WRONG } else { theme::GOOD }, |ui| {
            if ui.small_button("x").hint("Dismisses this message.").clicked() {
                commands.push(Command::Heard(n));
            }
            ui.add(egui::Label::new(&word.text).wrap().selectable(true));
        });
    }
    for (n, task) in session.tasks().iter().enumerate() {
        let is_running = task.progress().ended.is_none();
        bar(ui, theme::ACCENT, |ui| {
            if is_running {
                // One line, whose parts are of different heights.
                ui.horizontal(|ui| self::task(ui, n, task, commands));
            } else {
                self::task(ui, n, task, commands);
            }
        });
    }
}

fn bar(ui: &mut Ui, ink: egui::Color32, contents: impl FnOnce(&mut Ui)) {
    let frame = egui::Frame::new().fill(egui::Color32::from_gray(38)).inner_margin(egui::Margin::symmetric(10, 4));
    let response = frame.show(ui, |ui| {
        ui.set_min_width(ui.available_width());
        // As high as what is in it: a layout that is centred would take all the height there is.
        ui.horizontal_top(contents);
    });
    let rect = response.response.rect;
    ui.painter().vline(rect.left() + 1.5, rect.y_range(), egui::Stroke::new(3.0, ink));
}

fn task(ui: &mut Ui, n: usize, task: &Task, commands: &mut Commands) {
    let progress = task.progress();
    let (kind, place) = (task.order.kind.name(), task.order.place.display());
    match &progress.ended {
        None => {
            if ui.add_enabled(!task.is_cancelled(), egui::Button::new("Cancel")).clicked() {
                commands.push(Command::Cancel(n));
            }
            let left = progress.left().map(|left| format!(", {} left", time(left))).unwrap_or_default();
            let doing = if task.is_cancelled() { "stopping" } else { progress.doing.as_str() };
            ui.label(format!("{kind}: {doing} {} of {}{left}", progress.steps[0], progress.steps[1]));
            let bar = egui::ProgressBar::new(progress.part()).desired_width(160.0).desired_height(6.0);
            ui.add(bar.fill(theme::ACCENT));
            ui.add(egui::Label::new(theme::faint(place.to_string())).truncate());
        }
        Some(ended) => {
            if ui.small_button("x").hint("Dismisses this message.").clicked() {
                commands.push(Command::Dismiss(n));
            }
            let text = match ended {
                Ended::Wrote(files) => {
                    let files: Vec<String> = files.iter().map(|file| file.display().to_string()).collect();
                    format!("{kind}: wrote {}", files.join(", "))
                }
                Ended::Cancelled => format!("{kind}: cancelled, no files were left"),
                Ended::Failed(why) => format!("{kind}: {why}"),
            };
            let ink = if matches!(ended, Ended::Failed(_)) { theme::WRONG } else { theme::TEXT };
            let said = progress.said.iter().map(|line| format!("\n{line}")).collect::<String>();
            ui.add(egui::Label::new(egui::RichText::new(text + &said).color(ink)).wrap().selectable(true));
        }
    }
}

/// Draws the line.
pub fn line(ui: &mut Ui, session: &Session, fps: f32, commands: &mut Commands) {
    ui.horizontal(|ui| {
        ui.set_min_height(22.0);
        ui.add_space(6.0);
        let Some(take) = session.take() else {
            ui.label(theme::faint(if session.is_moving() { "Moving the hair..." } else { "No motion yet" }));
            return;
        };
        self::strands(ui, session, take, commands);
        ui.separator();
        let took = session.took().as_secs_f64() * 1000.0;
        let text = format!("{} frames in {}", take.frames(), time_short(took));
        ui.label(theme::faint(text)).hint("How long it took to move all frames after the last change.");
        if session.is_moving() {
            // Nothing that turns: it would have the window drawn all the while, by the cores that move the hair.
            ui.label(theme::faint("moving..."));
        }
        ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
            ui.add_space(8.0);
            if session.play.is_playing() {
                ui.label(theme::faint(format!("{fps:.0} fps")));
            } else if ui.add(egui::Label::new(theme::faint("F1 keys")).sense(egui::Sense::click())).clicked() {
                commands.push(Command::Show(Box::new(Dialog::Keys)));
            }
        });
    });
}

/// How many strands are shown: a few to all.
fn strands(ui: &mut Ui, session: &Session, take: &Take, commands: &mut Commands) {
    let whole = take.built.groom.of_scene;
    let most = most_strands(take).max(FEWEST);
    let mut strands = session.preferences().strands.min(most);
    ui.label(theme::faint("Strands"));
    ui.spacing_mut().slider_width = 110.0;
    let slider = egui::Slider::new(&mut strands, FEWEST..=most).logarithmic(true).show_value(false);
    let help = format!(
        "How many strands the view shows. Up to {TOUCHED} move with every change; more follow when you pause. Each moves \
         exactly as it does among all strands. At the right end: {}.",
        if most < whole { format!("{most}, as many as memory allows") } else { format!("all {whole}") }
    );
    let response = ui.add(slider).hint(help).accessible_name("Strands shown");
    if response.changed() {
        commands.push(Command::Strands(if strands == most { ALL } else { strands }));
    }
    let shown = take.strands().len();
    let all = if shown == whole { format!("all {whole}") } else { format!("{shown} of {whole}") };
    ui.label(match session.progress_deep() {
        Some((stage, part)) => {
            let wanted = session.preferences().strands.min(most);
            let percent = 100.0 * part;
            match stage {
                Stage::Building if take.built.groom.imported.is_some() => {
                    format!("{shown} of {wanted}, reading the others")
                }
                Stage::Building => format!("{shown} of {wanted}, growing the others: {percent:.0} %"),
                Stage::Moving => format!("{shown} of {wanted}, moving the others: {percent:.0} %"),
            }
        }
        None => all,
    });
}

fn time_short(milliseconds: f64) -> String {
    if milliseconds < 100.0 { format!("{milliseconds:.1} ms") } else { format!("{:.2} s", milliseconds / 1000.0) }
}

fn time(left: Duration) -> String {
    let seconds = left.as_secs();
    match seconds {
        0..60 => format!("{seconds} s"),
        60..3600 => format!("{} min {} s", seconds / 60, seconds % 60),
        _ => format!("{} h {} min", seconds / 3600, seconds / 60 % 60),
    }
}
