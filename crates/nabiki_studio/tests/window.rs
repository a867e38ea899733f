//! The real window, driven by what a person sees: open, drag, undo, save, reopen, export.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use eframe::egui::{DroppedFile, Event, Key, Modifiers, PointerButton, Pos2, Vec2, vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::{By, Queryable};
use nabiki_studio::app::App;
use nabiki_studio::command::Command;
use nabiki_studio::dialog::Dialog;
use nabiki_studio::session::Session;

#[path = "window/anything.rs"]
mod anything;
#[path = "window/blocks.rs"]
mod blocks;
#[path = "window/hands.rs"]
mod hands;
#[path = "window/sizes.rs"]
mod sizes;
#[path = "window/strangers.rs"]
mod strangers;
#[path = "window/tools.rs"]
mod tools;

const TEXT: &str = "# A breeze.\n[hair]\nstrands = 60\nsegments = 18\n[motion]\nform = \"free\"\nframes = 40\n\n\
                    [[force]]\nthrough = 20     # then calm\nvector = [-100, 0, 0]\n\n[[force]]\nthrough = 40\nvector = [0, 0, 0]\n";

/// A file over the window.
#[derive(Debug)]
struct Dropped(PathBuf);

impl DroppedFile for Dropped {
    fn path(&self) -> &Path {
        &self.0
    }

    fn bytes(&self) -> Result<Vec<u8>, String> {
        std::fs::read(&self.0).map_err(|e| e.to_string())
    }
}

struct Window<'a> {
    harness: Harness<'a, App>,
    folder: tempfile::TempDir,
}

impl Window<'_> {
    /// A window on a small scene, whose motion is there.
    fn open() -> Self {
        Self::of(TEXT, vec2(1280.0, 720.0))
    }

    fn of(text: &str, size: Vec2) -> Self {
        let folder = tempfile::tempdir().unwrap();
        let scene = folder.path().join("breeze.toml");
        std::fs::write(&scene, text).unwrap();
        let config = folder.path().join("config");
        std::fs::create_dir_all(&config).unwrap();
        std::fs::write(config.join("studio.toml"), "welcomed = true").unwrap();
        Self { harness: harness(config, Some(scene), size), folder }
    }

    fn session(&self) -> &Session {
        self.harness.state().session()
    }

    fn ends(&self) -> Vec<u32> {
        self.session().document().unwrap().scene().field.force.iter().map(|key| key.through).collect()
    }

    fn file(&self) -> PathBuf {
        self.folder.path().join("breeze.toml")
    }

    fn place_of(&self, label: &str) -> Pos2 {
        self.harness.get_by_label(label).rect().center()
    }

    /// Drags by steps, as a hand does.
    fn drag(&mut self, label: &str, by: Vec2) {
        let start = self.place_of(label);
        let steps = 8;
        self.harness.hover_at(start);
        self.harness.step();
        self.button(start, true);
        for n in 1..=steps {
            self.harness.hover_at(start + by * (n as f32 / steps as f32));
            self.harness.step();
        }
        self.button(start + by, false);
        self.harness.step();
        self.settle();
    }

    fn button(&mut self, pos: Pos2, pressed: bool) {
        let event = Event::PointerButton { pos, button: PointerButton::Primary, pressed, modifiers: Modifiers::NONE };
        self.harness.event(event);
        self.harness.step();
    }

    /// The frame in which hair is pulled.
    fn pulled(&self) -> Option<u32> {
        self.harness.state().view().marks().pulled
    }

    /// Takes hold of some hair: somewhere it is under the pointer.
    fn take_hold(&mut self) -> Pos2 {
        let view = self.harness.get_by_label("View of the hair").rect();
        let places =
            (0..400).map(|n| view.min + view.size() * vec2((n % 20) as f32 + 0.5, (n / 20) as f32 + 0.5) / 20.0);
        // Below the tools.
        let mut places = places.filter(|at| at.y > view.top() + 44.0);
        let held = places.find(|&at| {
            self.harness.hover_at(at);
            self.button(at, true);
            self.pulled().is_some() || {
                self.button(at, false);
                false
            }
        });
        held.expect("no hair in sight")
    }

    /// Pulls what is held until the wind follows.
    fn pull(&mut self, to: Pos2) {
        let force = |window: &Self| window.session().document().unwrap().scene().field.force.clone();
        let before = force(self);
        let clock = std::time::Instant::now();
        self.harness.hover_at(to);
        while force(self) == before {
            assert!(clock.elapsed().as_secs() < 60, "the wind never followed");
            self.harness.step();
        }
    }

    /// Clicks a field of a number, types and ends with Enter.
    fn type_into(&mut self, label: &str, text: &str) {
        self.click(label);
        self.harness.event(Event::Text(text.to_owned()));
        self.harness.step();
        self.press(Modifiers::NONE, Key::Enter);
        self.settle();
    }

    fn click(&mut self, label: &str) {
        // A title of the same words stands before its button.
        let found = self.harness.query_all_by_label(label).last();
        found.unwrap_or_else(|| panic!("nothing is called {label}")).click();
        self.harness.step();
        self.settle();
    }

    /// Lets go of a file over the window.
    fn drop(&mut self, path: &Path) {
        self.harness.input_mut().dropped_files.push(Arc::new(Dropped(path.to_owned())));
        self.harness.step();
        self.settle();
    }

    fn press(&mut self, modifiers: Modifiers, key: Key) {
        self.harness.key_press_modifiers(modifiers, key);
        self.harness.step();
        self.settle();
    }

    /// Until the motion of what was asked for is shown.
    fn settle(&mut self) {
        settle(&mut self.harness);
    }
}

