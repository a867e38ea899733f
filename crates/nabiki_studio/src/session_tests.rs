use std::path::PathBuf;

use glam::Vec3;
use nabiki_scene::scene::ForceSettings;

use super::*;
use crate::dialog::Next;
use crate::document::Phase;

pub(super) const TEXT: &str = "[hair]\nstrands = 60\nsegments = 18\n[motion]\nform = \"free\"\nframes = 20\n\
                    [[force]]\nthrough = 10     # then calm\nvector = [-100, 0, 0]\n[[force]]\nthrough = 20\nvector = [0, 0, 0]\n";

pub(super) struct Place(pub(super) tempfile::TempDir);

impl Place {
    pub(super) fn new() -> Self {
        let place = Self(tempfile::tempdir().unwrap());
        std::fs::write(place.file(), TEXT).unwrap();
        place
    }

    pub(super) fn file(&self) -> PathBuf {
        self.0.path().join("wind.toml")
    }

    pub(super) fn session(&self) -> Session {
        let mut session = Session::new(Some(self.0.path().join("config")), || ()).unwrap();
        session.begin(Some(&self.file()));
        session.wait();
        session
    }
}

fn tip(session: &Session, frame: u32) -> Vec3 {
    *session.take().unwrap().points(frame).last().unwrap()
}

/// What a new start would show of the scene as it is.
fn fresh(session: &Session) -> Vec<Vec3> {
    let scene = session.document().unwrap().scene().clone();
    let built = scene.build(nabiki_scene::Shown::AtMost(session.preferences().strands)).unwrap();
    let mut timeline = built.timeline().unwrap();
    let film = timeline.play();
    (0..=film.frames()).flat_map(|n| film.points(n).iter().copied()).collect()
}

#[test]
fn whatever_is_changed_is_moved_as_if_from_anew() {
    let place = Place::new();
    let mut session = place.session();
    for (key, value) in [
        ("force[0].vector", "[50.0, 20.0, 5.0]"),
        ("wind.ease", "\"smooth\""),
        ("free.settle", "5.0"),
        ("free.gravity", "\"earth\""),
        ("turbulence", "{}"),
        ("contact.margin", "0.5"),
        ("neighbours", "{}"),
        ("neighbours.carriers", "20"),
        ("hair.style.length.top", "16.0"),
        ("hair.style.comb.away", "2.0"),
        ("hair.segment_length", "2.0"),
        ("head.ellipsoid", "{ center = [-1.0, 0.0, 0.0], half_axes = [10.0, 11.0, 8.0] }"),
        ("motion.frames", "25"),
        ("motion.frame_rate", "30.0"),
        ("motion.straighten", "5.0"),
        ("motion.form", "\"paper\""),
        ("pseudo_force.alpha", "0.5"),
        ("picture.hair.colour", "\"red\""),
    ] {
        let value = format!("x = {value}").parse::<Table>().unwrap().remove("x");
        session.apply(Command::Set { key: key.to_owned(), value, phase: Phase::Done });
        session.wait();
        assert_eq!(session.trouble(), None, "{key}");
        assert!(*session.take().unwrap().film == *fresh(&session), "{key}: not what a new start would show");
    }
    session.apply(Command::Strands(30));
    session.wait();
    assert!(*session.take().unwrap().film == *fresh(&session));
    while session.document().unwrap().undo_name().is_some() {
        session.apply(Command::Act(Action::Undo));
        session.wait();
        assert!(*session.take().unwrap().film == *fresh(&session));
    }
    assert_eq!(session.document().unwrap().scene().to_toml().unwrap(), TEXT);
}

#[test]
fn more_strands_than_a_touch_moves_follow_when_the_hand_rests() {
    let place = Place::new();
    std::fs::write(place.file(), TEXT.replace("strands = 60", "strands = 2300")).unwrap();
    let mut session = place.session();
    let shown = |session: &Session| session.take().unwrap().strands().len();
    session.apply(Command::Strands(crate::preferences::ALL));
    session.wait();
    assert_eq!(shown(&session), 2300);
    assert!(*session.take().unwrap().film == *fresh(&session));
    for n in 1..4 {
        session.apply(Command::Vector { interval: 0, vector: Vec3::X * n as f32, phase: Phase::Dragging });
        session.motion.wait();
        session.receive();
        assert_eq!(shown(&session), crate::take::TOUCHED, "a touch does not wait for all");
    }
    let few = session.take().unwrap().clone();
    session.tick(0.01, 0.01);
    assert!(!session.is_moving(), "the hand has not rested");
    session.tick(0.2, 0.2);
    session.wait();
    let all = session.take().unwrap();
    assert_eq!((all.strands().len(), session.trouble()), (2300, None));
    assert!(*all.film == *fresh(&session));
    assert!(
        (0..=20).all(|frame| all.points(frame)[..few.points(0).len()] == *few.points(frame)),
        "the few move as among all"
    );
    session.apply(Command::Act(Action::Fewer));
    session.wait();
    assert_eq!(shown(&session), 1150);
    session.apply(Command::Act(Action::More));
    session.wait();
    assert_eq!((shown(&session), session.preferences().strands), (2300, crate::preferences::ALL));
}

