//! What a hand is doing in the view.

use glam::{Vec2, Vec3};
use nabiki::Pose;
use nabiki::dynamics::ForceSpace;
use nabiki_render::View;
use nabiki_scene::pull::{Lock, Pull, Pulled};

use super::camera::{Gesture, place_in_plane};
use super::handle::{self, Arrow};
use super::let_go::{LetGo, PULL, short};
use super::pick::Picked;
use super::tooling::{Combing, Painting};
use super::{Shown, Touch};
use crate::document::Phase;
use crate::take::Take;

/// About the node that is pulled: strands that come along have a node this near (cm).
pub const LOCK_CM: f32 = 1.5;

/// A hand that has gone no farther has not moved (cm): a hundredth of a pixel, and far more than roundings.
const STILL_CM: f32 = 5e-4;

/// What it is doing.
#[derive(Debug, Default)]
pub enum Hand {
    /// Nothing.
    #[default]
    Idle,
    /// It moves the camera.
    Camera(Gesture),
    /// It holds the tip of an interval's arrow.
    Tip {
        /// Which interval's.
        interval: usize,
        /// How.
        held: handle::Held,
        /// The vector it has dragged it to, if it has moved.
        vector: Option<Vec3>,
    },
    /// It holds a lock.
    Hair(Box<Held>),
    /// It paints.
    Paint(Box<Painting>),
    /// It combs.
    Comb(Box<Combing>),
}

/// A lock in the hand.
#[derive(Debug)]
pub struct Held {
    /// What is held.
    pub lock: Lock,
    /// The node it was taken hold of by, where it was (head space, cm).
    from: Vec3,
    /// The middle of the lock, where it was.
    middle: Vec3,
    /// What is to stay meanwhile, and where that is.
    nails: Vec<(Lock, Vec3)>,
    /// From the pixel taken hold of to that node.
    offset: Vec2,
    /// How far the hand has gone (head space, cm).
    pub way: Vec3,
    /// The solver.
    pull: Pull,
    /// What it has come to, once the wind has followed: there is something to accept, or to undo.
    pub followed: Option<Pulled>,
    /// Why it cannot follow; said once.
    failed: bool,
}

impl Held {
    /// How far the hair at this place (head space, cm) of a take is from the hand, in one line, and what stops it once that is known and
    /// shown.
    pub fn says(&self, hair: Vec3, take: &Take) -> Option<String> {
        let is_shown = |pulled: &Pulled| take.built.forces.intervals() == pulled.answer.keyframes;
        let searching = self.followed.as_ref().is_none_or(|pulled| !pulled.ended || !is_shown(pulled));
        let stop = self.followed.as_ref().and_then(|pulled| pulled.stop.as_ref());
        short(self.goal().distance(hair), 0.0, searching, stop)
    }

    /// Takes hold of a lock by a node at a pixel.
    pub fn new(lock: Lock, picked: &Picked, take: &Take, nails: &[Lock], view: &View, pixel: Vec2, pull: Pull) -> Self {
        let middle = |lock: &Lock| lock.middle(take.points(lock.frame), take.strands());
        Self {
            middle: middle(&lock),
            nails: nails.iter().map(|nail| (nail.clone(), middle(nail))).collect(),
            lock,
            from: picked.place,
            offset: view.project(picked.place).truncate() - pixel,
            way: Vec3::ZERO,
            pull,
            followed: None,
            failed: false,
        }
    }

    /// The hand is at this pixel of the view (head space): the lock should come along in the plane that faces the camera.
    pub fn drag(&mut self, view: &View, pixel: Vec2) {
        let way = place_in_plane(view, pixel + self.offset, self.from) - self.from;
        // There and back again is no way, but for roundings: hair that is only touched is not pulled.
        if way.distance(self.way) > STILL_CM {
            self.way = way;
            self.pull.to(self.goal());
        }
    }

    /// Where the middle of the lock should be (head space, cm).
    pub fn goal(&self) -> Vec3 {
        self.middle + self.way
    }

    /// What it is once it is let go, at this time; nothing where the hand has not moved.
    pub fn let_go(self, shown: &Shown<'_>, now: f64) -> Option<LetGo> {
        let goal = self.goal();
        let Self { lock, nails, pull, followed, way, .. } = self;
        (way != Vec3::ZERO).then(|| LetGo::new(lock, goal, nails, pull, followed.ok_or(shown.force), now))
    }

