//! What there is room for: large numbers, many words, large type.

use super::*;

fn rect(window: &Window<'_>, label: &str) -> eframe::egui::Rect {
    window.harness.get_by_label(label).rect()
}

#[test]
fn numbers_of_six_digits_are_whole_and_cover_nothing() {
    let text = TEXT.replace("[-100, 0, 0]", "[-912345.67, 912345.67, -912345.67]");
    for size in [vec2(1280.0, 720.0), vec2(490.0, 300.0)] {
        let mut window = Window::of(&text, size);
        window.click("Interval 1");
        let fields = ["Force x", "Force y", "Force z", "Strength of the interval"].map(|label| rect(&window, label));
        let room = rect(&window, "Ruler");
        for (i, field) in fields.iter().enumerate() {
            assert!(field.right() < room.left() - 74.0, "{size}: field {i} at {field}, the tracks at {room}");
            assert!(fields[..i].iter().all(|before| !before.shrink(0.5).intersects(*field)), "{size}: {fields:?}");
        }
    }
}

#[test]
fn the_unit_of_three_numbers_stands_beside_them_where_there_is_room() {
    let fan = "[[fan]]\nstrength = 10\nposition = [30, 0, 0]\ndirection = [-1, 0, 0]\n";
    let mut window = Window::of(&format!("{TEXT}\n{fan}"), vec2(1440.0, 900.0));
    window.click("Wind");
    window.click("Fans (1)");
    let last = rect(&window, "Fans Position: z");
    let units: Vec<_> = window.harness.query_all_by_label("cm").map(|node| node.rect()).collect();
    // Of the position alone: the direction has none, and a single number has its unit within its field.
    let [unit] = units[..] else { panic!("{units:?}") };
    assert!(unit.left() >= last.right() && last.y_range().contains(unit.center().y), "{unit} beside {last}");
    assert!(unit.right() <= 1440.0, "{unit}");
}

#[test]
fn no_button_above_the_tracks_covers_another_at_any_size_of_type() {
    // The same window at 1, 2, 2.6 and 3.5 times the size of its type.
    for size in [1.0, 2.0, 2.6, 3.5].map(|zoom| vec2(1280.0, 720.0) / zoom) {
        let window = Window::of(TEXT, size);
        let labels = ["First frame", "Play or pause", "Last frame", "Frame", "Speed", "Loop"];
        let labels = labels.into_iter().chain(["Add interval", "Split", "Join", "Delete"]);
        let rects: Vec<_> = labels.map(|label| (label, rect(&window, label))).collect();
        for (i, (label, rect)) in rects.iter().enumerate() {
            assert!(rect.left() >= 0.0 && rect.right() <= size.x, "{size}: {label} at {rect}");
            for (other, over) in &rects[..i] {
                assert!(!rect.shrink(0.5).intersects(*over), "{size}: {label} at {rect}, {other} at {over}");
            }
        }
    }
}

#[test]
fn what_is_said_is_seen_to_its_last_line() {
    let mut window = Window::open();
    for n in 0..6 {
        window.harness.state_mut().session_mut().say(format!("{n}: something that went wrong"), true);
        window.settle();
    }
    let view = rect(&window, "View of the hair");
    for n in 0..6 {
        let words = rect(&window, &format!("{n}: something that went wrong"));
        assert!(view.contains_rect(words), "{words} in {view}");
    }
}

#[test]
fn the_circles_of_an_interval_are_whole_in_a_small_window() {
    let mut window = Window::open();
    window.click("Interval 1");
    let below = window.harness.get_by_label("Strands shown").rect().top();
    for dial in ["Dial from the right", "Dial from above"] {
        let rect = window.harness.get_by_label(dial).rect();
        assert!(rect.width() >= 56.0 && rect.height() >= 56.0 && rect.bottom() < below, "{dial}: {rect}");
    }
}

#[test]
fn calm_has_no_sign_and_a_scene_without_wind_says_so() {
    let mut window = Window::open();
    window.click("Interval 1");
    window.type_into("Strength of the interval", "0");
    let vector = window.session().document().unwrap().scene().field.force[0].vector;
    assert_eq!(vector.to_array().map(f32::to_bits), [0; 3], "{vector}");
    window.press(Modifiers::COMMAND, Key::A);
    window.press(Modifiers::NONE, Key::Delete);
    assert!(window.harness.query_by_label_contains("There is no wind").is_some());
    assert!(window.harness.query_by_label_contains("Click an interval").is_none());
}

#[test]
fn what_goes_wrong_with_a_question_is_seen_in_it() {
    let mut window = Window::open();
    window.press(Modifiers::COMMAND | Modifiers::SHIFT, Key::S);
    window.harness.key_press_modifiers(Modifiers::COMMAND, Key::A);
    window.harness.event(Event::Text("/no/such/folder/red hand #1.toml".to_owned()));
    window.harness.step();
    window.harness.step();
    assert!(window.harness.query_by_label("There is no such folder.").is_some());
    window.press(Modifiers::NONE, Key::Enter);
    let said = window.harness.query_all_by_label_contains("not saved: ").map(|node| node.rect()).next_back().unwrap();
    let question = window.harness.get_by_label("Path").rect();
    assert!(question.x_range().contains(said.center().x) && said.top() > question.bottom(), "{said} in {question}");
    let clear = window.harness.get_by_label("Cancel").rect();
    assert!(!clear.intersects(said));
}

#[test]
fn an_interval_that_means_for_good_has_its_place_in_the_timeline() {
    let mut window = Window::of(&TEXT.replace("through = 40", "through = 4294967295"), vec2(1280.0, 720.0));
    assert_eq!(window.session().trouble(), None);
    window.click("Interval 2");
    window.drag("Border 2", vec2(200.0, 0.0));
    window.drag("Interval 2", vec2(200.0, 0.0));
    assert_eq!(window.ends(), [20, u32::MAX]);
    window.press(Modifiers::SHIFT, Key::ArrowRight);
    window.press(Modifiers::SHIFT, Key::ArrowRight);
    assert_eq!(window.session().play.frame(), 40);
    window.press(Modifiers::SHIFT, Key::ArrowLeft);
    assert_eq!(window.session().play.frame(), 21);
}