fn harness<'a>(config: PathBuf, scene: Option<PathBuf>, size: Vec2) -> Harness<'a, App> {
    let mut harness =
        Harness::builder().with_size(size).build_eframe(move |cc| App::new(cc, Some(config), scene).unwrap());
    settle(&mut harness);
    harness
}

fn settle(harness: &mut Harness<'_, App>) {
    for _ in 0..3 {
        harness.state_mut().session_mut().wait();
        harness.step();
    }
}

#[test]
fn a_border_is_dragged_in_one_step_saved_with_its_comment_and_opened_again() {
    let mut window = Window::open();
    let before = window.session().take().unwrap().film.clone();
    window.drag("Border 1", vec2(120.0, 0.0));
    let moved = window.ends()[0];
    assert!(moved > 22, "{moved}");
    assert!(window.session().take().unwrap().film != before, "the hair has not moved anew");
    window.press(Modifiers::COMMAND, Key::Z);
    assert_eq!(window.ends(), [20, 40], "one drag is one step");
    assert!(!window.session().document().unwrap().is_dirty());
    assert!(window.session().take().unwrap().film == before, "undone, it is not the motion that it was");
    window.press(Modifiers::COMMAND | Modifiers::SHIFT, Key::Z);
    assert_eq!(window.ends()[0], moved);
    window.press(Modifiers::COMMAND, Key::S);
    assert!(!window.session().document().unwrap().is_dirty());
    let text = std::fs::read_to_string(window.file()).unwrap();
    assert_eq!(text, TEXT.replace("through = 20 ", &format!("through = {moved} ")));
    let config = window.folder.path().join("again");
    let again = harness(config, Some(window.file()), vec2(1280.0, 720.0));
    assert_eq!(again.state().session().document().unwrap().scene().field.force[0].through, moved);
}

#[test]
fn a_vector_is_dragged_in_its_circle() {
    let mut window = Window::open();
    window.click("Interval 1");
    assert_eq!(window.session().chosen(), [0]);
    let tip = |window: &Window| *window.session().take().unwrap().points(20).last().unwrap();
    let before = tip(&window);
    window.drag("Dial from the right", vec2(0.0, -30.0));
    let vector = window.session().document().unwrap().scene().field.force[0].vector;
    assert!(vector.y > 20.0 && vector.z == 0.0, "{vector}");
    assert_ne!(tip(&window), before, "the hair has not moved anew");
    assert_eq!(window.session().document().unwrap().undo_name(), Some("Vector of interval 1"));
    window.press(Modifiers::COMMAND, Key::Z);
    assert_eq!(window.session().document().unwrap().undo_name(), None);
    assert_eq!(tip(&window), before);
}