#[test]
fn the_window_rests_while_a_motion_is_worked_out() {
    let place = Place::new();
    std::fs::write(place.file(), TEXT.replace("strands = 60", "strands = 2300")).unwrap();
    let mut session = place.session();
    session.apply(Command::Strands(crate::preferences::ALL));
    session.wait();
    session.apply(Command::Vector { interval: 0, vector: Vec3::X, phase: Phase::Dragging });
    // What is to follow is due long since.
    session.clock += 1.0;
    let waits = session.waits();
    assert!(waits > 0.5 || !session.motion.is_working(), "{waits}");
    session.motion.wait();
    assert_eq!(session.waits(), 0.0, "it is asked for as soon as the few are there");
}

#[test]
fn what_is_moved_of_many_strands_gives_way() {
    let place = Place::new();
    let session = place.session();
    let scene = session.document().unwrap().scene().clone();
    let mut motion = Motion::start(Manner::GivesWay, || ()).unwrap();
    motion.ask(scene.clone(), 60, false);
    motion.stop();
    motion.wait();
    assert!(motion.take().is_none());
    let numbers: Vec<u64> = (0..5).map(|_| motion.ask(scene.clone(), 60, false)).collect();
    motion.wait();
    let moved = motion.take().unwrap();
    assert_eq!(Some(&moved.number), numbers.last());
    assert_eq!(moved.result.unwrap().0.strands().len(), 60);
    motion.forget();
    motion.ask(scene, 30, false);
    motion.wait();
    assert_eq!(motion.take().unwrap().result.unwrap().0.strands().len(), 30);
}

#[test]
fn a_scene_that_cannot_move_keeps_the_last_good_motion_and_says_why() {
    let mut session = Place::new().session();
    let before = tip(&session, 10);
    session.apply(Command::Vector { interval: 0, vector: Vec3::new(-1e6, 0.0, 0.0), phase: Phase::Done });
    session.wait();
    let trouble = session.trouble().unwrap();
    assert!(trouble.key.as_deref().is_some_and(|key| key.starts_with("force[0]")), "{trouble:?}");
    assert!(!trouble.text.contains('\n'));
    assert_eq!(tip(&session, 10), before);
    session.apply(Command::Act(Action::Undo));
    session.wait();
    assert_eq!(session.trouble(), None);
}

#[test]
fn a_shorter_motion_takes_its_frames_out_of_the_sheet_in_one_step_and_says_so() {
    let place = Place::new();
    std::fs::write(place.file(), format!("{TEXT}[output]\nsheet = [0, 10, 15, 20]\n")).unwrap();
    let mut session = place.session();
    let set = |session: &mut Session, frames: i64, phase| {
        session.apply(Command::Set { key: "motion.frames".to_owned(), value: Some(frames.into()), phase });
        session.wait();
        assert_eq!((session.trouble(), session.take().unwrap().frames()), (None, frames as u32));
        let said = session.words().iter().map(|word| word.text.clone()).collect::<Vec<_>>();
        (session.document().unwrap().scene().output.sheet.clone().unwrap(), said)
    };
    for (frames, sheet) in [(17, vec![0, 10, 15]), (5, vec![0]), (12, vec![0, 10])] {
        let (has, said) = set(&mut session, frames, Phase::Dragging);
        assert_eq!((has, said.len()), (sheet, 1));
    }
    let (has, said) = set(&mut session, 20, Phase::Dragging);
    assert_eq!((has, said), (vec![0, 10, 15, 20], Vec::new()), "a drag back brings back what it took");
    session.apply(Command::EndDrag);
    assert_eq!(session.document().unwrap().undo_name(), None);
    let (has, said) = set(&mut session, 12, Phase::Done);
    assert_eq!(has, [0, 10]);
    assert!(said[0].contains("frames 15, 20"), "{said:?}");
    set(&mut session, 20, Phase::Done);
    assert!(session.document().unwrap().scene().check().is_ok());
    for _ in 0..2 {
        session.apply(Command::Act(Action::Undo));
    }
    assert!(!session.document().unwrap().is_dirty(), "one step has both");
}

