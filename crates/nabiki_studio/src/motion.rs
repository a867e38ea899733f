//! The worker that moves hair: a thread that takes the newest scene asked for, builds what has changed of it and plays it
//! whole.

use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use glam::Vec3;
use nabiki::dynamics::Timeline;
use nabiki::field::FieldSum;
use nabiki_scene::told::SwingTable;
use nabiki_scene::{BuiltScene, Error, Scene, Shown};

use crate::take::Take;

/// What to move.
#[derive(Clone, Debug)]
struct Request {
    scene: Scene,
    strands: usize,
    number: u64,
    fresh: bool,
}

/// A scene moved, or why it was not.
#[derive(Debug)]
pub struct Moved {
    /// The number of the request.
    pub number: u64,
    /// The motion with how long its swings take, or what is wrong with the scene.
    pub result: Result<(Arc<Take>, SwingTable), Error>,
    /// From when the worker took the request up until the motion was there.
    pub took: Duration,
}

/// Most bytes of points that a take may hold.
pub const MOST_BYTES: usize = 4 << 30;
/// Most points of a frame: what every card has room for. Of two vertices of 32 bytes each, they fill 128 MiB.
pub const MOST_POINTS: usize = 1 << 21;
/// Points of a stretch, between two of which a worker that gives way looks whether it should: a few hundredths of a second.
const STRETCH: usize = 4_000_000;
/// How often the worker says how far it is: a picture of the window takes a core away from it.
const TELLS: Duration = Duration::from_millis(250);

/// The worker. Whatever is asked for while it works replaces what was asked for before and has not been begun.
#[derive(Debug)]
pub struct Motion {
    shared: Arc<Shared>,
    thread: Option<JoinHandle<()>>,
    number: u64,
}

/// What a worker does with a motion that is no longer the newest asked for. One that is [stopped](Motion::stop) it gives up
/// in any manner.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Manner {
    /// It ends it first: a hand that drags sees the hair follow all the while.
    Finishes,
    /// It gives it up: much hair, that nobody waits for any more.
    GivesWay,
}

/// What a worker is doing with a motion.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Stage {
    /// It grows the hair, or reads it.
    #[default]
    Building,
    /// It moves the hair.
    Moving,
}

#[derive(Debug, Default)]
struct Shared {
    state: Mutex<State>,
    changed: Condvar,
}

#[derive(Debug, Default)]
struct State {
    request: Option<Request>,
    done: Option<Moved>,
    working: bool,
    /// What it does, and how much of that is done, 0..1.
    done_of: (Stage, f32),
    /// When it was last said.
    told: Option<Instant>,
    /// What is being worked on is wanted no more.
    stopped: bool,
    /// Files were to be read again for a request that was given up, and are for the next.
    fresh: bool,
    /// What is kept for the next request is to go.
    forget: bool,
    quit: bool,
}

impl State {
    /// Whether what is being worked on is to be worked out to its end.
    fn goes_on(&self, manner: Manner) -> bool {
        !self.stopped && (manner == Manner::Finishes || self.request.is_none())
    }

    /// Whether files are to be read again for whatever is begun next; once.
    fn reads_again(&mut self) -> bool {
        std::mem::take(&mut self.fresh) || self.request.as_ref().is_some_and(|waiting| waiting.fresh)
    }
}

