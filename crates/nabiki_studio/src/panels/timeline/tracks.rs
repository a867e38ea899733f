//! What else moves hair over time: the strength that is felt, swirls, the head, and the envelopes of local fields.

use eframe::egui::{self, Align2, Color32, Rect, Sense, Stroke, Ui, pos2, vec2};
use glam::Vec3;
use nabiki::field::Ease;
use toml::{Table, Value};

use super::{Scale, track_name};
use crate::command::Command;
use crate::document::Phase;
use crate::panels::fields::number_of;
use crate::panels::hands::Hands;
use crate::panels::{Commands, theme};
use crate::session::Session;
use crate::settings::value_at;
use crate::take::Take;

/// Height of a track (points).
const HEIGHT: f32 = 26.0;

/// Draws all tracks that there is something to see in.
pub fn ui(
    ui: &mut Ui,
    next: &mut impl FnMut(f32) -> (Rect, Rect),
    scale: &Scale,
    session: &Session,
    commands: &mut Commands,
) {
    let Some(document) = session.document() else { return };
    let field = &document.scene().field;
    if let Some(take) = session.take() {
        let (row, lane) = next(HEIGHT);
        let name = if field.gust.is_some() { "Gusts" } else { "Strength" };
        track_name(ui, row, name, theme::FAINT);
        let felt: Vec<f32> = (0..=take.frames())
            .map(|n| take.built.forces.wind.uniform(n.max(1)).unwrap_or(Vec3::ZERO).length())
            .collect();
        let steps = field.wind.ease == Ease::Stepped && field.gust.is_none();
        curve(ui, lane, scale, &felt, theme::ACCENT, steps);
        hint(
            ui,
            lane,
            &format!("|F| of the wind in each frame, at most {:.0}", felt.iter().copied().fold(0.0, f32::max)),
        );
    }
    if field.turbulence.is_some() {
        let (row, lane) = next(HEIGHT);
        track_name(ui, row, "Turbulence", theme::FAINT);
        envelope(ui, lane, scale, session, "turbulence", commands);
    }
    if let Some(take) = session.take().filter(|take| take.built.head_moves()) {
        let (row, lane) = next(HEIGHT);
        track_name(ui, row, "Head", theme::FAINT);
        head(ui, lane, scale, take);
    }
    for (kind, name, count) in [
        ("fan", "Fan", field.fan.len()),
        ("vortex", "Whirl", field.vortex.len()),
        ("point", "Point", field.point.len()),
    ] {
        for i in 0..count {
            let (row, lane) = next(HEIGHT);
            track_name(ui, row, &format!("{name} {}", i + 1), theme::FAINT);
            envelope(ui, lane, scale, session, &format!("{kind}[{i}]"), commands);
        }
    }
    let (row, _) = next(20.0);
    let add = Rect::from_min_size(row.left_top(), vec2(68.0, 20.0));
    let mut child = ui.new_child(egui::UiBuilder::new().max_rect(add));
    child.menu_button(theme::faint("+ Track"), |ui| {
        let settings = session.settings();
        for (label, table, once) in [
            ("Gusts", "gust", true),
            ("Turbulence", "turbulence", true),
            ("Flow around the head", "flow", true),
            ("Fan", "fan", false),
            ("Whirl", "vortex", false),
            ("Point", "point", false),
            ("Head motion...", "head.motion", true),
        ] {
            let there = value_at(settings, table);
            let group = crate::settings::Page::ALL
                .into_iter()
                .flat_map(|page| page.groups())
                .find(|group| group.table == table);
            let enabled = !(once && there.is_some());
            if ui.add_enabled(enabled, egui::Button::new(label)).clicked() {
                let key = if once {
                    table.to_owned()
                } else {
                    format!("{table}[{}]", there.and_then(Value::as_array).map_or(0, Vec::len))
                };
                if table == "head.motion" {
                    let chooser = crate::dialog::Chooser {
                        purpose: crate::dialog::Purpose::Open,
                        path: document.scene().file().parent().map(crate::dialog::as_folder).unwrap_or_default(),
                        endings: crate::settings::MOTION_FILES.to_vec(),
                    };
                    commands.push(Command::Show(Box::new(crate::dialog::Dialog::File(chooser))));
                } else {
                    commands.push(Command::Set {
                        key,
                        value: group.and_then(|group| group.fresh()),
                        phase: Phase::Done,
                    });
                }
            }
        }
    });
}

