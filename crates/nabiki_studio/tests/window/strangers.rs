//! What people who had never seen the window before ran into.

use eframe::egui::{LayerId, Order};
use nabiki_studio::actions::Action;

use super::*;

/// All of it between two pictures, as where they are slow.
fn at_once(window: &mut Window<'_>, events: Vec<Event>) {
    window.harness.input_mut().events.extend(events);
    window.harness.step();
}

fn button_event(pos: Pos2, pressed: bool) -> Event {
    Event::PointerButton { pos, button: PointerButton::Primary, pressed, modifiers: Modifiers::NONE }
}

fn act(window: &mut Window<'_>, command: Command) {
    window.harness.state_mut().session_mut().apply(command);
    window.settle();
}

fn undo_name(window: &Window<'_>) -> Option<String> {
    window.session().document().unwrap().undo_name().map(str::to_owned)
}

fn layer_at(window: &Window<'_>, at: Pos2) -> Option<LayerId> {
    window.harness.ctx.layer_id_at(at)
}

#[test]
fn a_list_of_units_lies_over_its_dialog_each_time_it_opens() {
    let mut window = Window::open();
    let file = window.folder.path().join("lock.obj");
    std::fs::write(&file, "v 0 0 0\nv 0 1 0\nl 1 2\n").unwrap();
    for unit in ["m", "in", "ft"] {
        window.drop(&file);
        let list = window.place_of("Unit of the file");
        window.harness.hover_at(list);
        window.harness.step();
        let dialog = layer_at(&window, list).unwrap();
        at_once(&mut window, vec![button_event(list, true), button_event(list, false)]);
        window.settle();
        let line = window.place_of(unit);
        let over = layer_at(&window, line).unwrap();
        assert!(over != dialog && over.order == Order::Foreground, "{unit}: {over:?} is the dialog's own layer");
        window.click(unit);
        let Some(Dialog::Import(import)) = window.session().dialog() else { panic!("it is not asked") };
        assert_eq!(import.unit, unit);
        window.click("Cancel");
    }
}

#[test]
fn nails_words_and_exports_that_failed_go_with_their_scene() {
    let mut window = Window::open();
    act(&mut window, Command::Go(30));
    let at = window.take_hold();
    window.button(at, false);
    window.harness.key_down(Key::N);
    window.harness.step();
    window.button(at, true);
    window.button(at, false);
    window.harness.key_up(Key::N);
    window.harness.step();
    assert_eq!(window.harness.state().view().marks().nails, [30]);
    let order = nabiki_studio::tasks::Order {
        kind: nabiki_studio::tasks::Kind::Usd,
        // Below what is no folder.
        place: window.folder.path().join("breeze.toml/hair.usdc"),
        frame: 0,
        strands: None,
    };
    let session = window.harness.state_mut().session_mut();
    session.say("something that went wrong with this scene", true);
    session.say_of_window("something that is wrong with the window", true);
    session.apply(Command::Export(order));
    while !session.tasks()[0].has_ended() {
        std::thread::yield_now();
    }
    window.settle();
    let other = window.folder.path().join("other.toml");
    std::fs::write(&other, TEXT.replace("strands = 60", "strands = 61")).unwrap();
    // It has as many points a strand, so that every nail would fit.
    act(&mut window, Command::Open(other));
    assert_eq!(window.session().take().unwrap().strands().len(), 61);
    assert_eq!(window.harness.state().view().marks().nails, [] as [u32; 0]);
    let words: Vec<&str> = window.session().words().iter().map(|word| word.text.as_str()).collect();
    assert_eq!(words, ["something that is wrong with the window"]);
    assert_eq!(window.session().tasks().len(), 0);
}

#[test]
fn a_window_at_rest_asks_for_no_picture() {
    let mut window = Window::open();
    window.click("Interval 1");
    window.drag("Border 1", vec2(60.0, 0.0));
    // Until news are old and what is not saved is kept.
    std::thread::sleep(std::time::Duration::from_millis(1100));
    for _ in 0..200 {
        window.harness.step();
    }
    for (what, key) in [("at rest", None), ("while a command is looked for", Some(Key::P))] {
        if let Some(key) = key {
            window.press(Modifiers::COMMAND, key);
            (0..40).for_each(|_| window.harness.step());
        }
        let delays = window.harness.output().viewport_output.values().map(|output| output.repaint_delay);
        let delay = delays.min().unwrap();
        assert!(delay.as_secs() > 3600, "{what}: another picture in {delay:?}");
    }
}

