//! The chosen intervals in numbers: one, or what several have in common.

mod dial;
mod many;

use eframe::egui::{self, Stroke, Ui};
use glam::Vec3;
use nabiki_scene::scene::ForceSettings;
use nabiki_scene::told::Swing;

use super::fields::{row_of, send, side_by_side};
use super::hands::Hands;
use super::number::Number;
use super::{Commands, theme};
use crate::command::Command;
use crate::document::Phase;
use crate::session::Session;
use crate::timeline;
use dial::{Seen, dial};

/// Width of the names beside the fields (points).
const NAMES: f32 = 60.0;

/// The strongest wind that a field takes.
const MOST: f64 = 1e6;

/// What the axes are.
const AXES: &str = "x points where the face looks, y up, z to the character's right. The force has no physical unit.";

/// Draws them into so much height, or more where that is too little.
pub fn ui(ui: &mut Ui, session: &Session, height: f32, commands: &mut Commands) {
    let Some(document) = session.document() else { return };
    let (keys, strengths) = (&document.scene().field.force, session.strengths());
    let top = ui.cursor().top();
    ui.spacing_mut().item_spacing.y = 3.0;
    let vectors: Vec<Vec3> = match session.chosen() {
        [] => return none(ui, keys.len()),
        [j] => {
            one(ui, session, *j, commands);
            vec![strengths[*j].vector]
        }
        chosen => {
            many::ui(ui, keys, &strengths, chosen, commands);
            chosen.iter().map(|&j| strengths[j].vector).collect()
        }
    };
    let left = height - (ui.cursor().top() - top) - 6.0;
    ui.horizontal(|ui| {
        let side = ((ui.available_width() - 8.0) / 2.0).min(left).clamp(56.0, 100.0);
        for seen in [Seen::FromHerRight, Seen::FromAbove] {
            let dragged = dial(ui, side, seen, session.chosen(), &vectors, commands);
            commands.extend(dragged.map(|way| many::pointed(keys, &strengths, session.chosen(), seen, way)));
        }
    });
}

fn one(ui: &mut Ui, session: &Session, j: usize, commands: &mut Commands) {
    let Some(document) = session.document() else { return };
    let keys = &document.scene().field.force;
    let frames = timeline::frames(keys, j);
    ui.label(format!("Interval {} of {}", j + 1, keys.len()));
    row_of(ui, NAMES, "Frames", "The first and last frame with this vector.", false, |ui| {
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
    row_of(ui, NAMES, "Force", AXES, false, |ui| {
        side_by_side(ui, 36.0, |ui| {
            for (axis, name) in ["x", "y", "z"].into_iter().enumerate() {
                let mut number = f64::from(vector[axis]);
                let mut changed = vector;
                let what = format!("Force {name}");
                let field = Number { range: -MOST..=MOST, step: 0.5, decimals: 2, ..Number::of(&what) };
                let response = field.ui(ui, &mut number, commands).hint(name);
                underline(ui, &response, axis);
                let response = response.accessible_name(&what);
                changed[axis] = number as f32;
                send(&response, commands, |phase| directed(keys, j, changed, phase));
            }
        });
    });
    if let Some(speed) = keys[j].speed {
        row_of(ui, NAMES, "Speed", "The speed of the air. The direction stays the same.", false, |ui| {
            let mut number = f64::from(speed.number);
            ui.spacing_mut().interact_size.x = 64.0;
            let what = "Speed of the interval";
            let field = Number { range: 0.0..=MOST, step: 0.2, decimals: 1, unit: speed.unit(), ..Number::of(what) };
            let response = field.ui(ui, &mut number, commands).accessible_name(what);
            send(&response, commands, |phase| {
                let mut keys = keys.clone();
                keys[j].speed = Some(speed.with(number as f32));
                Command::Intervals { name: "Speed of an interval", keys, chosen: None, phase }
            });
        });
    }
    // That of a speed is what it comes to; another one takes the place of the speed.
    let strength = session.strengths()[j].vector;
    row_of(ui, NAMES, "Strength", "|F|. The direction stays the same.", false, |ui| {
        let mut length = f64::from(strength.length());
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
    if let Some(swing) = session.swings().and_then(|swings| swings.rows.get(j)).map(|row| row.swing) {
        let help = match swing {
            Swing::Segments(_) => {
                "How many frames a swing takes at the root, in the middle and at the tip. Four times the force halves them. \
                 The paper advises to check this when you choose a force."
            }
            Swing::Strand(_) => "How many frames the hair takes to swing under wind and weight together.",
        };
        row_of(ui, NAMES, "Swing", help, false, |ui| {
            let words = |&frames: &f64| if frames.is_finite() { format!("{frames:.0}") } else { "-".to_owned() };
            let text: Vec<String> = swing.frames().iter().map(words).collect();
            ui.label(format!("{} frames", text.join("  "))).hint(help);
        });
    }
}

/// Another vector of an interval: of one with a speed another direction.
fn directed(keys: &[ForceSettings], j: usize, vector: Vec3, phase: Phase) -> Command {
    if keys[j].speed.is_none() {
        return Command::Vector { interval: j, vector, phase };
    }
    let mut keys = keys.to_vec();
    keys[j].vector = vector;
    Command::Intervals { name: "Direction of intervals", keys, chosen: None, phase }
}

/// The colour of its axis below a field.
fn underline(ui: &Ui, response: &egui::Response, axis: usize) {
    let rect = response.rect;
    let stroke = Stroke::new(1.0, theme::AXES[axis]);
    ui.painter().hline(rect.x_range().shrink(4.0), rect.bottom() - 1.0, stroke);
}

fn none(ui: &mut Ui, intervals: usize) {
    let words = match intervals {
        0 => "There is no wind. Add an interval first.",
        _ => "Click an interval to see its vector, or drag the border between two.",
    };
    ui.add_space(4.0);
    ui.add(egui::Label::new(theme::faint(words)).wrap());
}

/// A tenth is as exact as a hand.
fn rounded(vector: Vec3) -> Vec3 {
    // Calm has no sign.
    (10.0 * vector).round() / 10.0 + Vec3::ZERO
}

/// The vector of an interval whose force a hand has turned to this: with a speed it is a direction.
fn turned(key: &ForceSettings, force: Vec3) -> Vec3 {
    match (key.speed, force.try_normalize()) {
        (None, _) => rounded(force),
        (Some(_), None) => key.vector,
        (Some(_), Some(direction)) => (1000.0 * direction).round() / 1000.0 + Vec3::ZERO,
    }
}