fn hint(ui: &mut Ui, lane: Rect, text: &str) {
    ui.interact(lane, ui.scope_id().with((lane.top() as i32, "hint")), Sense::hover()).hint(text);
}

/// A curve through a value for each frame, from 0 to its largest; in `steps`, each holds through its frame.
fn curve(ui: &Ui, lane: Rect, scale: &Scale, values: &[f32], ink: Color32, steps: bool) {
    let most = values.iter().copied().fold(1e-6, f32::max);
    let y = |value: f32| lane.bottom() - 2.0 - (lane.height() - 4.0) * value / most;
    let painter = ui.painter().with_clip_rect(lane.intersect(ui.clip_rect()));
    painter.rect_filled(lane, 2.0, Color32::from_gray(28));
    let half = if steps { 0.5 } else { 0.0 };
    let ends = |n: usize, value: &f32| [-half, half].map(|half| pos2(scale.x(n as f64 + half), y(*value)));
    let points: Vec<egui::Pos2> = values.iter().enumerate().flat_map(|(n, value)| ends(n, value)).collect();
    let mut mesh = egui::Mesh::default();
    for (n, point) in points.iter().enumerate() {
        mesh.colored_vertex(*point, ink.gamma_multiply(0.25));
        mesh.colored_vertex(pos2(point.x, lane.bottom()), ink.gamma_multiply(0.05));
        if n > 0 {
            let k = 2 * n as u32;
            mesh.add_triangle(k - 2, k - 1, k);
            mesh.add_triangle(k - 1, k, k + 1);
        }
    }
    painter.add(mesh);
    painter.line(points, Stroke::new(1.2, ink.gamma_multiply(0.9)));
}

/// How far the head is turned from where it was at rest, and how far it went.
fn head(ui: &mut Ui, lane: Rect, scale: &Scale, take: &Take) {
    let rest = take.pose(0);
    let turned: Vec<f32> = (0..=take.frames())
        .map(|n| {
            let turn = take.pose(n).rotation * rest.rotation.inverse();
            let ahead = turn * Vec3::X;
            (-ahead.z).atan2(ahead.x).to_degrees()
        })
        .collect();
    let gone: Vec<f32> = (0..=take.frames()).map(|n| take.pose(n).position_cm.distance(rest.position_cm)).collect();
    curve(ui, lane, scale, &gone, theme::AXES[1], false);
    let painter = ui.painter().with_clip_rect(lane.intersect(ui.clip_rect()));
    let most = turned.iter().map(|angle| angle.abs()).fold(1.0, f32::max);
    let points = turned.iter().enumerate();
    let points =
        points.map(|(n, angle)| pos2(scale.x(n as f64), lane.center().y - 0.45 * lane.height() * angle / most));
    painter.line(points.collect(), Stroke::new(1.2, theme::TEXT));
    let far = gone.iter().copied().fold(0.0, f32::max);
    hint(
        ui,
        lane,
        &format!(
            "White: turn about the vertical, up to {most:.0} degrees either way. Green: distance moved, up to {far:.1} cm"
        ),
    );
}