#[test]
fn a_lock_is_pulled_the_wind_follows_and_one_step_undoes_it() {
    let mut window = Window::open();
    window.harness.state_mut().session_mut().apply(Command::Go(30));
    window.settle();
    let before = window.session().document().unwrap().scene().field.force.clone();
    let held = window.take_hold();
    assert_eq!(window.pulled(), Some(30), "the timeline marks the frame");
    window.pull(held + vec2(-40.0, -30.0));
    window.button(held + vec2(-40.0, -30.0), false);
    window.settle();
    assert_eq!(window.pulled(), None);
    assert_eq!(window.session().document().unwrap().undo_name(), Some("Pull the hair"));
    window.press(Modifiers::COMMAND, Key::Z);
    assert_eq!(window.session().document().unwrap().scene().field.force, before, "one pull is one step");
}

#[test]
fn a_setting_of_the_style_grooms_hair_anew() {
    let mut window = Window::of(TEXT, vec2(1280.0, 900.0));
    let before = window.session().take().unwrap().strands().points().to_vec();
    window.click("Style");
    window.drag("Length Top", vec2(-60.0, 0.0));
    assert!(window.session().take().unwrap().strands().points() != before);
    assert_eq!(window.session().document().unwrap().undo_name(), Some("Length: top"));
}

#[test]
fn the_palette_finds_a_command_and_does_it() {
    let mut window = Window::open();
    window.press(Modifiers::COMMAND, Key::P);
    window.harness.get_by_label("Command or setting").type_text("next ease");
    window.harness.step();
    window.harness.step();
    window.press(Modifiers::NONE, Key::Enter);
    assert_eq!(window.session().dialog(), None);
    assert_eq!(window.session().document().unwrap().scene().field.wind.ease, nabiki::field::Ease::Linear);
}

#[test]
fn the_ruler_shows_a_frame_and_keys_step_and_play() {
    let mut window = Window::open();
    window.press(Modifiers::NONE, Key::End);
    assert_eq!(window.session().play.frame(), 40);
    window.press(Modifiers::NONE, Key::ArrowLeft);
    assert_eq!(window.session().play.frame(), 39);
    window.drag("Ruler", vec2(-60.0, 0.0));
    assert!((5..20).contains(&window.session().play.frame()));
    window.harness.key_press(Key::Space);
    window.harness.step();
    assert!(window.session().play.is_playing());
    let before = window.session().play.frame();
    for _ in 0..30 {
        window.harness.step();
    }
    assert_ne!(window.session().play.frame(), before);
}

#[test]
fn an_export_is_begun_from_its_dialog_and_ends_in_a_file() {
    let mut window = Window::open();
    window.press(Modifiers::COMMAND, Key::E);
    window.click("USD");
    assert!(matches!(window.session().dialog(), Some(Dialog::Export(_))));
    window.click("Start export");
    assert_eq!(window.session().tasks().len(), 1);
    while !window.session().tasks()[0].has_ended() {
        std::thread::yield_now();
    }
    window.harness.step();
    let file = window.folder.path().join("out/breeze.usdc");
    assert!(file.exists());
    assert!(window.harness.query_by_label_contains("USD: wrote").is_some());
}

#[test]
fn what_is_not_saved_is_asked_for_before_the_window_closes() {
    let mut window = Window::open();
    window.drag("Border 1", vec2(60.0, 0.0));
    window.press(Modifiers::COMMAND, Key::Q);
    assert!(matches!(window.session().dialog(), Some(Dialog::Unsaved(_))));
    window.click("Cancel");
    assert_eq!(window.session().dialog(), None);
    assert!(window.session().document().unwrap().is_dirty());
}

#[test]
fn a_file_that_another_program_has_changed_is_asked_for() {
    let mut window = Window::open();
    window.drag("Border 1", vec2(60.0, 0.0));
    std::fs::write(window.file(), TEXT.replace("-100", "-30")).unwrap();
    window.press(Modifiers::COMMAND, Key::S);
    assert!(matches!(window.session().dialog(), Some(Dialog::Conflict(..))));
    assert!(std::fs::read_to_string(window.file()).unwrap().contains("-30"));
    window.click("Save over it");
    assert!(std::fs::read_to_string(window.file()).unwrap().contains("-100"));
}

