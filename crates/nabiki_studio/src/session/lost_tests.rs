use glam::Vec3;

use super::super::tests::{Place, TEXT};
use super::*;
use crate::actions::Action;
use crate::command::Command;
use crate::document::Phase;
use crate::tasks::{Kind, Order};

/// A window in which a scene is open, and over it the text of one that cannot be read.
fn with_text(place: &Place) -> (Session, PathBuf) {
    let mut session = place.session();
    let path = place.0.path().join("broken.toml");
    std::fs::write(&path, TEXT.replace("through = 20", "trough = 20")).unwrap();
    session.apply(Command::Open(path.clone()));
    assert!(session.broken().is_some_and(|broken| broken.error.is_some() && !broken.is_changed()));
    (session, path)
}

/// Changes the scene, as if no text lay over it yet.
fn edit(session: &mut Session) {
    let text = session.broken.take();
    session.apply(Command::Vector { interval: 0, vector: Vec3::X, phase: Phase::Done });
    session.broken = text;
}

fn asks(session: &Session, next: &Next) -> bool {
    matches!(session.dialog(), Some(Dialog::Unsaved(asked)) if asked == next)
}

#[test]
fn a_text_that_is_mended_is_not_lost_unasked() {
    let place = Place::new();
    let (mut session, _) = with_text(&place);
    assert!(session.may_close(), "nothing of it was changed");
    session.apply(Command::Mend("half".to_owned()));
    for (command, next) in [
        (Command::Act(Action::Quit), Next::Quit),
        (Command::Open(place.file()), Next::Open(place.file())),
        (Command::LeaveBroken, Next::LeaveText),
    ] {
        session.apply(command);
        assert!(asks(&session, &next), "{next:?}");
        session.apply(Command::CloseDialog);
        assert_eq!(session.broken().unwrap().text, "half");
    }
    std::fs::write(place.file(), TEXT.replace("-100", "-50")).unwrap();
    session.look_at_file();
    assert!(session.broken().is_some(), "a change of the other file does not take it away");
    session.apply(Command::LeaveBroken);
    session.apply(Command::GoOn);
    assert!(session.broken().is_none() && session.dialog().is_none() && session.may_close());
}

#[test]
fn text_and_scene_behind_it_are_asked_for_one_after_the_other() {
    let place = Place::new();
    let (mut session, path) = with_text(&place);
    edit(&mut session);
    session.apply(Command::Mend("half".to_owned()));
    assert!(!session.may_close() && session.loses_text(&Next::Quit));
    session.apply(Command::SaveAndGoOn(Next::Quit));
    assert_eq!(std::fs::read_to_string(&path).unwrap(), "half");
    assert!(asks(&session, &Next::Quit) && !session.loses_text(&Next::Quit));
    session.apply(Command::SaveAndGoOn(Next::Quit));
    assert_eq!(session.wishes(), [Wish::Quit]);
    assert!(!std::fs::read_to_string(place.file()).unwrap().contains("-100"));
}

#[test]
fn what_is_seen_is_saved_and_what_is_behind_it_is_left_alone() {
    let place = Place::new();
    let (mut session, path) = with_text(&place);
    edit(&mut session);
    session.apply(Command::Mend("half".to_owned()));
    for action in [Action::Undo, Action::Delete, Action::Save] {
        session.apply(Command::Act(action));
    }
    assert_eq!(session.document().unwrap().scene().field.force[0].vector, Vec3::X);
    assert_eq!(std::fs::read_to_string(place.file()).unwrap(), TEXT);
    assert_eq!(std::fs::read_to_string(&path).unwrap(), "half");
    assert!(session.broken().is_some_and(|broken| !broken.is_changed()));
    std::fs::write(&path, "theirs").unwrap();
    session.apply(Command::Mend(TEXT.to_owned()));
    session.apply(Command::Act(Action::Save));
    assert!(matches!(session.dialog(), Some(Dialog::Conflict(asked, None)) if *asked == path));
    session.apply(Command::SaveOver);
    assert_eq!(std::fs::read_to_string(&path).unwrap(), TEXT);
    assert!(session.broken().is_some(), "the scene behind it is not saved");
    session.apply(Command::UseMended);
    assert!(asks(&session, &Next::UseMended));
    session.apply(Command::SaveAndGoOn(Next::UseMended));
    assert_eq!(session.document().unwrap().path(), Some(path.as_path()));
    assert!(session.broken().is_none() && !session.document().unwrap().is_dirty());
    assert!(!std::fs::read_to_string(place.file()).unwrap().contains("-100"));
}

