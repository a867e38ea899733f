//! Pulls by their laws: what is near enough given enough work, what stays, what stops a pull.

use std::time::{Duration, Instant};

use glam::Vec3;
use nabiki::Strands;
use nabiki::dynamics::Form;
use nabiki::solve::{Answer, Stop};

use super::*;
use crate::{BuiltScene, Scene, Shown};

/// Strands in a wind of so many intervals, thirty frames of each.
fn gust(intervals: u32) -> BuiltScene {
    let mut text = format!("[hair]\nstrands = 40\n[motion]\nframes = {}\nform = \"free\"\n", 30 * intervals);
    for j in 1..=intervals {
        text += &format!("[[force]]\nthrough = {}\nvector = [-40, 0, 0]\n", 30 * j);
    }
    built(&text)
}

fn built(text: &str) -> BuiltScene {
    Scene::parse(text, "a.toml".as_ref(), &[]).unwrap().build(Shown::All).unwrap()
}

/// The strands at a frame.
fn at(built: &BuiltScene, frame: u32) -> Strands {
    built.timeline().unwrap().seek(frame).clone()
}

/// The same scene as a pull has left it.
fn pulled(built: &BuiltScene, answer: &Answer) -> BuiltScene {
    let mut scene = built.scene.clone();
    scene.accept(answer, built);
    scene.build(Shown::All).unwrap()
}

fn tip(strands: &Strands, strand: usize, frame: u32) -> Lock {
    Lock { frame, nodes: vec![(strand, strands.range(strand).len() - 1)] }
}

fn middle(lock: &Lock, strands: &Strands) -> Vec3 {
    lock.middle(strands.points(), strands)
}

/// The whole search for a goal, from a hand that was there at once.
fn searched(built: &BuiltScene, lock: &Lock, nails: &[Lock], freedom: Freedom, goal: Vec3) -> Pulled {
    let now = middle(lock, &at(built, lock.frame));
    let mut follower = Follower::new(built, lock, now, nails, freedom);
    follower.step(goal).unwrap();
    follower.search(goal, &mut |_| {}).unwrap().expect("nothing brakes it")
}

#[test]
fn a_lock_of_the_gust_comes_to_a_hand_five_centimetres_away_and_the_wind_beside_is_what_it_was() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenes/gust.toml");
    let built = Scene::load(path.as_ref(), &[]).unwrap().build(Shown::First(300)).unwrap();
    let before = at(&built, 20);
    for (strand, way) in [(12, Vec3::new(2.0, 4.0, 2.2)), (40, Vec3::new(1.0, 3.0, -3.9))] {
        let node = before.range(strand).len() - 4;
        let lock = Lock::about(20, before.points(), &before, 300, (strand, node), 1.5);
        let goal = middle(&lock, &before) + way;
        let found = searched(&built, &lock, &[], Freedom::default(), goal);
        assert!(found.left_cm < 0.3, "strand {strand}: {found:?}");
        assert_eq!((found.ended, &found.stop), (true, &None));
        let mut scene = built.scene.clone();
        scene.accept(&found.answer, &built);
        let after = scene.build(Shown::First(300)).unwrap();
        let off = middle(&lock, &at(&after, 20)).distance(goal);
        assert!((f64::from(off) - found.left_cm).abs() < 0.05, "{off} in the scene, {} in the search", found.left_cm);
        let outside = (1..=110).filter(|frame| !found.felt.contains(frame));
        for frame in outside {
            let [was, is] = [&built, &after].map(|built| built.force_at(Vec3::new(-12.0, -5.0, 3.0), frame));
            // What drifts with the wind goes on from where it has drifted to.
            if frame < *found.felt.start() {
                assert_eq!(was, is, "frame {frame}");
            }
        }
        assert!(*found.felt.end() < 40, "{:?}", found.felt);
    }
}