#[test]
fn a_field_that_is_left_open_is_not_filled_by_a_click() {
    let mut window = Window::of(TEXT, vec2(1280.0, 2400.0));
    window.click("Picture");
    window.click("Camera at the last frame on");
    window.press(Modifiers::COMMAND, Key::S);
    let before = window.session().document().unwrap().scene().to_toml().unwrap();
    for label in [
        "Camera Distance",
        "Camera Target",
        "Camera f-stop",
        "Movie Frame rate",
        "Camera at the last frame Field of view",
    ] {
        if window.harness.query_all_by_label(label).count() == 0 {
            window.click("Movie");
        }
        window.click(label);
        window.press(Modifiers::NONE, Key::Enter);
        window.click(label);
        window.harness.event(Event::Text("80".to_owned()));
        window.harness.step();
        window.press(Modifiers::NONE, Key::Escape);
        let text = window.session().document().unwrap().scene().to_toml().unwrap();
        assert_eq!(text, before, "{label}");
    }
    let camera = |window: &Window<'_>| window.session().document().unwrap().scene().picture.camera;
    window.type_into("Camera Distance", "80");
    window.type_into("Camera Target", "1, 2, 3");
    assert_eq!((camera(&window).distance, camera(&window).target), (Some(80.0), Some([1.0, 2.0, 3.0].into())));
}

#[test]
fn several_intervals_show_what_they_share_and_are_changed_in_one_step() {
    let text = format!("{TEXT}\n[[force]]\nthrough = 60\nvector = [-50, 10, 0]\n");
    let mut window = Window::of(&text, vec2(1280.0, 720.0));
    let keys = |window: &Window<'_>| window.session().document().unwrap().scene().field.force.clone();
    let before = keys(&window);
    act(&mut window, Command::Choose(vec![0, 2]));
    window.type_into("Force y of all", "20");
    let vectors: Vec<_> = keys(&window).iter().map(|key| key.vector.to_array()).collect();
    assert_eq!(vectors, [[-100.0, 20.0, 0.0], [0.0; 3], [-50.0, 20.0, 0.0]]);
    window.press(Modifiers::COMMAND, Key::Z);
    assert_eq!(keys(&window), before, "one step");
    // What differs is said so; taken as it is, nothing changes.
    window.click("Force x of all");
    window.press(Modifiers::NONE, Key::Enter);
    assert!(undo_name(&window).is_none() && window.session().words().is_empty(), "{:?}", window.session().words());
    window.drag("Force x of all", vec2(30.0, 0.0));
    let [a, b] = [0, 2].map(|j| keys(&window)[j].vector.x - before[j].vector.x);
    assert!(a > 5.0 && (a - b).abs() < 1e-3, "{a} {b}");
    window.press(Modifiers::COMMAND, Key::Z);
    assert_eq!(keys(&window), before, "a drag is one step");
    window.type_into("Strength of the intervals", "10");
    assert!([0, 2].iter().all(|&j| (keys(&window)[j].vector.length() - 10.0).abs() < 0.1));
    window.press(Modifiers::COMMAND, Key::Z);
    window.type_into("Frames of each interval", "7");
    assert_eq!(window.ends(), [7, 27, 34]);
    window.press(Modifiers::COMMAND, Key::Z);
    window.drag("Dial from the right", vec2(0.0, -30.0));
    let turned = keys(&window);
    assert!([0, 2].iter().all(|&j| turned[j].vector.normalize().dot(glam::Vec3::Y) > 0.99), "{turned:?}");
    assert!((turned[0].vector.length() - 100.0).abs() < 0.2 && turned[1] == before[1]);
    window.press(Modifiers::COMMAND, Key::Z);
    assert_eq!(keys(&window), before);
    assert_eq!(window.session().chosen(), [0, 2]);
}

#[test]
fn the_ease_of_all_intervals_stands_beside_all_of_them() {
    let mut window = Window::open();
    let ease = |window: &Window<'_>| window.session().document().unwrap().scene().field.wind.ease;
    for chosen in [vec![0], vec![], vec![0, 1]] {
        act(&mut window, Command::Choose(chosen));
        let button = window.harness.get_by_label("Ease of all intervals").rect();
        let [block, view] = ["Interval 1", "View of the hair"].map(|label| window.harness.get_by_label(label).rect());
        // Beside the track, and not among the fields of an interval.
        assert!(button.right() < block.left() && button.left() > view.left() + 236.0, "{button}");
        let before = ease(&window);
        window.click("Ease of all intervals");
        assert_ne!(ease(&window), before);
    }
}