#[test]
fn a_text_that_is_right_and_saved_is_opened() {
    let place = Place::new();
    let (mut session, path) = with_text(&place);
    session.apply(Command::Mend(TEXT.to_owned()));
    session.apply(Command::Act(Action::Save));
    assert!(session.broken().is_none());
    assert_eq!(session.document().unwrap().path(), Some(path.as_path()));
    assert!(!session.document().unwrap().is_dirty());
}

#[test]
fn a_scene_without_a_file_is_given_a_name_and_then_the_window_closes() {
    let place = Place::new();
    let mut session = Session::new(None, || ()).unwrap();
    session.begin(None);
    edit(&mut session);
    session.apply(Command::Act(Action::Quit));
    session.apply(Command::SaveAndGoOn(Next::Quit));
    let Some(Dialog::File(chooser)) = session.dialog() else { panic!("no name is asked for") };
    let chooser = Box::new(chooser.clone());
    let nowhere = place.0.path().join("no/such/folder.toml");
    session.apply(Command::Chosen(chooser.clone(), nowhere));
    assert!(session.words().iter().any(|word| word.text.contains("there is no such folder")));
    assert_eq!(session.wishes(), []);
    let path = place.0.path().join("mine.toml");
    session.apply(Command::Chosen(chooser, path.clone()));
    assert!(path.is_file());
    assert_eq!(session.wishes(), [Wish::Quit]);
}

#[test]
fn what_another_program_has_written_is_saved_over_and_then_the_window_closes() {
    let place = Place::new();
    let mut session = place.session();
    edit(&mut session);
    std::fs::write(place.file(), "theirs").unwrap();
    session.apply(Command::SaveAndGoOn(Next::Quit));
    assert!(matches!(session.dialog(), Some(Dialog::Conflict(_, Some(Next::Quit)))));
    session.apply(Command::SaveOver);
    assert_eq!(session.wishes(), [Wish::Quit]);
}

#[test]
fn an_export_that_runs_is_asked_for() {
    let place = Place::new();
    let mut session = place.session();
    let (gate, opened) = std::sync::mpsc::channel::<()>();
    let order = Order { kind: Kind::Usd, place: place.0.path().join("hair.usda"), frame: 0, strands: None };
    let scene = session.document().unwrap().scene().clone();
    // It stands still at its first word until the gate goes.
    let task = Task::begin(order, scene, move || opened.recv().unwrap_or_default()).unwrap();
    session.tasks.push(task);
    assert!(!session.may_close());
    assert_eq!(session.dialog(), Some(&Dialog::Exporting));
    session.apply(Command::CloseDialog);
    assert!(!session.tasks()[0].is_cancelled());
    edit(&mut session);
    assert!(!session.may_close() && asks(&session, &Next::Quit));
    session.apply(Command::GoOn);
    assert_eq!(session.dialog(), Some(&Dialog::Exporting), "that is another question");
    session.apply(Command::CloseDialog);
    assert!(session.document().unwrap().is_dirty(), "nothing is lost yet");
    session.apply(Command::Act(Action::Quit));
    session.apply(Command::GoOn);
    session.apply(Command::GoOn);
    assert_eq!(session.wishes(), [Wish::Quit]);
    assert!(session.tasks()[0].is_cancelled() && session.may_close());
    drop(gate);
    while !session.tasks()[0].has_ended() {
        std::thread::yield_now();
    }
}

#[test]
fn a_text_that_a_killed_window_had_is_offered_and_goes_on_being_mended() {
    let place = Place::new();
    let (mut session, path) = with_text(&place);
    session.apply(Command::Mend("half".to_owned()));
    session.keep();
    let recovery = place.0.path().join("config/recovery");
    let kept = std::fs::read_dir(&recovery).unwrap().flatten().map(|entry| entry.path());
    let kept: Vec<PathBuf> = kept.filter(|path| path.extension().is_some_and(|e| e == "toml")).collect();
    assert_eq!(kept.len(), 1);
    let text = std::fs::read_to_string(&kept[0]).unwrap();
    drop(session);
    assert!(!kept[0].exists(), "a window that closes has asked");
    std::fs::write(recovery.join("1-0.toml"), text).unwrap();
    let mut session = place.session();
    session.apply(Command::Recover(0));
    let broken = session.broken().unwrap();
    assert_eq!((broken.text.as_str(), &broken.path), ("half", &path));
    assert!(broken.is_changed() && session.dialog().is_none());
}

