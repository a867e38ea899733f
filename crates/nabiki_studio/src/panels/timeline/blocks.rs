//! The intervals of the wind as blocks, with borders to drag.

use eframe::egui::{self, Align2, Color32, CursorIcon, Rect, Sense, Stroke, Ui, pos2, vec2};
use glam::Vec3;
use nabiki_scene::scene::ForceSettings;
use nabiki_scene::told::Swing;

use super::Scale;
use crate::command::Command;
use crate::document::Phase;
use crate::panels::hands::Hands;
use crate::panels::{Commands, theme};
use crate::session::Session;
use crate::timeline;

/// Half the width of what a border is taken hold of by (points).
const GRIP: f32 = 5.0;

/// Draws them.
pub fn ui(ui: &mut Ui, rect: Rect, scale: &Scale, session: &Session, commands: &mut Commands) {
    let Some(document) = session.document() else { return };
    let keys = &document.scene().field.force;
    if keys.is_empty() {
        let text = "No wind. Add an interval (A).";
        ui.painter().text(rect.left_center() + vec2(8.0, 0.0), Align2::LEFT_CENTER, text, font(), theme::FAINT);
        return;
    }
    let strengths = session.strengths();
    let strongest = strengths.iter().map(|key| key.vector.length()).fold(1e-6, f32::max);
    for (j, strength) in strengths.iter().enumerate() {
        block(ui, rect, scale, session, keys, j, strength.vector.length() / strongest, commands);
    }
    for j in 0..keys.len() {
        border(ui, rect, scale, keys, j, commands);
    }
}

fn font() -> egui::FontId {
    egui::FontId::proportional(theme::SMALL)
}

#[expect(clippy::too_many_arguments, reason = "one block of a row")]
fn block(
    ui: &mut Ui,
    row: Rect,
    scale: &Scale,
    session: &Session,
    keys: &[ForceSettings],
    j: usize,
    of_strongest: f32,
    commands: &mut Commands,
) {
    let frames = timeline::frames(keys, j);
    let (left, right) = (scale.x(f64::from(*frames.start()) - 0.5), scale.x(f64::from(*frames.end()) + 0.5));
    let rect = Rect::from_min_max(pos2(left + 1.0, row.top()), pos2((right - 1.0).max(left + 2.0), row.bottom()));
    let touch = rect.shrink2(vec2(GRIP.min(rect.width() / 4.0), 0.0)).intersect(ui.clip_rect());
    let response = ui.interact(touch, ui.scope_id().with(("block", j)), Sense::click_and_drag());
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, true, format!("Interval {}", j + 1)));
    let chosen = session.chosen().contains(&j);
    if response.clicked() {
        commands.push(Command::Choose(chosen_after(ui, session.chosen(), j)));
    }
    drag(ui, &response, scale, session, keys, j, commands);
    let blamed = session
        .trouble()
        .and_then(|trouble| trouble.key.as_deref())
        .is_some_and(|key| key.starts_with(&format!("force[{j}]")));
    let fill = match (chosen, response.hovered()) {
        (true, _) => Color32::from_rgb(78, 66, 50),
        (_, true) => Color32::from_gray(58),
        _ => Color32::from_gray(49),
    };
    let edge = match (blamed, chosen) {
        (true, _) => theme::WRONG,
        (_, true) => theme::ACCENT,
        _ => Color32::from_gray(62),
    };
    let painter = ui.painter().with_clip_rect(row.intersect(ui.clip_rect()));
    painter.rect(rect, 3.0, fill, Stroke::new(1.0, edge), egui::StrokeKind::Inside);
    let painter = painter.with_clip_rect(rect.intersect(row).intersect(ui.clip_rect()));
    let vector = keys[j].vector;
    // What is seen of a block carries its words, wherever its ends are.
    let seen = rect.intersect(row);
    let middle = pos2(seen.left() + 26.0_f32.min(seen.width() / 2.0), rect.center().y);
    arrow(&painter, middle, vector, 22.0 * of_strongest.sqrt());
    if seen.width() > 92.0 {
        let x = seen.left() + 54.0;
        painter.text(pos2(x, rect.top() + 17.0), Align2::LEFT_CENTER, strength(&keys[j]), font(), theme::TEXT);
        let lines = if seen.width() > 112.0 { 2 } else { 0 };
        let words = [format!("{} to {}", frames.start(), frames.end()), swing(session, j)];
        for (i, text) in words.into_iter().take(lines).enumerate() {
            let at = pos2(x, rect.top() + 32.0 + 14.0 * i as f32);
            painter.text(at, Align2::LEFT_CENTER, text, egui::FontId::proportional(10.5), theme::FAINT);
        }
    }
    let [x, y, z] = vector.to_array();
    let force = keys[j].speed.map_or("Force".to_owned(), |speed| format!("{speed} along"));
    response.hint(format!(
        "Frames {} to {}\n{force} {x}, {y}, {z}\n{}\n\nDrag the block to move it in time, or a border to change its length.\nHold Shift to move everything after it along.",
        frames.start(),
        frames.end(),
        swings(session, j)
    ));
}

fn strength(key: &ForceSettings) -> String {
    if let Some(speed) = key.speed {
        return speed.to_string();
    }
    match key.vector.length() {
        0.0 => "calm".to_owned(),
        length if length < 10.0 => format!("{length:.1}"),
        length => format!("{length:.0}"),
    }
}