#[test]
fn a_scene_with_errors_shows_its_line() {
    let mut window = Window::open();
    let broken = window.folder.path().join("broken.toml");
    std::fs::write(&broken, TEXT.replace("form = \"free\"", "form = \"fre\"")).unwrap();
    window.press(Modifiers::COMMAND, Key::O);
    let name = broken.file_name().unwrap().to_str().unwrap().to_owned();
    window.click(&name);
    window.click("Open");
    let error = window.session().broken().unwrap().error.clone().unwrap();
    assert_eq!(error.line, Some(6));
    assert!(window.harness.query_by_label_contains("broken.toml:6:").is_some(), "the error is not on the screen");
    assert!(window.session().take().is_some());
    assert!(window.harness.query_by_label_contains("The scene behind it stays").is_some());
    window.harness.state_mut().session_mut().say("something that went wrong", true);
    window.settle();
    let [text, words] = ["Text of the scene", "something that went wrong"];
    let [text, words] = [text, words].map(|label| window.harness.get_by_label(label).rect());
    assert!(text.bottom() <= words.top(), "{words} lies over {text}");
    window.harness.state_mut().session_mut().apply(Command::Heard(0));
    for label in ["Border 1", "Interval 1"] {
        window.drag(label, vec2(60.0, 0.0));
    }
    assert_eq!(window.session().document().unwrap().undo_name(), None, "the scene behind a text is left alone");
    window.click("Close the text");
    assert!(window.session().broken().is_none());
}

#[test]
fn a_broken_layout_and_broken_preferences_do_not_stop_the_start() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("layout.json"), "{ \"root\": 17 }").unwrap();
    std::fs::write(folder.path().join("studio.toml"), "window = \"large\"").unwrap();
    let harness = harness(folder.path().to_owned(), None, vec2(1280.0, 720.0));
    let session = harness.state().session();
    assert!(session.take().is_some());
    for file in ["studio.toml", "layout.json"] {
        assert!(session.words().iter().any(|word| word.text.contains(file)), "{file} is not said");
    }
    assert!(harness.query_by_label("Style").is_some());
}

#[test]
fn every_panel_is_drawn_in_every_size_with_every_scene() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes");
    let scenes = ["storm.toml", "curls.toml", "ponytail.toml", "ball.toml", "paper/gust.toml"];
    for (scene, size) in
        scenes.into_iter().zip([[1280.0, 720.0], [640.0, 420.0], [3840.0, 2160.0], [900.0, 1400.0], [1600.0, 900.0]])
    {
        let config = tempfile::tempdir().unwrap();
        std::fs::write(config.path().join("studio.toml"), "welcomed = true\nstrands = 300").unwrap();
        let mut harness = harness(config.path().to_owned(), Some(folder.join(scene)), Vec2::from(size));
        assert_eq!(harness.state().session().trouble(), None, "{scene}");
        for page in nabiki_studio::settings::Page::ALL {
            if let Some(tab) = harness.query_all_by_label(page.title()).last() {
                tab.click();
            }
            harness.step();
            harness.step();
        }
    }
}

#[test]
fn the_words_of_the_first_start_go_with_the_first_touch_which_does_what_it_does() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = harness(folder.path().to_owned(), None, vec2(1280.0, 720.0));
    assert_eq!(harness.state().session().dialog(), Some(&Dialog::Welcome));
    let words = harness.get_by_label_contains("The intervals below are the wind").rect();
    let view = harness.get_by_label("View of the hair").rect();
    assert!(view.contains_rect(words) && words.right() < view.left() + 0.3 * view.width(), "{words} in {view}");
    harness.key_press(Key::Space);
    harness.step();
    harness.step();
    assert_eq!(harness.state().session().dialog(), None);
    assert!(harness.state().session().play.is_playing());
    assert!(harness.query_by_label_contains("The intervals below are the wind").is_none());
    assert!(harness.state().session().preferences().welcomed);
}

#[test]
fn nothing_of_a_page_is_cut_in_a_small_window() {
    for size in [vec2(720.0, 450.0), vec2(1280.0, 720.0), vec2(640.0, 420.0)] {
        let mut window = Window::of(TEXT, size);
        for page in nabiki_studio::settings::Page::ALL {
            window.click(page.title());
            let has_place = By::new().predicate(|node| node.raw_bounds().is_some());
            for node in window.harness.query_all(has_place) {
                let rect = node.rect();
                assert!(rect.right() <= size.x + 0.5, "{} in {size}: {rect}, {node:?}", page.title());
            }
        }
    }
}