#[test]
fn a_sheet_of_which_a_shorter_motion_leaves_nothing_gets_frames_that_there_are() {
    let place = Place::new();
    std::fs::write(place.file(), format!("{TEXT}[output]\nsheet = [15, 20] # the fall\n")).unwrap();
    let mut session = place.session();
    for phase in [Phase::Dragging, Phase::Done] {
        session.apply(Command::Set { key: "motion.frames".to_owned(), value: Some(10.into()), phase });
        let scene = session.document().unwrap().scene();
        assert_eq!(scene.output.sheet.as_deref(), Some(&[0, 3, 6, 9][..]));
        let text = scene.to_toml().unwrap();
        assert!(text.contains("# the fall"), "{text}");
        let said: Vec<&str> = session.words().iter().map(|word| word.text.as_str()).collect();
        assert!(
            matches!(said[..], [said] if said.contains("15, 20") && said.contains("0, 3, 6, 9 instead")),
            "{said:?}"
        );
    }
    session.apply(Command::Act(Action::Undo));
    assert!(!session.document().unwrap().is_dirty(), "one step has both");
    std::fs::write(place.file(), format!("{TEXT}[output]\nsheet = []\n")).unwrap();
    let mut session = place.session();
    session.apply(Command::Set { key: "motion.frames".to_owned(), value: Some(10.into()), phase: Phase::Done });
    assert_eq!(session.document().unwrap().scene().output.sheet.as_deref(), Some(&[][..]), "none is wanted");
}

#[test]
fn longer_hair_gets_the_segments_that_it_takes_in_one_step_and_a_drag_back_takes_them_back() {
    let mut session = Place::new().session();
    let segments = |session: &Session| session.document().unwrap().scene().hair.grown().unwrap().segments;
    let set = |session: &mut Session, length: f64, phase| {
        session.apply(Command::Set { key: "hair.style.length.top".to_owned(), value: Some(length.into()), phase });
        session.wait();
        assert_eq!(session.trouble(), None, "{length} cm");
        session.words().iter().map(|word| word.text.clone()).collect::<Vec<_>>()
    };
    for (length, wanted) in [(25.4, 26), (30.0, 30), (20.0, 20)] {
        let said = set(&mut session, length, Phase::Dragging);
        assert_eq!(segments(&session), wanted);
        assert!(matches!(&said[..], [said] if said.contains(&wanted.to_string())), "{said:?}");
    }
    assert_eq!((set(&mut session, 18.0, Phase::Dragging).len(), segments(&session)), (0, 18));
    session.apply(Command::EndDrag);
    assert_eq!(session.document().unwrap().undo_name(), None);
    set(&mut session, 26.0, Phase::Done);
    session.apply(Command::Act(Action::Undo));
    assert_eq!(segments(&session), 18);
    assert!(!session.document().unwrap().is_dirty(), "one step has both");
}

#[test]
fn what_goes_wrong_with_a_question_is_known_while_it_stands_and_saved_it_is_so_no_longer() {
    let place = Place::new();
    let mut session = place.session();
    session.say("something older", true);
    session.tick(1.0, 1.0);
    session.apply(Command::Act(Action::SaveAs));
    assert_eq!(session.wrong_with_dialog(), None);
    session.tick(1.0, 1.0);
    let Some(Dialog::File(chooser)) = session.dialog().cloned() else { panic!("no question") };
    let chosen = |name: &str| Command::Chosen(Box::new(chooser.clone()), place.0.path().join(name));
    session.apply(chosen("nowhere/red hand #1.toml"));
    assert!(session.wrong_with_dialog().is_some_and(|wrong| wrong.contains("nowhere/red hand #1.toml")));
    session.apply(chosen("red hand #1"));
    assert!(place.0.path().join("red hand #1.toml").is_file());
    assert_eq!((session.dialog(), session.wrong_with_dialog()), (None, None));
    let said: Vec<&str> = session.words().iter().map(|word| word.text.as_str()).collect();
    assert_eq!(said, ["something older", "Saved red hand #1.toml"]);
}

