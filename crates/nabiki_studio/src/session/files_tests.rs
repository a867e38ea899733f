use glam::Vec3;

use super::*;
use crate::session::tests::{Place, TEXT};

fn blow(session: &mut Session) {
    session.apply(Command::Vector { interval: 0, vector: Vec3::X, phase: Phase::Done });
}

#[test]
fn a_start_opens_the_last_scene_that_is_still_there_at_rest_with_its_strongest_wind_chosen() {
    let place = Place::new();
    let [gone, calm] = ["gone.toml", "calm.toml"].map(|name| place.0.path().join(name));
    std::fs::write(&calm, TEXT.replace("[-100, 0, 0]", "[1, 0, 0]").replace("[0, 0, 0]", "[0, -9, 0]")).unwrap();
    std::fs::write(&gone, TEXT).unwrap();
    let mut session = place.session();
    assert_eq!(session.chosen(), [0]);
    session.apply(Command::Open(calm.clone()));
    session.apply(Command::Go(12));
    session.apply(Command::Open(gone.clone()));
    assert_eq!(session.play.frame(), 0);
    session.end();
    std::fs::remove_file(&gone).unwrap();
    let mut session = Session::new(Some(place.0.path().join("config")), || ()).unwrap();
    session.begin(None);
    assert_eq!(session.document().unwrap().path(), Some(calm.as_path()));
    assert_eq!(session.chosen(), [1]);
}

#[test]
fn what_another_program_has_written_is_not_read_over_what_is_not_saved_but_said_each_time() {
    let place = Place::new();
    let mut session = place.session();
    blow(&mut session);
    for x in ["-50", "-60"] {
        std::fs::write(place.file(), TEXT.replace("-100", x)).unwrap();
        session.words.clear();
        session.look_at_file();
        assert!(matches!(session.words(), [word] if word.wrong && word.text.contains("another program")), "{x}");
        assert_eq!(session.document().unwrap().scene().field.force[0].vector, Vec3::X);
        // And back.
        std::fs::write(place.file(), TEXT).unwrap();
        session.look_at_file();
    }
}

#[test]
fn reading_again_reads_the_files_that_a_scene_names_and_throws_no_text_away() {
    let place = Place::new();
    let strand = |x: i32| format!("v {x} 9 0\nv {} 5 0\nv {} 1 0\nl 1 2 3\n", x + 1, x + 1);
    let hair = place.0.path().join("lock.obj");
    std::fs::write(&hair, strand(9)).unwrap();
    let text = "[hair]\nfile = \"lock.obj\"\nunit = \"cm\"\nup = \"+y\"\nfacing = \"+x\"\n[motion]\nframes = 2\n\
                [[force]]\nthrough = 2\nvector = [1, 0, 0]\n";
    std::fs::write(place.file(), text).unwrap();
    let mut session = place.session();
    let root = |session: &Session| session.take().unwrap().points(0)[0].x;
    assert_eq!((session.trouble(), root(&session)), (None, 9.0));
    std::fs::write(&hair, strand(12)).unwrap();
    session.apply(Command::Act(Action::Reload));
    session.wait();
    assert_eq!(root(&session), 12.0);
    std::fs::write(place.file(), "nonsense").unwrap();
    session.look_at_file();
    session.apply(Command::Mend("half".to_owned()));
    session.apply(Command::Act(Action::Reload));
    assert!(matches!(session.dialog(), Some(Dialog::Unsaved(_))));
    assert_eq!(session.broken().unwrap().text, "half");
}

#[test]
fn a_dropped_file_keeps_what_it_says_nothing_of() {
    let place = Place::new();
    let turn = concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenes/motion/turn.csv");
    std::fs::copy(turn, place.0.path().join("turn.csv")).unwrap();
    let motion = "[head.motion]\nfile = \"turn.csv\"\nup = \"+y\"\nfacing = \"+x\"\n";
    let text = TEXT.replace("strands = 60", "strands = 60\nsegment_length = 0.5");
    std::fs::write(place.file(), format!("{text}{motion}")).unwrap();
    let mut session = place.session();
    let mut drop = |name: &str, role: Role, unit: &str| {
        let path = place.0.path().join(name);
        let empty = String::new;
        let import = Import {
            path,
            roles: vec![role],
            role,
            unit: unit.to_owned(),
            up: empty(),
            facing: empty(),
            node: "Head".to_owned(),
        };
        let command = session.import(&import).unwrap();
        session.apply(command);
        session.document().unwrap().scene().settings().unwrap()
    };
    let value = |settings: &toml::Table, key: &str| crate::settings::value_at(settings, key).cloned();
    let head = drop("bust.obj", Role::Head, "m");
    assert_eq!(value(&head, "head.mesh"), Some("bust.obj".into()), "as it is from the scene");
    assert_eq!(value(&head, "head.motion.file"), Some("turn.csv".into()));
    let hair = drop("lock.obj", Role::Hair, "cm");
    assert_eq!(value(&hair, "hair.segment_length"), Some(0.5.into()));
    drop("one.obj", Role::Body, "m");
    let bodies = drop("two.obj", Role::Body, "m");
    let meshes = ["body[0].mesh", "body[1].mesh"].map(|key| value(&bodies, key));
    assert_eq!(meshes, ["one.obj", "two.obj"].map(|name| Some(name.into())));
    let walk = drop("walk.bvh", Role::Motion, "m");
    assert_eq!(value(&walk, "head.motion.unit_cm"), Some(100.0.into()));
}

#[test]
fn a_still_is_of_the_frame_that_is_shown_and_a_file_that_is_chosen_is_the_settings() {
    let place = Place::new();
    let motion = "[head.motion]\nfile = \"a.csv\"\nup = \"+y\"\nfacing = \"+x\"\n";
    std::fs::write(place.file(), format!("{TEXT}{motion}")).unwrap();
    let mut session = place.session();
    session.play.set_last(20);
    session.apply(Command::Go(7));
    session.apply(Command::Act(Action::Export));
    assert!(matches!(session.dialog(), Some(Dialog::Export(order)) if order.frame == 7));
    let purpose = Purpose::Setting("head.motion.file".to_owned());
    let chooser = Chooser { purpose, path: String::new(), endings: Vec::new() };
    session.apply(Command::Show(Box::new(Dialog::File(chooser.clone()))));
    session.apply(Command::Chosen(Box::new(chooser), place.0.path().join("b.csv")));
    assert_eq!(session.dialog(), None);
    assert!(session.document().unwrap().scene().to_toml().unwrap().contains("file = \"b.csv\""));
}

#[test]
fn a_file_that_is_no_text_is_said_and_not_shown() {
    let place = Place::new();
    let mut session = place.session();
    let picture = place.0.path().join("picture.toml");
    std::fs::write(&picture, "a = \0\n").unwrap();
    session.apply(Command::Open(picture));
    assert!(session.broken().is_none() && session.words().iter().any(|word| word.wrong));
}
