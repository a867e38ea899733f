//! What a hand begins and does not end as it meant to: Escape, numbers that are none, Enter.

use super::*;

fn vector(window: &Window<'_>) -> glam::Vec3 {
    window.session().document().unwrap().scene().field.force[0].vector
}

fn escape(window: &mut Window<'_>) {
    window.harness.key_press(Key::Escape);
    window.harness.step();
    window.settle();
}

#[test]
fn escape_gives_up_a_pull_and_all_is_as_it_was() {
    let mut window = Window::open();
    window.harness.state_mut().session_mut().apply(Command::Go(30));
    window.harness.state_mut().session_mut().apply(Command::Choose(vec![1]));
    window.settle();
    let force = |window: &Window<'_>| window.session().document().unwrap().scene().field.force.clone();
    let before = force(&window);
    let held = window.take_hold();
    window.pull(held + vec2(-40.0, -30.0));
    escape(&mut window);
    assert_eq!(force(&window), before);
    assert_eq!(window.session().document().unwrap().undo_name(), None);
    assert_eq!(window.session().chosen(), [1], "it means but one thing at a time");
    window.harness.hover_at(held + vec2(30.0, 30.0));
    window.harness.step();
    window.button(held + vec2(30.0, 30.0), false);
    window.settle();
    assert_eq!(force(&window), before, "the hand is empty");
    escape(&mut window);
    assert_eq!(window.session().chosen(), [] as [usize; 0]);
}

#[test]
fn escape_gives_up_a_border() {
    let mut window = Window::open();
    let start = window.place_of("Border 1");
    window.harness.hover_at(start);
    window.harness.step();
    window.button(start, true);
    for n in 1..=4 {
        window.harness.hover_at(start + vec2(15.0 * n as f32, 0.0));
        window.harness.step();
    }
    assert_ne!(window.ends(), [20, 40]);
    escape(&mut window);
    window.harness.hover_at(start + vec2(90.0, 0.0));
    window.harness.step();
    window.button(start + vec2(90.0, 0.0), false);
    window.settle();
    assert_eq!(window.ends(), [20, 40]);
    assert_eq!(window.session().document().unwrap().undo_name(), None);
}

#[test]
fn what_is_typed_and_is_no_number_leaves_the_field_as_it_was() {
    let mut window = Window::open();
    window.click("Interval 1");
    window.click("Style");
    let before = vector(&window);
    let fields = ["Force x", "Force y", "Strength of the interval", "Last frame of the interval", "Strands Strands"];
    for field in fields {
        for text in ["nan", "inf", "1e99", "-5e30"] {
            window.type_into(field, text);
            assert_eq!(window.session().document().unwrap().undo_name(), None, "{field}: {text}");
            let said = window.session().words().last().map(|word| word.text.clone());
            assert!(said.as_ref().is_some_and(|said| said.contains(text)), "{field}: {text} is not said: {said:?}");
        }
    }
    window.harness.state_mut().session_mut().tick(60.0, 0.0);
    let said = window.session().words();
    assert!(said.len() == fields.len() && said.iter().all(|word| word.wrong), "{said:?}");
    // As it is: nothing is changed, and nothing wrong with it any more.
    window.type_into("Strands Strands", "60");
    assert!(window.session().words().iter().all(|word| !word.text.contains("hair.strands")));
    assert_eq!(window.session().words().len(), fields.len() - 1);
    window.type_into("Strength of the interval", "-5");
    assert_eq!(vector(&window), before);
    window.type_into("Strength of the interval", "60");
    assert_eq!(vector(&window), glam::Vec3::new(-60.0, 0.0, 0.0), "its direction stays");
    assert!(window.session().words().iter().all(|word| !word.text.contains("Strength")));
    window.press(Modifiers::COMMAND, Key::Z);
    assert_eq!(vector(&window), before);
    assert_eq!(window.session().document().unwrap().undo_name(), None);
}

#[test]
fn escape_puts_the_old_number_back_and_typing_begins_with_it() {
    let mut window = Window::open();
    window.click("Interval 1");
    let before = vector(&window);
    for _ in 0..2 {
        window.click("Force x");
        window.harness.event(Event::Text("-77".to_owned()));
        window.harness.step();
        escape(&mut window);
        assert_eq!(vector(&window), before);
        assert_eq!(window.session().document().unwrap().undo_name(), None);
    }
    window.click("Force x");
    window.press(Modifiers::NONE, Key::Enter);
    assert_eq!(vector(&window), before, "what was given up does not wait in the field");
    window.type_into("Force x", "-77");
    assert_eq!(vector(&window).x, -77.0);
}

#[test]
fn a_value_out_of_the_range_of_its_field_stays_until_a_hand_changes_it() {
    let mut window = Window::of(&TEXT.replace("[-100, 0, 0]", "[-2000000, 0, 0]"), vec2(1280.0, 720.0));
    window.click("Interval 1");
    for _ in 0..4 {
        window.harness.step();
    }
    assert_eq!(vector(&window).x, -2e6);
    assert!(!window.session().document().unwrap().is_dirty());
    window.type_into("Force x", "-100");
    assert_eq!(vector(&window).x, -100.0);
}

#[test]
fn enter_opens_what_was_typed() {
    let mut window = Window::open();
    let other = window.folder.path().join("other.toml");
    std::fs::write(&other, TEXT).unwrap();
    window.press(Modifiers::COMMAND, Key::O);
    window.harness.event(Event::Text("other.toml".to_owned()));
    window.harness.step();
    window.harness.step();
    window.press(Modifiers::NONE, Key::Enter);
    assert_eq!(window.session().dialog(), None);
    assert_eq!(window.session().document().unwrap().path(), Some(other.as_path()));
}

