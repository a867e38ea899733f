use super::*;
use crate::actions::Action;
use crate::command::Command;
use crate::session::tests::Place;
use crate::tools::{Tool, Tools};

fn regions(session: &Session) -> &[Region] {
    &session.document().unwrap().scene().free.regions
}

fn region(points: &[[f32; 4]]) -> Box<Region> {
    Box::new(Region { painted: points.to_vec(), ..Region::default() })
}

fn paint(session: &mut Session, points: &[[f32; 4]]) {
    let painted = match session.tools().region {
        Some(i) => Box::new(Region { painted: points.to_vec(), ..regions(session)[i].clone() }),
        None => region(points),
    };
    session.apply(Command::Painted { region: session.tools().region, painted });
}

#[test]
fn the_first_stroke_makes_a_region_and_the_next_ones_change_it() {
    let place = Place::new();
    let mut session = place.session();
    paint(&mut session, &[[8.0, 4.0, 0.0, 1.0]]);
    assert_eq!((session.tools().region, regions(&session)[0].name.as_str()), (Some(0), "painted 1"));
    paint(&mut session, &[[8.0, 4.0, 0.0, 0.5]]);
    assert_eq!((regions(&session).len(), regions(&session)[0].painted[0][3]), (1, 0.5));
    session.wait();
    assert_eq!(session.trouble(), None);
    // With none at hand, another one.
    session.apply(Command::Use(Box::new(Tools { region: None, ..session.tools().clone() })));
    paint(&mut session, &[[-8.0, 4.0, 0.0, 1.0]]);
    assert_eq!((regions(&session).len(), regions(&session)[1].name.as_str()), (2, "painted 2"));
    // Each stroke is a step.
    for left in [1, 1, 0] {
        session.apply(Command::Act(Action::Undo));
        assert_eq!(regions(&session).len(), left);
    }
    assert_eq!(session.tools().region, None);
}

#[test]
fn a_region_without_hair_is_refused_and_stays_as_it_was() {
    let place = Place::new();
    let mut session = place.session();
    paint(&mut session, &[[8.0, 4.0, 0.0, 1.0]]);
    paint(&mut session, &[[8.0, 4.0, 0.0, 0.0]]);
    assert_eq!(regions(&session)[0].painted, [[8.0, 4.0, 0.0, 1.0]]);
    assert!(session.words().iter().any(|word| word.text.contains("a region needs hair")), "{:?}", session.words());
    paint(&mut session, &[[8.0, 4.0, 0.0, 0.5]]);
    assert!(session.words().iter().all(|word| !word.text.contains("a region needs hair")));
}

#[test]
fn the_brush_stays_with_its_region_where_others_go() {
    let place = Place::new();
    let mut session = place.session();
    for x in [8.0, 7.0, 6.0] {
        session.apply(Command::Use(Box::new(Tools { region: None, ..session.tools().clone() })));
        paint(&mut session, &[[x, 4.0, 0.0, 1.0]]);
    }
    session.apply(Command::Use(Box::new(Tools { region: Some(1), ..session.tools().clone() })));
    let remove = |session: &mut Session, i: usize| {
        let key = format!("free.regions[{i}]");
        session.apply(Command::Set { key, value: None, phase: Phase::Done });
    };
    remove(&mut session, 0);
    assert_eq!((session.tools().region, regions(&session)[0].name.as_str()), (Some(0), "painted 2"));
    remove(&mut session, 0);
    assert_eq!((session.tools().region, regions(&session).len()), (None, 1));
}

/// The hair that was combed, and about no other hair, lies nearer to where it was combed.
#[test]
fn combed_hair_is_led_there_and_the_rest_stays() {
    let place = Place::new();
    let mut session = place.session();
    session.wait();
    let (take, frame) = (session.take().unwrap().clone(), 12);
    let strands = take.strands();
    let at = |take: &Take, s: usize| take.points(frame)[strands.range(s)].to_vec();
    // Turned about the root by a third of a turn, out of the wind's way.
    let turn = glam::Quat::from_rotation_y(1.0);
    let combed = |s: usize| -> Vec<Vec3> {
        at(&take, s).iter().map(|&p| at(&take, s)[0] + turn * (p - at(&take, s)[0])).collect()
    };
    session.apply(Command::Combed { frame, strands: vec![(0, combed(0))] });
    let scene = session.document().unwrap().scene().clone();
    let aim = &scene.aims[0];
    assert_eq!((aim.frame, aim.from, aim.through, aim.region.as_deref()), (Some(12), 12, Some(12), Some("combed 1")));
    assert_eq!((aim.curves.len(), regions(&session).len()), (1, 1));
    assert!((nabiki::strands::length(&aim.curves[0]) - nabiki::strands::length(&combed(0))).abs() < 0.5);
    session.wait();
    assert_eq!(session.trouble(), None);
    let led = session.take().unwrap().clone();
    let tip = |points: &[Vec3]| points[points.len() - 1];
    let far = |take: &Take| tip(&at(take, 0)).distance(tip(&combed(0)));
    assert!(far(&led) < 0.6 * far(&take), "{} {}", far(&led), far(&take));
    let region = &scene.free.regions[0];
    for s in (0..strands.len()).filter(|&s| region.weight(strands.strand(s)[0]) == 0.0) {
        assert_eq!(at(&led, s), at(&take, s), "strand {s}");
    }
    // Another stroke in this frame belongs to the same aim, and the same strand combed again is led anew.
    session.apply(Command::Combed { frame, strands: vec![(0, at(&take, 0)), (1, combed(1))] });
    let scene = session.document().unwrap().scene();
    assert_eq!((scene.aims.len(), scene.aims[0].curves.len(), scene.free.regions.len()), (1, 2, 1));
    assert!(tip(&scene.aims[0].curves[0]).distance(tip(&at(&take, 0))) < 0.01);
    session.apply(Command::Act(Action::Undo));
    session.apply(Command::Act(Action::Undo));
    let scene = session.document().unwrap().scene();
    assert!(scene.aims.is_empty() && scene.free.regions.is_empty());
}

#[test]
fn tools_go_by_keys_and_brackets_change_their_size() {
    let place = Place::new();
    let mut session = place.session();
    let strands = session.preferences().strands;
    session.apply(Command::Act(Action::Paint));
    assert_eq!(session.tools().tool, Tool::Paint);
    let radius = session.tools().radius;
    session.apply(Command::Act(Action::More));
    assert!(session.tools().radius > radius && session.preferences().strands == strands);
    session.apply(Command::Act(Action::Comb));
    assert_eq!(session.tools().tool, Tool::Comb);
    session.apply(Command::Act(Action::SelectNone));
    assert_eq!(session.tools().tool, Tool::Pull);
    session.apply(Command::Act(Action::Fewer));
    assert!(session.preferences().strands < strands);
}