#[test]
fn a_dropped_file_is_asked_how_it_lies_and_a_wrong_one_refused_in_a_line() {
    let mut window = Window::open();
    let folder = window.folder.path().to_owned();
    let long = format!("{}.bvh", "a_recording_with_a_long_name_".repeat(7));
    let names = ["locks.hair", "bust.obj", "walk.bvh", long.as_str(), "head.glb", "all.usda", "ball.ply"];
    for name in names {
        std::fs::write(folder.join(name), "nothing that could be read").unwrap();
        window.drop(&folder.join(name));
        let Some(Dialog::Import(import)) = window.session().dialog() else { panic!("{name}: it is not asked") };
        for role in import.roles.clone() {
            assert!(window.harness.query_all_by_label(role.name()).count() > 0, "{name}: {}", role.name());
        }
        for button in ["Cancel", "Import"] {
            let rect = window.harness.get_by_label(button).rect();
            assert!(rect.right() < 1280.0 && rect.bottom() < 720.0, "{name}: {button} at {rect}");
        }
        window.click("Import");
        assert_eq!(window.session().dialog(), None);
        let said = window.session().trouble().map(|trouble| trouble.text.clone());
        let said = said.or_else(|| window.session().words().last().map(|word| word.text.clone())).unwrap();
        assert!(said.contains(name) && !said.contains('\n'), "{name}: {said}");
        assert!(window.session().take().is_some(), "the last good motion stays");
        if window.session().trouble().is_some() {
            window.press(Modifiers::COMMAND, Key::Z);
        }
        assert_eq!(window.session().trouble(), None, "{name}");
        assert!(!window.session().document().unwrap().is_dirty(), "{name}");
    }
    std::fs::write(folder.join("notes.png"), [0x89, b'P', b'N', b'G', 0, 1, 2]).unwrap();
    for wrong in [folder.join("notes.png"), folder.clone(), folder.join("not_there.toml")] {
        window.drop(&wrong);
        assert!(window.session().dialog().is_none() && window.session().broken().is_none(), "{wrong:?}");
        let said = &window.session().words().last().unwrap().text;
        assert!(said.contains(&wrong.display().to_string()) && !said.contains('\n'), "{said}");
    }
    // However much has been said, most of the window is still the window.
    for n in 0..40 {
        window.harness.state_mut().session_mut().say(format!("{n}: something that went wrong"), true);
        window.harness.step();
    }
    assert!(window.harness.get_by_label("View of the hair").rect().height() > 100.0);
}

#[test]
fn the_slider_of_strands_goes_from_300_to_all() {
    let mut window = Window::of(&TEXT.replace("strands = 60", "strands = 2100"), vec2(1280.0, 720.0));
    let slider = window.harness.get_by_label("Strands shown").rect();
    for (to, shown) in [(slider.left() - 40.0, 300), (slider.right() + 40.0, 2100)] {
        window.button(slider.center(), true);
        window.harness.hover_at(eframe::egui::pos2(to, slider.center().y));
        window.harness.step();
        window.button(eframe::egui::pos2(to, slider.center().y), false);
        window.settle();
        assert_eq!(window.session().take().unwrap().strands().len(), shown);
    }
    assert_eq!(window.session().preferences().strands, nabiki_studio::preferences::ALL);
    assert!(window.harness.query_by_label("all 2100").is_some());
}

#[test]
fn what_is_said_lies_over_the_view_and_changes_the_size_of_nothing() {
    let mut window = Window::open();
    let labels = ["View of the hair", "Ruler", "Interval 1", "Strands shown"];
    let places = |window: &Window<'_>| labels.map(|label| window.harness.get_by_label(label).rect());
    let before = places(&window);
    for n in 0..3 {
        window.harness.state_mut().session_mut().say(format!("{n}: something that went wrong"), true);
        window.harness.step();
        window.harness.step();
        assert_eq!(places(&window), before);
    }
    let words = window.harness.get_by_label("0: something that went wrong").rect();
    assert!(before[0].contains_rect(words), "{words} in {}", before[0]);
    for n in (0..3).rev() {
        window.harness.state_mut().session_mut().apply(Command::Heard(n));
    }
    window.settle();
    assert_eq!(places(&window), before);
}
