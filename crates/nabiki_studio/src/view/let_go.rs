//! Hair that was let go: the search that goes on for a while, how far the hair falls short, why, and what would help.

use std::ops::RangeInclusive;

use glam::Vec3;
use nabiki::dynamics::Form;
use nabiki::field::Keyframe;
use nabiki::solve::Stop;
use nabiki_scene::pull::{Follower, Freedom, Lock, Pull, Pulled};

use super::{Shown, Touch};
use crate::document::Phase;
use crate::take::Take;

/// Hair this near to the hand has arrived: nothing is said (cm). What is farther reads as 0.4 cm or more.
pub const SHORT: f32 = 0.35;

/// What a pull is called in the undo menu.
pub const PULL: &str = "Pull the hair";

/// So long the search goes on after the hand has let go (s): nobody waits longer for hair to come.
const SETTLES: f64 = 2.0;
/// The same of what was asked for by a button, which takes more looking for (s).
const LOOKS: f64 = 6.0;

/// Something that may help where hair falls short.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Offer {
    /// What the button says, and the undo menu.
    pub name: &'static str,
    /// What it does, in a sentence.
    pub help: &'static str,
    /// What may change then.
    pub freedom: Freedom,
}

/// All of them.
const OFFERS: [Offer; 2] = [
    Offer {
        name: "Add an interval here",
        help: "Adds a second interval before this one and searches for both vectors.",
        freedom: Freedom { another: true, stiffness: false },
    },
    Offer {
        name: "Let stiffness change too",
        help: "Searches for the wind and for the stiffness of all the hair.",
        freedom: Freedom { another: false, stiffness: true },
    },
];

/// A lock that was let go, and what was asked of the hair.
#[derive(Debug)]
pub struct LetGo {
    /// What was held.
    pub lock: Lock,
    /// Where it should be (head space, cm).
    pub goal: Vec3,
    /// What should have stayed, and where.
    nails: Vec<(Lock, Vec3)>,
    /// What is done, for the menu.
    name: &'static str,
    /// The intervals that were found.
    force: Vec<Keyframe>,
    /// The search, while it goes on, and until when it may.
    search: Option<(Pull, f64)>,
    /// Whether it has found something that is not in the scene yet by a step of its own.
    is_first: bool,
    /// What keeps the hair from the hand.
    stop: Option<Stop>,
    /// The frames that feel it.
    felt: Option<RangeInclusive<u32>>,
    /// When it was let go: until the next picture the scene is what it was before.
    since: f64,
}

impl LetGo {
    /// Of a pull that has come to this by now, or to nothing, so that these are still the intervals.
    pub fn new(
        lock: Lock,
        goal: Vec3,
        nails: Vec<(Lock, Vec3)>,
        pull: Pull,
        followed: Result<Pulled, &[Keyframe]>,
        now: f64,
    ) -> Self {
        pull.let_go();
        let ended = followed.as_ref().is_ok_and(|pulled| pulled.ended);
        let search = (!ended).then_some((pull, now + SETTLES));
        let is_first = followed.is_err();
        let (force, stop, felt) = match followed {
            Ok(Pulled { answer, stop, felt, .. }) => (answer.keyframes, stop, Some(felt)),
            Err(force) => (force.to_vec(), None, None),
        };
        Self { lock, goal, nails, name: PULL, force, search, is_first, stop, felt, since: now }
    }

    /// Whether something nearer may still come.
    pub fn is_looking(&self) -> bool {
        self.search.is_some()
    }

    /// The frames that feel it, while the wind is as it was found.
    pub fn felt(&self, force: &[Keyframe]) -> Option<RangeInclusive<u32>> {
        self.felt.clone().filter(|_| force == self.force)
    }

    /// What has been found since. Whoever has changed the wind meanwhile wants it no more.
    pub fn settle(&mut self, shown: &Shown<'_>, now: f64) -> Option<Touch> {
        if now <= self.since {
            return None;
        }
        let (pull, until) = self.search.as_ref()?;
        let news = pull.take();
        // A picture that changes when nobody expects it any more is worse than hair that falls short.
        let late = now > *until && !self.is_first;
        if late || shown.force != self.force {
            self.search = None;
            return None;
        }
        match news? {
            Ok(pulled) => {
                self.stop.clone_from(&pulled.stop);
                self.felt = Some(pulled.felt.clone());
                if pulled.ended {
                    self.search = None;
                }
                let is_new = self.is_first || pulled.answer.keyframes != self.force;
                self.force.clone_from(&pulled.answer.keyframes);
                let phase = if std::mem::take(&mut self.is_first) { Phase::Done } else { Phase::After };
                let Pulled { answer, interval, .. } = pulled;
                is_new.then(|| Touch::Pulled { name: self.name, answer: Box::new(answer), interval, phase })
            }
            Err(why) => {
                self.search = None;
                Some(Touch::Refused(why))
            }
        }
    }

    /// What would help. Nothing does where the hair is too short or a body is in the way.
    pub fn offers(&self, take: &Take) -> Vec<Offer> {
        if self.is_looking() || !matches!(self.stop, Some(Stop::Force { .. } | Stop::Unknowns { .. } | Stop::Nail(_))) {
            return Vec::new();
        }
        let has_stiffness = match &take.built.dynamics.form {
            Form::Paper => false,
            Form::Free(free) => free.form.stiffness.largest() > 0.0,
        };
        let mut offers = OFFERS.to_vec();
        let has_room = Follower::has_room_for_another(&take.built, self.lock.frame);
        offers.retain(|offer| if offer.freedom.another { has_room } else { has_stiffness });
        offers
    }

