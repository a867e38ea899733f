//! Pulling the hair: a lock in a hand, nails that hold others, and the wind that follows, found on a thread of its own.

use std::sync::mpsc::{Receiver, Sender, channel};

use glam::Vec3;
use nabiki::Strands;
use nabiki::field::Keyframe;
use nabiki::solve::{Drag, Goal, Node, Problem, Unknown, Wish};
use nabiki_scene::BuiltScene;

/// Intervals whose vectors follow a hand: the last that begin before the frame, besides the chosen one.
const FREE_INTERVALS: usize = 2;
/// How much a nail counts beside the lock in the hand.
const NAIL_WEIGHT: f32 = 2.0;
/// A step that leaves more than this part of what was left gains nothing. After so many of them in a row the hair rests until the hand
/// moves on: a first one may only have gone too far, across a kink, and the next is more careful.
const WORTH: f64 = 0.98;
const PATIENCE: u32 = 6;

/// Nodes that belong together, in one frame.
#[derive(Clone, Debug, PartialEq)]
pub struct Lock {
    /// The frame.
    pub frame: u32,
    /// Strand and node of each.
    pub nodes: Vec<(usize, usize)>,
}

impl Lock {
    /// The middle of its nodes (head space, cm) where the strands have these points.
    pub fn middle(&self, points: &[Vec3], strands: &Strands) -> Vec3 {
        let sum: Vec3 = self.nodes.iter().map(|&(strand, node)| points[strands.range(strand)][node]).sum();
        sum / self.nodes.len().max(1) as f32
    }

    /// Whether all its nodes are nodes of these strands.
    pub fn fits(&self, strands: &Strands) -> bool {
        self.nodes.iter().all(|&(strand, node)| strand < strands.len() && node < strands.range(strand).len())
    }

    fn wish(&self, goal: Goal, weight: f32) -> Wish {
        let nodes = self.nodes.iter().map(|&(strand, node)| Node { strand: strand as u32, node: node as u32 });
        Wish { frame: self.frame, nodes: nodes.collect(), goal, weight }
    }
}

/// What is to be solved while a lock is pulled: it is the first wish, and the nails are the others. `chosen` is an interval that
/// follows the hand as well, however long before it ends.
pub fn problem(built: &BuiltScene, held: &Lock, nails: &[Lock], chosen: Option<usize>) -> Problem {
    let mut wishes = vec![held.wish(Goal::MeanMoved(Vec3::ZERO), 1.0)];
    wishes.extend(nails.iter().map(|nail| nail.wish(Goal::Stay, NAIL_WEIGHT)));
    let mut problem = built.problem(Vec::new(), wishes);
    let keyframes = &mut problem.wind.keyframes;
    if keyframes.is_empty() {
        keyframes.push(Keyframe { through: built.frames(), vector: Vec3::ZERO });
    }
    problem.unknowns = unknowns(keyframes, held.frame, chosen);
    problem
}

/// The vectors that follow a hand at a frame: those of the last intervals that begin before it, and the chosen one's if it does.
fn unknowns(keyframes: &[Keyframe], frame: u32, chosen: Option<usize>) -> Vec<Unknown> {
    let begins = |j: usize| if j == 0 { 0 } else { keyframes[j - 1].through };
    let before = (0..keyframes.len()).filter(|&j| begins(j) < frame).count();
    let follows = |j: &usize| j + FREE_INTERVALS >= before || chosen == Some(*j);
    (0..before).filter(follows).map(Unknown::Vector).collect()
}

/// Where a pull has come to.
#[derive(Clone, Debug, PartialEq)]
pub struct Pulled {
    /// The intervals that pull the hair there.
    pub force: Vec<Keyframe>,
    /// What is left between hand and hair, and of the nails (cm).
    pub left_cm: f64,
}

/// A pull: the solver on its thread. Let it go by dropping it.
#[derive(Debug)]
pub struct Pull {
    moved: Sender<Vec3>,
    pulled: Receiver<Result<Pulled, String>>,
}