#[test]
fn hair_follows_the_hand() {
    let built = gust(1);
    let before = at(&built, 30);
    let held = tip(&before, 3, 30);
    let pull = Pull::new(Follower::new(&built, &held, middle(&held, &before), &[], Freedom::default()), || {});
    let way = Vec3::new(2.0, 1.0, 1.0);
    pull.to(middle(&held, &before) + way / 2.0);
    pull.to(middle(&held, &before) + way);
    let clock = Instant::now();
    let mut newest: Option<Pulled> = None;
    while newest.as_ref().is_none_or(|pulled| !pulled.ended) {
        assert!(clock.elapsed() < Duration::from_secs(60), "it does not come nearer than {newest:?}");
        newest = pull.take().map(Result::unwrap).or(newest);
        std::thread::sleep(Duration::from_millis(5));
    }
    let found = newest.unwrap();
    assert!(found.left_cm < 0.3, "{found:?}");
    let after = at(&pulled(&built, &found.answer), 30);
    let left = middle(&held, &after).distance(middle(&held, &before) + way);
    // What the solver says is what the simulation does: f32 against f64 over 30 frames, far below a millimetre.
    assert!((f64::from(left) - found.left_cm).abs() < 0.05, "{left} {}", found.left_cm);
}

#[test]
fn what_is_found_is_nearer_and_nearer_and_stays_there_once_it_has_arrived() {
    let built = gust(2);
    let before = at(&built, 45);
    let held = tip(&before, 7, 45);
    let goal = middle(&held, &before) + Vec3::new(3.0, 3.0, 2.0);
    let mut follower = Follower::new(&built, &held, middle(&held, &before), &[], Freedom::default());
    let (first, _) = follower.step(goal).unwrap();
    let mut heard = vec![first.left_cm];
    let end = follower.search(goal, &mut |pulled| heard.push(pulled.left_cm)).unwrap().unwrap();
    // Of what has arrived a gentler wind may be a little farther away.
    let arrived = 0.2;
    assert!(heard.windows(2).all(|pair| pair[1] < pair[0].max(arrived)), "{heard:?}");
    assert!(end.left_cm < arrived, "{end:?} after {heard:?}");
}

#[test]
fn a_search_gives_way_at_once_and_goes_on_from_the_nearest() {
    use std::sync::atomic::{AtomicUsize, Ordering};
    let built = gust(2);
    let before = at(&built, 45);
    let held = tip(&before, 7, 45);
    let goal = middle(&held, &before) + Vec3::new(3.0, 3.0, 2.0);
    let mut follower = Follower::new(&built, &held, middle(&held, &before), &[], Freedom::default());
    let asked = Arc::new(AtomicUsize::new(0));
    let theirs = asked.clone();
    follower.set_brake(move || theirs.fetch_add(1, Ordering::Relaxed) >= 2);
    follower.step(goal).unwrap();
    asked.store(0, Ordering::Relaxed);
    let mut nearest = f64::INFINITY;
    let found = follower.search(goal, &mut |pulled| nearest = pulled.left_cm).unwrap();
    assert_eq!(found, None, "it was braked");
    assert!(asked.load(Ordering::Relaxed) < 10, "it went on");
    asked.store(0, Ordering::Relaxed);
    let (pulled, _) = follower.step(goal).unwrap();
    assert!(pulled.left_cm <= nearest, "{} after {nearest}", pulled.left_cm);
}

#[test]
fn hair_is_pulled_by_the_middle_of_a_lock_even_where_there_is_no_wind_yet() {
    for form in ["free", "paper"] {
        let built = built(&format!(
            "[hair]\nstrands = 40\n[motion]\nframes = 60\nform = \"{form}\"\n\
            [[force]]\nthrough = 1\nvector = [0, 0, 0]\n"
        ));
        let before = at(&built, 30);
        let [a, b] = [3, 20].map(|strand| tip(&before, strand, 30));
        let held = Lock { frame: 30, nodes: [a.nodes.clone(), b.nodes.clone()].concat() };
        let half = 0.5 * (middle(&a, &before) + middle(&b, &before));
        assert!(middle(&held, &before).distance(half) < 1e-4);
        let way = Vec3::new(-1.0, 0.5, 0.0);
        let found = searched(&built, &held, &[], Freedom::default(), half + way);
        assert!(found.left_cm < 0.3, "{form}: {found:?}");
        let after = pulled(&built, &found.answer);
        assert!(middle(&held, &at(&after, 30)).distance(half + way) < 0.35);
        assert!((31..=60).all(|frame| after.force_at(Vec3::ZERO, frame) == Vec3::ZERO), "calm again: {found:?}");
    }
    let none = built("[hair]\nstrands = 40\n[motion]\nframes = 30\nform = \"free\"\n");
    let before = at(&none, 30);
    let held = tip(&before, 3, 30);
    let goal = middle(&held, &before) + Vec3::new(-1.0, 0.5, 0.0);
    let found = searched(&none, &held, &[], Freedom::default(), goal);
    assert!(found.left_cm < 0.3 && !found.answer.keyframes.is_empty(), "{found:?}");
}