#[test]
fn a_file_with_errors_is_mended_in_the_window() {
    let place = Place::new();
    let mut session = place.session();
    let broken = place.0.path().join("broken.toml");
    let text = TEXT.replace("through = 20", "trough = 20");
    std::fs::write(&broken, &text).unwrap();
    session.apply(Command::Open(broken.clone()));
    assert_eq!(session.broken().unwrap().error.as_ref().unwrap().line, Some(11));
    assert_eq!(session.document().unwrap().path(), Some(place.file().as_path()), "the good one stays");
    session.apply(Command::UseMended);
    assert!(session.broken().is_some(), "it is not mended yet");
    session.apply(Command::Mend(TEXT.to_owned()));
    assert!(session.broken().unwrap().error.is_none());
    session.apply(Command::UseMended);
    session.wait();
    assert!(session.broken().is_none() && session.document().unwrap().is_dirty());
    session.apply(Command::Act(Action::Save));
    assert_eq!(std::fs::read_to_string(&broken).unwrap(), TEXT);
}

#[test]
fn an_error_written_from_outside_leaves_the_motion_and_a_right_change_is_taken() {
    let place = Place::new();
    let mut session = place.session();
    std::fs::write(place.file(), TEXT.replace("-100", "-50")).unwrap();
    session.look_at_file();
    session.wait();
    assert_eq!(session.document().unwrap().scene().field.force[0].vector.x, -50.0);
    std::fs::write(place.file(), "nonsense").unwrap();
    session.look_at_file();
    assert!(session.broken().is_some());
    assert!(session.take().is_some());
    std::fs::remove_file(place.file()).unwrap();
    session.said_changed = false;
    session.look_at_file();
    let is_said =
        |session: &Session| session.words().iter().any(|word| word.wrong && word.text.contains("no longer there"));
    assert!(is_said(&session));
    session.apply(Command::Act(Action::Save));
    assert!(place.file().is_file() && !is_said(&session), "saved, it is there again");
}

#[test]
fn what_would_be_lost_is_asked_for() {
    let place = Place::new();
    let mut session = place.session();
    session.apply(Command::Vector { interval: 0, vector: Vec3::X, phase: Phase::Done });
    let other = place.0.path().join("other.toml");
    std::fs::write(&other, TEXT).unwrap();
    session.apply(Command::Open(other.clone()));
    assert!(matches!(session.dialog(), Some(Dialog::Unsaved(Next::Open(_)))));
    assert!(!session.may_close());
    session.apply(Command::CloseDialog);
    assert_eq!(session.document().unwrap().path(), Some(place.file().as_path()));
    session.apply(Command::Open(other.clone()));
    session.apply(Command::GoOn);
    assert_eq!(session.document().unwrap().path(), Some(other.as_path()));
    assert!(session.may_close());
}

#[test]
fn what_a_killed_window_had_is_offered_and_opened() {
    let place = Place::new();
    let mut session = place.session();
    session.apply(Command::Vector { interval: 0, vector: Vec3::new(1.0, 2.0, 3.0), phase: Phase::Done });
    session.keep();
    // As a kill leaves it: what it kept, and no lock.
    let recovery = place.0.path().join("config/recovery");
    let kept = std::fs::read_dir(&recovery)
        .unwrap()
        .flatten()
        .find(|entry| entry.path().extension().is_some_and(|e| e == "toml"));
    let text = std::fs::read_to_string(kept.unwrap().path()).unwrap();
    drop(session);
    std::fs::write(recovery.join("1-0.toml"), text).unwrap();
    let mut session = place.session();
    assert!(matches!(session.dialog(), Some(Dialog::Recover(kept)) if kept.len() == 1));
    session.apply(Command::Recover(0));
    session.wait();
    let document = session.document().unwrap();
    assert_eq!(document.scene().field.force[0].vector, Vec3::new(1.0, 2.0, 3.0));
    assert!(document.is_dirty());
    assert_eq!(document.path(), Some(place.file().as_path()));
    assert_eq!(crate::recovery::left_behind(&recovery), []);
}

#[test]
fn no_interval_is_chosen_that_is_not_there() {
    let place = Place::new();
    let mut session = place.session();
    // A panel that was drawn before the last step was taken back speaks of what there was.
    session.apply(Command::Choose(vec![1, 2]));
    assert_eq!(session.chosen(), [1]);
    session.apply(Command::Act(Action::Delete));
    session.apply(Command::Choose(vec![1]));
    assert_eq!(session.chosen(), [] as [usize; 0]);
    session.apply(Command::Act(Action::SelectAll));
    session.apply(Command::Act(Action::Delete));
    session.apply(Command::Act(Action::Ease));
    session.wait();
    assert_eq!(session.trouble(), None, "there is nothing to ease");
    assert!(session.words().iter().any(|word| word.wrong && word.text.contains("no wind to ease")));
}