    /// What the wind has come to.
    pub fn follow(&mut self) -> Option<Touch> {
        match self.pull.take()? {
            Ok(pulled) => {
                let before = self.followed.replace(pulled.clone());
                let is_new = before.is_none_or(|before| before.answer != pulled.answer);
                is_new.then(|| touched(pulled, Phase::Dragging))
            }
            Err(why) if !self.failed => {
                self.failed = true;
                Some(Touch::Refused(why))
            }
            Err(_) => None,
        }
    }
}

/// What a pull has come to, to be made true.
pub fn touched(Pulled { answer, interval, .. }: Pulled, phase: Phase) -> Touch {
    Touch::Pulled { name: PULL, answer: Box::new(answer), interval, phase }
}

/// The tip of an arrow that was let go: it stays where the hand has left it, though an arrow drawn anew may be longer or shorter for its
/// force, until something else is seen.
#[derive(Debug)]
pub struct LeftTip {
    scene: u64,
    interval: usize,
    held: handle::Held,
    vector: Vec3,
    view: View,
    frame: u32,
}

impl LeftTip {
    /// The arrow as it was left.
    pub fn arrow(&self, shown: &Shown<'_>, world: &View) -> Option<(usize, Arrow)> {
        let is_as_left = self.scene == shown.scene
            && self.view == *world
            && self.frame == shown.frame
            && shown.selected_interval == Some(self.interval)
            && shown.force.get(self.interval).is_some_and(|key| key.vector == self.vector);
        let arrow = self.held.showing(self.vector);
        let (view, _) = of_forces(shown, world);
        let tip = view.project(arrow.tip);
        let size = Vec2::new(view.size[0] as f32, view.size[1] as f32);
        // Let go beyond the edge it could not be taken hold of again.
        let is_seen = tip.z > 0.0 && tip.truncate().cmpge(Vec2::ZERO).all() && tip.truncate().cmple(size).all();
        (is_as_left && is_seen && !shown.playing).then_some((self.interval, arrow))
    }
}

impl Hand {
    /// Whether it holds something that changes the scene.
    pub fn is_busy(&self) -> bool {
        matches!(self, Self::Tip { .. } | Self::Hair(_) | Self::Paint(_) | Self::Comb(_))
    }

    /// It lets go, and what it did is accepted.
    pub fn release(&mut self) -> Option<Touch> {
        match std::mem::take(self) {
            Self::Tip { interval, vector: Some(vector), .. } => Some(Touch::SetVector { interval, vector, done: true }),
            _ => None,
        }
    }

    /// It gives up: all is as it was before.
    pub fn give_up(&mut self) -> Option<Touch> {
        match std::mem::take(self) {
            Self::Tip { vector: Some(_), .. } => Some(Touch::Undone),
            Self::Hair(held) if held.followed.is_some() => Some(Touch::Undone),
            _ => None,
        }
    }

    /// The arrow whose tip has just been let go, as it is held.
    pub fn tip_let_go(&self, shown: &Shown<'_>, view: &View) -> Option<LeftTip> {
        let Self::Tip { interval, held, vector: Some(vector) } = self else { return None };
        let (interval, held, vector) = (*interval, *held, *vector);
        Some(LeftTip { scene: shown.scene, interval, held, vector, view: *view, frame: shown.frame })
    }

    /// The tip of an arrow follows the pointer.
    pub fn drag_tip(&mut self, view: &View, pixel: Vec2) -> Option<Touch> {
        let Self::Tip { interval, held, vector } = self else { return None };
        if vector.is_none() && held.rests(pixel) {
            return None;
        }
        let now = handle::rounded(held.dragged(view, pixel).force());
        (*vector != Some(now)).then(|| {
            *vector = Some(now);
            Touch::SetVector { interval: *interval, vector: now, done: false }
        })
    }
}

/// The space of the forces: the camera in it, and where the head is in it.
pub fn of_forces(shown: &Shown<'_>, world: &View) -> (View, Pose) {
    let pose = shown.take.pose(shown.frame);
    match shown.take.built.dynamics.motion.force_space {
        ForceSpace::World => (*world, pose),
        ForceSpace::Head => (world.in_head(&pose), Pose::STILL),
    }
}

/// The arrow of the selected interval while nothing plays, in the space of the forces and within reach on a display of so many pixels to a point.
pub fn arrow(shown: &Shown<'_>, scale: f32, world: &View) -> Option<(usize, Arrow)> {
    let (view, pose) = of_forces(shown, world);
    let interval = shown.selected_interval.filter(|_| !shown.playing)?;
    let key = shown.force.get(interval)?;
    Some((interval, Arrow::new(&shown.take.built.model.head.ellipsoid, &pose, key.vector).within(&view, scale)))
}