#[test]
fn what_is_nailed_stays() {
    let built = gust(2);
    let before = at(&built, 58);
    let (held, nail) = (tip(&before, 3, 60), tip(&before, 20, 58));
    let goal = middle(&held, &at(&built, 60)) + Vec3::new(2.0, 1.0, 1.0);
    // How far the tip goes that may be nailed, of another strand and two frames earlier.
    let gone = |nails: &[Lock]| {
        let found = searched(&built, &held, nails, Freedom { another: true, stiffness: false }, goal);
        middle(&nail, &at(&pulled(&built, &found.answer), 58)).distance(middle(&nail, &before))
    };
    let (nailed, free) = (gone(std::slice::from_ref(&nail)), gone(&[]));
    assert!(nailed < 0.5 * free && free > 0.1, "{nailed} for {free}");
}

#[test]
fn what_stops_a_pull_is_named() {
    let built = gust(1);
    let before = at(&built, 30);
    let held = tip(&before, 3, 30);
    let root = before.strand(3)[0];
    let place = middle(&held, &before);
    let length: f32 = before.strand(3).windows(2).map(|pair| pair[0].distance(pair[1])).sum();
    let stop = |nails: &[Lock], goal: Vec3| searched(&built, &held, nails, Freedom::default(), goal).stop;

    let away = root + (place - root).normalize() * 1.4 * length;
    let Some(Stop::Length { away_cm, reach_cm }) = stop(&[], away) else { panic!("{:?}", stop(&[], away)) };
    assert!((away_cm - 1.4 * f64::from(length)).abs() < 0.01 && (reach_cm - f64::from(length)).abs() < 0.01);

    assert_eq!(stop(&[], Vec3::ZERO), Some(Stop::Body("contact".to_owned())), "the middle of the head");

    let near = place + Vec3::new(2.0, 1.0, 1.0);
    assert_eq!(stop(&[], near), None);
    assert_eq!(stop(std::slice::from_ref(&held), near), Some(Stop::Nail(1)), "the same node");
    let elsewhere = tip(&before, 20, 5);
    assert_eq!(stop(&[elsewhere], near), None, "a nail that is not in the way is not blamed");
}

/// Of hair so heavy that it can hardly be stepped in a stronger wind than the scene's, and hardly moves in that. However stiff, it could be.
#[test]
fn a_wind_that_hair_cannot_be_stepped_in_is_named() {
    let mut built = gust(1);
    let mut allows = |gravity: u32| {
        let Form::Free(free) = &mut built.dynamics.form else { unreachable!() };
        free.form.gravity = gravity as f32;
        built.timeline().is_ok()
    };
    let (mut most, mut refused) = (1, 1 << 24);
    while refused - most > 1 {
        let middle = u32::midpoint(most, refused);
        if allows(middle) { most = middle } else { refused = middle }
    }
    assert!(allows(most) && most > 1);
    let before = at(&built, 30);
    let held = tip(&before, 3, 30);
    let root = before.strand(3)[0];
    let goal = root + 0.9 * (middle(&held, &before) + Vec3::new(-2.0, 3.0, 2.0) - root);
    let found = searched(&built, &held, &[], Freedom::default(), goal);
    let Some(Stop::Force { strongest }) = found.stop else { panic!("{found:?}") };
    let of_scene = 40.0;
    assert!((strongest - of_scene).abs() < 0.2 * of_scene, "{strongest}");

    // Where a stronger wind can be stepped, and does not bring it there, that is not to blame.
    let soft = gust(1);
    let before = at(&soft, 30);
    let held = tip(&before, 3, 30);
    let length: f32 = before.strand(3).windows(2).map(|pair| pair[0].distance(pair[1])).sum();
    let root = before.strand(3)[0];
    let near_root = root + (middle(&held, &before) - root) * (0.3 / length);
    let stop = searched(&soft, &held, &[], Freedom::default(), near_root).stop;
    assert!(!matches!(stop, Some(Stop::Force { .. })), "{stop:?}");
}
