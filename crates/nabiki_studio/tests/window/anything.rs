//! Whatever hands do, in any order.

use eframe::egui::{MouseWheelSource, MouseWheelUnit, TouchPhase};
use nabiki_studio::actions::{ACTIONS, Action};

use super::*;

/// SplitMix64.
struct Chance(u64);

impl Chance {
    fn below(&mut self, n: usize) -> usize {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) % n as u64) as usize
    }
}

fn place(chance: &mut Chance, size: Vec2) -> Pos2 {
    let of = |chance: &mut Chance| (chance.below(1000) as f32 + 0.5) / 1000.0;
    Pos2::ZERO + size * vec2(of(chance), of(chance))
}

fn act(window: &mut Window<'_>, chance: &mut Chance, size: Vec2) {
    match chance.below(12) {
        // Several in one picture of the window, as on a slow machine.
        0..4 => {
            for _ in 0..=chance.below(3) {
                let Some(key) = ACTIONS[chance.below(ACTIONS.len())].key else { continue };
                let modifiers = Modifiers { command: key.command, shift: key.shift, ..Modifiers::NONE };
                window.harness.key_press_modifiers(modifiers, Key::from_name(key.key).unwrap());
            }
        }
        4..7 => {
            let at = place(chance, size);
            let button = [PointerButton::Primary, PointerButton::Primary, PointerButton::Secondary][chance.below(3)];
            window.harness.hover_at(at);
            for pressed in [true, false] {
                window.harness.event(Event::PointerButton { pos: at, button, pressed, modifiers: Modifiers::NONE });
                window.harness.step();
            }
        }
        7..10 => {
            let (from, to) = (place(chance, size), place(chance, size));
            let modifiers = [Modifiers::NONE, Modifiers::SHIFT, Modifiers::COMMAND, Modifiers::ALT][chance.below(4)];
            window.harness.hover_at(from);
            let button = PointerButton::Primary;
            window.harness.event(Event::PointerButton { pos: from, button, pressed: true, modifiers });
            window.harness.step();
            let steps = 1 + chance.below(6);
            for n in 1..=steps {
                window.harness.hover_at(from + (to - from) * (n as f32 / steps as f32));
                window.harness.step();
                if chance.below(8) == 0 {
                    act(window, chance, size);
                }
            }
            window.harness.event(Event::PointerButton { pos: to, button, pressed: false, modifiers });
        }
        // What is typed into a question may be a path, in whatever folder the test runs.
        10 if window.session().dialog().is_none() => {
            let text = ["1", "0", "-3", "12", "0.5", "1e3", "abc", "50, 20", "red"][chance.below(9)];
            window.harness.event(Event::Text(text.to_owned()));
            window.harness.step();
            window.harness.key_press(Key::Enter);
        }
        _ => {
            window.harness.hover_at(place(chance, size));
            let delta = vec2(0.0, chance.below(200) as f32 - 100.0);
            let (unit, phase, modifiers) = (MouseWheelUnit::Point, TouchPhase::Move, Modifiers::NONE);
            let source = MouseWheelSource::Wheel;
            window.harness.event(Event::MouseWheel { unit, delta, phase, modifiers, source });
        }
    }
    window.harness.step();
}

#[test]
fn whatever_hands_do_the_motion_is_the_scenes_and_undo_leads_back() {
    for round in 0..4 {
        let size = [vec2(1280.0, 720.0), vec2(800.0, 500.0)][round % 2];
        let mut window = Window::of(TEXT, size);
        let first = window.session().document().unwrap().scene().clone();
        let mut chance = Chance(round as u64);
        for _ in 0..150 {
            act(&mut window, &mut chance, size);
        }
        window.press(Modifiers::NONE, Key::Escape);
        let session = window.harness.state_mut().session_mut();
        let Some(document) = session.document().filter(|_| session.broken().is_none()) else { continue };
        if let (None, Some(take)) = (session.trouble(), session.take()) {
            let built = document.scene().clone().build(nabiki_scene::Shown::AtMost(take.strands().len())).unwrap();
            let mut timeline = built.timeline().unwrap();
            let film = timeline.play();
            let points = (0..=film.frames()).flat_map(|n| film.points(n));
            assert!(take.film.iter().eq(points), "round {round}: what is seen is not the scene");
        }
        while session.document().unwrap().undo_name().is_some() {
            session.apply(Command::Act(Action::Undo));
        }
        let document = session.document().unwrap();
        if document.scene().file() == first.file() {
            assert!(*document.scene() == first, "round {round}: what is undone is not as it was");
        }
    }
}
