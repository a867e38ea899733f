use glam::Vec3;

use super::*;
use crate::session::tests::{Place, TEXT};

fn vector(session: &Session) -> Vec3 {
    session.document().unwrap().scene().field.force[0].vector
}

fn blow(session: &mut Session, vector: Vec3) {
    session.apply(Command::Vector { interval: 0, vector, phase: Phase::Done });
    session.wait();
}

fn act(session: &mut Session, action: Action) {
    session.apply(Command::Act(action));
}

/// A scene whose first interval has another vector than the take that is kept.
fn kept_and_changed(place: &Place) -> (Session, Arc<Take>) {
    let mut session = place.session();
    assert_eq!(session.trouble(), None);
    let first = session.take().unwrap().clone();
    act(&mut session, Action::Keep);
    blow(&mut session, Vec3::new(0.0, 60.0, 0.5));
    (session, first)
}

#[test]
fn what_is_kept_is_seen_until_the_scene_is_asked_for_or_changed() {
    let place = Place::new();
    let (mut session, first) = kept_and_changed(&place);
    assert!(session.seen_instead().is_none());
    assert_ne!(session.take().unwrap().film, first.film);
    act(&mut session, Action::Compare);
    let wind = Difference {
        name: "Interval 1: vector".to_owned(),
        kept: "(-100, 0, 0)".to_owned(),
        now: "(0, 60, 0.5)".to_owned(),
    };
    let (seen, differences) = session.seen_instead().unwrap();
    assert!(Arc::ptr_eq(seen, &first));
    assert_eq!(differences, [wind]);
    act(&mut session, Action::Keep);
    assert!(session.seen_instead().is_some(), "what is kept already is not kept again");
    act(&mut session, Action::Compare);
    assert!(session.seen_instead().is_none());
    for action in [Action::Ease, Action::Undo, Action::Redo] {
        act(&mut session, Action::Compare);
        assert!(session.seen_instead().is_some());
        act(&mut session, action);
        assert!(session.seen_instead().is_none(), "{action:?} is a change of the scene, which is to be seen");
    }
    assert!(Arc::ptr_eq(session.kept_take().unwrap(), &first));
}

#[test]
fn exchanged_twice_all_is_as_it_was_and_each_is_one_step_of_undo() {
    let place = Place::new();
    let (mut session, first) = kept_and_changed(&place);
    let changed = session.take().unwrap().clone();
    let [was, is] = [Vec3::new(-100.0, 0.0, 0.0), Vec3::new(0.0, 60.0, 0.5)];
    act(&mut session, Action::Exchange);
    assert_eq!(vector(&session), was);
    assert_eq!(session.take().unwrap().film, first.film, "it is seen before it is moved again");
    session.wait();
    assert_eq!(session.take().unwrap().film, first.film);
    assert_eq!(session.kept_take().unwrap().film, changed.film);
    act(&mut session, Action::Undo);
    assert_eq!(vector(&session), is);
    act(&mut session, Action::Redo);
    // The motion of what is exchanged need not have come.
    for wanted in [is, was, is] {
        act(&mut session, Action::Exchange);
        assert_eq!(vector(&session), wanted);
    }
    session.wait();
    assert_eq!(session.take().unwrap().film, changed.film);
    assert_eq!(session.kept_take().unwrap().film, first.film);
}

#[test]
fn the_last_touch_is_kept_though_its_motion_is_not_there_yet() {
    let place = Place::new();
    let (mut session, _) = kept_and_changed(&place);
    session.apply(Command::Vector { interval: 0, vector: Vec3::Y, phase: Phase::Done });
    act(&mut session, Action::Exchange);
    act(&mut session, Action::Exchange);
    assert_eq!(vector(&session), Vec3::Y);
}

#[test]
fn where_nothing_is_kept_it_says_how_until_something_is() {
    let place = Place::new();
    let mut session = place.session();
    for action in [Action::Compare, Action::Exchange] {
        act(&mut session, action);
        assert_eq!(session.words().iter().filter(|word| word.wrong && word.text == NONE).count(), 1);
    }
    act(&mut session, Action::Keep);
    assert!(session.words().iter().all(|word| !word.wrong));
    act(&mut session, Action::Compare);
    assert_eq!(session.seen_instead().unwrap().1, [], "it is as the scene is");
}