#[test]
fn a_scene_that_cannot_move_does_not_show_the_hair_of_the_one_before() {
    let place = Place::new();
    let mut session = place.session();
    let still = place.0.path().join("still.toml");
    std::fs::write(&still, TEXT.replace("-100", "-1000000")).unwrap();
    session.apply(Command::Open(still));
    session.wait();
    assert!(session.trouble().is_some() && session.take().is_none() && session.swings().is_none());
    session.apply(Command::Open(place.file()));
    session.wait();
    assert!(session.trouble().is_none() && session.take().is_some());
}

#[test]
fn a_window_that_has_closed_leaves_nothing_beside_the_preferences() {
    let place = Place::new();
    let (mut session, _) = with_text(&place);
    session.apply(Command::Mend("half".to_owned()));
    session.keep();
    let recovery = place.0.path().join("config/recovery");
    let left = || std::fs::read_dir(&recovery).unwrap().count();
    assert_eq!(left(), 3, "two locks and the text");
    session.end();
    assert_eq!(left(), 0);
}

#[test]
fn nothing_changes_the_scene_behind_a_text_and_that_is_said() {
    let place = Place::new();
    let (mut session, _) = with_text(&place);
    let scene = session.document().unwrap().scene().clone();
    let key = "motion.frames".to_owned();
    for command in [
        Command::Set { key: key.clone(), value: Some(10.into()), phase: Phase::Done },
        Command::SetAll { name: "Length".to_owned(), settings: vec![(key, Some(10.into()))] },
        Command::Vector { interval: 0, vector: Vec3::X, phase: Phase::Dragging },
        Command::Intervals { name: "Cut", keys: Vec::new(), chosen: None, phase: Phase::Done },
        Command::Scene { name: "Camera".to_owned(), scene: Box::default(), phase: Phase::Done },
        Command::Act(Action::SelectAll),
        Command::Act(Action::Delete),
        Command::Act(Action::Split),
    ] {
        session.words.clear();
        let chooses = matches!(command, Command::Act(Action::SelectAll));
        session.apply(command.clone());
        assert_eq!(*session.document().unwrap().scene(), scene, "{command:?}");
        assert_eq!(session.words().iter().any(|word| word.text.contains("fix or close")), !chooses, "{command:?}");
    }
    session.apply(Command::LeaveBroken);
    assert!(session.words().iter().all(|word| !word.text.contains("fix or close")), "it is not behind a text any more");
    edit(&mut session);
    assert!(session.document().unwrap().is_dirty());
}

#[test]
fn a_scene_whose_file_is_gone_is_asked_about_before_it_is_lost_and_one_that_cannot_be_written_says_where_to() {
    let place = Place::new();
    let mut session = place.session();
    let folder = place.file().with_file_name("gone");
    std::fs::create_dir(&folder).unwrap();
    let file = folder.join("wind.toml");
    session.apply(Command::SaveTo(file.clone()));
    assert!(session.may_close());
    std::fs::remove_file(&file).unwrap();
    assert!(!session.document().unwrap().is_dirty() && !session.may_close(), "it would be lost");
    session.apply(Command::CloseDialog);
    // Where its folder was there is a file now, so that no file can be there.
    std::fs::remove_dir(&folder).unwrap();
    std::fs::write(&folder, "").unwrap();
    session.apply(Command::Act(Action::Save));
    let said = session.words().last().unwrap();
    assert!(said.wrong && said.text.contains(&file.display().to_string()), "{said:?}");
    assert!(said.text.contains("Save as") && !said.text.contains('\n'), "{said:?}");
    session.apply(Command::SaveTo(place.file().with_file_name("again.toml")));
    assert!(session.may_close());
}

/// What lies beside the preferences of windows that live.
fn kept_texts(place: &Place) -> Vec<String> {
    let files = std::fs::read_dir(place.0.path().join("config/recovery")).unwrap().flatten().map(|entry| entry.path());
    let files = files.filter(|path| path.extension().is_some_and(|e| e == "toml"));
    files.map(|path| std::fs::read_to_string(path).unwrap()).collect()
}

#[test]
fn what_was_recovered_or_mended_and_is_not_saved_is_kept_though_nothing_was_changed_since() {
    let place = Place::new();
    let mut session = place.session();
    edit(&mut session);
    session.keep();
    let text = kept_texts(&place).remove(0);
    drop(session);
    let left = place.0.path().join("config/recovery/1-0.toml");
    std::fs::write(&left, &text).unwrap();
    let mut session = place.session();
    // The question has stood for a while.
    session.keep();
    session.apply(Command::Recover(0));
    assert!(!left.exists());
    assert!(matches!(&kept_texts(&place)[..], [kept] if kept.contains("[1, 0, 0]")), "{:?}", kept_texts(&place));
    session.apply(Command::Act(Action::Save));
    assert_eq!(kept_texts(&place), [] as [String; 0]);
    let (mut session, _) = with_text(&place);
    session.keep();
    session.apply(Command::Mend(TEXT.replace("-100", "-70")));
    session.apply(Command::UseMended);
    session.keep();
    assert!(matches!(&kept_texts(&place)[..], [kept] if kept.contains("-70")), "{:?}", kept_texts(&place));
}