/// What is chosen after a click on an interval, by what is held.
fn chosen_after(ui: &Ui, chosen: &[usize], j: usize) -> Vec<usize> {
    let held = ui.input(|input| input.modifiers);
    let mut after = chosen.to_vec();
    if held.command {
        match after.iter().position(|&known| known == j) {
            Some(at) => drop(after.remove(at)),
            None => after.push(j),
        }
    } else if let (true, Some(&first), Some(&last)) = (held.shift, chosen.first(), chosen.last()) {
        after = (first.min(j)..=last.max(j)).collect();
    } else {
        after = vec![j];
    }
    after.sort_unstable();
    after
}

/// Slides what is dragged, all that is chosen with it.
fn drag(
    ui: &Ui,
    response: &egui::Response,
    scale: &Scale,
    session: &Session,
    keys: &[ForceSettings],
    j: usize,
    commands: &mut Commands,
) {
    let id = response.id.with("from");
    if response.drag_started() {
        ui.data_mut(|data| data.insert_temp(id, keys.to_vec()));
        if !session.chosen().contains(&j) {
            commands.push(Command::Choose(vec![j]));
        }
    }
    if let Some(pointer) = response.held_at()
        && let Some(start) = ui.input(|input| input.pointer.press_origin())
        && let Some(from) = ui.data(|data| data.get_temp::<Vec<ForceSettings>>(id))
    {
        let by = (scale.time(pointer.x) - scale.time(start.x)).round() as i64;
        let moving = if session.chosen().contains(&j) { session.chosen().to_vec() } else { vec![j] };
        let keys = timeline::slide(&from, &moving, by);
        commands.push(Command::Intervals { name: "Slide", keys, chosen: None, phase: Phase::Dragging });
    }
    if response.drag_stopped() {
        ui.data_mut(|data| data.remove::<Vec<ForceSettings>>(id));
        commands.push(Command::EndDrag);
    }
}

fn border(ui: &mut Ui, row: Rect, scale: &Scale, keys: &[ForceSettings], j: usize, commands: &mut Commands) {
    let x = scale.x(f64::from(keys[j].through) + 0.5);
    let grip = Rect::from_x_y_ranges(x - GRIP..=x + GRIP, row.y_range());
    if !grip.intersects(row) {
        return;
    }
    let response = ui.interact(grip, ui.scope_id().with(("border", j)), Sense::drag());
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Slider, true, format!("Border {}", j + 1)));
    let response = response.on_hover_and_drag_cursor(CursorIcon::ResizeHorizontal);
    if let Some(pointer) = response.held_at() {
        let frame = (scale.time(pointer.x) - 0.5).round().max(1.0) as u32;
        let ripple = ui.input(|input| input.modifiers.shift);
        let keys = timeline::move_border(keys, j, frame, ripple);
        commands.push(Command::Intervals { name: "Move a border", keys, chosen: None, phase: Phase::Dragging });
    }
    if response.drag_stopped() {
        commands.push(Command::EndDrag);
    }
    if response.hovered() || response.dragged() {
        ui.painter().vline(x, row.y_range(), Stroke::new(2.0, theme::ACCENT));
        if response.dragged() {
            let at = pos2(x, row.top() - 2.0);
            ui.painter().text(at, Align2::CENTER_BOTTOM, keys[j].through, font(), theme::ACCENT);
        }
    }
}

/// A vector as it is seen from the character's right, a little from in front and above.
pub fn arrow(painter: &egui::Painter, middle: egui::Pos2, vector: Vec3, length: f32) {
    let Some(direction) = vector.try_normalize() else {
        painter.circle_filled(middle, 2.0, theme::FAINT);
        return;
    };
    let flat = vec2(direction.x - 0.35 * direction.z, -direction.y + 0.3 * direction.z) * length;
    if flat.length() < 3.0 {
        painter.circle_stroke(middle, 4.0, Stroke::new(1.5, theme::ACCENT));
        return;
    }
    let (tail, tip) = (middle - 0.5 * flat, middle + 0.5 * flat);
    let along = flat.normalized();
    let head = 6.0_f32.min(0.6 * flat.length());
    let across = along.rot90() * head * 0.55;
    painter.line_segment([tail, tip - along * head], Stroke::new(2.0, theme::ACCENT));
    let triangle = vec![tip, tip - along * head + across, tip - along * head - across];
    painter.add(egui::Shape::convex_polygon(triangle, theme::ACCENT, Stroke::NONE));
}

/// The swing at the tip, in a few words.
fn swing(session: &Session, j: usize) -> String {
    match session.swings().and_then(|swings| swings.rows.get(j)).map(|row| row.swing.of_tip()) {
        Some(tip) if tip.is_finite() => format!("swing {tip:.0}"),
        _ => String::new(),
    }
}

/// All that is known of it.
fn swings(session: &Session, j: usize) -> String {
    let Some(row) = session.swings().and_then(|swings| swings.rows.get(j)) else { return String::new() };
    let words = |frames: f64| if frames.is_finite() { format!("{frames:.0}") } else { "-".to_owned() };
    match row.swing {
        Swing::Segments(frames) => {
            let [root, middle, tip] = frames.map(words);
            format!("A swing takes {root} frames at the root, {middle} in the middle, {tip} at the tip.")
        }
        Swing::Strand(frames) => format!("A swing takes {} frames.", words(frames)),
    }
}