#[test]
fn a_dial_keeps_its_tip_under_the_hand_that_lets_go() {
    let mut window = Window::open();
    window.click("Interval 1");
    let dial = window.harness.get_by_label("Dial from the right").rect();
    let (from, to) = (dial.center() - vec2(20.0, 0.0), dial.center() + vec2(9.0, -6.0));
    window.harness.hover_at(from);
    window.harness.step();
    window.button(from, true);
    window.harness.hover_at(from + vec2(0.0, 20.0));
    window.harness.step();
    // It goes on and lets go between two pictures.
    at_once(&mut window, vec![Event::PointerMoved(to), button_event(to, false)]);
    window.settle();
    let vector = window.session().document().unwrap().scene().field.force[0].vector;
    let (way, hand) = (glam::Vec2::new(vector.x, -vector.y), to - dial.center());
    let hand = glam::Vec2::new(hand.x, hand.y);
    assert!(way.normalize().dot(hand.normalize()) > 0.999, "{vector} for {hand}");
    // Taken hold of where it lies and let go, it stays what it is: the circle is as large as before.
    window.button(to, true);
    at_once(&mut window, vec![Event::PointerMoved(to + vec2(8.0, 0.0))]);
    at_once(&mut window, vec![Event::PointerMoved(to)]);
    window.button(to, false);
    window.settle();
    let again = window.session().document().unwrap().scene().field.force[0].vector;
    assert!((again - vector).length() < 0.11, "{vector} {again}");
}

#[test]
fn words_about_a_number_go_while_it_is_dragged() {
    let mut window = Window::open();
    let at = window.place_of("Frame");
    let is_said = |window: &Window<'_>| window.harness.query_by_label("The frame shown.").is_some();
    window.harness.hover_at(at);
    (0..20).for_each(|_| window.harness.step());
    assert!(is_said(&window), "at rest it is said");
    window.button(at, true);
    for n in 1..6 {
        window.harness.hover_at(at + vec2(2.0 * n as f32, 0.0));
        window.harness.step();
        assert!(!is_said(&window), "it covers what is dragged");
    }
    window.button(at, false);
}

#[test]
fn the_palette_leads_to_a_setting() {
    for (query, page, label) in [
        ("curl radius", "Style", "Curl Radius"),
        ("hair.style.clumps.wave_length", "Style", "Clumps Wave length"),
        ("f_stop", "Picture", "Camera f-stop"),
        ("settle", "Motion", "Shape and settling Settle: from root to tip"),
    ] {
        let mut window = Window::open();
        window.press(Modifiers::COMMAND, Key::P);
        window.harness.get_by_label("Command or setting").type_text(query);
        window.harness.step();
        window.harness.step();
        window.press(Modifiers::NONE, Key::Enter);
        assert_eq!(window.session().dialog(), None);
        (0..8).for_each(|_| window.harness.step());
        let page = nabiki_studio::settings::Page::ALL.into_iter().find(|of| of.title() == page).unwrap();
        let shown = window.harness.query_all_by_label(label).last();
        let rect = shown.unwrap_or_else(|| panic!("{query}: {label} is not shown on {page:?}")).rect();
        assert!(rect.top() > 40.0 && rect.bottom() < 500.0, "{query}: {label} at {rect}");
        assert!(window.session().document().unwrap().undo_name().is_none());
    }
    let mut window = Window::open();
    act(&mut window, Command::Reveal("pseudo_force.alpha".to_owned()));
    act(&mut window, Command::Reveal("disturbance.every".to_owned()));
    let said = &window.session().words().last().unwrap().text;
    assert!(said.contains("the paper's form"), "{said}");
    act(&mut window, Command::Choose(Vec::new()));
    act(&mut window, Command::Reveal("force.vector".to_owned()));
    assert_eq!(window.session().chosen(), [0]);
}

#[test]
fn a_colour_by_name_is_the_same_as_it_looks() {
    let mut window = Window::open();
    window.click("Picture");
    let hair = |window: &Window<'_>| window.session().document().unwrap().scene().picture.hair;
    let of = |window: &Window<'_>| nabiki_render::colour::of_mass(&hair(window));
    for name in ["brown", "blond", "red", "grey"] {
        let set = Command::Set {
            key: "picture.hair.colour".to_owned(),
            value: Some(name.into()),
            phase: nabiki_studio::document::Phase::Done,
        };
        act(&mut window, set);
        let before = of(&window);
        window.click("Hair Colour");
        window.click("by RGB");
        assert!(matches!(hair(&window).colour, nabiki_render::settings::HairColour::Rgb(_)));
        let after = of(&window);
        assert!((0..3).all(|c| (after[c] - before[c]).abs() < 2e-4 + 0.01 * before[c]), "{name}: {before:?} {after:?}");
        act(&mut window, Command::Act(Action::Undo));
    }
}
