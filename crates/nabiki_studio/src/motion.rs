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
pub const MOST_BYTES: usize = 1 << 30;

/// The worker. Whatever is asked for while it works replaces what was asked for before and has not been begun.
#[derive(Debug)]
pub struct Motion {
    shared: Arc<Shared>,
    thread: Option<JoinHandle<()>>,
    number: u64,
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
    quit: bool,
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
    pub fn start(wake: impl Fn() + Send + Sync + 'static) -> std::io::Result<Self> {
        let shared = Arc::new(Shared::default());
        let theirs = shared.clone();
        let thread = std::thread::Builder::new().name("motion".to_owned()).spawn(move || {
            // A pool of its own, so that a touch need not wait for the tasks of a picture being drawn.
            match rayon::ThreadPoolBuilder::new().build() {
                Ok(pool) => pool.install(|| work(&theirs, &wake)),
                Err(_) => work(&theirs, &wake),
            }
        })?;
        Ok(Self { shared, thread: Some(thread), number: 0 })
    }

    /// Asks for the motion of a scene's first `strands` strands. Returns the number by which it will be known. `fresh`: its
    /// files are read again even if they were before.
    pub fn ask(&mut self, scene: Scene, strands: usize, fresh: bool) -> u64 {
        self.number += 1;
        let mut state = self.shared.lock();
        let fresh = fresh || state.request.as_ref().is_some_and(|waiting| waiting.fresh);
        state.request = Some(Request { scene, strands, number: self.number, fresh });
        self.shared.changed.notify_all();
        self.number
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
        self.shared.lock().quit = true;
        self.shared.changed.notify_all();
        if let Some(thread) = self.thread.take() {
            // It panics only where the method does, and that has been said by then.
            let _ = thread.join();
        }
    }
}

fn work(shared: &Shared, wake: &(impl Fn() + Sync)) {
    let mut player = Player::default();
    loop {
        let request = {
            let mut state = shared.lock();
            loop {
                if state.quit {
                    return;
                }
                if let Some(request) = state.request.take() {
                    state.working = true;
                    break request;
                }
                state = shared.changed.wait(state).unwrap_or_else(PoisonError::into_inner);
            }
        };
        let start = Instant::now();
        let number = request.number;
        let result = player.play(request);
        let moved = Moved { number, result, took: start.elapsed() };
        let mut state = shared.lock();
        state.done = Some(moved);
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
    fn play(&mut self, Request { scene, strands, number, fresh }: Request) -> Result<(Arc<Take>, SwingTable), Error> {
        scene.check().map_err(|refused| scene.refusal(refused))?;
        let shown = Shown::AtMost(strands);
        let known = self.built.clone().filter(|_| !fresh);
        let built = match &known {
            Some(known) => known.changed_to(scene, shown)?,
            None => scene.build(shown)?,
        };
        check_size(&built)?;
        let timeline = match (known, self.timeline.take()) {
            (Some(known), Some(timeline)) => reused(timeline, &known, &built),
            _ => None,
        };
        let mut timeline = match timeline {
            Some(timeline) => timeline,
            None => built.timeline().inspect_err(|_| self.built = None)?,
        };
        let points = built.hair.strands.points().len() * (built.frames() as usize + 1);
        let film = self.film(points, |film| timeline.play_into(film));
        let swings = SwingTable::of(&built);
        let built = Arc::new(built);
        (self.built, self.timeline) = (Some(built.clone()), Some(timeline));
        Ok((Arc::new(Take { built, film, number }), swings))
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
    if known.hair.strands != built.hair.strands {
        return None;
    }
    let same_poses = known.frames() == built.frames()
        && known.head_moves() == built.head_moves()
        && (!built.head_moves() || (0..=built.frames()).all(|n| known.pose(n) == built.pose(n)));
    if !same_poses {
        timeline.set_poses(built.given_poses(), built.frames()).ok()?;
    }
    if known.dynamics != built.dynamics {
        // The old field may be too strong for the new settings, or the new one for the old.
        timeline.set_field(Arc::new(FieldSum::default())).ok()?;
        timeline.set_dynamics(&built.dynamics).ok()?;
    }
    timeline.set_field(built.field.clone()).ok()?;
    Some(timeline)
}

/// Refuses more points than there is room for.
fn check_size(built: &BuiltScene) -> Result<(), Error> {
    let points = built.hair.strands.points().len() * (built.frames() as usize + 1);
    let bytes = points * size_of::<Vec3>();
    if bytes <= MOST_BYTES {
        return Ok(());
    }
    Err(Error::refused(format!(
        "{} strands in {} frames take {:.1} GiB: show fewer strands, or give motion.frames less",
        built.hair.strands.len(),
        built.frames() + 1,
        bytes as f64 / (1u64 << 30) as f64
    )))
}