impl Pull {
    /// Takes hold; `wake` is called whenever the wind has followed.
    pub fn new(problem: Problem, wake: impl Fn() + Send + 'static) -> Self {
        let (moved, moves) = channel();
        let (give, pulled) = channel();
        std::thread::spawn(move || {
            if let Err(why) = follow(problem, &moves, &give, &wake) {
                // Nobody hears it if the hand has let go.
                let _ = give.send(Err(why));
                wake();
            }
        });
        Self { moved, pulled }
    }

    /// The hand is now this far from where it took hold (head space, cm).
    pub fn to(&self, way: Vec3) {
        // A thread that ended has said why.
        let _ = self.moved.send(way);
    }

    /// What the wind has come to since the last call, or why it cannot follow.
    pub fn take(&self) -> Option<Result<Pulled, String>> {
        self.pulled.try_iter().last()
    }
}

/// Follows the newest place of the hand, and goes on while that is worth it.
fn follow(
    problem: Problem,
    moves: &Receiver<Vec3>,
    give: &Sender<Result<Pulled, String>>,
    wake: &dyn Fn(),
) -> Result<(), String> {
    let mut drag = Drag::new(problem).map_err(|error| error.to_string())?;
    let mut in_vain = PATIENCE;
    let mut way = Vec3::ZERO;
    loop {
        if in_vain == PATIENCE {
            match moves.recv() {
                Ok(newest) => way = newest,
                Err(_) => return Ok(()),
            }
            in_vain = 0;
        }
        if let Some(newest) = moves.try_iter().last() {
            (way, in_vain) = (newest, 0);
        }
        let step = drag.pull(0, Goal::MeanMoved(way)).map_err(|error| error.to_string())?;
        in_vain = if step.after_cm >= WORTH * step.before_cm { in_vain + 1 } else { 0 };
        let pulled = Pulled { force: drag.answer().keyframes, left_cm: step.after_cm };
        if give.send(Ok(pulled)).is_err() {
            return Ok(());
        }
        wake();
    }
}

#[cfg(test)]
mod tests {
    use std::time::{Duration, Instant};

    use nabiki_scene::{Scene, Shown};

    use super::*;

    fn key(through: u32, x: f32) -> Keyframe {
        Keyframe { through, vector: Vec3::new(x, 0.0, 0.0) }
    }

    #[test]
    fn only_intervals_that_can_reach_the_frame_follow() {
        let keys = [key(10, 1.0), key(20, 2.0), key(30, 3.0)];
        let vectors = |of: &[usize]| of.iter().map(|&j| Unknown::Vector(j)).collect::<Vec<_>>();
        assert_eq!(unknowns(&keys, 5, None), vectors(&[0]));
        assert_eq!(unknowns(&keys, 10, None), vectors(&[0]));
        assert_eq!(unknowns(&keys, 11, None), vectors(&[0, 1]));
        assert_eq!(unknowns(&keys, 30, None), vectors(&[1, 2]));
        assert_eq!(unknowns(&keys, 30, Some(0)), vectors(&[0, 1, 2]));
        assert_eq!(unknowns(&keys, 5, Some(2)), vectors(&[0]));
    }

    /// Forty strands in a wind of so many intervals, thirty frames of each.
    fn gust(intervals: u32) -> BuiltScene {
        let mut text = format!("[hair]\nstrands = 40\n[motion]\nframes = {}\nform = \"free\"\n", 30 * intervals);
        for j in 1..=intervals {
            text += &format!("[[force]]\nthrough = {}\nvector = [-40, 0, 0]\n", 30 * j);
        }
        Scene::parse(&text, "a.toml".as_ref(), &[]).unwrap().build(Shown::All).unwrap()
    }

    /// The strands at a frame.
    fn at(built: &BuiltScene, frame: u32) -> Strands {
        built.timeline().unwrap().seek(frame).clone()
    }