/// The envelope of a local field: keys to drag, a double click for another one.
fn envelope(ui: &mut Ui, lane: Rect, scale: &Scale, session: &Session, table: &str, commands: &mut Commands) {
    let painter = ui.painter().with_clip_rect(lane.intersect(ui.clip_rect()));
    painter.rect_filled(lane, 2.0, Color32::from_gray(28));
    let key = format!("{table}.envelope");
    let keys: Vec<(i64, f64)> = value_at(session.settings(), &key)
        .and_then(Value::as_array)
        .into_iter()
        .flatten()
        .filter_map(|key| Some((key.get("frame")?.as_integer()?, number_of(key.get("factor")?)?)))
        .collect();
    let most = keys.iter().map(|(_, factor)| factor.abs()).fold(1.0, f64::max);
    let y = |factor: f64| lane.bottom() - 4.0 - (lane.height() - 8.0) * (factor / most).clamp(0.0, 1.0) as f32;
    let factor = |y: f32| f64::from((lane.bottom() - 4.0 - y) / (lane.height() - 8.0)) * most;
    let set = |keys: &[(i64, f64)], phase| Command::Set {
        key: key.clone(),
        value: (!keys.is_empty())
            .then(|| Value::Array(keys.iter().map(|&(frame, factor)| as_key(frame, factor)).collect())),
        phase,
    };
    let behind = ui.interact(lane, ui.scope_id().with((table, "envelope")), Sense::click());
    if behind.double_clicked()
        && let Some(pointer) = behind.interact_pointer_pos()
    {
        let (frame, factor) = (i64::from(scale.frame(pointer.x)), (factor(pointer.y) * 100.0).round() / 100.0);
        let mut keys = keys.clone();
        keys.retain(|known| known.0 != frame);
        keys.push((frame, factor.max(0.0)));
        keys.sort_by_key(|key| key.0);
        commands.push(set(&keys, Phase::Done));
    }
    behind.hint("Its strength over time. Double-click to add a key, drag to move one, right-click to remove one.");
    let (first, last) = (keys.first().map_or(1.0, |key| key.1), keys.last().map_or(1.0, |key| key.1));
    let ends = (pos2(lane.left(), y(first)), pos2(lane.right(), y(last)));
    let way = std::iter::once(ends.0)
        .chain(keys.iter().map(|&(frame, factor)| pos2(scale.x(frame as f64), y(factor))))
        .chain([ends.1]);
    painter.line(way.collect(), Stroke::new(1.2, theme::AXES[2]));
    for (i, &(frame, part)) in keys.iter().enumerate() {
        let at = pos2(scale.x(frame as f64), y(part));
        let response = ui.interact(
            Rect::from_center_size(at, vec2(12.0, 12.0)),
            ui.scope_id().with((table, "key", i)),
            Sense::click_and_drag(),
        );
        let mut moved = keys.clone();
        if let Some(pointer) = response.held_at() {
            let low = i.checked_sub(1).map_or(0, |i| keys[i].0 + 1);
            // Keys of one frame, which a scene refuses, can be dragged apart.
            let high = keys.get(i + 1).map_or(i64::from(u32::MAX), |key| key.0 - 1).max(low);
            let part = (factor(pointer.y).clamp(0.0, most.max(1.0)) * 100.0).round() / 100.0;
            moved[i] = (i64::from(scale.frame(pointer.x)).clamp(low, high), part);
            commands.push(set(&moved, Phase::Dragging));
        }
        if response.drag_stopped() {
            commands.push(Command::EndDrag);
        }
        if response.secondary_clicked() {
            moved.remove(i);
            commands.push(set(&moved, Phase::Done));
        }
        let ink = if response.hovered() || response.dragged() { theme::ACCENT } else { theme::TEXT };
        let painter = ui.painter().with_clip_rect(lane.intersect(ui.clip_rect()));
        let diamond = [vec2(0.0, -4.5), vec2(4.5, 0.0), vec2(0.0, 4.5), vec2(-4.5, 0.0)].map(|way| at + way);
        painter.add(egui::Shape::convex_polygon(diamond.to_vec(), ink, Stroke::NONE));
        response.hint(format!("Frame {frame}: {part} times the strength"));
    }
    if keys.is_empty() {
        let at = lane.left_center() + vec2(6.0, 0.0);
        painter.text(at, Align2::LEFT_CENTER, "always", egui::FontId::proportional(10.5), theme::FAINT);
    }
}

fn as_key(frame: i64, factor: f64) -> Value {
    let entries: [(String, Value); 2] = [("frame".to_owned(), frame.into()), ("factor".to_owned(), factor.into())];
    Value::Table(Table::from_iter(entries))
}
