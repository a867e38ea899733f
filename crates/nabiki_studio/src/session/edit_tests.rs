use glam::Vec3;

use super::*;
use crate::session::tests::{Place, TEXT};

fn act(session: &mut Session, action: Action) {
    session.apply(Command::Act(action));
}

fn ends(session: &Session) -> Vec<u32> {
    session.document().unwrap().scene().field.force.iter().map(|key| key.through).collect()
}

/// A window on a scene of the usual one and these lines.
fn with(place: &Place, lines: &str) -> Session {
    std::fs::write(place.file(), format!("{TEXT}{lines}")).unwrap();
    place.session()
}

#[test]
fn what_was_just_made_is_chosen_and_what_is_gone_leaves_no_other_chosen() {
    let mut session = Place::new().session();
    session.apply(Command::Go(15));
    act(&mut session, Action::Add);
    assert_eq!((ends(&session), session.chosen()), (vec![10, 15, 20], &[2][..]));
    session.apply(Command::Choose(vec![1, 2]));
    act(&mut session, Action::Join);
    assert_eq!((ends(&session), session.chosen()), (vec![10, 20], &[1][..]));
    session.apply(Command::Choose(vec![0]));
    act(&mut session, Action::Cut);
    assert_eq!((ends(&session), session.chosen()), (vec![20], &[][..]));
    // At rest is before the first frame that feels anything.
    session.apply(Command::Go(0));
    act(&mut session, Action::Paste);
    assert_eq!((ends(&session), session.chosen()), (vec![10, 20], &[0][..]));
    assert_eq!(session.document().unwrap().scene().field.force[0].vector, Vec3::new(-100.0, 0.0, 0.0));
    act(&mut session, Action::Delete);
    assert_eq!((ends(&session), session.chosen()), (vec![20], &[][..]));
}

#[test]
fn borders_are_gone_to_one_after_the_other() {
    let mut session = Place::new().session();
    let mut frames = |action: Action| {
        [(); 3].map(|()| {
            act(&mut session, action);
            session.play.frame()
        })
    };
    assert_eq!(frames(Action::NextBorder), [11, 20, 20]);
    assert_eq!(frames(Action::PreviousBorder), [11, 1, 0]);
}

#[test]
fn without_intervals_nothing_is_left_that_acts_on_them() {
    let turn = concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenes/motion/turn.csv");
    let moved = format!("[head.motion]\nfile = '{turn}'\nup = \"+y\"\nfacing = \"+x\"\n[body_wind]\n");
    for (more, flows) in [("", false), (moved.as_str(), true)] {
        let place = Place::new();
        let mut session = with(&place, &format!("[gust]\n[flow]\n{more}"));
        assert_eq!(session.trouble(), None);
        act(&mut session, Action::SelectAll);
        act(&mut session, Action::Delete);
        session.wait();
        let field = &session.document().unwrap().scene().field;
        assert_eq!((session.trouble(), field.gust.is_some(), field.flow.is_some()), (None, false, flows));
    }
}

#[test]
fn a_fringe_takes_segments_where_there_is_one_and_no_length_takes_more_than_hair_can_have() {
    let segments = |session: &Session| session.document().unwrap().scene().hair.grown().unwrap().segments;
    for (width, wanted) in [(0, 18), (3, 30)] {
        let place = Place::new();
        let mut session = with(&place, &format!("[hair.style.fringe]\nhalf_width = {width}\n"));
        let set = |session: &mut Session, key: &str, value: f64| {
            session.apply(Command::Set { key: key.to_owned(), value: Some(value.into()), phase: Phase::Done });
        };
        set(&mut session, "hair.style.length.fringe", 30.0);
        assert_eq!(segments(&session), wanted);
        set(&mut session, "hair.style.length.top", 5000.0);
        assert_eq!(segments(&session), wanted, "that is refused as it stands");
    }
}

#[test]
fn each_ease_has_its_turn() {
    let mut session = Place::new().session();
    for ease in [Ease::Linear, Ease::Smooth, Ease::Stepped] {
        act(&mut session, Action::Ease);
        assert_eq!(session.document().unwrap().scene().field.wind.ease, ease);
    }
}

#[test]
fn a_pull_has_its_own_interval_chosen_and_giving_it_up_what_was_chosen_before() {
    let mut session = Place::new().session();
    session.wait();
    session.apply(Command::Choose(vec![1]));
    let pull = |session: &mut Session, phase| {
        let keyframes = session.document().unwrap().scene().field.as_given();
        let answer = nabiki::solve::Answer { keyframes, gust: None, stiffness: None, settle: None };
        session.apply(Command::Pulled { name: "Pull the hair", answer: Box::new(answer), interval: 0, phase });
    };
    pull(&mut session, crate::document::Phase::Dragging);
    pull(&mut session, crate::document::Phase::Dragging);
    assert_eq!(session.chosen(), [0]);
    session.apply(Command::GiveUpDrag);
    assert_eq!(session.chosen(), [1]);
    pull(&mut session, crate::document::Phase::Done);
    session.apply(Command::GiveUpDrag);
    assert_eq!(session.chosen(), [0]);
}

#[test]
fn what_is_found_after_a_pull_was_undone_changes_nothing() {
    use crate::document::Phase;

    let mut session = Place::new().session();
    session.wait();
    let force = |session: &Session| session.document().unwrap().scene().field.as_given();
    let before = force(&session);
    let pull = |session: &mut Session, x: f32, phase: Phase| {
        let mut keyframes = force(session);
        keyframes[0].vector = Vec3::new(x, 0.0, 0.0);
        let answer = nabiki::solve::Answer { keyframes, gust: None, stiffness: None, settle: None };
        session.apply(Command::Pulled { name: "Pull the hair", answer: Box::new(answer), interval: 0, phase });
    };
    pull(&mut session, -200.0, Phase::Done);
    pull(&mut session, -300.0, Phase::After);
    assert_eq!(force(&session)[0].vector.x, -300.0);
    act(&mut session, Action::Undo);
    pull(&mut session, -400.0, Phase::After);
    assert_eq!(force(&session), before);
    act(&mut session, Action::Redo);
    assert_eq!(force(&session)[0].vector.x, -300.0, "and it is still there to be done again");
}