    /// Looks again, with more that may change.
    pub fn look_again(&mut self, offer: Offer, take: &Take, now: f64, wake: impl Fn() + Send + 'static) {
        let nails: Vec<Lock> = self.nails.iter().map(|(nail, _)| nail.clone()).collect();
        let middle = self.lock.middle(take.points(self.lock.frame), take.strands());
        let pull = Pull::new(Follower::new(&take.built, &self.lock, middle, &nails, offer.freedom), wake);
        pull.to(self.goal);
        pull.let_go();
        (self.search, self.name, self.is_first) = (Some((pull, now + LOOKS)), offer.name, true);
    }

    /// As if the hand had gone on by so much, and one wind did not bring the hair there.
    #[cfg(test)]
    pub fn falls_short(&mut self, by: Vec3) {
        self.goal += by;
        self.stop = Some(Stop::Unknowns { frames: 12 });
    }

    /// How far the hair falls short of it, in one line; nothing where it does not, and where another wind blows or another frame is
    /// shown.
    pub fn fell_short(&self, shown: &Shown<'_>) -> Option<String> {
        let take = shown.take;
        let is_there = |lock: &Lock| lock.fits(take.strands()) && lock.frame <= take.frames();
        if shown.force != self.force || shown.frame != self.lock.frame || !is_there(&self.lock) {
            return None;
        }
        let off = |lock: &Lock, place: Vec3| lock.middle(take.points(lock.frame), take.strands()).distance(place);
        let of_nails = self.nails.iter().filter(|(nail, _)| is_there(nail)).map(|(nail, place)| off(nail, *place));
        // What was found is not shown yet: the hair is on its way.
        let searching = self.is_looking() || take.built.forces.intervals() != self.force;
        short(off(&self.lock, self.goal), of_nails.fold(0.0, f32::max), searching, self.stop.as_ref())
    }
}

/// How far a lock is from the hand and a nail from its place (cm), in one line: whether the search goes on, or what stops it.
pub fn short(lock: f32, nail: f32, searching: bool, stop: Option<&Stop>) -> Option<String> {
    let lock = (lock > SHORT).then(|| format!("{lock:.1} cm short"));
    let slips = (nail > SHORT).then(|| format!("a nail slips {nail:.1} cm"));
    // That a nail slips says already that it holds the hair.
    let stop = stop.filter(|stop| slips.is_none() || !matches!(stop, Stop::Nail(_)));
    let words: Vec<String> = lock.into_iter().chain(slips).collect();
    if words.is_empty() {
        return None;
    }
    let words = words.join(", ");
    Some(match stop {
        _ if searching => format!("{words}, searching..."),
        Some(stop) => format!("{words}: {}", why(stop)),
        None => words,
    })
}

/// What keeps the hair from the hand, in a few words.
pub fn why(stop: &Stop) -> String {
    match stop {
        Stop::Length { away_cm, reach_cm } => {
            format!("the hair is {reach_cm:.1} cm long and the hand is {away_cm:.1} cm from the root")
        }
        Stop::Body(name) if name == "contact" => "the head is in the way".to_owned(),
        Stop::Body(name) => format!("{name} is in the way"),
        Stop::Nail(_) => "a nail holds it".to_owned(),
        Stop::Force { strongest } => {
            format!("it needs a total force above {strongest:.0}, the limit for this hair")
        }
        Stop::Unknowns { frames: 1 } => "one frame of wind is too short".to_owned(),
        Stop::Unknowns { frames } => format!("no wind over these {frames} frames gets it there"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_stops_a_pull_is_said_in_one_line() {
        let length = Stop::Length { away_cm: 21.04, reach_cm: 18.0 };
        assert_eq!(why(&length), "the hair is 18.0 cm long and the hand is 21.0 cm from the root");
        assert_eq!(why(&Stop::Body("contact".to_owned())), "the head is in the way");
        assert_eq!(why(&Stop::Body("body[1]".to_owned())), "body[1] is in the way");
        let all = [length, Stop::Nail(2), Stop::Force { strongest: 812.6 }, Stop::Unknowns { frames: 12 }];
        assert!(all.iter().all(|stop| why(stop).len() < 80 && !why(stop).contains('\n')));
    }

    #[test]
    fn what_is_where_it_should_be_is_not_spoken_of() {
        let says = |lock, nail, searching, stop: Option<&Stop>| short(lock, nail, searching, stop);
        let nail = Stop::Nail(0);
        assert_eq!(says(0.29, 0.02, true, Some(&nail)), None);
        assert_eq!(says(1.34, 0.0, false, None).as_deref(), Some("1.3 cm short"));
        assert_eq!(says(1.34, 0.0, true, None).as_deref(), Some("1.3 cm short, searching..."));
        assert_eq!(says(1.34, 0.0, false, Some(&nail)).as_deref(), Some("1.3 cm short: a nail holds it"));
        assert_eq!(says(0.0, 0.4, false, None).as_deref(), Some("a nail slips 0.4 cm"));
        assert_eq!(says(0.0, 1.5, false, Some(&nail)).as_deref(), Some("a nail slips 1.5 cm"));
        let both = "1.3 cm short, a nail slips 0.4 cm, searching...";
        assert_eq!(says(1.3, 0.4, true, None).as_deref(), Some(both));
    }
}
