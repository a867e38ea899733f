//! What several intervals have in common, to be changed in all of them at once: one step.

use eframe::egui::{Response, Ui, Vec2};
use glam::Vec3;
use nabiki::field::Keyframe;
use nabiki_scene::scene::ForceSettings;

use super::dial::Seen;
use super::{AXES, MOST, NAMES, directed, rounded, turned, underline};
use crate::command::Command;
use crate::document::Phase;
use crate::panels::fields::{row_of, send, side_by_side};
use crate::panels::hands::Hands;
use crate::panels::number::Number;
use crate::panels::{Commands, theme};
use crate::timeline;

/// A number that all share, or the mean of those that differ.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Shared {
    number: f64,
    mixed: bool,
}

impl Shared {
    fn of(numbers: impl Iterator<Item = f64> + Clone) -> Self {
        let first = numbers.clone().next().unwrap_or_default();
        let mixed = numbers.clone().any(|number| number != first);
        let count = numbers.clone().count().max(1) as f64;
        // A mean that somebody types is another number than the one that stands for what differs.
        let number = if mixed { numbers.sum::<f64>() / count + 1e-9 } else { first };
        Self { number, mixed }
    }

    /// What a field has made of it for one of the numbers: what was typed, or as much more as it was dragged by.
    fn applied(self, to: f64, response: &Response, field: f64) -> f64 {
        if response.dragged() || response.drag_stopped() { to + field - self.number } else { field }
    }
}

/// Draws fields for the chosen intervals, which are so strong.
pub fn ui(ui: &mut Ui, keys: &[ForceSettings], strengths: &[Keyframe], chosen: &[usize], commands: &mut Commands) {
    let (first, last) = (chosen[0], chosen[chosen.len() - 1]);
    ui.label(format!("{} of {} intervals", chosen.len(), keys.len()));
    let lengths = chosen.iter().map(|&j| f64::from(length(keys, j)));
    let shared = Shared::of(lengths);
    let help = "How many frames each selected interval has. Everything after it moves along.";
    row_of(ui, NAMES, "Frames", help, false, |ui| {
        let mut number = shared.number;
        ui.spacing_mut().interact_size.x = 46.0;
        let what = "Frames of each interval";
        let field = Number { range: 1.0..=1e7, step: 0.25, decimals: 0, mixed: shared.mixed, ..Number::of(what) };
        let response = field.ui(ui, &mut number, commands).accessible_name(what);
        let lengths = |j: usize| {
            let length = f64::from(length(keys, j));
            shared.applied(length, &response, number).round().clamp(1.0, 1e7) as u32
        };
        send_keys(&response, commands, "Frames of intervals", || timeline::with_lengths(keys, chosen, lengths));
        let range = format!("each, {} to {}", timeline::frames(keys, first).start(), keys[last].through);
        ui.label(theme::faint(range));
    });
    row_of(ui, NAMES, "Force", AXES, false, |ui| {
        side_by_side(ui, 36.0, |ui| {
            for (axis, name) in ["x", "y", "z"].into_iter().enumerate() {
                let shared = Shared::of(chosen.iter().map(|&j| f64::from(keys[j].vector[axis])));
                let mut number = shared.number;
                let what = format!("Force {name} of all");
                let field = Number { range: -MOST..=MOST, step: 0.5, decimals: 2, ..Number::of(&what) };
                let field = Number { mixed: shared.mixed, ..field };
                let response = field.ui(ui, &mut number, commands).hint(name);
                underline(ui, &response, axis);
                let response = response.accessible_name(&what);
                send_keys(&response, commands, "Force of intervals", || {
                    changed(keys, chosen, |_, key| {
                        let to = shared.applied(f64::from(key.vector[axis]), &response, number);
                        key.vector[axis] = to.clamp(-MOST, MOST) as f32;
                    })
                });
            }
        });
    });
    let help = "|F|. Directions stay the same. A typed number applies to all; a drag scales all by the same factor.";
    row_of(ui, NAMES, "Strength", help, false, |ui| {
        let shared = Shared::of(chosen.iter().map(|&j| f64::from(strengths[j].vector.length())));
        let mut number = shared.number;
        ui.spacing_mut().interact_size.x = 64.0;
        let what = "Strength of the intervals";
        let field = Number { range: 0.0..=MOST, step: 0.5, decimals: 1, mixed: shared.mixed, ..Number::of(what) };
        let response = field.ui(ui, &mut number, commands).accessible_name(what);
        let is_dragged = response.dragged() || response.drag_stopped();
        send_keys(&response, commands, "Strength of intervals", || {
            changed(keys, chosen, |j, key| {
                let vector = strengths[j].vector;
                let times = (number / shared.number) as f32;
                if let (Some(speed), true) = (key.speed, is_dragged && shared.number > 0.0) {
                    key.speed = Some(speed.with(speed.number * times));
                    return;
                }
                key.speed = None;
                key.vector = match vector.try_normalize() {
                    // A tenth would lose what grows from nearly nothing.
                    Some(_) if is_dragged && shared.number > 0.0 => vector * times,
                    Some(direction) => rounded(direction * number as f32),
                    None if is_dragged => vector,
                    None => rounded(Vec3::NEG_X * number as f32),
                };
            })
        });
    });
}

