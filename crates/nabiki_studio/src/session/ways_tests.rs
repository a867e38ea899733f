//! What comes late, and what goes on while nobody touches anything.

use super::tests::{Place, TEXT};
use super::*;
use crate::document::Phase;

fn act(session: &mut Session, action: Action) {
    session.apply(Command::Act(action));
}

#[test]
fn a_motion_that_comes_late_is_no_word_about_the_scene_as_it_is() {
    let place = Place::new();
    let mut session = place.session();
    let (take, swings) = (session.take.clone().unwrap(), session.swings.clone().unwrap());
    let late = |number, result| Moved { number, result, took: Duration::ZERO };
    let value = Some(toml::Value::Float(-1.0));
    session.apply(Command::Set { key: "free.settle".to_owned(), value, phase: Phase::Done });
    session.wait();
    assert!(session.trouble().is_some());
    session.receive_touched(late(session.asked - 1, Ok((take.clone(), swings.clone()))));
    assert!(session.trouble().is_some(), "that one could move, but this one cannot");
    act(&mut session, Action::Undo);
    session.wait();
    session.receive_touched(late(session.asked - 1, Err(nabiki_scene::Error::Cancelled)));
    assert_eq!(session.trouble(), None);
    let other = place.0.path().join("other.toml");
    std::fs::write(&other, TEXT).unwrap();
    session.apply(Command::Open(other));
    session.receive_touched(late(session.first_asked - 1, Ok((take.clone(), swings))));
    assert!(session.take().is_none_or(|now| !Arc::ptr_eq(now, &take)), "the hair of the scene before");
}

#[test]
fn a_play_does_not_leap_over_what_a_window_has_rested_for_and_a_frame_that_is_gone_to_stays() {
    let mut session = Place::new().session();
    act(&mut session, Action::Play);
    session.tick(60.0, 0.125);
    assert_eq!(session.play.frame(), 3);
    session.apply(Command::Go(10));
    session.tick(1.0, 1.0);
    assert_eq!(session.play.frame(), 10);
}

#[test]
fn what_is_chosen_for_the_window_has_ends_goes_round_and_is_remembered() {
    let place = Place::new();
    let mut session = place.session();
    for (action, wanted) in [(Action::ZoomIn, 4.0), (Action::ZoomOut, 0.5)] {
        (0..40).for_each(|_| act(&mut session, action));
        assert_eq!(session.preferences().zoom, wanted);
    }
    let endings = [(); 3].map(|()| {
        act(&mut session, Action::Ending);
        assert_eq!(session.preferences().ending, session.play.ending);
        session.play.ending
    });
    assert_eq!(endings, [Ending::Stop, Ending::Swing, Ending::Loop]);
    session.apply(Command::Prefer(Box::new(Preferences { strands: 30, ..session.preferences().clone() })));
    session.wait();
    assert_eq!(session.take().unwrap().strands().len(), 30);
    std::fs::write(place.file(), TEXT.replace("strands = 60", "strands = 500")).unwrap();
    act(&mut session, Action::Reload);
    session.apply(Command::Strands(500));
    session.wait();
    for _ in 0..2 {
        act(&mut session, Action::Fewer);
        session.wait();
        assert_eq!(session.take().unwrap().strands().len(), crate::preferences::FEWEST);
    }
}

#[test]
fn a_scene_that_is_saved_under_another_name_is_opened_next_time_and_what_was_to_come_comes() {
    let place = Place::new();
    let mut session = place.session();
    session.apply(Command::Vector { interval: 0, vector: glam::Vec3::X, phase: Phase::Done });
    std::fs::write(place.file(), "theirs").unwrap();
    act(&mut session, Action::Quit);
    session.apply(Command::SaveAndGoOn(crate::dialog::Next::Quit));
    assert!(matches!(session.dialog(), Some(Dialog::Conflict(..))));
    act(&mut session, Action::SaveAs);
    let Some(Dialog::File(chooser)) = session.dialog().cloned() else { panic!("no name is asked for") };
    let mine = place.0.path().join("mine.toml");
    session.apply(Command::Chosen(Box::new(chooser), mine.clone()));
    assert_eq!(session.wishes(), [Wish::Quit]);
    assert_eq!(session.preferences().recent.first(), Some(&mine));
}
