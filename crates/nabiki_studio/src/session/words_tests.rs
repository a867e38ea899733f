use super::super::Session;
use super::super::tests::Place;
use crate::actions::Action;
use crate::command::Command;
use crate::document::Phase;

#[test]
fn what_went_well_is_said_for_six_seconds_and_what_went_wrong_until_it_is_read() {
    let place = Place::new();
    let mut session = place.session();
    session.say("well", false);
    session.say("wrong", true);
    let said = |session: &Session| session.words().iter().map(|word| word.text.clone()).collect::<Vec<_>>();
    session.apply(Command::Act(Action::Play));
    // A window at rest looks up now and then only.
    for _ in 0..5 {
        session.tick(1.0, 0.0);
    }
    assert_eq!(said(&session), ["well", "wrong"]);
    session.tick(1.5, 0.0);
    assert_eq!(said(&session), ["wrong"]);
    assert_eq!(session.play.frame(), 0, "a rest is not played");
    session.apply(Command::Heard(0));
    assert!(said(&session).is_empty());
}

#[test]
fn what_is_refused_is_said_until_it_is_given_as_it_may_be() {
    let place = Place::new();
    let mut session = place.session();
    let said = |session: &Session| {
        assert!(session.words().iter().all(|word| word.wrong), "{:?}", session.words());
        session.words().iter().map(|word| word.text.clone()).collect::<Vec<_>>()
    };
    let refuse = |about: &str, why: &str| Command::Refuse { about: about.to_owned(), why: why.to_owned() };
    let set =
        |key: &str, value: i64| Command::Set { key: key.to_owned(), value: Some(value.into()), phase: Phase::Done };
    session.apply(refuse("Force x", "not five"));
    session.apply(set("motion.frames", -3));
    assert_eq!(said(&session).len(), 2);
    session.tick(60.0, 0.0);
    session.apply(set("hair.strands", 50));
    assert!(said(&session)[1].contains("motion.frames"), "{:?}", said(&session));
    session.apply(refuse("Force x", "not six"));
    assert_eq!(said(&session)[1], "not six", "of one thing the last word counts");
    session.apply(set("motion.frames", 20));
    assert_eq!(said(&session), ["not six"]);
    session.apply(Command::Took("Force x".to_owned()));
    assert!(said(&session).is_empty());
    session.apply(Command::Act(Action::Join));
    session.tick(60.0, 0.0);
    assert_eq!(said(&session).len(), 1, "that nothing could be joined is no good news");
    session.apply(Command::Choose(vec![0, 1]));
    session.apply(Command::Act(Action::Join));
    assert!(said(&session).is_empty());
    session.apply(refuse("Force x", "not seven"));
    session.apply(Command::Act(Action::Save));
    session.apply(Command::Open(place.file()));
    assert!(session.words().iter().all(|word| word.text != "not seven"), "another scene has refused nothing");
}
