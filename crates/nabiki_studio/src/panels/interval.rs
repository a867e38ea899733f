//! The chosen interval in numbers.

use eframe::egui::{self, Sense, Stroke, Ui, pos2, vec2};
use glam::Vec3;
use nabiki::field::Ease;

use super::fields::{row_of, send, side_by_side};
use super::number::Number;
use super::{Commands, theme};
use crate::command::Command;
use crate::document::Phase;
use crate::session::Session;
use crate::timeline;

/// Width of the names beside the fields (points).
const NAMES: f32 = 60.0;

/// The strongest wind that a field takes.
const MOST: f64 = 1e6;

/// Draws it into so much height, or more where that is too little.
pub fn ui(ui: &mut Ui, session: &Session, height: f32, commands: &mut Commands) {
    let Some(document) = session.document() else { return };
    let scene = document.scene();
    let keys = &scene.field.force;
    let [j] = session.chosen() else {
        none(ui, session, keys.len());
        return;
    };
    let j = *j;
    let top = ui.cursor().top();
    let frames = timeline::frames(keys, j);
    ui.spacing_mut().item_spacing.y = 3.0;
    ui.horizontal(|ui| {
        ui.label(format!("Interval {} of {}", j + 1, keys.len()));
        ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
            let ease = match scene.field.wind.ease {
                Ease::Stepped => "stepped",
                Ease::Linear => "linear",
                Ease::Smooth => "smooth",
            };
            let help = "How one vector leads to the next, in all intervals (E).";
            if ui.small_button(ease).on_hover_text(help).clicked() {
                commands.push(Command::Act(crate::actions::Action::Ease));
            }
        });
    });
    row_of(ui, NAMES, "Frames", "First and last frame that feel this vector.", false, |ui| {
        ui.spacing_mut().interact_size.x = 46.0;
        ui.label(theme::faint(format!("{} to", frames.start())));
        let mut through = f64::from(*frames.end());
        let high = keys.get(j + 1).map_or(10_000_000, |next| next.through - 1);
        let range = f64::from(*frames.start())..=f64::from(high);
        let what = "Last frame of the interval";
        let field = Number { range, step: 0.25, decimals: 0, ..Number::of(what) };
        let response = field.ui(ui, &mut through, commands).accessible_name(what);
        send(&response, commands, |phase| Command::Intervals {
            name: "Move a border",
            keys: timeline::move_border(keys, j, through as u32, false),
            chosen: None,
            phase,
        });
    });
    let vector = keys[j].vector;
    row_of(
        ui,
        NAMES,
        "Force",
        "x: where the face looks, y: up, z: to the character's right. Without a unit: only its effect counts.",
        false,
        |ui| {
            side_by_side(ui, 36.0, |ui| {
                for (axis, name) in ["x", "y", "z"].into_iter().enumerate() {
                    let mut number = f64::from(vector[axis]);
                    let mut changed = vector;
                    let what = format!("Force {name}");
                    let field = Number { range: -MOST..=MOST, step: 0.5, decimals: 2, ..Number::of(&what) };
                    let response = field.ui(ui, &mut number, commands).on_hover_text(name);
                    let rect = response.rect;
                    ui.painter().hline(
                        rect.x_range().shrink(4.0),
                        rect.bottom() - 1.0,
                        Stroke::new(1.0, theme::AXES[axis]),
                    );
                    let response = response.accessible_name(&what);
                    changed[axis] = number as f32;
                    send(&response, commands, |phase| Command::Vector { interval: j, vector: changed, phase });
                }
            });
        },
    );
    row_of(ui, NAMES, "Strength", "|F|: its direction stays.", false, |ui| {
        let mut length = f64::from(vector.length());
        ui.spacing_mut().interact_size.x = 64.0;
        let what = "Strength of the interval";
        let field = Number { range: 0.0..=MOST, step: 0.5, decimals: 1, ..Number::of(what) };
        let response = field.ui(ui, &mut length, commands).accessible_name(what);
        let direction = vector.try_normalize().unwrap_or(Vec3::NEG_X);
        send(&response, commands, |phase| Command::Vector {
            interval: j,
            vector: rounded(direction * length as f32),
            phase,
        });
    });
    if let Some([root, middle, tip]) = session.swings().and_then(|swings| swings.rows.get(j)).map(|row| row.periods) {
        let help = "Frames that a swing takes at the root, in the middle and at the tip, as the paper advises to look at when a \
                    force is chosen: four times the force halves it.";
        row_of(ui, NAMES, "Swing", help, false, |ui| {
            let text = [root, middle, tip]
                .map(|frames| if frames.is_finite() { format!("{frames:.0}") } else { "-".to_owned() });
            ui.label(format!("{} frames", text.join("  "))).on_hover_text(help);
        });
    }
    let left = height - (ui.cursor().top() - top) - 6.0;
    ui.horizontal(|ui| {
        let side = ((ui.available_width() - 8.0) / 2.0).min(left).clamp(56.0, 100.0);
        dial(ui, side, Seen::FromHerRight, j, vector, commands);
        dial(ui, side, Seen::FromAbove, j, vector, commands);
    });
}