#[test]
fn saved_under_its_own_name_it_asks_about_what_another_program_has_written_there() {
    let place = Place::new();
    let mut session = place.session();
    edit(&mut session);
    std::fs::write(place.file(), "theirs").unwrap();
    session.apply(Command::Act(Action::Save));
    assert!(matches!(session.dialog(), Some(Dialog::Conflict(..))));
    session.apply(Command::Act(Action::SaveAs));
    let Some(Dialog::File(chooser)) = session.dialog().cloned() else { panic!("no name is asked for") };
    let own = PathBuf::from(&chooser.path);
    session.apply(Command::Chosen(Box::new(chooser), own));
    assert!(matches!(session.dialog(), Some(Dialog::Conflict(..))));
    assert_eq!(std::fs::read_to_string(place.file()).unwrap(), "theirs");
    let (mut session, path) = with_text(&place);
    session.apply(Command::Mend("half".to_owned()));
    std::fs::write(&path, "theirs").unwrap();
    session.apply(Command::SaveTo(path.clone()));
    assert!(matches!(session.dialog(), Some(Dialog::Conflict(..))));
    assert_eq!(std::fs::read_to_string(&path).unwrap(), "theirs");
}

/// Asks the desktop for what the session asks for, and takes its answer.
fn ask_desktop(session: &mut Session, answer: PathBuf) {
    let Some(Dialog::File(chooser)) = session.dialog() else { panic!("no file is asked for") };
    session.desktop = Some(crate::desktop::Asked::asks(chooser.clone(), move || Some(answer), || ()).unwrap());
}

#[test]
fn a_name_without_an_ending_replaces_no_scene_that_the_desktop_has_not_asked_about() {
    let place = Place::new();
    let mut session = place.session();
    let other = place.0.path().join("other.toml");
    std::fs::write(&other, "another").unwrap();
    session.apply(Command::Act(Action::SaveAs));
    ask_desktop(&mut session, other.with_extension(""));
    while session.asks_desktop() {
        session.tick(0.001, 0.001);
    }
    assert_eq!(std::fs::read_to_string(&other).unwrap(), "another");
    assert!(matches!(session.dialog(), Some(Dialog::File(chooser)) if Path::new(&chooser.path) == other));
    ask_desktop(&mut session, place.0.path().join("new"));
    while session.asks_desktop() {
        session.tick(0.001, 0.001);
    }
    assert!(place.0.path().join("new.toml").is_file() && session.dialog().is_none());
}

#[test]
fn what_the_desktop_was_asked_for_one_scene_is_not_done_to_another() {
    let place = Place::new();
    let mut session = place.session();
    let (other, name) = (place.0.path().join("other.toml"), place.0.path().join("name.toml"));
    std::fs::write(&other, TEXT).unwrap();
    session.apply(Command::Act(Action::SaveAs));
    ask_desktop(&mut session, name.clone());
    // A file let go over the window.
    session.apply(Command::Open(other.clone()));
    for _ in 0..20 {
        session.tick(0.001, 0.001);
        std::thread::sleep(std::time::Duration::from_millis(1));
    }
    assert_eq!(session.document().unwrap().path(), Some(other.as_path()));
    assert!(!name.exists());
}

#[test]
fn a_text_that_nobody_has_touched_here_is_read_again_when_another_program_has_mended_it() {
    let place = Place::new();
    let mut session = place.session();
    for text in ["nonsense".to_owned(), TEXT.replace("= 20", "= "), TEXT.replace("-100", "-50")] {
        std::fs::write(place.file(), &text).unwrap();
        session.look_at_file();
        assert_eq!(session.broken().is_some(), !text.contains("-50"), "{text}");
        assert!(session.broken().is_none_or(|broken| broken.text == text));
    }
    assert_eq!(session.document().unwrap().scene().field.force[0].vector.x, -50.0);
    let (mut session, path) = with_text(&place);
    std::fs::write(&path, TEXT).unwrap();
    session.look_at_file();
    assert_eq!(session.document().unwrap().path(), Some(path.as_path()));
    let (mut session, path) = with_text(&place);
    edit(&mut session);
    std::fs::write(&path, TEXT).unwrap();
    session.look_at_file();
    assert!(session.broken().is_some(), "the scene behind it is not saved");
}