#[test]
fn a_dialog_is_as_high_as_what_is_in_it() {
    let mut window = Window::open();
    window.drag("Border 1", vec2(60.0, 0.0));
    let asked = |window: &mut Window<'_>| {
        window.press(Modifiers::COMMAND, Key::Q);
        let place = window.place_of("Do not save");
        window.click("Cancel");
        place
    };
    let before = asked(&mut window);
    window.press(Modifiers::NONE, Key::F1);
    escape(&mut window);
    assert_eq!(window.session().dialog(), None);
    window.press(Modifiers::COMMAND, Key::O);
    window.click("Cancel");
    assert!((asked(&mut window) - before).length() < 1.0);
}

#[test]
fn what_cannot_be_undone_is_not_offered_to_be() {
    let mut window = Window::open();
    let still = window.folder.path().join("still.toml");
    std::fs::write(&still, TEXT.replace("[-100, 0, 0]", "[-2000000, 0, 0]")).unwrap();
    window.harness.state_mut().session_mut().apply(Command::Open(still));
    window.settle();
    assert!(window.session().trouble().is_some() && window.session().take().is_none());
    assert!(window.harness.query_by_label_contains("This scene does not move yet").is_some());
    assert!(window.harness.query_by_label("Undo").is_none());
    window.click("Interval 1");
    window.type_into("Force x", "3000");
    window.type_into("Force x", "900000");
    assert!(window.session().trouble().is_some() && window.harness.query_by_label("Undo").is_some());
}

#[test]
fn saving_takes_what_is_being_typed() {
    let mut window = Window::open();
    window.click("Interval 1");
    window.click("Force x");
    // Typed and saved between two pictures, as where they are slow.
    window.harness.event(Event::Text("-55".to_owned()));
    window.harness.key_press_modifiers(Modifiers::COMMAND, Key::S);
    window.settle();
    assert_eq!(vector(&window).x, -55.0);
    assert!(std::fs::read_to_string(window.file()).unwrap().contains("[-55"));
    assert!(!window.session().document().unwrap().is_dirty());
    window.click("Picture");
    window.click("Force x");
    window.harness.event(Event::Text("nan".to_owned()));
    window.press(Modifiers::COMMAND, Key::S);
    assert_eq!(vector(&window).x, -55.0, "what is no number is not taken");
    window.press(Modifiers::NONE, Key::S);
    assert_eq!(window.ends(), [20, 40], "split at frame 0 does nothing");
}

#[test]
fn a_text_that_is_saved_goes_on_being_typed() {
    let mut window = Window::open();
    let broken = window.folder.path().join("broken.toml");
    std::fs::write(&broken, TEXT.replace("\"free\"", "\"fre\"")).unwrap();
    window.harness.state_mut().session_mut().apply(Command::Open(broken.clone()));
    window.settle();
    window.click("Text of the scene");
    for letter in ["x", "y"] {
        window.harness.event(Event::Text(letter.to_owned()));
        window.press(Modifiers::COMMAND, Key::S);
        assert!(std::fs::read_to_string(&broken).unwrap().contains(letter));
        assert!(!window.session().broken().unwrap().is_changed());
    }
}

#[test]
fn escape_closes_a_menu_and_means_nothing_else() {
    let mut window = Window::open();
    window.click("Interval 1");
    window.click("File");
    assert!(window.harness.query_by_label_contains("Save as").is_some());
    escape(&mut window);
    assert!(window.harness.query_by_label_contains("Save as").is_none());
    assert_eq!(window.session().chosen(), [0]);
    escape(&mut window);
    assert_eq!(window.session().chosen(), [] as [usize; 0]);
}

#[test]
fn the_list_of_keys_has_all_of_them_and_fits_a_small_window() {
    let mut window = Window::open();
    window.press(Modifiers::NONE, Key::F1);
    for entry in nabiki_studio::actions::ACTIONS.iter().filter(|entry| entry.key.is_some()) {
        assert!(window.harness.query_all_by_label(&entry.keys_text()).count() > 0, "{}", entry.name);
    }
    for gesture in nabiki_studio::gestures::GESTURES {
        assert!(window.harness.query_all_by_label(gesture.hand).count() > 0, "{}", gesture.hand);
    }
    let close = window.harness.get_by_label("Close").rect();
    assert!(close.right() < 1280.0 && close.bottom() < 720.0, "{close}");
}

#[test]
fn of_a_take_that_is_kept_a_hand_moves_the_camera_alone() {
    let mut window = Window::open();
    window.press(Modifiers::NONE, Key::End);
    window.press(Modifiers::NONE, Key::K);
    let start = window.take_hold();
    let camera = |window: &Window<'_>| window.harness.state().view().camera();
    let before = camera(&window);
    window.press(Modifiers::NONE, Key::X);
    window.harness.step();
    assert!(window.harness.query_by_label("Kept take").is_none(), "what is held is pulled in the scene");
    assert!(window.pulled().is_some());
    window.button(start, false);
    window.press(Modifiers::NONE, Key::X);
    window.harness.step();
    window.harness.get_by_label("Kept take");
    let wind = window.session().document().unwrap().scene().field.force.clone();
    window.button(start, true);
    for n in 1..=10 {
        window.harness.hover_at(start + vec2(4.0, 3.0) * n as f32);
        window.harness.step();
        assert_eq!(window.pulled(), None);
    }
    window.button(start + vec2(40.0, 30.0), false);
    window.settle();
    assert_eq!(window.session().document().unwrap().scene().field.force, wind);
    assert_ne!(camera(&window), before);
    window.press(Modifiers::NONE, Key::X);
    window.harness.step();
    assert!(window.harness.query_by_label("Kept take").is_none());
    window.take_hold();
    assert!(window.pulled().is_some());
}