#[test]
fn intervals_are_cut_joined_copied_and_pasted_as_single_steps() {
    let mut session = Place::new().session();
    session.apply(Command::Go(5));
    session.apply(Command::Act(Action::Split));
    assert_eq!(session.chosen(), [1]);
    session.apply(Command::Choose(vec![0, 1]));
    session.apply(Command::Act(Action::Join));
    let keys = |session: &Session| session.document().unwrap().scene().field.force.clone();
    assert_eq!(keys(&session).len(), 2);
    session.apply(Command::Choose(vec![0]));
    session.apply(Command::Act(Action::Copy));
    session.apply(Command::Go(11));
    session.apply(Command::Act(Action::Paste));
    let ends: Vec<u32> = keys(&session).iter().map(|key| key.through).collect();
    assert_eq!(ends, [10, 20]);
    for _ in 0..3 {
        session.apply(Command::Act(Action::Undo));
    }
    assert_eq!(session.document().unwrap().undo_name(), None);
    session.apply(Command::Act(Action::SelectAll));
    session.apply(Command::Act(Action::Delete));
    assert_eq!(keys(&session), [] as [ForceSettings; 0]);
    session.wait();
    assert_eq!(session.trouble(), None, "the free form moves without wind");
    session.apply(Command::Act(Action::Add));
    assert_eq!(keys(&session).len(), 1);
}

#[test]
fn a_dropped_file_becomes_settings_of_the_scene_in_one_step() {
    let place = Place::new();
    let csv = place.0.path().join("turn.csv");
    std::fs::write(&csv, "t_s,px_m,py_m,pz_m,qx,qy,qz,qw\n0,0,0,0,0,0,0,1\n10,0.1,0,0,0,0,0,1\n").unwrap();
    let mut session = place.session();
    session.apply(Command::Open(csv.clone()));
    let Some(Dialog::Import(import)) = session.dialog() else { panic!("it is not asked how it lies") };
    let import = crate::dialog::Import { up: "+y".to_owned(), facing: "+x".to_owned(), ..import.clone() };
    let command = session.import(&import).unwrap();
    session.apply(Command::CloseDialog);
    session.apply(command);
    session.wait();
    assert_eq!(session.trouble(), None, "{:?}", session.words());
    assert!(session.take().unwrap().built.head_moves());
    session.apply(Command::Act(Action::Undo));
    session.wait();
    assert!(!session.take().unwrap().built.head_moves());
}

#[test]
fn the_desktops_answer_is_taken_and_a_desktop_without_a_dialog_said() {
    let place = Place::new();
    let other = place.0.path().join("other.toml");
    std::fs::write(&other, TEXT).unwrap();
    let mut session = place.session();
    let ask = |session: &mut Session, path: Option<PathBuf>, after: Duration| {
        session.apply(Command::Act(Action::Open));
        let Some(Dialog::File(chooser)) = session.dialog() else { panic!("no file is asked for") };
        let answer = move || {
            std::thread::sleep(after);
            path
        };
        session.desktop = Some(Asked::asks(chooser.clone(), answer, || ()).unwrap());
        while session.asks_desktop() {
            session.tick(0.001, 0.001);
        }
    };
    ask(&mut session, Some(other.clone()), Duration::ZERO);
    assert_eq!((session.dialog(), session.document().unwrap().path()), (None, Some(other.as_path())));
    ask(&mut session, None, Duration::from_millis(500));
    assert!(session.has_desktop(), "it was closed by a hand");
    ask(&mut session, None, Duration::ZERO);
    assert!(!session.has_desktop());
    assert!(matches!(session.dialog(), Some(Dialog::File(_))), "the path can be typed");
}

#[test]
fn the_first_start_shows_the_gust_and_its_words() {
    let folder = tempfile::tempdir().unwrap();
    let mut session = Session::new(Some(folder.path().to_owned()), || ()).unwrap();
    session.begin(None);
    assert_eq!(session.dialog(), Some(&Dialog::Welcome));
    session.apply(Command::CloseDialog);
    session.remember();
    let mut again = Session::new(Some(folder.path().to_owned()), || ()).unwrap();
    again.begin(None);
    assert_eq!(again.dialog(), None);
    assert!(again.document().unwrap().scene().field.force.len() > 1);
}

#[test]
fn the_scene_of_the_first_start_is_the_gust() {
    let gust = std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenes/gust.toml")).unwrap();
    assert_eq!(files::FIRST, gust);
}