    /// The same scene in another wind.
    fn blown(built: &BuiltScene, force: Vec<Keyframe>) -> BuiltScene {
        let mut scene = built.scene.clone();
        scene.field.force = force;
        scene.build(Shown::All).unwrap()
    }

    fn tip(strands: &Strands, strand: usize, frame: u32) -> Lock {
        Lock { frame, nodes: vec![(strand, strands.range(strand).len() - 1)] }
    }

    #[test]
    fn hair_follows_the_hand() {
        let built = gust(1);
        let before = at(&built, 30);
        let held = tip(&before, 3, 30);
        let pull = Pull::new(problem(&built, &held, &[], None), || {});
        let way = Vec3::new(2.0, 1.0, 1.0);
        pull.to(way / 2.0);
        pull.to(way);
        let clock = Instant::now();
        let mut newest: Option<Pulled> = None;
        while newest.as_ref().is_none_or(|p| p.left_cm > 0.5) {
            assert!(clock.elapsed() < Duration::from_secs(60), "it does not come nearer than {newest:?}");
            newest = pull.take().map(Result::unwrap).or(newest);
            std::thread::sleep(Duration::from_millis(5));
        }
        let pulled = newest.unwrap();
        let after = at(&blown(&built, pulled.force), 30);
        let left = held.middle(after.points(), &after).distance(held.middle(before.points(), &before) + way);
        // What the solver says is what the simulation does: f32 against f64 over 30 frames, far below a millimetre.
        assert!((f64::from(left) - pulled.left_cm).abs() < 0.05, "{left} {}", pulled.left_cm);
    }

    #[test]
    fn hair_is_pulled_by_the_middle_of_a_lock_even_where_there_is_no_wind_yet() {
        let text = "[hair]\nstrands = 40\n[motion]\nframes = 30\nform = \"free\"\n";
        let built = Scene::parse(text, "a.toml".as_ref(), &[]).unwrap().build(Shown::All).unwrap();
        let before = at(&built, 30);
        let [a, b] = [3, 20].map(|strand| tip(&before, strand, 30));
        let held = Lock { frame: 30, nodes: [a.nodes.clone(), b.nodes.clone()].concat() };
        let middle = |strands: &Strands, lock: &Lock| lock.middle(strands.points(), strands);
        let half = 0.5 * (middle(&before, &a) + middle(&before, &b));
        assert!(middle(&before, &held).distance(half) < 1e-4);
        let way = Vec3::new(-1.0, 0.5, 0.0);
        let mut drag = Drag::new(problem(&built, &held, &[], None)).unwrap();
        for _ in 0..10 {
            drag.pull(0, Goal::MeanMoved(way)).unwrap();
        }
        let force = drag.answer().keyframes;
        assert!(matches!(&force[..], [key] if key.through == 30), "{force:?}");
        let after = at(&blown(&built, force), 30);
        assert!(middle(&after, &held).distance(half + way) < 0.5 * way.length());
    }

    #[test]
    fn what_is_nailed_stays() {
        let built = gust(2);
        let before = at(&built, 30);
        let (held, nail) = (tip(&before, 3, 60), tip(&before, 20, 30));
        // How far the tip goes that may be nailed, of another strand and thirty frames earlier.
        let gone = |nails: &[Lock]| {
            let mut drag = Drag::new(problem(&built, &held, nails, None)).unwrap();
            for _ in 0..10 {
                drag.pull(0, Goal::MeanMoved(Vec3::new(2.0, 1.0, 1.0))).unwrap();
            }
            let after = at(&blown(&built, drag.answer().keyframes), 30);
            nail.middle(after.points(), &after).distance(nail.middle(before.points(), &before))
        };
        let (nailed, free) = (gone(std::slice::from_ref(&nail)), gone(&[]));
        assert!(nailed < 0.1 * free && free > 0.1, "{nailed} for {free}");
    }
}