fn none(ui: &mut Ui, session: &Session, intervals: usize) {
    match session.chosen().len() {
        0 => {
            let words = match intervals {
                0 => "There is no wind. Add an interval to have some.",
                _ => "Click an interval to see its vector, or drag a border between two.",
            };
            ui.add_space(4.0);
            ui.add(egui::Label::new(theme::faint(words)).wrap());
        }
        n => drop(ui.label(theme::faint(format!("{n} of {intervals} intervals are chosen.")))),
    }
}

/// A tenth is as exact as a hand.
fn rounded(vector: Vec3) -> Vec3 {
    // Calm has no sign.
    (10.0 * vector).round() / 10.0 + Vec3::ZERO
}

/// From where a vector is seen.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
enum Seen {
    FromHerRight,
    FromAbove,
}

/// A vector as an arrow in a circle, to be dragged.
fn dial(ui: &mut Ui, side: f32, seen: Seen, j: usize, vector: Vec3, commands: &mut Commands) {
    let (rect, response) = ui.allocate_exact_size(vec2(side, side), Sense::click_and_drag());
    let (name, help) = match seen {
        Seen::FromHerRight => {
            ("Dial from the right", "From the character's right: she looks to the right. Drag the arrow.")
        }
        Seen::FromAbove => ("Dial from above", "From above: she looks to the right. Drag the arrow."),
    };
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Slider, true, name));
    let (centre, radius) = (rect.center(), side / 2.0 - 3.0);
    // The circle grows by powers of two, so that the arrow fits and does not run away from the hand while it is dragged.
    let id = response.id.with("reach");
    let fitting = 50.0 * 2.0_f32.powf((vector.length().max(25.0) * 1.2 / 50.0).log2().ceil());
    let reach = if response.dragged() { ui.data(|data| data.get_temp(id)).unwrap_or(fitting) } else { fitting };
    ui.data_mut(|data| data.insert_temp(id, reach));
    let scale = radius / reach;
    if response.dragged()
        && let Some(pointer) = response.interact_pointer_pos()
    {
        let way = (pointer - centre) / scale;
        let changed = match seen {
            Seen::FromHerRight => Vec3::new(way.x, -way.y, vector.z),
            Seen::FromAbove => Vec3::new(way.x, vector.y, way.y),
        };
        commands.push(Command::Vector { interval: j, vector: rounded(changed), phase: Phase::Dragging });
    }
    if response.drag_stopped() {
        commands.push(Command::EndDrag);
    }
    let painter = ui.painter();
    painter.circle(centre, radius, theme::GROUND, Stroke::new(1.0, theme::LINE));
    painter.hline(centre.x - radius..=centre.x + radius, centre.y, Stroke::new(1.0, theme::LINE));
    painter.vline(centre.x, centre.y - radius..=centre.y + radius, Stroke::new(1.0, theme::LINE));
    // The head, so that it is seen where she looks.
    painter.circle_filled(centre, 7.0, egui::Color32::from_gray(52));
    painter.circle_filled(pos2(centre.x + 7.5, centre.y), 2.0, egui::Color32::from_gray(52));
    let flat = match seen {
        Seen::FromHerRight => vec2(vector.x, -vector.y),
        Seen::FromAbove => vec2(vector.x, vector.z),
    } * scale;
    let flat = if flat.length() > radius { flat.normalized() * radius } else { flat };
    let tip = centre + flat;
    let ink = if response.hovered() || response.dragged() { theme::ACCENT } else { theme::ACCENT.gamma_multiply(0.85) };
    painter.line_segment([centre, tip], Stroke::new(2.0, ink));
    painter.circle_filled(tip, 4.0, ink);
    response.on_hover_text(format!("{help}\nThe circle is {reach}."));
}