#[test]
fn a_scene_that_does_not_move_is_not_exchanged_for_what_is_kept() {
    let place = Place::new();
    let (mut session, first) = kept_and_changed(&place);
    let value = Some(Value::Float(-1.0));
    session.apply(Command::Set { key: "free.settle".to_owned(), value, phase: Phase::Done });
    act(&mut session, Action::Exchange);
    assert!(
        session.words().iter().any(|word| word.wrong && word.text.contains("free.settle")),
        "{:?}",
        session.words()
    );
    assert!(Arc::ptr_eq(session.kept_take().unwrap(), &first));
    assert_eq!(vector(&session), Vec3::new(0.0, 60.0, 0.5));
}

#[test]
fn both_takes_are_seen_with_the_same_strands() {
    let place = Place::new();
    let (mut session, first) = kept_and_changed(&place);
    session.apply(Command::Strands(30));
    session.wait();
    act(&mut session, Action::Compare);
    session.wait();
    let fewer = |session: &Session| {
        let kept = session.kept_take().unwrap();
        (0..=20).all(|n| *kept.points(n) == first.points(n)[..kept.strands().points().len()])
    };
    assert_eq!(session.kept_take().unwrap().strands().len(), 30);
    assert!(fewer(&session));
    session.apply(Command::Strands(45));
    session.wait();
    act(&mut session, Action::Compare);
    session.wait();
    assert_eq!(session.kept_take().unwrap().strands().len(), 45);
    assert!(fewer(&session));
}

#[test]
fn what_is_kept_goes_along_into_another_folder_and_not_into_another_scene() {
    let place = Place::new();
    // A path that leads elsewhere from another folder.
    let turn = concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenes/motion/turn.csv");
    std::fs::copy(turn, place.0.path().join("turn.csv")).unwrap();
    std::fs::write(place.file(), format!("[head.motion]\nfile = \"turn.csv\"\nup = \"+y\"\nfacing = \"+x\"\n{TEXT}"))
        .unwrap();
    let (mut session, first) = kept_and_changed(&place);
    let below = place.0.path().join("below");
    std::fs::create_dir(&below).unwrap();
    session.apply(Command::SaveTo(below.join("wind.toml")));
    act(&mut session, Action::Compare);
    assert_eq!(session.seen_instead().unwrap().1.len(), 1, "the folder alone is no difference");
    act(&mut session, Action::Exchange);
    assert_eq!(session.document().unwrap().scene().file(), below.join("wind.toml"));
    act(&mut session, Action::Save);
    session.wait();
    assert_eq!(session.trouble(), None);
    assert_eq!(session.take().unwrap().film, first.film);
    let text = std::fs::read_to_string(below.join("wind.toml")).unwrap();
    assert_eq!(text, format!("[head.motion]\nfile = \"../turn.csv\"\nup = \"+y\"\nfacing = \"+x\"\n{TEXT}"));
    session.apply(Command::Open(place.file()));
    session.wait();
    assert!(session.kept_take().is_none());
}

#[test]
fn settings_that_differ_are_named_as_the_pages_name_them() {
    let table = |text: &str| text.parse::<Table>().unwrap();
    let kept =
        table("[free]\nsettle = 20\n[turbulence]\nstrength = 3.5\n[[fan]]\nstrength = 2\n[[fan]]\nstrength = 5\n");
    let now = table("[free]\nsettle = 40\n[[fan]]\nstrength = 2\n[[force]]\nthrough = 3\n");
    let found: Vec<_> = differences(&kept, &now).into_iter().map(|d| [d.name, d.kept, d.now].join("|")).collect();
    assert_eq!(found.len(), 4, "{found:?}");
    for wanted in ["fan[1]|on|none", "turbulence|on|none", "force|none|"] {
        assert!(found.iter().any(|line| line.starts_with(wanted)), "{wanted}: {found:?}");
    }
    let settle = found.iter().find(|line| line.ends_with("|20|40")).unwrap();
    assert!(settle.to_lowercase().contains("settl"), "{settle}");
}
