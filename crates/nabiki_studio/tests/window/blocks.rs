//! Hands in the timeline: blocks, borders, time, keys of envelopes.

use eframe::egui::{MouseWheelSource, MouseWheelUnit, Rect, TouchPhase, pos2};

use super::*;

/// Four intervals of ten frames, and turbulence that grows.
fn open() -> Window<'static> {
    let mut text = TEXT[..TEXT.find("[[force]]").unwrap()].to_owned();
    for n in 1..=4 {
        text += &format!("[[force]]\nthrough = {}\nvector = [{n}0, 0, 0]\n", 10 * n);
    }
    text += "[turbulence]\nstrength = 1\nenvelope = [{ frame = 5, factor = 0.5 }, { frame = 20, factor = 1 }]\n";
    Window::of(&text, vec2(1440.0, 900.0))
}

fn hold(window: &mut Window<'_>, modifiers: Modifiers) {
    window.harness.event(Event::ModifiersChanged(modifiers));
    window.harness.step();
}

fn press(window: &mut Window<'_>, at: Pos2, button: PointerButton, modifiers: Modifiers) {
    window.harness.hover_at(at);
    window.harness.step();
    for pressed in [true, false] {
        window.harness.event(Event::PointerButton { pos: at, button, pressed, modifiers });
        window.harness.step();
    }
    window.settle();
}

/// A double click: the second follows in the next picture.
fn twice(window: &mut Window<'_>, at: Pos2) {
    window.harness.hover_at(at);
    window.harness.step();
    for _ in 0..2 {
        let (button, modifiers) = (PointerButton::Primary, Modifiers::NONE);
        let click = [true, false].map(|pressed| Event::PointerButton { pos: at, button, pressed, modifiers });
        // Both in one picture: a step for each would make it a slow hand.
        window.harness.input_mut().events.extend(click);
        window.harness.step();
    }
    window.settle();
}

fn block(window: &Window<'_>, n: usize) -> Rect {
    window.harness.get_by_label(&format!("Interval {n}")).rect()
}

#[test]
fn shift_chooses_all_up_to_a_block_and_ctrl_one_more_or_less() {
    let mut window = open();
    window.click("Interval 1");
    for (n, modifiers, chosen) in [
        (3, Modifiers::SHIFT, vec![0, 1, 2]),
        (2, Modifiers::COMMAND, vec![0, 2]),
        (4, Modifiers::COMMAND, vec![0, 2, 3]),
        (2, Modifiers::NONE, vec![1]),
    ] {
        hold(&mut window, modifiers);
        let at = block(&window, n).center();
        press(&mut window, at, PointerButton::Primary, modifiers);
        hold(&mut window, Modifiers::NONE);
        assert_eq!(window.session().chosen(), chosen);
    }
}

#[test]
fn what_comes_after_a_border_moves_along_with_shift_and_what_is_chosen_slides_together() {
    let mut window = open();
    hold(&mut window, Modifiers::SHIFT);
    window.drag("Border 1", vec2(60.0, 0.0));
    hold(&mut window, Modifiers::NONE);
    let by = window.ends()[0] - 10;
    assert!(by > 0);
    assert_eq!(window.ends(), [10, 20, 30, 40].map(|end| end + by));
    window.press(Modifiers::COMMAND, Key::Z);
    window.harness.state_mut().session_mut().apply(Command::Choose(vec![1, 2]));
    window.drag("Interval 2", vec2(60.0, 0.0));
    let by = window.ends()[0] - 10;
    assert!(by > 0);
    assert_eq!(window.ends(), [10 + by, 20 + by, 30 + by, 40]);
}

#[test]
fn the_wheel_up_nears_time_about_the_pointer_and_a_double_click_in_the_ruler_shows_all() {
    let mut window = open();
    let before = block(&window, 2);
    window.harness.hover_at(before.center());
    let (unit, phase, source) = (MouseWheelUnit::Point, TouchPhase::Move, MouseWheelSource::Wheel);
    window.harness.event(Event::MouseWheel { unit, delta: vec2(0.0, 60.0), phase, modifiers: Modifiers::NONE, source });
    window.harness.run_steps(20);
    let near = block(&window, 2);
    assert!(near.width() > 1.1 * before.width(), "{near} {before}");
    assert!((near.center().x - before.center().x).abs() < 2.0, "{near} {before}");
    let ruler = window.place_of("Ruler");
    twice(&mut window, ruler);
    assert!((block(&window, 2).width() - before.width()).abs() < 0.5);
}

#[test]
fn keys_of_an_envelope_are_made_where_they_are_clicked_and_removed_by_the_other_button() {
    let mut window = open();
    let first = block(&window, 1);
    // A block is touched a little within its ends, and the second track below the blocks is that of the turbulence.
    let (left, right) = (first.left() - 6.0, first.right() + 6.0);
    let place = |frame: f32, factor: f32| {
        pos2(left + (right - left) * (frame - 0.5) / 10.0, first.bottom() + 4.0 + 30.0 + 22.0 - 18.0 * factor)
    };
    let keys = |window: &Window<'_>| {
        let scene = window.session().document().unwrap().scene();
        let envelope = &scene.field.turbulence.as_ref().unwrap().envelope;
        envelope.iter().map(|key| (key.frame, key.factor)).collect::<Vec<_>>()
    };
    assert_eq!(keys(&window), [(5, 0.5), (20, 1.0)]);
    for factor in [0.5, 1.0] {
        twice(&mut window, place(12.0, factor));
        let now = keys(&window);
        assert_eq!(now.iter().map(|key| key.0).collect::<Vec<_>>(), [5, 12, 20], "one of a frame");
        assert!((now[1].1 - factor).abs() < 0.06, "{now:?}");
    }
    press(&mut window, place(20.0, 1.0), PointerButton::Secondary, Modifiers::NONE);
    assert_eq!(keys(&window).iter().map(|key| key.0).collect::<Vec<_>>(), [5, 12]);
}

#[test]
fn the_circles_show_where_she_looks_and_what_is_above_and_at_her_right() {
    let vector = |window: &Window<'_>| window.session().document().unwrap().scene().field.force[0].vector;
    for (dial, way, wanted) in [
        ("Dial from the right", vec2(25.0, 0.0), glam::Vec3::X),
        ("Dial from the right", vec2(0.0, 25.0), -glam::Vec3::Y),
        ("Dial from above", vec2(25.0, 0.0), glam::Vec3::X),
        ("Dial from above", vec2(0.0, 25.0), glam::Vec3::Z),
    ] {
        let mut window = open();
        window.click("Interval 1");
        window.drag(dial, way);
        let toward = vector(&window).normalize().dot(wanted);
        assert!(toward > 0.99, "{dial}: {}", vector(&window));
    }
}

#[test]
fn panels_have_their_share_again_once_a_small_window_is_large() {
    let mut window = open();
    let places = |window: &Window<'_>| {
        ["View of the hair", "Ruler", "Interval 1"].map(|label| window.harness.get_by_label(label).rect())
    };
    let before = places(&window);
    for size in [vec2(640.0, 420.0), vec2(1440.0, 900.0)] {
        window.harness.set_size(size);
        window.harness.run_steps(4);
    }
    assert_eq!(places(&window), before);
}
