use super::*;
use crate::actions::Action;
use crate::command::Command;
use crate::document::Phase;
use crate::session::Session;
use crate::session::tests::{Place, TEXT};

fn set(session: &mut Session, key: &str, value: f64, phase: Phase) {
    session.apply(Command::Set { key: key.to_owned(), value: Some(value.into()), phase });
    session.wait();
    assert_eq!(session.trouble(), None, "{key} = {value}");
}

/// Segments, and their length.
fn hair(session: &Session) -> (usize, f32) {
    let scene = session.document().unwrap().scene();
    let length = scene.hair.segment_length;
    (scene.hair.grown().unwrap().segments, length)
}

#[test]
fn every_curl_is_taken_with_the_segments_that_draw_it() {
    for form in ["free", "paper"] {
        let place = Place::new();
        std::fs::write(place.file(), TEXT.replace("\"free\"", &format!("\"{form}\""))).unwrap();
        for (radius, pitch, more) in [
            (0.2, 2.5, None),
            (1.0, 4.2, None),
            (3.0, 1.0, None),
            (0.5, 0.5, None),
            (0.3, 2.0, Some(("variation", 0.6))),
            (0.3, 2.0, Some(("frizz", 0.6))),
            (0.8, 1.5, Some(("flatness", 1.0))),
        ] {
            let mut session = place.session();
            let before = hair(&session);
            set(&mut session, "hair.style.curl.radius", radius, Phase::Done);
            let said = session.words().iter().find(|word| word.text.starts_with(TAKEN));
            assert!(said.is_some(), "{:?}", session.words());
            set(&mut session, "hair.style.curl.pitch", pitch, Phase::Done);
            if let Some((key, value)) = more {
                set(&mut session, &format!("hair.style.curl.{key}"), value, Phase::Done);
            }
            let curled = hair(&session);
            assert!(curled.1 < before.1 && curled.0 > before.0, "{radius} {pitch}: {curled:?}");
            let curl = session.document().unwrap().scene().hair.grown().unwrap().style.curl;
            assert_eq!(curl.pitch, pitch as f32);
            assert_eq!(curl.radius, radius.min(pitch) as f32);
            let steps = 2 + usize::from(more.is_some());
            (0..steps).for_each(|_| session.apply(Command::Act(Action::Undo)));
            assert!(!session.document().unwrap().is_dirty(), "each is one step with what it takes");
        }
    }
}

#[test]
fn a_curl_that_is_dragged_back_takes_everything_back() {
    let mut session = Place::new().session();
    let text = |session: &Session| session.document().unwrap().scene().to_toml().unwrap();
    let before = text(&session);
    for radius in [0.05, 0.4, 2.6, 5.0, 0.4, 0.0] {
        set(&mut session, "hair.style.curl.radius", radius, Phase::Dragging);
    }
    session.apply(Command::EndDrag);
    assert_eq!(session.document().unwrap().undo_name(), None, "{}", text(&session));
    assert_eq!(text(&session), before);
}

#[test]
fn shorter_segments_and_a_fringe_take_as_many_as_hair_is_long() {
    let mut session = Place::new().session();
    set(&mut session, "hair.segment_length", 0.25, Phase::Done);
    assert_eq!(hair(&session).0, 72);
    assert_eq!(
        session.document().unwrap().scene().free.stiffness,
        Scene::default().free.stiffness,
        "a hand sets these"
    );
}

#[test]
fn of_two_settings_the_one_that_a_hand_changes_takes_the_other_along() {
    let mut session = Place::new().session();
    let of = |session: &Session, key: &str| {
        let scene = session.document().unwrap().scene();
        let clumps = scene.hair.grown().unwrap().style.clumps;
        match key {
            "wave" => clumps.wave,
            "wave_length" => clumps.wave_length,
            "friction" => scene.contact.friction,
            _ => scene.contact.static_friction,
        }
    };
    set(&mut session, "hair.style.clumps.wave", 3.0, Phase::Done);
    assert!((18.75..18.76).contains(&of(&session, "wave_length")));
    set(&mut session, "hair.style.clumps.wave_length", 5.0, Phase::Done);
    assert!((0.79..=0.8).contains(&of(&session, "wave")));
    set(&mut session, "contact.friction", 0.6, Phase::Done);
    assert_eq!(of(&session, "static_friction"), 0.6);
    set(&mut session, "contact.static_friction", 0.05, Phase::Done);
    assert_eq!(of(&session, "friction"), 0.05);
    assert!(session.words().iter().any(|word| word.text.starts_with(TAKEN)), "{:?}", session.words());
    (0..4).for_each(|_| session.apply(Command::Act(Action::Undo)));
    assert!(!session.document().unwrap().is_dirty(), "each is one step with what it takes");
    // A drag back takes it back.
    for wave in [0.3, 2.0, 0.1] {
        set(&mut session, "hair.style.clumps.wave", wave, Phase::Dragging);
    }
    session.apply(Command::EndDrag);
    assert!(!session.document().unwrap().is_dirty());
}