impl Shared {
    /// A thread that died while it held the state left it whole: nothing is done under the lock but to move values.
    fn lock(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Motion {
    /// A worker that calls `wake` whenever something is there to be [taken](Self::take).
    ///
    /// # Errors
    /// The system's, if it gives no thread.
    pub fn start(manner: Manner, wake: impl Fn() + Send + Sync + 'static) -> std::io::Result<Self> {
        let shared = Arc::new(Shared::default());
        let theirs = shared.clone();
        let thread = std::thread::Builder::new().name("motion".to_owned()).spawn(move || {
            // A pool of its own, so that a touch need not wait for the tasks of a picture being drawn.
            match rayon::ThreadPoolBuilder::new().build() {
                Ok(pool) => pool.install(|| work(manner, &theirs, &wake)),
                Err(_) => work(manner, &theirs, &wake),
            }
        })?;
        Ok(Self { shared, thread: Some(thread), number: 0 })
    }

    /// Asks for the motion of a scene's first `strands` strands. Returns the number by which it will be known. `fresh`: its
    /// files are read again even if they were before.
    pub fn ask(&mut self, scene: Scene, strands: usize, fresh: bool) -> u64 {
        self.number += 1;
        let mut state = self.shared.lock();
        let fresh = state.reads_again() || fresh;
        state.request = Some(Request { scene, strands, number: self.number, fresh });
        self.shared.changed.notify_all();
        self.number
    }

    /// What is being done, and how much of that is, 0..1.
    pub fn progress(&self) -> (Stage, f32) {
        self.shared.lock().done_of
    }

    /// What was asked for is wanted no more: it does not come, nor does what was there already and has not been taken.
    pub fn stop(&self) {
        let mut state = self.shared.lock();
        state.fresh = state.reads_again();
        (state.request, state.done, state.stopped) = (None, None, state.working);
        self.shared.changed.notify_all();
    }

    /// As [`stop`](Self::stop), and lets go of all that is kept for what may be asked for next.
    pub fn forget(&self) {
        self.stop();
        self.shared.lock().forget = true;
        self.shared.changed.notify_all();
    }

    /// The newest motion that has not been taken yet.
    pub fn take(&self) -> Option<Moved> {
        self.shared.lock().done.take()
    }

    /// Whether something asked for is not there yet.
    pub fn is_working(&self) -> bool {
        let state = self.shared.lock();
        state.working || state.request.is_some()
    }

    /// Waits until everything asked for is there.
    pub fn wait(&self) {
        let mut state = self.shared.lock();
        while state.working || state.request.is_some() {
            state = self.shared.changed.wait(state).unwrap_or_else(PoisonError::into_inner);
        }
    }
}

impl Drop for Motion {
    fn drop(&mut self) {
        self.stop();
        self.shared.lock().quit = true;
        self.shared.changed.notify_all();
        if let Some(thread) = self.thread.take() {
            // It panics only where the method does, and that has been said by then.
            let _ = thread.join();
        }
    }
}

fn work(manner: Manner, shared: &Shared, wake: &(impl Fn() + Sync)) {
    let mut player = Player::default();
    loop {
        let request = {
            let mut state = shared.lock();
            loop {
                if state.quit {
                    return;
                }
                if std::mem::take(&mut state.forget) {
                    player = Player::default();
                }
                if let Some(request) = state.request.take() {
                    (state.working, state.stopped) = (true, false);
                    (state.done_of, state.told) = ((Stage::Building, 0.0), Some(Instant::now()));
                    break request;
                }
                state = shared.changed.wait(state).unwrap_or_else(PoisonError::into_inner);
            }
        };
        let start = Instant::now();
        let number = request.number;
        let goes_on = |stage: Stage, part: f32| {
            let mut state = shared.lock();
            state.done_of = (stage, part);
            let tells = manner == Manner::GivesWay && state.told.is_some_and(|told| told.elapsed() >= TELLS);
            if tells {
                state.told = Some(Instant::now());
            }
            let goes_on = state.goes_on(manner);
            drop(state);
            if tells {
                wake();
            }
            goes_on
        };
        let result = player.play(request, &goes_on);
        let mut state = shared.lock();
        if let Some(result) = result.transpose()
            && !state.stopped
        {
            state.done = Some(Moved { number, result, took: start.elapsed() });
        }
        state.working = false;
        drop(state);
        shared.changed.notify_all();
        wake();
    }
}

/// What the worker keeps from one request to the next.
#[derive(Default)]
struct Player {
    built: Option<Arc<BuiltScene>>,
    timeline: Option<Timeline>,
    /// Films given out, whose storage is used again once nobody shows them any more.
    films: Vec<Arc<[Vec3]>>,
}

/// Films kept for their storage: the one shown, the one on its way there, and the next.
const FILMS: usize = 3;

impl Player {
    /// The motion asked for; none where it did not go on to the end.
    fn play(
        &mut self,
        request: Request,
        goes_on: &(dyn Fn(Stage, f32) -> bool + Sync),
    ) -> Result<Option<(Arc<Take>, SwingTable)>, Error> {
        let fresh = request.fresh;
        let played = self.play_known(request, goes_on);
        if fresh && !matches!(played, Ok(Some(_))) {
            // What is known is of files that were to be read again.
            (self.built, self.timeline) = (None, None);
        }
        match played {
            Err(Error::Cancelled) => Ok(None),
            played => played,
        }
    }

    fn play_known(
        &mut self,
        Request { scene, strands, number, fresh }: Request,
        goes_on: &(dyn Fn(Stage, f32) -> bool + Sync),
    ) -> Result<Option<(Arc<Take>, SwingTable)>, Error> {
        scene.check().map_err(|refused| scene.refusal(refused))?;
        let shown = Shown::AtMost(strands);
        let known = self.built.clone().filter(|_| !fresh);
        let built = scene.build_while(shown, known.as_deref().as_slice(), &|part| goes_on(Stage::Building, part))?;
        check_size(&built)?;
        if !goes_on(Stage::Moving, 0.0) {
            self.built = Some(Arc::new(built));
            self.timeline = None;
            return Ok(None);
        }
        let timeline = match (known, self.timeline.take()) {
            (Some(known), Some(timeline)) => reused(timeline, &known, &built),
            _ => None,
        };
        let mut timeline = match timeline {
            Some(timeline) => timeline,
            None => built.timeline().inspect_err(|_| self.built = None)?,
        };
        let points = built.strands().points().len() * (built.frames() as usize + 1);
        let stretch = (STRETCH / built.strands().points().len().max(1)).max(1) as u32;
        let (mut whole, mut frame) = (false, 0);
        let mut next = || {
            frame += stretch;
            goes_on(Stage::Moving, frame as f32 / (built.frames() + 1) as f32)
        };
        let film = self.film(points, |film| whole = timeline.play_into_while(film, stretch, &mut next));
        let swings = SwingTable::of(&built);
        let built = Arc::new(built);
        (self.built, self.timeline) = (Some(built.clone()), Some(timeline));
        Ok(whole.then(|| (Arc::new(Take { built, film, number }), swings)))
    }

    /// A film of so many points, in storage that nobody looks at any more where there is some.
    fn film(&mut self, points: usize, play: impl FnOnce(&mut [Vec3])) -> Arc<[Vec3]> {
        self.films.retain(|film| film.len() == points);
        let free = self.films.iter_mut().position(|film| Arc::get_mut(film).is_some());
        let mut film = match free {
            Some(free) => self.films.swap_remove(free),
            None => std::iter::repeat_n(Vec3::ZERO, points).collect(),
        };
        if let Some(storage) = Arc::get_mut(&mut film) {
            play(storage);
        }
        if self.films.len() < FILMS {
            self.films.push(film.clone());
        }
        film
    }
}

/// The timeline of a scene that was `known`, as that of another; none where the hair is another.
fn reused(mut timeline: Timeline, known: &BuiltScene, built: &BuiltScene) -> Option<Timeline> {
    if known.strands() != built.strands() {
        return None;
    }
    if known.frames() != built.frames() || known.way.poses != built.way.poses {
        timeline.set_poses(built.given_poses(), built.frames()).ok()?;
    }
    if known.dynamics != built.dynamics {
        // The old field may be too strong for the new settings, or the new one for the old.
        timeline.set_field(Arc::new(FieldSum::default())).ok()?;
        timeline.set_dynamics(&built.dynamics).ok()?;
    }
    timeline.set_field(built.forces.field.clone()).ok()?;
    Some(timeline)
}

/// Refuses more points than there is room for.
fn check_size(built: &BuiltScene) -> Result<(), Error> {
    let points = built.strands().points().len();
    let bytes = points * (built.frames() as usize + 1) * size_of::<Vec3>();
    let strands = built.strands().len();
    if bytes > MOST_BYTES {
        return Err(Error::refused(format!(
            "{strands} strands in {} frames need {:.1} GiB: show fewer strands, or set motion.frames lower",
            built.frames() + 1,
            bytes as f64 / (1u64 << 30) as f64
        )));
    }
    if points > MOST_POINTS {
        return Err(Error::refused(format!(
            "{strands} strands have {points} points, more than the view can draw ({MOST_POINTS}): show fewer strands"
        )));
    }
    Ok(())
}

/// As many of a take's strands, or of those that it is some of, as `check_size` does not refuse.
pub fn most_strands(take: &Take) -> usize {
    let (strands, points) = (take.strands().len().max(1), take.strands().points().len().max(1));
    let frames = take.frames() as usize + 1;
    let points_in_all = MOST_POINTS.min(MOST_BYTES / (frames * size_of::<Vec3>()));
    // A hundredth is left for hair that is not of one length.
    let fit = (points_in_all as f64 * 0.99 * strands as f64 / points as f64) as usize;
    take.built.groom.of_scene.min(fit)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn scene() -> Scene {
        let text = "[hair]\nstrands = 8\n[motion]\nframes = 5\n[[force]]\nthrough = 5\nvector = [1, 2, 3]\n";
        Scene::parse(text, "wind.toml".as_ref(), &[]).unwrap()
    }

    #[test]
    fn a_newer_motion_stops_one_that_gives_way_and_a_word_stops_any() {
        let request = Some(Request { scene: scene(), strands: 8, number: 2, fresh: false });
        for (manner, goes_on) in [(Manner::Finishes, true), (Manner::GivesWay, false)] {
            assert!(State { working: true, ..State::default() }.goes_on(manner));
            assert!(!State { working: true, stopped: true, ..State::default() }.goes_on(manner));
            let newer = State { working: true, request: request.clone(), ..State::default() };
            assert_eq!(newer.goes_on(manner), goes_on);
        }
    }

    #[test]
    fn what_is_stopped_never_comes_and_what_is_asked_for_afterwards_does() {
        for manner in [Manner::Finishes, Manner::GivesWay] {
            let mut motion = Motion::start(manner, || ()).unwrap();
            motion.ask(scene(), 8, false);
            motion.stop();
            motion.wait();
            assert!(motion.take().is_none(), "{manner:?}");
            let wanted = motion.ask(scene(), 8, false);
            motion.wait();
            assert_eq!(motion.take().unwrap().number, wanted);
        }
    }

    #[test]
    fn hair_that_grows_is_given_up_and_what_is_known_stays() {
        let grown = |length: f32, strands: usize| {
            let mut scene = scene();
            let nabiki_scene::scene::HairSource::Grown(grown) = &mut scene.hair.source else { panic!() };
            (grown.strands, grown.style.length.top) = (2000, length);
            Request { scene, strands, number: 1, fresh: false }
        };
        let mut player = Player::default();
        assert!(player.play(grown(17.0, 2000), &|_, _| true).unwrap().is_some());
        let known = player.built.clone().unwrap();
        let asked = std::sync::atomic::AtomicUsize::new(0);
        let few = |stage: Stage, _: f32| {
            assert_eq!(stage, Stage::Building, "it has grown to the end");
            asked.fetch_add(1, std::sync::atomic::Ordering::Relaxed) < 3
        };
        assert!(player.play(grown(16.0, 2000), &few).unwrap().is_none());
        assert!(Arc::ptr_eq(&known, player.built.as_ref().unwrap()), "the next request has the roots");
        let parts = Mutex::new(Vec::new());
        let note = |stage: Stage, part: f32| {
            parts.lock().unwrap().push((stage == Stage::Moving, part));
            true
        };
        let take = player.play(grown(16.0, 2000), &note).unwrap().unwrap().0;
        assert!(*take.built.strands().points() == *grown(16.0, 0).scene.build(Shown::All).unwrap().strands().points());
        let parts = parts.into_inner().unwrap();
        assert!(parts.iter().any(|&(moves, part)| !moves && part > 0.5), "nothing is said of how far it is");
        assert!(parts.iter().all(|(_, part)| (0.0..=1.0).contains(part)), "{parts:?}");
    }

    #[test]
    fn a_file_that_was_to_be_read_again_and_is_not_there_stays_missed() {
        let folder = tempfile::tempdir().unwrap();
        let mesh = folder.path().join("box.obj");
        std::fs::write(&mesh, "v 30 0 0\nv 33 0 0\nv 30 3 0\nv 30 0 3\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n").unwrap();
        let text = "[hair]\nstrands = 8\n[motion]\nform = \"free\"\nframes = 5\n\
                    [[body]]\nmesh = \"box.obj\"\nunit = \"cm\"\nup = \"+y\"\nfacing = \"+x\"\norigin = [0, 0, 0]\n";
        let scene = Scene::parse(text, &folder.path().join("a.toml"), &[]).unwrap();
        let mut player = Player::default();
        let mut play =
            |fresh| player.play(Request { scene: scene.clone(), strands: 8, number: 1, fresh }, &|_, _| true).is_ok();
        assert!(play(true));
        std::fs::remove_file(&mesh).unwrap();
        assert!(play(false), "a file counts as it was when it was read");
        assert!(!play(true));
        assert!(!play(false), "a change of something else does not bring it back");
    }

    #[test]
    fn files_that_were_to_be_read_again_are_whatever_is_given_up() {
        let mut state =
            State { request: Some(Request { scene: scene(), strands: 8, number: 1, fresh: true }), ..State::default() };
        assert!(state.reads_again());
        (state.fresh, state.request) = (true, None);
        assert!(state.reads_again() && !state.reads_again());
    }
}
