//! Pulling the hair with the mouse: the lock, nails that hold others, and the search for the wind, on its own thread.
//!
//! While the mouse moves, the wind follows in quick steps. When it rests, or quick steps gain nothing, the full search
//! continues with more steps, other intervals and other starts. A movement of the mouse stops it between two motions.
//! The result is the nearest motion so far.

mod few;
mod follow;
mod lock;

use std::ops::RangeInclusive;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use glam::Vec3;
use nabiki::solve::{Answer, Stop};

pub use follow::{Follower, Freedom};
pub use lock::Lock;

/// A mouse that has not moved for this long rests.
const REST: Duration = Duration::from_millis(80);
/// The full search begins after this many quick steps in a row without gain.
const PATIENCE: u32 = 2;

/// The current result of a pull.
#[derive(Clone, Debug, PartialEq)]
pub struct Pulled {
    /// The settings that pull the hair there.
    pub answer: Answer,
    /// The index of the pull's interval.
    pub interval: usize,
    /// The frames in which it may change the wind.
    pub felt: RangeInclusive<u32>,
    /// Where the lock should be (head space, cm).
    pub goal: Vec3,
    /// Remaining distance (cm).
    pub left_cm: f64,
    /// Whether the full search has ended. Nothing better comes until the mouse moves again.
    pub ended: bool,
    /// Why the hair does not reach the mouse, once that is known.
    pub stop: Option<Stop>,
}

/// A pull: the search on its thread. Drop it to end the search.
#[derive(Debug)]
pub struct Pull {
    shared: Arc<Shared>,
}

#[derive(Debug, Default)]
struct Shared {
    state: Mutex<State>,
    changed: Condvar,
    /// Whether a search should give way.
    urgent: AtomicBool,
}

#[derive(Debug, Default)]
struct State {
    /// The goal of the lock, if it is new.
    goal: Option<Vec3>,
    /// Time of the last goal.
    moved: Option<Instant>,
    /// Whether the goal is final.
    is_let_go: bool,
    /// Nobody listens any more.
    is_gone: bool,
    news: Option<Result<Pulled, String>>,
}

impl Shared {
    /// A thread that died while it held the state left it complete: the lock is only held to move values.
    fn lock(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Pull {
    /// Starts a pull. `wake` is called after each new result.
    pub fn new(follower: Follower, wake: impl Fn() + Send + 'static) -> Self {
        let shared = Arc::new(Shared::default());
        let theirs = shared.clone();
        let spawned = std::thread::Builder::new().name("pull".to_owned()).spawn({
            let theirs = theirs.clone();
            move || {
                if let Err(why) = work(follower, &theirs, &wake) {
                    theirs.lock().news = Some(Err(why));
                    wake();
                }
            }
        });
        if let Err(e) = spawned {
            theirs.lock().news = Some(Err(format!("cannot search for a wind: {e}")));
        }
        Self { shared }
    }

    /// Sets the goal for the middle of the lock's nodes (head space, cm).
    pub fn to(&self, goal: Vec3) {
        let mut state = self.shared.lock();
        (state.goal, state.moved) = (Some(goal), Some(Instant::now()));
        self.shared.urgent.store(true, Ordering::Relaxed);
        self.shared.changed.notify_all();
    }

    /// Reports that the mouse button was released: the goal is final, so the search need not wait.
    pub fn let_go(&self) {
        self.shared.lock().is_let_go = true;
        self.shared.changed.notify_all();
    }

    /// The latest result since the last call, or the error.
    pub fn take(&self) -> Option<Result<Pulled, String>> {
        self.shared.lock().news.take()
    }
}

impl Drop for Pull {
    fn drop(&mut self) {
        self.shared.lock().is_gone = true;
        self.shared.urgent.store(true, Ordering::Relaxed);
        self.shared.changed.notify_all();
    }
}

/// The next thing to do.
enum Next {
    Step,
    Search,
    Go,
}

fn work(mut follower: Follower, shared: &Arc<Shared>, wake: &dyn Fn()) -> Result<(), String> {
    let theirs = shared.clone();
    follower.set_brake(move || theirs.urgent.load(Ordering::Relaxed));
    let give = |pulled: Pulled| {
        shared.lock().news = Some(Ok(pulled));
        wake();
    };
    let (mut in_vain, mut ended) = (0, true);
    let mut goal = Vec3::ZERO;
    loop {
        match next(shared, &mut goal, &mut in_vain, &mut ended) {
            Next::Go => return Ok(()),
            Next::Step => {
                let (pulled, gained) = follower.step(goal).map_err(|error| error.to_string())?;
                in_vain = if gained { 0 } else { in_vain + 1 };
                give(pulled);
            }
            Next::Search => {
                let done = follower.search(goal, &mut |pulled| give(pulled)).map_err(|error| error.to_string())?;
                if let Some(pulled) = done {
                    ended = true;
                    give(pulled);
                }
            }
        }
    }
}

/// Waits for something to do. `goal` is the newest; `ended`: nothing nearer will be found for it.
fn next(shared: &Shared, goal: &mut Vec3, in_vain: &mut u32, ended: &mut bool) -> Next {
    let mut state = shared.lock();
    loop {
        if state.is_gone {
            return Next::Go;
        }
        if let Some(newest) = state.goal.take() {
            shared.urgent.store(false, Ordering::Relaxed);
            (*goal, *in_vain, *ended) = (newest, 0, false);
            return Next::Step;
        }
        if *ended {
            state = shared.changed.wait(state).unwrap_or_else(PoisonError::into_inner);
            continue;
        }
        let rests = state.is_let_go || state.moved.is_none_or(|moved| moved.elapsed() >= REST);
        return if rests || *in_vain >= PATIENCE { Next::Search } else { Next::Step };
    }
}

#[cfg(test)]
mod tests;
