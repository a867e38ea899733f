//! Brush and comb in the window: strokes over hair, one step each.

use super::*;

/// A stroke over the middle of the view, where the hair is.
fn stroke(window: &mut Window<'_>, ends: bool) -> Pos2 {
    let view = window.harness.get_by_label("View of the hair").rect();
    let at = |y: f32| view.min + view.size() * vec2(0.45, y);
    window.harness.hover_at(at(0.3));
    window.button(at(0.3), true);
    for n in 0..=6 {
        window.harness.hover_at(at(0.3 + 0.06 * n as f32));
        window.harness.step();
    }
    if ends {
        window.button(at(0.66), false);
        window.settle();
    }
    at(0.66)
}

fn scene<'a>(window: &'a Window<'_>) -> &'a nabiki_scene::Scene {
    window.session().document().unwrap().scene()
}

#[test]
fn a_stroke_paints_a_region_that_is_saved_and_opened_again() {
    let mut window = Window::open();
    window.press(Modifiers::NONE, Key::B);
    stroke(&mut window, true);
    let regions = scene(&window).free.regions.clone();
    assert!(regions.len() == 1 && regions[0].painted.iter().any(|point| point[3] > 0.5), "{regions:?}");
    assert_eq!(window.session().document().unwrap().undo_name(), Some("Paint a region"));
    // Nothing is pulled with a brush in the hand.
    assert!(window.pulled().is_none());
    assert_eq!(window.ends(), [20, 40]);
    window.press(Modifiers::COMMAND, Key::S);
    let text = std::fs::read_to_string(window.file()).unwrap();
    assert!(text.starts_with(TEXT.lines().next().unwrap()) && text.contains("painted = [\n    ["), "{text}");
    let again = harness(window.folder.path().join("again"), Some(window.file()), vec2(1280.0, 720.0));
    assert_eq!(again.state().session().document().unwrap().scene().free.regions, regions);
    // Erased where it was painted, less is left; undone, all of it.
    window.click("Erase");
    stroke(&mut window, true);
    let left: f32 = scene(&window).free.regions[0].painted.iter().map(|point| point[3]).sum();
    let painted: f32 = regions[0].painted.iter().map(|point| point[3]).sum();
    assert!(left < painted || window.session().words().iter().any(|word| word.text.contains("needs hair")), "{left}");
    window.press(Modifiers::COMMAND, Key::Z);
    window.press(Modifiers::COMMAND, Key::Z);
    assert!(scene(&window).free.regions.is_empty());
}

#[test]
fn a_stroke_over_a_region_that_is_undone_meanwhile_is_given_up() {
    let mut window = Window::open();
    window.press(Modifiers::NONE, Key::B);
    stroke(&mut window, true);
    assert_eq!(scene(&window).free.regions.len(), 1);
    window.click("Erase");
    let at = stroke(&mut window, false);
    window.press(Modifiers::COMMAND, Key::Z);
    window.button(at, false);
    window.settle();
    assert!(scene(&window).free.regions.is_empty());
}

#[test]
fn a_combed_frame_becomes_an_aim_and_escape_gives_a_stroke_up() {
    let mut window = Window::open();
    window.press(Modifiers::NONE, Key::H);
    stroke(&mut window, true);
    assert!(scene(&window).aims.is_empty(), "frame 0 is at rest");
    assert!(
        window.session().words().iter().any(|word| word.text.contains("Frame 0")),
        "{:?}",
        window.session().words()
    );
    window.harness.state_mut().session_mut().apply(Command::Go(15));
    window.settle();
    let at = stroke(&mut window, false);
    window.press(Modifiers::NONE, Key::Escape);
    window.button(at, false);
    window.settle();
    assert!(scene(&window).aims.is_empty() && window.session().document().unwrap().undo_name().is_none());
    assert_eq!(window.session().tools().tool, nabiki_studio::tools::Tool::Comb, "Escape has given up the stroke alone");
    stroke(&mut window, true);
    let aims = &scene(&window).aims;
    assert!(aims.len() == 1 && aims[0].frame == Some(15) && !aims[0].curves.is_empty(), "{aims:?}");
    assert_eq!(window.session().trouble(), None);
    window.press(Modifiers::NONE, Key::Escape);
    assert_eq!(window.session().tools().tool, nabiki_studio::tools::Tool::Pull);
}