fn length(keys: &[ForceSettings], j: usize) -> u32 {
    let frames = timeline::frames(keys, j);
    frames.end() - frames.start() + 1
}

fn send_keys(
    response: &Response,
    commands: &mut Commands,
    name: &'static str,
    keys: impl FnOnce() -> Vec<ForceSettings>,
) {
    send(response, commands, |phase| Command::Intervals { name, keys: keys(), chosen: None, phase });
}

fn changed(keys: &[ForceSettings], chosen: &[usize], change: impl Fn(usize, &mut ForceSettings)) -> Vec<ForceSettings> {
    let mut keys = keys.to_vec();
    keys.iter_mut().enumerate().filter(|(j, _)| chosen.contains(j)).for_each(|(j, key)| change(j, key));
    keys
}

/// What a drag in a circle makes of the intervals chosen.
pub fn pointed(keys: &[ForceSettings], strengths: &[Keyframe], chosen: &[usize], seen: Seen, way: Vec2) -> Command {
    let phase = Phase::Dragging;
    let vector = |j: usize, key: &ForceSettings| turned(key, seen.turned(strengths[j].vector, way, chosen));
    match chosen {
        [j] => directed(keys, *j, vector(*j, &keys[*j]), phase),
        _ => {
            let keys = changed(keys, chosen, |j, key| key.vector = vector(j, key));
            Command::Intervals { name: "Direction of intervals", keys, chosen: None, phase }
        }
    }
}

#[cfg(test)]
mod tests {
    use eframe::egui::vec2;

    use super::*;

    #[test]
    fn several_turn_to_the_hand_and_keep_their_strengths_in_the_plane_that_is_seen() {
        let keys = [Vec3::new(-3.0, 4.0, 7.0), Vec3::new(0.0, -10.0, 0.0), Vec3::ZERO];
        let strengths: Vec<Keyframe> =
            (1..).zip(keys).map(|(n, vector)| Keyframe { through: 10 * n, vector }).collect();
        let keys: Vec<ForceSettings> = strengths.iter().copied().map(ForceSettings::from).collect();
        let Command::Intervals { keys: turned, .. } =
            pointed(&keys, &strengths, &[0, 1], Seen::FromHerRight, vec2(9.0, 0.0))
        else {
            panic!("not intervals")
        };
        assert_eq!(
            turned.iter().map(|key| key.vector).collect::<Vec<_>>(),
            [Vec3::new(5.0, 0.0, 7.0), Vec3::new(10.0, 0.0, 0.0), Vec3::ZERO]
        );
        let Command::Vector { vector, .. } = pointed(&keys, &strengths, &[0], Seen::FromAbove, vec2(9.0, 1.0)) else {
            panic!("no vector")
        };
        assert_eq!(vector, Vec3::new(9.0, 4.0, 1.0));
    }

    #[test]
    fn a_mean_stands_for_what_differs_and_is_no_number_that_is_typed() {
        assert_eq!(Shared::of([2.0, 2.0].into_iter()), Shared { number: 2.0, mixed: false });
        let shared = Shared::of([1.0, 3.0].into_iter());
        assert!(shared.mixed && shared.number != 2.0 && (shared.number - 2.0).abs() < 1e-6);
    }
}
